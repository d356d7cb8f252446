"""A mission flown over MAVLink, by the rules of each autopilot."""

from __future__ import annotations

import pytest

from offboard.sitl.dialect import mavlink
from tests.offboard.sitl.station import POINTS, Station, autopilot, distance, mission, ready

KINDS = ("px4", "ardupilot")


@pytest.mark.parametrize("kind", KINDS)
def test_a_mission_is_flown_to_its_end(kind):
    station = ready(kind)
    told = station.fly_until(lambda: station.pilot.captain.mission_over)
    first = 1 if kind == "ardupilot" else 0
    reached = {m.seq for m in station.seen if m.get_type() == "MISSION_ITEM_REACHED"}
    assert reached == {first, first + 1}  # a circle is never over
    assert distance(station.pilot, *POINTS[-1][:2]) < 150.0
    assert [m for m in told if m.get_type() == "MISSION_CURRENT"][-1].seq == first + 2


def test_px4_repeats_what_it_has_reached_and_ardupilot_does_not():
    counts = {}
    for kind in KINDS:
        station = ready(kind)
        station.fly(30.0)
        counts[kind] = sum(m.get_type() == "MISSION_ITEM_REACHED" for m in station.seen)
    assert counts == {"px4": 10, "ardupilot": 1}


@pytest.mark.parametrize("kind", KINDS)
def test_heartbeat_tells_mode_and_arming(kind):
    station = Station(autopilot(kind))
    station.fly(0.1)
    before = station.last("HEARTBEAT")
    station.command(400, 1.0)
    armed = station.last("HEARTBEAT")
    assert not before.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED
    assert armed.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED
    assert (before.autopilot, before.base_mode, before.custom_mode) == {
        "px4": (12, 29, 50593792),
        "ardupilot": (3, 81, 0),
    }[kind]


def test_px4_flies_to_the_flagged_item_at_once():
    station = ready("px4")
    station.fly(20.0)
    new = mission(points=(POINTS[0], (800.0, 600.0, 200.0), *POINTS[1:]), flagged=1)
    assert station.upload(new)[0] == 0
    target = station.last("POSITION_TARGET_GLOBAL_INT")
    assert (target.lat_int, target.lon_int) == (new[1].x, new[1].y)
    assert station.last("MISSION_CURRENT").total == 4


def test_ardupilot_keeps_its_target_until_it_is_told_otherwise():
    station = ready("ardupilot")
    station.fly(20.0)
    old = station.last("POSITION_TARGET_GLOBAL_INT").lat_int
    new = mission("ardupilot", (POINTS[0], (800.0, 600.0, 200.0), *POINTS[1:]), flagged=2)
    assert station.upload(new)[0] == 0
    station.fly(3.0)
    assert station.last("POSITION_TARGET_GLOBAL_INT").lat_int == old
    assert (station.last("MISSION_CURRENT").seq, station.last("MISSION_CURRENT").total) == (2, 4)
    station.send(mavlink.MAVLink_mission_set_current_message(1, 1, 2))
    station.read()
    assert station.last("POSITION_TARGET_GLOBAL_INT").lat_int == new[2].x


def test_px4_holds_when_a_new_mission_cannot_be_flown():
    station = ready("px4")
    station.fly(20.0)
    station.parameter("MIS_TKO_LAND_REQ", 2.8e-45)  # the bytes of the integer 2
    assert station.upload(mission())[0] == 0
    station.read()
    assert station.last("STATUSTEXT").text.startswith("No valid mission available, loitering")
    assert station.last("HEARTBEAT").custom_mode == 50593792
    current = station.last("MISSION_CURRENT")
    assert (current.mission_state, current.mission_mode) == (1, 2)


def test_ardupilot_swallows_the_first_item():
    station = Station(autopilot("ardupilot"))
    station.fly(0.1)
    assert station.upload(mission("px4"))[0] == 0  # without home in front
    first, second, *_ = station.download()
    assert (first.frame, first.z) == (0, 600.0)
    assert (second.x, second.frame) == (mission("px4")[1].x, 3)


def test_links_are_apart():
    pilot = autopilot("px4")
    one, two = Station(pilot, link=1), Station(pilot, link=2, system=255)
    pilot.open(1)
    pilot.open(2)
    one.command(511, 33.0, 1e6 * 0.1)
    pilot.step(0.1)
    for station in (one, two):
        station.read()
        station.seen.clear()
    for _ in range(100):
        pilot.step(0.1)
    counts = [len(s.read("GLOBAL_POSITION_INT")) for s in (one, two)]
    assert counts == [100, 50]
