"""How good a decision was, computed outside the decision: the best waypoint, and the shortest path."""

from __future__ import annotations

import math

import numpy as np

from avoidance.problem import INFEASIBLE, WaypointProblem, search_box, straight_cost
from avoidance.seeds import rule_seeds
from avoidance.tangent_graph import shortest_path
from avoidance.types import Floats, Search

COARSE = 81
"""Points of the first grid on each axis."""
KEPT = 12
"""Cells of a grid that are refined."""
FINE = 9
"""Points of each refined cell on each axis."""
STEPS = 7
"""Refinements, each by a factor of (FINE - 1) / 2."""
FLOOR = 0.05
"""Below this cost of the detour the gap has no meaning (half a metre of path)."""


def best_waypoint(problem: WaypointProblem) -> tuple[Floats, float] | None:
    """The best single waypoint, from a refined grid under the same constraints.

    Parameters
    ----------
    problem : WaypointProblem
        The search.

    Returns
    -------
    (point, cost) or None
        Point of shape (2,) [m] and f of Eq. (6); None if the grid finds no feasible point.
    """
    low, high = search_box(problem)
    centre, half = 0.5 * (low + high), 0.5 * (high - low)
    axis = np.linspace(-1.0, 1.0, COARSE)
    grid = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)
    points = np.concatenate([centre + half * grid, rule_seeds(problem, 40).points])
    ranks = _rank(problem, points)
    cell = 2.0 * half / (COARSE - 1)
    offsets = np.linspace(-1.0, 1.0, FINE)
    stencil = np.stack(np.meshgrid(offsets, offsets, indexing="ij"), axis=-1).reshape(-1, 2)
    for _ in range(STEPS):
        best = points[np.argsort(ranks, kind="stable")[:KEPT]]
        points = np.concatenate([best, (best[:, None] + cell * stencil[None]).reshape(-1, 2)])
        ranks = _rank(problem, points)
        cell = cell * 2.0 / (FINE - 1)
    winner = int(np.argmin(ranks))
    if ranks[winner] >= INFEASIBLE:
        return None
    return points[winner], float(ranks[winner])


def search_gap(search: Search) -> float | None:
    """(f - f_best) / (f_best - f_straight) of one waypoint search.

    Parameters
    ----------
    search : Search
        A search that a decision carries.

    Returns
    -------
    float or None
        0 for the best waypoint there is; None without a waypoint, or where the detour costs so little
        that the ratio has no meaning.
    """
    problem = search.problem
    if search.found is None or not isinstance(problem, WaypointProblem):
        return None
    best = best_waypoint(problem)
    lowest = search.cost if best is None else min(best[1], search.cost)
    detour = lowest - straight_cost(problem)
    if detour < FLOOR:
        return None
    return (search.cost - lowest) / detour


def length_to_optimum(search: Search) -> float | None:
    """Length of start -> waypoint -> target over the length of the shortest path there is.

    Parameters
    ----------
    search : Search
        A search that a decision carries.

    Returns
    -------
    float or None
        1 or more; None without a waypoint or without a path.

    Notes
    -----
    The shortest path is the tangent graph's, round the circles that the segments must keep clear of.
    """
    if search.found is None:
        return None
    inside = _shrunk(search)
    path = shortest_path(search.start, search.target, search.centres, inside)
    if path is None or path.length < 1.0:
        return None
    length = math.dist(search.start, search.found) + math.dist(search.found, search.target)
    return length / path.length


def _shrunk(search: Search) -> Floats:
    """Radii that leave start and target outside."""
    radii = search.radii
    for point in (search.start, search.target):
        distance = np.hypot(search.centres[:, 0] - point[0], search.centres[:, 1] - point[1])
        radii = np.minimum(radii, distance - 1e-3)
    return np.maximum(radii, 0.0)


def _rank(problem: WaypointProblem, points: Floats) -> Floats:
    """`problem.rank` in pieces that fit the cache."""
    return np.concatenate([problem.rank(points[i : i + 512]) for i in range(0, len(points), 512)])


__all__ = ["best_waypoint", "length_to_optimum", "search_gap"]
