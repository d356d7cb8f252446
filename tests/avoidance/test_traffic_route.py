"""Two waypoints where one does not do."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from avoidance.ladder import way_round, widest_way
from avoidance.prediction import route_separation
from avoidance.traffic_route import two_waypoints
from avoidance.types import Rung
from tests.avoidance.worlds import intruders, problem

TARGET = (40_000.0, 0.0)
GATES = intruders(  # two lines abreast that close the way ahead, the second where the first is open
    *((9000.0, float(east), -15.0, 0.0) for east in range(-12_000, 1, 2000)),
    *((20_000.0, float(east), -15.0, 0.0) for east in range(-1000, 12_001, 2000)),
)


def separation(question, route) -> float:
    points = np.array([question.start, *route, question.target])[None]
    return float(route_separation(points, 15.0, question.intruders).min())


def test_two_lines_abreast_open_on_opposite_sides_take_two_waypoints() -> None:
    question = problem([], target=TARGET, intruders=GATES)
    plan = way_round(question, np.random.default_rng(0))
    assert plan is not None
    assert plan.rung is Rung.ROUTE
    assert len(plan.waypoints) == 2
    assert separation(question, plan.waypoints) >= 1100.0 - 1.0


def test_they_are_refined_to_the_shortest_way() -> None:
    """One intruder head-on: nearly as short as the best by one waypoint."""
    question = problem([], target=TARGET, intruders=intruders((9000.0, 0.0, -15.0, 0.0)))
    pairs, lacking = two_waypoints(question, np.random.default_rng(0))
    route = [question.start, *pairs[0].tolist(), question.target]
    assert lacking == 0.0
    assert sum(math.dist(a, b) for a, b in pairwise(route)) < 40_000.0 + 250.0


def test_a_route_is_left_for_a_wider_one_only_where_that_is_much_wider() -> None:
    """Nobody gets out of the way of this any more; what can be done is done once."""
    question = problem([], target=TARGET, intruders=intruders((1500.0, 0.0, -60.0, 0.0)))
    rng = np.random.default_rng(0)
    assert way_round(question, rng) is None
    plan = widest_way(question, rng)
    assert plan is not None
    lacking = question.separation_shortfall(plan.waypoints)
    assert lacking < question.separation_shortfall(()) - 50.0
    assert widest_way(question, rng, lacking) is None
