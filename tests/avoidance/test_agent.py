"""One scan in, one decision out."""

from __future__ import annotations

import numpy as np
import pytest

from avoidance import Decision, Detour, Keep, RadarScan, Replace, Reroute, Resume, Route, Rung, Waypoint
from avoidance.agent import Agent
from avoidance.flown import flown_segments
from avoidance.geometry import segments_clearance
from avoidance.known import kept_margin
from avoidance.orbits import waypoint_room
from avoidance.parameters import DEFAULT, PRESETS
from avoidance.prediction import route_separation
from tests.avoidance.worlds import PERFORMANCE, intruders, ownship, route, scan


def decide(
    obstacles: list[tuple[float, float]], way: Route | None = None, preset: str = "default", scans: int = 2
) -> Decision:
    """Show the same scan to a vehicle at the origin, flying north, until something is decided."""
    agent = Agent(PERFORMANCE, PRESETS[preset], np.random.default_rng(0))
    way = route((40_000.0, 0.0)) if way is None else way
    for second in range(scans):
        decision = agent.decide(ownship(time=second), way, scan(obstacles, float(second)))
    return decision


def test_a_clear_route_is_kept() -> None:
    assert isinstance(decide([(8000.0, 3000.0)]), Keep)


@pytest.mark.parametrize("preset", PRESETS)
def test_a_blocked_leg_gets_one_waypoint(preset: str) -> None:
    decision = decide([(8000.0, 300.0)], preset=preset)
    assert isinstance(decision, Detour)
    assert decision.rung is Rung.WAYPOINT
    assert decision.threat is not None
    assert decision.threat.ids == (1,)
    assert decision.route is not None
    assert [waypoint.item for waypoint in decision.route] == [None, 1]


def test_the_detour_is_clear_as_flown() -> None:
    decision = decide([(8000.0, 300.0), (8500.0, -900.0)])
    assert decision.route is not None
    points = np.array([(0.0, 0.0), *((w.north, w.east) for w in decision.route)])
    starts, ends, extra = flown_segments(points[None], 0.0, PERFORMANCE)
    distance = segments_clearance(starts[0], ends[0], np.array([(8000.0, 300.0), (8500.0, -900.0)]))
    assert (distance - extra[0][:, None]).min() >= 1000.0


def test_an_obstacle_above_its_radius_does_not_count() -> None:
    agent = Agent(PERFORMANCE)
    for second in range(3):
        high = scan([(8000.0, 0.0)], float(second), radius=300.0, altitude=600.0)
        assert isinstance(agent.decide(ownship(time=second), route((40_000.0, 0.0)), high), Keep)


def test_a_waypoint_inside_a_sphere_is_replaced_by_the_nearest_safe_point() -> None:
    decision = decide([(8000.0, 200.0)], route((8000.0, 0.0), (8000.0, 20_000.0)))
    assert isinstance(decision, Replace)
    assert decision.waypoint is not None
    assert decision.waypoint.item == 1
    assert decision.waypoint.moved
    away = np.hypot(decision.waypoint.north - 8000.0, decision.waypoint.east - 200.0)
    assert away == pytest.approx(
        1000.0 + DEFAULT.margin + waypoint_room(PERFORMANCE, DEFAULT.margin), abs=1.5
    )


def test_a_walled_in_waypoint_is_not_flown_into() -> None:
    angles = np.linspace(0.0, 2 * np.pi, 14, endpoint=False)
    ring = [(8000.0 + 2600.0 * np.cos(a), 2600.0 * np.sin(a)) for a in angles]
    way = route((8000.0, 0.0), (30_000.0, 0.0))
    agent = Agent(PERFORMANCE)
    for second in range(4):
        decision = agent.decide(ownship(time=second), way, scan(ring, float(second)))
        if decision.route is not None:
            way = Route(way.origin, decision.route)
    place = way.waypoints[[w.item for w in way.waypoints].index(1)]
    assert np.hypot(place.north - 8000.0, place.east) > 3300.0  # outside the ring


def test_two_walls_with_gaps_on_opposite_sides_need_a_route() -> None:
    walls = [(6000.0, float(east)) for east in range(-60_000, 3000, 1500)]
    walls += [(11_000.0, float(east)) for east in range(-3000, 60_000, 1500)]
    decision = decide(walls, route((17_000.0, 0.0)))
    assert isinstance(decision, Reroute)
    assert decision.rung is Rung.ROUTE
    assert len(decision.waypoints) > 1


def test_an_intruder_head_on_is_avoided_and_the_leg_resumed() -> None:
    agent = Agent(PERFORMANCE)
    way = route((40_000.0, 0.0))
    decisions = []
    for second in range(25):
        table = np.array([[9000.0 - 15.0 * second, 100.0, 200.0]])
        seen = RadarScan(float(second), np.array([1]), table, np.array([np.nan]))
        decision = agent.decide(ownship(15.0 * second, time=second), way, seen)
        decisions.append(decision)
        if decision.route is not None:
            way = Route(Waypoint(15.0 * second, 0.0, 200.0), decision.route)
    assert [d.name for d in decisions if d.name != "keep"] == ["detour"]
    nothing = RadarScan(60.0, np.empty(0, np.int64), np.empty((0, 3)), np.empty(0))
    after = [agent.decide(ownship(900.0, 300.0, time=60.0 + t), way, nothing) for t in range(2)]
    assert isinstance(after[0], Resume)
    assert after[0].route == (Waypoint(40_000.0, 0.0, 200.0, item=1),)


def test_the_same_inputs_give_the_same_decision() -> None:
    first, second = decide([(8000.0, 300.0)]), decide([(8000.0, 300.0)])
    assert first.route == second.route
    assert first.why == second.why


def test_a_sphere_that_appears_round_the_vehicle_is_left_by_the_shortest_way() -> None:
    decision = decide([(-200.0, 300.0)], scans=1)
    assert isinstance(decision, Detour)
    assert decision.waypoint.north > 0.0
    assert decision.waypoint.east < 0.0  # straight away from its centre
    assert np.hypot(decision.waypoint.north + 200.0, decision.waypoint.east - 300.0) > 1000.0


def test_the_way_out_of_a_sphere_does_not_lead_into_the_next() -> None:
    wall = [(-900.0, -1200.0), (900.0, -1200.0), (0.0, 600.0)]
    decision = decide(wall, scans=1)
    assert isinstance(decision, Detour)
    away = [np.hypot(decision.waypoint.north - n, decision.waypoint.east - e) for n, e in wall]
    assert min(away) > 1000.0


def test_a_new_mission_replaces_what_is_remembered_of_the_old_one() -> None:
    agent = Agent(PERFORMANCE)
    nothing = scan([], 0.0)
    agent.decide(ownship(), route((40_000.0, 0.0)), nothing)
    way = route((5000.0, 30_000.0))
    for second in range(1, 4):
        decision = agent.decide(ownship(time=second), way, scan([(5000.0, 30_200.0)], float(second)))
        if isinstance(decision, Replace):
            break
    assert isinstance(decision, Replace)
    assert decision.waypoint is not None
    assert np.hypot(decision.waypoint.north - 5000.0, decision.waypoint.east - 30_000.0) < 1500.0


def test_a_waypoint_moved_for_a_false_return_is_put_back() -> None:
    agent = Agent(PERFORMANCE)
    way = route((1500.0, 0.0), (40_000.0, 0.0))
    for second in range(8):
        seen = scan([(1500.0, 300.0)] if second == 0 else [], float(second))
        decision = agent.decide(ownship(time=second), way, seen)
        if decision.route is not None:
            way = Route(way.origin, decision.route)
    assert way.waypoints[0] == Waypoint(1500.0, 0.0, 200.0, item=1)


def test_an_obstacle_and_an_intruder_together() -> None:
    """A route round what stands still is no answer to what moves."""
    agent = Agent(PERFORMANCE)
    table = np.array([[9000.0, 300.0, 200.0], [9500.0, 0.0, 200.0]])
    for second in range(4):
        moved = table - np.array([[0.0, 0.0, 0.0], [15.0 * second, 0.0, 0.0]])
        seen = RadarScan(float(second), np.array([1, 2]), moved, np.array([1000.0, np.nan]))
        decision = agent.decide(ownship(15.0 * second, time=second), route((40_000.0, 0.0)), seen)
    assert decision.route is not None
    points = np.array([(45.0, 0.0), *((w.north, w.east) for w in decision.route)])
    assert route_separation(points[None], 15.0, intruders((9455.0, 0.0, -15.0, 0.0)))[0, 0] > 1000.0


def said_of(offsets: list[float], away: float) -> list[str]:
    """Decisions as the leg shifts towards a sphere whose centre lies `away` from where it was."""
    agent, said = Agent(PERFORMANCE), []
    for second, east in enumerate(offsets):
        drifted = route((40_000.0, east), origin=(0.0, east))
        own = ownship(north=15.0 * second, east=east, time=float(second))
        said.append(agent.decide(own, drifted, scan([(9000.0, away)], time=float(second))).name)
    return said


@pytest.mark.parametrize(("lacking", "blocked"), [(-1.0, False), (6.0, True)])
def test_everything_is_kept_from_what_is_new(lacking: float, blocked: bool) -> None:
    keep = 1000.0 + kept_margin(DEFAULT, PERFORMANCE)
    assert ("detour" in said_of([0.0] * 3, keep - lacking)) == blocked


@pytest.mark.parametrize(("drift", "blocked"), [(6.0, False), (12.0, True)])
def test_a_route_found_clear_has_some_slack(drift: float, blocked: bool) -> None:
    """As much as the vehicle may stray."""
    keep = 1000.0 + kept_margin(DEFAULT, PERFORMANCE)
    assert ("detour" in said_of([0.0] * 3 + [drift] * 2, keep + 1.0)) == blocked
