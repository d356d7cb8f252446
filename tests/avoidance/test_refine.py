"""The last metres of a waypoint search."""

from __future__ import annotations

import numpy as np

from avoidance.problem import INFEASIBLE
from avoidance.refine import refined
from tests.avoidance.worlds import problem


def test_a_poor_waypoint_becomes_a_good_one() -> None:
    question = problem([(9000.0, 400.0)])
    far = np.array([8000.0, -3200.0])
    before = float(question.rank(far[None])[0])
    point, rank, evaluated = refined(question, far, before, rounds=8)
    assert rank < before < INFEASIBLE
    assert rank == question.rank(point[None])[0]
    assert evaluated > 0


def test_the_best_waypoint_stays() -> None:
    question = problem([(9000.0, 400.0)])
    begun = np.array([8000.0, -3200.0])
    point, rank, _ = refined(question, begun, float(question.rank(begun[None])[0]), rounds=40)
    again, same, _ = refined(question, point, rank, rounds=8)
    assert same == rank
    assert (again == point).all()
