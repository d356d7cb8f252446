"""From a good waypoint to the best one near it: a pattern search along the two new legs."""

from __future__ import annotations

import numpy as np

from avoidance.problem import WaypointProblem
from avoidance.types import Floats

STEPS = 2000.0 * np.geomspace(1.0, 1.0 / 4096.0, 9)
"""Lengths of the steps tried in each round [m]."""
DIRECTIONS = np.array(
    [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1)], dtype=np.float64
)
"""Steps along the first leg and along the second."""


def refined(problem: WaypointProblem, point: Floats, rank: float, rounds: int) -> tuple[Floats, float, int]:
    """The best point that steps from a given one lead to.

    Parameters
    ----------
    problem : WaypointProblem
        The search.
    point : array, shape (2,)
        A feasible point to begin with [m].
    rank : float
        Its cost.
    rounds : int
        Most rounds; each takes the best of all steps.

    Returns
    -------
    point : array, shape (2,)
        The best point [m], the given one if no step is better.
    rank : float
        Its cost.
    evaluated : int
        Points whose flown curve was looked at.

    Notes
    -----
    A pattern search (Hooke and Jeeves 1961) in the two directions that leave one of the new legs on its
    line: where a leg touches the circle that it must keep clear of, a step along it keeps touching, while
    the axes of the map would lead into the circle or away from it. All lengths are tried at once.
    """
    start, target = np.array(problem.start), np.array(problem.target)
    legs, evaluated = np.empty((2, 2)), 0
    for _ in range(rounds):
        legs[0], legs[1] = _unit(point - start), _unit(target - point)
        candidates = point + (STEPS[:, None, None] * (DIRECTIONS @ legs)).reshape(-1, 2)
        cost = problem.cost(candidates)
        candidates, cost = candidates[cost < rank], cost[cost < rank]
        placed = problem.waypoint_violation(candidates) <= 0.0
        if not placed.any():
            break
        candidates = candidates[placed]
        ranks = problem.rank_placed(candidates, cost[placed])
        evaluated += len(candidates)
        best = int(np.argmin(ranks))
        if ranks[best] >= rank:
            break
        point, rank = candidates[best], float(ranks[best])
    return point, rank, evaluated


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / max(float(np.hypot(*vector)), 1e-9))
