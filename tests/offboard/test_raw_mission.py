"""Edited waypoints back among everything else of a mission."""

from __future__ import annotations

from dataclasses import replace

import pytest

from avoidance import Waypoint
from offboard.errors import LinkError
from offboard.frames import MapFrame
from offboard.mission_list import MissionList
from offboard.orbit import Orbit
from offboard.raw_mission import RawItem, RawMission, compose

FRAME = MapFrame(14.39, 76.60, 600.0)


def at(north: float, command: int = 16, **more) -> RawItem:
    latitude, longitude = FRAME.to_geodetic(north, 0.0)
    return RawItem(command, 6, x=round(latitude * 1e7), y=round(longitude * 1e7), z=200.0, **more)


def do(command: int, *params: float) -> RawItem:
    return RawItem(command, 2, (*params, *[0.0] * (4 - len(params))))


RAW = RawMission.of([do(178, 0, 18), at(0), do(206, 25), at(5000), do(177, 1, 3), at(9000)])
LIST = MissionList.of(RAW.plan(600.0), FRAME, 15.0)
ANCHOR, NEW = Waypoint(1000.0, 0.0, 200.0), Waypoint(3000.0, 900.0, 200.0)


def commands(composed) -> list[int]:
    return [item.command for item in composed.items]


def test_unedited_it_is_what_was_uploaded_and_circles_at_its_end():
    composed = compose(RAW, LIST, 0, FRAME)
    assert composed.items[:-1] == RAW.items
    assert composed.items[-1].command == 17
    assert RAW.first_speed() == 18.0


def test_a_detour_goes_behind_what_is_done_at_the_waypoint_before_and_has_an_anchor():
    edited = LIST.with_route(1, (NEW, *LIST.ahead(1)), FRAME)
    composed = compose(RAW, edited, 1, FRAME, anchor=ANCHOR)
    assert commands(composed) == [178, 16, 206, 16, 16, 16, 177, 16, 17]
    assert composed.current == 4
    assert composed.entry_of(composed.current) == 1
    assert composed.items[6].params[0] == 1.0  # the jump still leads to the first waypoint
    assert composed.entry_of(8) == 4  # past the end


def test_a_detour_that_has_been_passed_is_left_out():
    edited = LIST.with_route(1, (NEW, *LIST.ahead(1)), FRAME)
    composed = compose(RAW, edited, 2, FRAME)
    assert commands(composed) == [178, 16, 206, 16, 177, 16, 17]
    assert composed.entry_of(composed.current) == 2


def test_a_jump_follows_its_target():
    edited = LIST.with_route(0, (NEW, *LIST.ahead(0)), FRAME)
    jump = next(item for item in compose(RAW, edited, 0, FRAME).items if item.command == 177)
    assert jump.params[0] == 2.0


def test_what_belongs_to_a_skipped_waypoint_is_still_done():
    edited = LIST.with_route(1, LIST.ahead(2), FRAME)
    assert commands(compose(RAW, edited, 1, FRAME)) == [178, 16, 206, 177, 16, 17]


def test_a_hold_is_circled_before_the_current_waypoint():
    composed = compose(RAW, LIST, 1, FRAME, hold=Orbit(1000.0, 0.0, 200.0, 90.0, -1))
    item = composed.items[composed.current]
    assert (item.command, item.params[2]) == (17, -90.0)
    assert composed.entry_of(composed.current) == 1


def test_a_circle_at_the_last_waypoint_is_no_waypoint():
    raw = RawMission.of([at(0), at(5000), at(5000, 17)])
    assert raw.flown_to == (0, 1)


def test_a_mission_that_leads_nowhere_is_refused():
    with pytest.raises(LinkError, match="no item to fly to"):
        RawMission.of([do(178, 0, 18)])


@pytest.mark.parametrize("frame", [10, 11, 1])
def test_heights_above_the_ground_are_refused_with_the_item(frame):
    mission = RawMission.of([at(0), replace(at(5000), frame=frame)])
    with pytest.raises(LinkError, match=f"item 1: altitude in MAV_FRAME {frame}"):
        mission.plan(600.0)
