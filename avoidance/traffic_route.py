"""Two waypoints round traffic where one does not do: several intruders, or too little time."""

from __future__ import annotations

import math

import numpy as np

from avoidance.prediction import separation_shortfall
from avoidance.problem import INFEASIBLE, WaypointProblem
from avoidance.types import Floats

FIRST_ANGLES = np.radians(np.arange(-160.0, 161.0, 10.0))
"""Bearings of the first waypoint from that of the target [rad]: also away from it, to let others pass."""
FIRST_RANGES = np.array([300.0, 700.0, 1500.0, 3000.0, 6000.0])
"""Its distances [m]."""
SECOND_ANGLES = np.radians(np.arange(-90.0, 91.0, 10.0))
"""Bearings of the second waypoint, seen from the start as well [rad]."""
SECOND_RANGES = np.array([1000.0, 2500.0, 5000.0, 9000.0, 14_000.0])
"""Its distances [m]."""
MOST = 100_000
"""Pairs of waypoints times intruders that are looked at; if there are more, only every so many-th pair."""
REFINED = 4
"""Pairs that are refined ..."""
ROUNDS, TRIES = 8, 24
"""... in so many rounds of so many tries each."""
SPREAD = 600.0
"""Standard deviation of the first tries [m]; it is halved from round to round."""


def two_waypoints(problem: WaypointProblem, rng: np.random.Generator) -> tuple[Floats, float]:
    """The shortest way by two waypoints that keeps from intruders what is to be kept.

    Parameters
    ----------
    problem : WaypointProblem
        The search; only its traffic is looked at.
    rng : numpy.random.Generator
        Spreads the tries about the best pairs of a coarse grid.

    Returns
    -------
    waypoints : array, shape (m, 2, 2)
        Ways, best first: those that keep it by their length, then the others by what they lack [m].
    shortfall : float
        What the best lacks [m].
    """
    first = _polar(problem, FIRST_ANGLES, FIRST_RANGES)
    lacking = _shortfall(problem, first[:, None])
    first = first[lacking <= lacking.min()]  # what is lost on the way to it is lost
    second = _polar(problem, SECOND_ANGLES, SECOND_RANGES)
    pairs = np.stack([np.repeat(first, len(second), axis=0), np.tile(second, (len(first), 1))], axis=1)
    pairs = pairs[:: 1 + len(pairs) * len(problem.intruders) // MOST]
    rank = _rank(problem, pairs)
    best = np.argsort(rank, kind="stable")[:REFINED]
    pairs, rank = pairs[best], rank[best]
    for number in range(ROUNDS):
        step = SPREAD * 0.5**number * rng.standard_normal((len(pairs), TRIES, 2, 2))
        tries = np.concatenate([pairs[:, None], pairs[:, None] + step], axis=1)
        ranks = _rank(problem, tries.reshape(-1, 2, 2)).reshape(len(pairs), -1)
        chosen = ranks.argmin(axis=1)
        pairs, rank = tries[np.arange(len(pairs)), chosen], ranks[np.arange(len(pairs)), chosen]
    order = np.argsort(rank, kind="stable")
    return pairs[order], max(float(rank[order[0]]) - INFEASIBLE, 0.0)


def _polar(problem: WaypointProblem, angles: Floats, ranges: Floats) -> Floats:
    """Points about the start, shape (a r, 2)."""
    bearing = math.atan2(problem.target[1] - problem.start[1], problem.target[0] - problem.start[0])
    rays = np.stack([np.cos(bearing + angles), np.sin(bearing + angles)], axis=1)
    return np.asarray(np.array(problem.start) + ranges[None, :, None] * rays[:, None]).reshape(-1, 2)


def _shortfall(problem: WaypointProblem, onward: Floats) -> Floats:
    route = problem.after_run(onward)
    return separation_shortfall(route, problem.speeds(route), problem.intruders.after(problem.delay))


def _rank(problem: WaypointProblem, pairs: Floats) -> Floats:
    """Length, and above every length the shortfall of those that come too near, shape (n,)."""
    target = np.broadcast_to(np.array(problem.target), (len(pairs), 1, 2))
    onward = np.concatenate([pairs, target], axis=1)
    start = np.broadcast_to(np.array(problem.start), (len(pairs), 1, 2))
    legs = np.diff(np.concatenate([start, onward], axis=1), axis=1)
    length = np.hypot(legs[..., 0], legs[..., 1]).sum(axis=1)
    shortfall = _shortfall(problem, onward)
    return np.where(shortfall > 0.0, INFEASIBLE + shortfall, length)
