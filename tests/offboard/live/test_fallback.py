"""The fall-back: who holds the vehicle, we or somebody else."""

from __future__ import annotations

import pytest

from avoidance import Performance, Waypoint
from offboard.frames import MapFrame
from offboard.live.aboard import Aboard
from offboard.live.autopilots import rules_of
from offboard.live.edit_run import Wanted
from offboard.live.fallback import COME_BACK, Fallback
from offboard.live.limits import EditTimes
from offboard.live.messages import Ask, Message, Reply
from offboard.live.telemetry import Telemetry
from offboard.live.vehicle_clock import VehicleClock
from offboard.live.watch import Watch
from offboard.mission_list import MissionList
from offboard.raw_mission import Composed

FRAME = MapFrame(14.39, 76.60, 600.0)
MISSION, HOLD = 4 << 16 | 4 << 24, 4 << 16 | 3 << 24
PLACE, ELSEWHERE = Waypoint(3000.0, 400.0, 200.0), Waypoint(500.0, 0.0, 200.0)


class Link:
    """Numbers requests, and has a clock."""

    def __init__(self):
        self.now = 100.0

    def wall(self):
        return self.now

    def ask(self, what, *values):
        self.asked = what, *values
        return 7


class Fallen:
    """A PX4 that could not be given an edit."""

    def __init__(self):
        self.link, telemetry = Link(), Telemetry(custom_mode=MISSION)
        can = Performance(15.0, 0.5, 1.0, 100.0, 15.0)
        clock = VehicleClock(0.0, 0.0)
        self.aboard = Aboard(self.link, telemetry, rules_of(12), FRAME, can, EditTimes(), {}, clock)
        self.fallback = Fallback(self.aboard, Watch(rules_of(12), disarmed=False))
        nothing = Wanted(MissionList((), ()), Composed((), (), 0), None, PLACE, 0)
        self.fallback.begin(nothing, "refused")

    def shows(self, mode, place, seconds=0.2):
        """Who is found to fly it, a while later, in a mode and on the way to a place."""
        self.link.now += seconds
        latitude_deg, longitude_deg = FRAME.to_geodetic(place.north, place.east)
        fields = {"lat_int": round(latitude_deg * 1e7), "lon_int": round(longitude_deg * 1e7)}
        self.aboard.telemetry.custom_mode = mode
        self.aboard.telemetry.feed(Message("POSITION_TARGET_GLOBAL_INT", fields, arrived=self.link.now))
        return self.fallback.taken()


def test_the_vehicle_is_sent_to_the_place_by_its_height_above_the_sea():
    what, *values = Fallen().link.asked
    assert what is Ask.GOTO
    assert values[:3] == pytest.approx([*FRAME.to_geodetic(PLACE.north, PLACE.east), 800.0])


def test_a_target_of_before_that_comes_after_the_mode_is_nobody_else_s():
    fallen = Fallen()
    assert fallen.shows(HOLD, ELSEWHERE) is None
    assert fallen.shows(HOLD, PLACE) is None
    assert "sent the vehicle to another place" in fallen.shows(HOLD, ELSEWHERE)


def test_a_hold_that_never_leads_to_our_place_is_somebody_else_s():
    fallen = Fallen()
    assert fallen.shows(MISSION, ELSEWHERE, 4.0) is None
    assert fallen.shows(HOLD, ELSEWHERE) is None
    assert fallen.shows(HOLD, ELSEWHERE, COME_BACK - 4.0) is None
    assert not fallen.fallback.due  # it is not known yet who holds it
    assert "sent the vehicle to another place" in fallen.shows(HOLD, ELSEWHERE, 1.5)


def test_one_that_has_refused_us_and_shows_no_target_is_held_by_somebody_else():
    fallen = Fallen()
    fallen.fallback.on_reply(Reply(Ask.GOTO, 7, ok=False, why="DENIED"))
    fallen.aboard.telemetry.custom_mode = HOLD
    assert fallen.fallback.taken() is None
    fallen.link.now += 3.0
    assert fallen.fallback.taken() == "someone else holds the vehicle"


def test_the_mission_is_tried_again_after_a_while_at_the_place():
    fallen = Fallen()
    assert fallen.shows(HOLD, PLACE, 1.0) is None
    assert not fallen.fallback.due
    assert fallen.shows(HOLD, PLACE, COME_BACK) is None
    assert fallen.fallback.due
