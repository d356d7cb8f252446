"""Where a waypoint search starts from (Algorithm 8, Eq. 27).

Seeds decide, not coefficients: the best waypoint nearly always lies where two of the curves that bound the
feasible set meet: tangents from the start and from the target to the circles that the segments must keep
clear of, and the circles that the waypoint itself must keep clear of.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from avoidance.cost import path_length
from avoidance.geometry import segment_point_distance
from avoidance.problem import INFEASIBLE, WaypointProblem
from avoidance.refine import refined
from avoidance.seed_curves import OUTSIDE, Curves
from avoidance.traffic_seeds import traffic_seeds
from avoidance.types import Floats, Ints

BATCH = 256
"""Candidates whose own place is tested at once."""
CHUNK = 48
"""Candidates whose flown curve is tested first."""
NO_WAYPOINT = 1e6
"""Violation of a candidate whose own place breaks a constraint, beside how much it breaks it [m]."""
NO_LEG = 0.5 * NO_WAYPOINT
"""The same of one that the straight legs to and from it rule out [m]."""
MOST_OBSTACLES = 40
"""Obstacles whose curves are intersected; more would not fit a decision's budget."""
ROUNDS = 3
"""Steps that the best seed is moved by."""
ROUNDS_FROM_AFAR = 8
"""The same, where none of the curves led to a feasible point."""
REACH = 2000.0
"""Obstacles this much further than the search limit bound a search only where a leg is long [m]."""


def sphere_seeds(problem: WaypointProblem, count: int, rng: np.random.Generator) -> Floats:
    """Points about the safety sphere, from the UAV's tangents on both sides.

    Parameters
    ----------
    problem : WaypointProblem
        The search.
    count : int
        How many, alternating left and right.
    rng : numpy.random.Generator
        Spreads them along the sphere.

    Returns
    -------
    array, shape (count, 2)
        Seeds [m].

    Notes
    -----
    Algorithm 8 and Eq. (27), about the terminal obstacles of the cluster. Differs from the paper: E26,
    the formula needs coordinates relative to the vehicle and has two valid solutions; the seeds are spread
    from them along the sphere of RS + tolerance, since on RS every one would break g1.
    """
    members = problem.avoided
    if not len(members):
        return _fan(problem)[:count]
    left, right = _terminals(problem, members)
    seeds = np.empty((count, 2))
    for i in range(count):
        side = -1.0 if i % 2 == 0 else 1.0
        index = int(left if side < 0 else right)
        radius = float(problem.keep_waypoint[index]) + OUTSIDE
        centre = problem.centres[index]
        north, east = float(centre[0]) - problem.start[0], float(centre[1]) - problem.start[1]
        distance = math.hypot(north, east)
        bearing = math.atan2(east, north)
        opening = math.acos(min(radius / max(distance, radius), 1.0))
        angle = bearing + math.pi - side * (opening + 0.5 * float(rng.uniform(-0.2, 1.0)))
        seeds[i] = centre + radius * np.array([math.cos(angle), math.sin(angle)])
    return seeds


def rule_seeds(problem: WaypointProblem, count: int) -> tuple[Floats, Floats, int]:
    """The best points on the curves that bound the feasible set.

    Parameters
    ----------
    problem : WaypointProblem
        The search.
    count : int
        How many to return at most.

    Returns
    -------
    seeds : array, shape (m, 2)
        Best first, m <= count [m].
    ranks : array, shape (m,)
        What `WaypointProblem.rank` says of them; NaN where that has not been asked.
    evaluated : int
        Candidates whose feasibility was tested.

    Notes
    -----
    Intersections of tangents with tangents, tangents with circles, circles with circles, and points along
    the circles. Candidates are taken in order of cost, so the first feasible one is the best of all; turns
    and risk move the best waypoint off these points a little, so it is then refined. Where no candidate is
    feasible (the turn on to the first leg can ask for more room than the curves give), or only a fence is in
    the way, points in a fan are tried.
    """
    fenced = not (len(problem.avoided) or len(problem.intruders))
    candidates = _fan(problem) if fenced else _candidates(problem)
    if math.isfinite(problem.longest):
        candidates = candidates[path_length(candidates, problem.start, problem.target) < problem.longest]
    if not len(candidates):
        return np.array([problem.start]), np.array([np.nan]), 0
    seeds, ranks, tested = _best_first(problem, candidates, count)
    rounds = ROUNDS_FROM_AFAR if fenced else ROUNDS
    if ranks[0] >= INFEASIBLE and math.isinf(problem.longest) and not fenced:
        further = [seeds, _fan(problem), _from_afar(problem)]
        seeds, ranks, more = _best_first(problem, np.concatenate(further), count)
        tested += more
        rounds = ROUNDS_FROM_AFAR
    if ranks[0] < INFEASIBLE:
        best, rank, more = refined(problem, seeds[0], float(ranks[0]), rounds)
        seeds = np.concatenate([best[None], seeds])[:count]
        ranks = np.concatenate([[rank], ranks])[:count]
        tested += more
    return seeds, np.where(ranks < INFEASIBLE + NO_LEG, ranks, np.nan), tested


def _candidates(problem: WaypointProblem) -> Floats:
    """Points where curves that bound the feasible set meet, shape (m, 2) [m]."""
    near = _near(problem)
    candidates = [traffic_seeds(problem)] if len(problem.intruders) else []
    if len(near):
        curves = Curves.of(problem, near)
        candidates += [_meetings(problem, curves), curves.beside()]
    return np.concatenate(candidates)


def _from_afar(problem: WaypointProblem) -> Floats:
    """The same of obstacles also that lie far from what is avoided, where a long leg may touch them."""
    near, everywhere = _near(problem), _nearest(problem, np.arange(len(problem.centres)))
    if not len(near) or np.array_equal(near, everywhere):
        return np.empty((0, 2))
    return _meetings(problem, Curves.of(problem, everywhere))


def _meetings(problem: WaypointProblem, curves: Curves) -> Floats:
    """Where curves meet one another, shape (m, 2) [m]."""
    found = np.concatenate([*curves.corners(), *curves.pierced(problem), *curves.crossings()])
    return found.view(np.float64).reshape(-1, 2)


def _near(problem: WaypointProblem) -> Ints:
    """Obstacles about what is avoided: they bound nearly all searches."""
    if not len(problem.avoided):
        return problem.avoided
    members = problem.centres[problem.avoided]
    low = members.min(axis=0) - problem.parameters.search_limit - REACH
    high = members.max(axis=0) + problem.parameters.search_limit + REACH
    inside = ((problem.centres >= low) & (problem.centres <= high)).all(axis=1)
    return _nearest(problem, np.flatnonzero(inside))


def _nearest(problem: WaypointProblem, inside: Ints) -> Ints:
    """As many of some obstacles as fit into a decision, those nearest to the straight leg, ascending."""
    if len(inside) <= MOST_OBSTACLES:
        return inside
    gap = (
        segment_point_distance(problem.start, problem.target, problem.centres[inside]) - problem.keep[inside]
    )
    return np.sort(inside[np.argsort(gap, kind="stable")[:MOST_OBSTACLES]])


def _terminals(problem: WaypointProblem, members: Ints) -> tuple[int, int]:
    """The leftmost and the rightmost member of a cluster, seen along the leg."""
    offset = problem.centres[members] - np.array(problem.start)
    along = np.array(problem.target) - np.array(problem.start)
    across = along[0] * offset[:, 1] - along[1] * offset[:, 0]
    side = np.arctan2(across, offset @ along)
    return int(members[int(np.argmin(side))]), int(members[int(np.argmax(side))])


def _fan(problem: WaypointProblem) -> Floats:
    """Points ahead of the start in a fan, where there are no curves, shape (m, 2)."""
    bearing = math.atan2(problem.target[1] - problem.start[1], problem.target[0] - problem.start[0])
    distance = min(math.dist(problem.start, problem.target), 12_000.0)
    angle = bearing + np.radians(np.arange(-90.0, 90.1, 5.0))
    radius = distance * np.array([0.1, 0.2, 0.35, 0.5, 0.7, 0.9])
    grid = radius[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)[None]
    return np.asarray(np.array(problem.start) + grid).reshape(-1, 2)


def _best_first(problem: WaypointProblem, candidates: Floats, count: int) -> tuple[Floats, Floats, int]:
    """The best feasible candidates first, then the least violating ones; their ranks; how many were tested.

    They are taken in order of length, the constraints on the waypoint itself (g1, g2) first, for they are
    cheap and sort out most; then the straight legs; then the flown curve. No longer one can be better once
    the best costs less than its length alone.
    """
    length = path_length(candidates, problem.start, problem.target)
    order = np.argsort(length, kind="stable")
    chosen: list[Floats] = []
    ranks: list[Floats] = []
    best, tested = math.inf, 0
    for begin in range(0, len(order), BATCH):
        if best < INFEASIBLE and best <= problem.parameters.path_weight * length[order[begin]]:
            break
        batch = candidates[order[begin : begin + BATCH]]
        short = problem.waypoint_violation(batch)
        good = short <= 0.0
        chosen.append(batch[~good])
        ranks.append(INFEASIBLE + NO_WAYPOINT + short[~good])
        batch = batch[good]
        short = problem.leg_violation(batch)
        good = short <= 0.0
        chosen.append(batch[~good])
        ranks.append(INFEASIBLE + NO_LEG + short[~good])
        for points, cost in _chunks(problem, batch[good]):
            chosen.append(points)
            ranks.append(problem.rank_placed(points, cost))
            tested += len(points)
            best = min(best, float(ranks[-1].min()))
            if best < INFEASIBLE:
                break
    points, rank = np.concatenate(chosen), np.concatenate(ranks)
    first = np.argsort(rank, kind="stable")[:count]
    return points[first], rank[first], tested


def _chunks(problem: WaypointProblem, points: Floats) -> Iterator[tuple[Floats, Floats]]:
    """Points in order of cost, and their cost; a few at first, then ever more at a time."""
    cost = problem.cost(points)
    order = np.argsort(cost, kind="stable")
    points, cost = points[order], cost[order]
    begin, size = 0, CHUNK
    while begin < len(points):
        yield points[begin : begin + size], cost[begin : begin + size]
        begin, size = begin + size, 2 * size
