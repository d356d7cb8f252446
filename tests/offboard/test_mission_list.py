from __future__ import annotations

import dataclasses
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from avoidance import Waypoint
from offboard.mission import CameraAction, MissionItem, MissionPlan
from offboard.mission_list import MissionList
from tests.offboard.fake_plant import HOME

METRES = st.floats(-300_000.0, 300_000.0)
NAN = st.just(math.nan)
ITEMS = st.builds(
    lambda north, east, **rest: MissionItem(*HOME.to_geodetic(north, east), **rest),
    north=METRES,
    east=METRES,
    relative_altitude_m=st.floats(50.0, 500.0),
    speed_m_s=NAN | st.floats(12.0, 22.0),
    acceptance_radius_m=NAN | st.floats(20.0, 1000.0),
    loiter_time_s=NAN | st.floats(0.0, 60.0),
    camera_action=st.sampled_from(CameraAction),
    yaw_deg=NAN | st.floats(0.0, 360.0),
)
PLACES = st.builds(Waypoint, METRES, METRES, st.just(200.0))


def mission_of(*speeds: float, radius: float = math.nan) -> MissionList:
    """Items 10 km apart towards north, with these speeds."""
    items = [
        MissionItem(*HOME.to_geodetic(1e4 * i, 0.0), 200.0, speed_m_s=speed, acceptance_radius_m=radius)
        for i, speed in enumerate(speeds)
    ]
    return MissionList.of(MissionPlan.of(items), HOME, cruise_speed=15.0)


def same(a: MissionItem, b: MissionItem, *apart_from: str) -> bool:
    """Equal field for field, NaN being equal to NaN."""
    return all(
        field.name in apart_from or repr(getattr(a, field.name)) == repr(getattr(b, field.name))
        for field in dataclasses.fields(MissionItem)
    )


@settings(max_examples=60, deadline=None)
@given(items=st.lists(ITEMS, min_size=1, max_size=6), data=st.data())
def test_uploaded_items_keep_their_fields_through_any_edit(
    items: list[MissionItem], data: st.DataObject
) -> None:
    mission = MissionList.of(MissionPlan.of(items), HOME, cruise_speed=15.0)
    current = data.draw(st.integers(0, len(items) - 1))
    route: list[Waypoint] = []
    for waypoint in mission.ahead(current):
        route += data.draw(st.lists(PLACES, max_size=2))
        fate = data.draw(st.sampled_from(["keep", "move", "skip"]))
        if fate == "move":
            route.append(dataclasses.replace(waypoint, north=waypoint.north + 900.0, moved=True))
        elif fate == "keep":
            route.append(waypoint)

    edited = mission.with_route(current, route, HOME)

    assert edited.ahead(current) == tuple(route)
    assert edited.entries[:current] == mission.entries[:current]
    for entry in edited.entries:
        if entry.waypoint.item is None:
            continue
        place = ("latitude_deg", "longitude_deg") if entry.waypoint.moved else ()
        assert same(entry.item, items[entry.waypoint.item], *place)
    gone = set(range(current, len(items))) - {w.item for w in route}
    assert set(edited.skipped) == gone


@settings(max_examples=40, deadline=None)
@given(items=st.lists(ITEMS, min_size=1, max_size=5))
def test_a_mission_that_was_not_edited_downloads_as_it_was_uploaded(items: list[MissionItem]) -> None:
    mission = MissionList.of(MissionPlan.of(items), HOME, cruise_speed=15.0)

    assert all(same(a, b) for a, b in zip(mission.items(), items, strict=True))


def test_an_injected_waypoint_takes_after_the_item_it_precedes() -> None:
    mission = mission_of(math.nan, 18.0, math.nan, radius=250.0)
    new = Waypoint(14_000.0, 1500.0, 210.0)

    edited = mission.with_route(2, (new, mission.entries[2].waypoint), HOME)

    entry = edited.entries[2]
    assert entry.injected
    assert entry.airspeed == 18.0
    assert entry.item.acceptance_radius_m == 250.0
    assert entry.item.relative_altitude_m == 210.0
    place = HOME.to_map(entry.item.latitude_deg, entry.item.longitude_deg)
    assert math.dist(place, (14_000.0, 1500.0)) < 1e-3


def test_the_speed_of_a_skipped_item_still_holds_behind_it() -> None:
    mission = mission_of(15.0, 20.0, math.nan)

    edited = mission.with_route(1, (mission.entries[2].waypoint,), HOME)

    assert edited.skipped == (1,)
    assert edited.entries[1].airspeed == 20.0
    assert edited.items()[0].speed_m_s == 20.0


def test_a_moved_item_can_be_moved_back() -> None:
    mission = mission_of(15.0, 15.0)
    target = mission.entries[1].waypoint
    moved = dataclasses.replace(target, east=2500.0, moved=True)

    back = mission.with_route(1, (moved,), HOME).with_route(1, (target,), HOME)

    assert back == mission


def test_an_operators_items_are_part_of_the_mission_afterwards() -> None:
    mission = mission_of(math.nan, math.nan, math.nan)
    extra = MissionItem(*HOME.to_geodetic(5000.0, 800.0), 200.0, speed_m_s=20.0)

    longer = mission.with_injected(1, [extra], HOME)

    assert [entry.waypoint.item for entry in longer.entries] == [0, 3, 1, 2]
    assert [entry.airspeed for entry in longer.entries] == [15.0, 15.0, 20.0, 15.0]
    again = longer.with_route(1, longer.ahead(1), HOME)
    assert again == longer


@pytest.mark.parametrize(
    ("route", "message"),
    [
        ((Waypoint(0.0, 0.0, 200.0, item=7),), "item 7, must be between 0 and 1"),
        ((Waypoint(10_000.0, 5.0, 200.0, item=1),), "item 1 at another place"),
        ((Waypoint(1.0, 1.0, 1.0, 1, True), Waypoint(2.0, 1.0, 1.0, 1, True)), "an item twice"),
    ],
)
def test_routes_that_contradict_the_mission_are_refused(route: tuple[Waypoint, ...], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        mission_of(15.0, 15.0).with_route(1, route, HOME)
