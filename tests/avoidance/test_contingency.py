"""The orbit that is always kept, and the passages that are not entered for the want of one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from avoidance import Ownship, Performance, Route, Waypoint
from avoidance.agent import Agent
from avoidance.contingency import first_trap, longest_stretch, room_outside
from avoidance.known import Known, kept_margin
from avoidance.ladder import way_round
from avoidance.orbits import (
    orbit_from_here,
    orbit_on_arrival,
    orbit_reach,
    passage_room,
    reach_across,
    turning_room,
    waypoint_room,
)
from avoidance.parameters import DEFAULT, PAPER
from avoidance.passages import Gap, way_with_orbits
from tests.avoidance.test_route_check import known
from tests.avoidance.worlds import PERFORMANCE, ownship, route, scan


def corridor(half_width: float, length: float = 6000.0, begin: float = 3000.0) -> list[tuple[float, float]]:
    """Two walls of spheres; nothing within `half_width` of the line between them."""
    places = np.arange(begin, begin + length + 1.0, 100.0)
    return [(float(north), side * (half_width + 1000.0)) for north in places for side in (-1.0, 1.0)]


def seen(obstacles: list[tuple[float, float]], own: Ownship, way: Route) -> Known:
    return known(obstacles, own, way)


def test_in_the_open_the_orbit_is_wide_and_touches_the_course_one_roll_time_ahead() -> None:
    own = ownship()
    orbit = orbit_from_here(own, seen([(9000.0, 0.0)], own, route((40_000.0, 0.0))), PERFORMANCE)
    assert orbit.clearance > 0.0
    assert orbit.radius == pytest.approx(1.5 * PERFORMANCE.turn_radius)
    assert orbit.centre[0] == pytest.approx(PERFORMANCE.airspeed * PERFORMANCE.roll_time)
    assert abs(orbit.centre[1]) == pytest.approx(orbit.radius)


@pytest.mark.parametrize(("side", "direction"), [(-1.0, 1), (1.0, -1)])
def test_the_orbit_is_begun_away_from_what_is_near(side: float, direction: int) -> None:
    own = ownship()
    near = seen([(0.0, side * 1060.0)], own, route((40_000.0, 0.0)))
    orbit = orbit_from_here(own, near, PERFORMANCE)
    assert orbit.clearance >= 0.0
    assert orbit.direction == direction


@pytest.mark.parametrize(("more", "free"), [(2.0, True), (-2.0, False)])
def test_between_two_spheres_an_orbit_needs_its_reach_to_both_sides(more: float, free: bool) -> None:
    half = orbit_reach(PERFORMANCE)
    aside = 1.2 * PERFORMANCE.turn_radius
    lead = PERFORMANCE.airspeed * PERFORMANCE.roll_time
    own = ownship(north=-lead, east=-aside)
    walls = seen([(0.0, -half - 1000.0 - more), (0.0, half + 1000.0 + more)], own, route((40_000.0, 0.0)))
    assert (orbit_from_here(own, walls, PERFORMANCE).clearance >= 0.0) == free


@pytest.mark.parametrize(
    ("half_width", "length", "trap"), [(60, 6000, True), (60, 0, False), (150, 6000, False)]
)
def test_only_a_long_and_narrow_passage_is_a_trap(half_width: float, length: float, trap: bool) -> None:
    own, way = ownship(), route((40_000.0, 0.0))
    found = first_trap(own, way, seen(corridor(half_width, length), own, way), PERFORMANCE, DEFAULT)
    assert (found is not None) == trap


def test_a_trap_tells_where_it_begins_and_between_what() -> None:
    own, way = ownship(), route((1000.0, 0.0), (40_000.0, 0.0))
    found = first_trap(own, way, seen(corridor(80.0), own, way), PERFORMANCE, DEFAULT)
    assert found is not None
    assert found.leg == 1
    assert found.threat.narrow
    assert found.threat.distance == pytest.approx(3000.0, abs=300.0)
    assert found.threat.required == pytest.approx(turning_room(PERFORMANCE))
    assert len(found.threat.ids) == 2


def test_a_leg_that_is_cut_hides_no_trap_on_the_way_to_it() -> None:
    walls = corridor(60.0, length=3000.0)
    way = route((8000.0, 0.0), (40_000.0, 0.0))
    agent = Agent(PERFORMANCE)
    for second in range(4):
        decision = agent.decide(ownship(time=second), way, scan([*walls, (9500.0, 0.0)], time=second))
    assert decision.threat is not None
    assert decision.threat.leg == 0
    assert decision.threat.narrow


def test_out_of_a_narrow_passage_a_way_is_found_through_another_that_is_short() -> None:
    """Room for orbits everywhere would shut it; the way with no more room than it needs is no trap."""
    gate = [(17_000.0, side * east) for east in np.arange(1055.0, 9000.0, 1500.0) for side in (-1.0, 1.0)]
    walls = [
        (north, -2500.0 + side * 1045.0) for north in np.arange(2500.0, 6501.0, 500.0) for side in (-1, 1)
    ]
    own, points = ownship(), ((1500.0, -2500.0), (7000.0, -2500.0), (20_000.0, 0.0))
    way = Route(
        Waypoint(0.0, 0.0, 200.0, item=0),
        tuple(Waypoint(n, e, 200.0, item=1 if n > 9000.0 else None) for n, e in points),
    )
    around = seen([*walls, *gate], own, way)
    trap = first_trap(own, way, around, PERFORMANCE, DEFAULT)
    assert trap is not None
    gap = Gap.of(own, way, around, trap, PERFORMANCE, DEFAULT)
    found = way_with_orbits(gap, way_round, np.random.default_rng(0))
    assert found is not None
    assert found.route is not None
    assert len(found.route) == 1


@pytest.mark.parametrize(("more", "trap"), [(0.5, False), (-25.0, True)])
@pytest.mark.parametrize("turn", [10.0, 12.5, 15.0])
def test_beside_a_sphere_an_orbit_is_free_on_the_other_side_as_soon_as_there_is_room(
    turn: float, more: float, trap: bool
) -> None:
    corner = np.radians(turn)
    away = (1000.0 + room_outside(PERFORMANCE, corner) + more) / np.cos(0.5 * corner)
    bearings = np.arange(np.radians(-90.0), np.radians(60.0), corner)
    round_it = [(float(away * np.sin(b)), float(-away * np.cos(b))) for b in bearings]
    course = 0.5 * corner
    own = ownship(round_it[0][0] - 500.0 * np.cos(course), round_it[0][1] + 500.0 * np.sin(course))
    way = route(*round_it)
    assert (first_trap(own, way, seen([(0.0, 0.0)], own, way), PERFORMANCE, DEFAULT) is not None) == trap


@pytest.mark.parametrize(("half_width", "room"), [(60.0, False), (250.0, True)])
def test_an_orbit_on_arrival_needs_room_on_one_side(half_width: float, room: bool) -> None:
    own, way = ownship(), route((6000.0, 0.0))
    around = seen(corridor(half_width), own, way)
    assert orbit_on_arrival((0.0, 0.0), way.waypoints[0], around, PERFORMANCE) == room


@pytest.mark.parametrize(
    "performance", [PERFORMANCE, replace(PERFORMANCE, wind_bound=12.0, tracking_error=10.0)]
)
def test_where_a_waypoint_may_lie_an_orbit_is_free_on_arrival_from_everywhere(
    performance: Performance,
) -> None:
    margin = kept_margin(DEFAULT, performance)
    away = 1000.0 + margin + waypoint_room(performance, margin) + 0.1
    own, way = ownship(), route((0.0, 0.0))
    around = seen([(away * np.cos(b), away * np.sin(b)) for b in np.arange(0.0, 6.0, 0.5)], own, way)
    for bearing in np.arange(0.0, 6.2, 0.1):
        before = (-5000.0 * np.cos(bearing), -5000.0 * np.sin(bearing))
        assert orbit_on_arrival(before, way.waypoints[0], around, performance)


@pytest.mark.parametrize(("more", "trap"), [(1.0, False), (-40.0, True)])
def test_a_way_in_with_room_on_both_sides_is_no_trap_along_one_of_them(more: float, trap: bool) -> None:
    room = DEFAULT.margin + passage_room(PERFORMANCE, DEFAULT.margin) + more
    aside = room - max(DEFAULT.margin, reach_across(PERFORMANCE))
    own, way = ownship(east=-aside), route((40_000.0, -aside), origin=(0.0, -aside))
    found = first_trap(own, way, seen(corridor(room), own, way), PERFORMANCE, DEFAULT)
    assert (found is not None) == trap


def test_no_trap_without_the_promise() -> None:
    own, way = ownship(), route((40_000.0, 0.0))
    assert first_trap(own, way, seen(corridor(60.0), own, way), PERFORMANCE, PAPER) is None


def test_wind_needs_wider_turns_and_shorter_stretches() -> None:
    windy = replace(PERFORMANCE, wind_bound=8.0)
    assert turning_room(windy) > 1.5 * turning_room(PERFORMANCE)
    assert longest_stretch(windy, 1000.0) < longest_stretch(PERFORMANCE, 1000.0)
