"""Which side of a hill is passed that is seen piece by piece."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from avoidance.agent import Agent
from avoidance.ladder import way_round
from avoidance.parameters import DEFAULT
from avoidance.problem import WaypointProblem
from avoidance.route_check import Blocked
from avoidance.sides import Sides, barred, side_of
from avoidance.types import Decision, Floats, Ownship, Route, Threat, Waypoint
from tests.avoidance.test_route_check import known
from tests.avoidance.worlds import PERFORMANCE, ownship, problem, route, scan

RANGE = 10_000.0


def wall(first: float, last: float, north: float = 9000.0) -> list[tuple[float, float]]:
    """Spheres side by side from one east to another [m]."""
    return [(north, float(east)) for east in np.arange(first, last + 1.0, 1500.0)]


def hill(obstacles: list[tuple[float, float]]) -> WaypointProblem:
    """The search for a way round all of some obstacles."""
    return replace(problem(obstacles, target=(40_000.0, 0.0)), avoided=np.arange(len(obstacles)))


def blocked() -> Blocked:
    return Blocked(Threat((0,), 0, 8000.0, 533.0, 0.0, 1025.0), 0, np.array([0]))


def looking(*places: tuple[float, float]) -> Sides:
    """One whose radar has looked from some places, and once reported something at its range."""
    sides = Sides()
    for second, (north, east) in enumerate(places):
        far = [(north - RANGE, east)]
        sides.look(ownship(north, east, time=float(second)), scan(far, float(second)))
    return sides


def chosen(question: WaypointProblem, sides: Sides) -> float:
    plan = sides.way(way_round)(question, np.random.default_rng(0))
    assert plan is not None
    return side_of(question, plan.waypoints)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_barrier_leaves_one_side(side: float) -> None:
    plan = way_round(barred(hill(wall(-3000.0, 3000.0)), side), np.random.default_rng(0))
    assert plan is not None
    assert side_of(hill(wall(-3000.0, 3000.0)), plan.waypoints) == -side


def test_a_side_is_kept_though_the_other_is_a_little_shorter() -> None:
    before = hill(wall(-1500.0, 0.0))
    long = hill([*wall(-4500.0, 4500.0), (9000.0, 5200.0)])
    sides = looking((7000.0, -4500.0), (7000.0, 5200.0))
    assert chosen(before, sides) == 1.0
    assert chosen(long, sides) == -1.0  # the shorter one, without a memory
    sides.chosen(before, blocked(), ((9000.0, 1100.0),))
    assert chosen(long, sides) == 1.0


def test_a_short_hill_is_passed_on_the_shorter_side_whatever_was_chosen_before() -> None:
    sides = looking((0.0, 0.0))
    sides.chosen(hill(wall(-1500.0, 0.0)), blocked(), ((9000.0, 1100.0),))
    assert chosen(hill([*wall(-1500.0, 1500.0), (9000.0, 2200.0)]), sides) == -1.0


def test_a_side_is_left_for_one_that_is_much_shorter() -> None:
    sides = looking((7000.0, -2500.0), (7000.0, 5000.0))
    before, after = hill(wall(-1500.0, 0.0)), hill(wall(-1500.0, 5900.0))
    sides.chosen(before, blocked(), ((9000.0, 1100.0),))
    assert chosen(after, sides) == -1.0


def test_an_end_that_nobody_has_seen_is_taken_to_go_on() -> None:
    question = hill(wall(-3000.0, 6000.0))
    longer = looking((0.0, -3000.0), (600.0, -3000.0)).extended(question)
    more = longer.centres[len(question.centres) :]
    assert len(more)
    assert (more[:, 1] > 6000.0).all()  # the other end was seen
    assert more[:, 1].max() <= 6000.0 + 9000.0


def test_what_is_expected_is_not_told_as_known() -> None:
    """Yardsticks are computed from what a search tells: a hill that is not there would flatter a detour."""
    question, sides = hill(wall(-3000.0, 6000.0)), looking((0.0, -3000.0), (600.0, -3000.0))
    plan = sides.way(way_round)(question, np.random.default_rng(0))
    assert plan is not None
    assert plan.search.centres is question.centres
    assert plan.search.radii is question.keep


def test_a_hill_whose_ends_were_seen_is_what_it_is() -> None:
    question = hill(wall(-3000.0, 6000.0))
    assert looking((7000.0, -3000.0), (7000.0, 6000.0)).extended(question) is question


@pytest.mark.filterwarnings("error")
def test_a_hill_that_is_not_known_any_more_has_no_end() -> None:
    """Tracks die, and radars rename them: nothing is left of what was gone round."""
    question = replace(problem([(9000.0, 0.0)]), avoided=np.empty(0, dtype=np.int64))
    sides = looking((0.0, 0.0))
    assert sides.extended(question) is question
    assert sides.ends_left(question) is None


def test_each_end_that_comes_into_view_is_told_once() -> None:
    """On whichever side: behind the end that was feared to be far there may be the shorter way."""
    question, sides = hill(wall(-7500.0, 7500.0)), looking((0.0, 0.0))
    sides.chosen(question, blocked(), ((9000.0, 9000.0),))
    way = Route(Waypoint(0.0, 0.0, 200.0), (Waypoint(9000.0, 9000.0, 200.0),))
    assert sides.ends_left(question) is None
    for east, left in ((-9000.0, 1), (9000.0, 0)):
        sides.look(ownship(7000.0, east), scan([(0.0, 0.0)]))
        assert sides.ends_left(question) == left
        assert sides.ends_left(question) is None
        assert (sides.expected(way, known([(9000.0, 0.0)], ownship(), way)) is None) == (left == 0)


def test_a_short_hill_is_what_it_is() -> None:
    question = hill(wall(-1500.0, 1500.0))
    assert looking((0.0, 0.0)).extended(question) is question


def test_a_ridge_seen_piece_by_piece_takes_few_changes_of_the_route() -> None:
    ridge: Floats = np.array(wall(-12_000.0, 33_000.0, north=20_000.0))
    decisions = flown(ridge, 60_000.0, seconds=4500)
    assert 3 <= len(decisions) <= 9
    assert any("the end of the hill" in decision.why for decision in decisions)


def flown(obstacles: Floats, goal: float, seconds: int) -> list[Decision]:
    """Changes of the route of a point that flies corner to corner, looked at every 6 s."""
    agent = Agent(PERFORMANCE, DEFAULT)
    way = route((goal, 0.0))
    place, changes = np.zeros(2), []
    for second in range(0, seconds, 6):
        step = np.array([way.waypoints[0].north, way.waypoints[0].east]) - place
        while np.hypot(*step) < 100.0 and len(way.waypoints) > 1:
            way = replace(way, origin=way.waypoints[0], waypoints=way.waypoints[1:])
            step = np.array([way.waypoints[0].north, way.waypoints[0].east]) - place
        place = place + 90.0 * step / np.hypot(*step)
        course = float(np.degrees(np.arctan2(step[1], step[0])))
        own: Ownship = ownship(float(place[0]), float(place[1]), course, float(second))
        near = obstacles[np.hypot(*(obstacles - place).T) < RANGE]
        seen = scan([(float(north), float(east)) for north, east in near], float(second))
        names = np.flatnonzero(np.hypot(*(obstacles - place).T) < RANGE)
        decision = agent.decide(own, way, replace(seen, ids=names.astype(np.int64)))
        if decision.route is not None:
            changes.append(decision)
            way = replace(way, origin=Waypoint(*place.tolist(), 200.0), waypoints=decision.route)
    return changes
