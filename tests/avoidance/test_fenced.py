"""What the geofence does to routes, stand-ins and orbits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from avoidance import Detour, Keep, Replace, Reroute, Route
from avoidance.agent import Agent
from avoidance.detours import search_problem
from avoidance.exact_route import exact_route
from avoidance.fenced_space import nearest_within
from avoidance.geofence import FenceArea, Geofence, Walls
from avoidance.known import within_fence
from avoidance.orbits import orbit_from_here, waypoint_room
from avoidance.parameters import DEFAULT
from avoidance.route_check import first_blocked_leg
from avoidance.tangent_graph import shortest_path
from tests.avoidance.test_route_check import known
from tests.avoidance.worlds import PERFORMANCE, ownship, route, scan

NOTHING = np.empty((0, 2)), np.empty(0)


def box(south: float, west: float, north: float, east: float, include: bool = False) -> FenceArea:
    """A rectangle."""
    return FenceArea(include, ((south, west), (north, west), (north, east), (south, east)))


def shortest(
    fence: Geofence, room: float, discs: list[tuple[float, float, float]] | None = None
) -> float | None:
    """Length of the shortest way from the origin to 10 km north, posts and discs included."""
    table = np.array([*(discs or []), *((n, e, room) for n, e in fence.posts)]).reshape(-1, 3)
    path = shortest_path((0.0, 0.0), (10_000.0, 0.0), table[:, :2], table[:, 2], Walls(fence.walls, room))
    return None if path is None else path.length


def test_round_a_square_without_room_the_way_bends_at_two_corners() -> None:
    fence = Geofence([box(4000.0, -3000.0, 6000.0, 1000.0)])
    assert shortest(fence, 1e-3) == pytest.approx(2.0 * math.hypot(4000.0, 1000.0) + 2000.0, abs=0.1)


def test_round_a_square_with_room_the_way_bends_round_its_corners() -> None:
    fence = Geofence([box(5000.0, -3000.0, 5000.001, 1000.0)])
    reach, room = math.hypot(5000.0, 1000.0), 100.0
    tangent = math.sqrt(reach**2 - room**2)
    turn = 2.0 * (math.asin(room / reach) + math.atan2(1000.0, 5000.0))
    assert shortest(fence, room) == pytest.approx(2.0 * tangent + room * turn, rel=1e-4)


def test_a_gap_narrower_than_twice_the_room_is_no_way() -> None:
    wall = [box(4000.0, -50_000.0, 6000.0, -90.0), box(4000.0, 90.0, 6000.0, 50_000.0)]
    inside = box(-1000.0, -40_000.0, 12_000.0, 40_000.0, include=True)
    assert shortest(Geofence([inside, *wall]), 85.0) == pytest.approx(10_000.0)
    assert shortest(Geofence([inside, *wall]), 95.0) is None


def test_a_disc_that_leans_on_a_wall_is_passed_on_the_other_side() -> None:
    fence = Geofence([box(-1000.0, -40_000.0, 12_000.0, 900.0, include=True)])
    length = shortest(fence, 50.0, [(5000.0, 300.0, 1000.0)])
    assert length == pytest.approx(shortest(Geofence(), 50.0, [(5000.0, 300.0, 1000.0)]), abs=1e-6)
    blocked = Geofence([box(-1000.0, -600.0, 12_000.0, 900.0, include=True)])
    assert shortest(blocked, 50.0, [(5000.0, 300.0, 1000.0)]) is None


@settings(max_examples=60)
@given(
    st.lists(
        st.tuples(st.integers(1, 9), st.integers(-4, 4), st.integers(1, 3), st.integers(1, 3)), max_size=5
    ),
    st.lists(st.tuples(st.integers(2, 8), st.integers(-3, 3)), max_size=3),
)
def test_the_way_with_walls_is_that_round_many_small_discs(
    boxes: list[tuple[int, int, int, int]], discs: list[tuple[int, int]]
) -> None:
    """Walls against the same walls as chains of discs, by the planner without walls."""
    room, step = 100.0, 25.0
    areas = [
        box(1000.0 * n + 37.0, 600.0 * e + 11.0, 1000.0 * n + 37.0 + 333.0 * h, 600.0 * (e + w))
        for n, e, h, w in boxes
    ]
    fence = Geofence(areas)
    if not fence.allows(np.array([(0.0, 0.0), (10_000.0, 0.0)])).all():
        return
    walls = fence.walls
    ends = np.array([(0.0, 0.0), (10_000.0, 0.0)])
    if (Walls(walls).clearance(ends, ends) < room).any():
        return
    extra = [(1000.0 * n, 700.0 * e, 400.0) for n, e in discs]
    exact = shortest(fence, room, extra)
    chain = [p for a, b in walls for p in np.linspace(a, b, max(2, math.ceil(math.dist(a, b) / step)))]
    table = np.array([*extra, *((*p, room) for p in chain)]).reshape(-1, 3)
    rough = shortest_path(tuple(ends[0]), tuple(ends[1]), table[:, :2], table[:, 2])
    if rough is None:
        assert exact is None  # discs that touch still leave a way, so this is the stricter side
    elif exact is not None:
        assert rough.length <= exact + 1e-6
        assert exact - rough.length < 20.0 + 5.0 * len(walls)


def fly_scans(fence: Geofence, way: Route, obstacles: list[tuple[float, float]]) -> tuple[list, Route]:
    """Show the same scan until nothing changes any more."""
    agent = Agent(PERFORMANCE, DEFAULT, geofence=fence)
    decisions = []
    for second in range(4):
        decisions.append(agent.decide(ownship(time=second), way, scan(obstacles, float(second))))
        if decisions[-1].route is not None:
            way = Route(way.origin, decisions[-1].route)
    return decisions, way


def test_a_detour_stays_within_the_fence() -> None:
    """The shorter side is forbidden."""
    fence = Geofence([box(-2000.0, -840.0, 42_000.0, 20_000.0, include=True)])
    free, _ = fly_scans(Geofence(), route((40_000.0, 0.0)), [(9000.0, 200.0)])
    fenced, way = fly_scans(fence, route((40_000.0, 0.0)), [(9000.0, 200.0)])
    assert [d.waypoint.east < 0.0 for d in free if isinstance(d, Detour)] == [True]
    assert [d.waypoint.east > 0.0 for d in fenced if isinstance(d, Detour)] == [True]
    points = np.array([(0.0, 0.0), *((w.north, w.east) for w in way.waypoints)])
    assert Walls(fence.walls).clearance(points[:-1], points[1:]).min() >= DEFAULT.margin


def test_a_leg_that_leaves_the_fence_is_flown_round_its_corner_and_says_why() -> None:
    fence = Geofence([box(9000.0, -5000.0, 11_000.0, 800.0)])
    decisions, _ = fly_scans(fence, route((40_000.0, 0.0)), [])
    first = next(d for d in decisions if not isinstance(d, Keep))
    assert isinstance(first, Detour | Reroute)
    assert first.why.startswith("the geofence cuts the route 8.9 km ahead")


@pytest.mark.parametrize("place", [(9000.0, 5200.0), (9000.0, 4950.0)])
def test_a_waypoint_outside_the_fence_or_at_its_edge_is_replaced_by_the_nearest_inside(
    place: tuple[float, float],
) -> None:
    fence = Geofence([box(-5000.0, -5000.0, 15_000.0, 5000.0, include=True)])
    decisions, way = fly_scans(fence, route(place, (12_000.0, 0.0)), [])
    assert isinstance(decisions[0], Replace)
    assert "the geofence" in decisions[0].why
    room = DEFAULT.margin + waypoint_room(PERFORMANCE, DEFAULT.margin)
    assert (way.waypoints[0].north, way.waypoints[0].east) == pytest.approx((9000.0, 5000.0 - room), abs=0.1)


def test_the_nearest_place_is_in_the_part_of_the_fence_that_can_be_reached() -> None:
    island = box(9000.0, 8000.0, 11_000.0, 10_000.0, include=True)
    fence = Geofence([box(-5000.0, -5000.0, 15_000.0, 5000.0, include=True), island])
    found = nearest_within((10_000.0, 8500.0), (0.0, 0.0), *NOTHING, np.empty(0), fence, 50.0, 150.0)
    assert found == pytest.approx((10_000.0, 4850.0), abs=0.1)


@pytest.mark.parametrize("room", [95.0, 0.0])
def test_what_shuts_a_field_from_edge_to_edge_leaves_a_place_before_it(room: float) -> None:
    """All the nearest places lie behind it, more of them than ways are looked for."""
    centres = np.array([(11_000.0, east) for east in np.arange(-3000.0, 3001.0, 1500.0)])
    fence = Geofence([box(-3000.0, -3500.0, 24_000.0, 3500.0, include=True)])
    keep = np.full(5, 1025.0)
    found = nearest_within((20_000.0, 0.0), (0.0, 0.0), centres, keep + room, keep, fence, 25.0, 25.0 + room)
    notch = 11_000.0 - math.sqrt((1025.0 + room) ** 2 - 750.0**2)  # between two of them
    assert found is not None
    assert found[0] == pytest.approx(notch, abs=0.1)
    assert abs(found[1]) == pytest.approx(750.0, abs=0.1)


def test_an_orbit_turns_away_from_the_fence() -> None:
    own, way = ownship(), route((40_000.0, 0.0))
    fence = Geofence([box(-5000.0, -60.0, 50_000.0, 5000.0, include=True)])
    orbit = orbit_from_here(own, within_fence(known([], own, way), fence, own, DEFAULT), PERFORMANCE)
    assert orbit.direction == 1
    assert orbit.clearance >= 0.0


@pytest.mark.parametrize("corner", [(2059.0, -1406.0, 3895.0, 400.0), (2500.0, -311.0, 4390.0, 1091.0)])
def test_the_exact_route_round_a_box_is_found_though_its_turns_come_near(
    corner: tuple[float, float, float, float],
) -> None:
    """Walls are widened with the circles about their ends: no way could bend round one that is smaller."""
    own, way = ownship(), route((6000.0, 0.0))
    around = within_fence(known([], own, way), Geofence([box(*corner)]), own, DEFAULT)
    blocked = first_blocked_leg(own, way, around, PERFORMANCE)
    assert blocked is not None
    problem, _, _ = search_problem(own, way, around, blocked, PERFORMANCE, DEFAULT)
    found = exact_route(problem)
    assert found is not None
    corners = np.array([problem.start, *found, problem.target])
    assert np.hypot(*np.diff(corners, axis=0).T).sum() < 6200.0


def test_in_a_lane_beside_a_box_the_vehicle_does_not_hold() -> None:
    fence = Geofence([box(-3000.0, -3000.0, 12_000.0, 1000.0, True), box(3000.0, -3500.0, 6500.0, 600.0)])
    decision = Agent(PERFORMANCE, geofence=fence).decide(ownship(), route((9000.0, 0.0)), scan([]))
    assert isinstance(decision, Detour | Reroute)
