"""One rule of the road: who is left on the left, and what a flight on the wrong side costs."""

from __future__ import annotations

import numpy as np
import pytest

from avoidance.right_of_way import gives_way, wrong_side
from avoidance.search import search_waypoint
from tests.avoidance.worlds import intruders, problem

CASES = {
    "head-on": ((9000.0, 0.0, -15.0, 0.0), True),
    "from the right": ((6000.0, 6000.0, 0.0, -15.0), True),
    "from the left": ((6000.0, -6000.0, 0.0, 15.0), False),
    "overtaken": ((3000.0, 0.0, 8.0, 0.0), False),
    "overtaking": ((-5000.0, 500.0, 30.0, 0.0), False),
}


@pytest.mark.parametrize(("row", "expected"), CASES.values(), ids=CASES.keys())
def test_way_is_given_to_what_is_ahead_or_comes_from_the_right(row, expected) -> None:
    assert gives_way(0.0, (0.0, 0.0), intruders(row)).tolist() == [expected]


def test_the_wrong_side_is_the_one_that_leaves_it_on_the_right() -> None:
    oncoming = intruders((9000.0, 0.0, -15.0, 0.0))
    routes = np.array([[[0.0, 0.0], [4500.0, side], [20_000.0, 0.0]] for side in (1500.0, -1500.0)])
    assert wrong_side(routes, 15.0, oncoming, np.array([True])).tolist() == [0.0, 1.0]
    assert wrong_side(routes, 15.0, oncoming, np.array([False])).tolist() == [0.0, 0.0]


@pytest.mark.parametrize("offset", [-150.0, 0.0, 150.0])
def test_head_on_both_turn_to_the_right(offset) -> None:
    """Also where the left would be a little shorter: the other one turns to its right as well."""
    question = problem([], target=(40_000.0, 0.0), intruders=intruders((9000.0, offset, -15.0, 0.0)))
    found = search_waypoint(question, np.random.default_rng(0)).found
    assert found is not None
    assert found[1] > 0.0


@pytest.mark.parametrize("side", [1.0, -1.0], ids=["from the right", "from the left"])
def test_crossing_traffic_is_passed_behind(side) -> None:
    """Sec. 5.7."""
    crossing = intruders((6000.0, side * 6000.0, 0.0, -side * 15.0))
    found = search_waypoint(
        problem([], target=(40_000.0, 0.0), intruders=crossing), np.random.default_rng(0)
    ).found
    assert found is not None
    assert side * found[1] > 0.0
