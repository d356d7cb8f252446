"""Where a waypoint search starts from (Algorithm 8, Eq. 27).

Seeds decide, not coefficients: the best waypoint nearly always lies where two of the curves that bound the
feasible set meet: tangents from the start and from the target to the circles that the segments must keep
clear of, and the circles that the waypoint itself must keep clear of.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from avoidance.cost import path_length
from avoidance.geometry import segment_point_distance
from avoidance.problem import INFEASIBLE, WaypointProblem, straight_cost
from avoidance.refine import refined
from avoidance.seed_curves import MOST_CIRCLES, OUTSIDE, Curves
from avoidance.traffic_seeds import traffic_seeds
from avoidance.types import Floats, Ints

BATCH = 256
"""Candidates whose own place is tested at once ..."""
BATCH_ALONE = 128
"""... at first, where nothing moves: the best of them nearly always passes."""
CHUNK = 48
"""Candidates whose flown curve is tested first ..."""
CHUNK_ALONE = 4
"""... where nothing moves."""
NO_WAYPOINT = 1e6
"""Violation of a candidate whose own place breaks a constraint, beside how much it breaks it [m]."""
NO_LEG = 0.5 * NO_WAYPOINT
"""The same of one that the straight legs to and from it rule out [m]."""
ROUNDS = 8
"""Most steps that the best seed is moved by ..."""
ROUNDS_IN_TRAFFIC = 3
"""... and where something moves, for the swarm searches on from there."""
REACH = 2000.0
"""Obstacles this much further than the search limit bound a search only where a leg is long [m]."""
RISKY = 0.1
"""Risk may make another point the best where it is more than this part of what a detour costs ..."""
AT_STAKE = 10.0
"""... or weighs as much as so much of way [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Seeds:
    """Points to search from, best first."""

    points: Floats
    """North and east, shape (m, 2) [m]."""
    ranks: Floats
    """What `WaypointProblem.rank` says of them, shape (m,); NaN where that has not been asked."""
    tested: int
    """Candidates whose flown curve was looked at."""
    proven: bool = False
    """True if the first one is the best there is, but for the little that less risk could save."""

    @property
    def feasible(self) -> bool:
        """True if the first one meets every constraint."""
        return bool(self.ranks[0] < INFEASIBLE)


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


def rule_seeds(problem: WaypointProblem, count: int) -> Seeds:
    """The best points on the curves that bound the feasible set.

    Parameters
    ----------
    problem : WaypointProblem
        The search.
    count : int
        How many to return at most.

    Returns
    -------
    Seeds
        Best first, at least one.

    Notes
    -----
    Intersections of tangents with tangents, tangents with circles, circles with circles, and points along
    the circles. Candidates are taken in order of cost, so the first feasible one is the best of them. No way
    is cheaper than the cheapest of those that the straight legs allow: if that one can be flown, and no
    obstacle's curves were left out, it is the best there is; so those where curves meet are tried alone at
    first. Else turns have moved the best waypoint off these points, or risk may have, or curves left out
    would lead to it: all are tried, and the best is refined. Where no candidate is feasible (the turn on to
    the first leg can ask for more room than the curves give), or only a fence is in the way, points in a fan
    are tried.
    """
    fenced = not (len(problem.avoided) or len(problem.intruders))
    complete = not fenced and len(problem.centres) + len(problem.avoided) <= MOST_CIRCLES
    if complete and problem.alone and "g1" not in problem.relaxed and math.isinf(problem.longest):
        # so far from the circles every turn fits
        meetings = Curves.of(problem, _near(problem)).meetings(pads=1)
        found = _best_first(problem, meetings, count, complete)
        if found.proven:
            return found
    candidates = _fan(problem) if fenced else _candidates(problem)
    if math.isfinite(problem.longest):
        candidates = candidates[path_length(candidates, problem.start, problem.target) < problem.longest]
    if not len(candidates):
        return Seeds(np.array([problem.start]), np.array([np.nan]), 0)
    found = _best_first(problem, candidates, count, complete)
    rounds = ROUNDS if problem.alone else ROUNDS_IN_TRAFFIC
    if not found.feasible and math.isinf(problem.longest) and not fenced:
        again = _best_first(problem, np.concatenate([found.points, _fan(problem)]), count, complete=False)
        found = replace(again, tested=found.tested + again.tested)
        rounds = ROUNDS
    if not found.feasible or found.proven:
        return found
    best, rank, more = refined(problem, found.points[0], float(found.ranks[0]), rounds)
    points = np.concatenate([best[None], found.points])[:count]
    return Seeds(points, np.concatenate([[rank], found.ranks])[:count], found.tested + more)


def _candidates(problem: WaypointProblem) -> Floats:
    """Points where curves that bound the feasible set meet, shape (m, 2) [m]."""
    candidates = [] if problem.alone else [traffic_seeds(problem)]
    if len(problem.avoided):
        curves = Curves.of(problem, _near(problem))
        candidates += [curves.meetings(), curves.beside()]
    return np.concatenate(candidates)


def _near(problem: WaypointProblem) -> Ints:
    """As many obstacles as fit into a decision: about what is avoided, then those nearest to the leg."""
    if len(problem.centres) <= MOST_CIRCLES:
        return np.arange(len(problem.centres))
    members = problem.centres[problem.avoided]
    low = members.min(axis=0) - problem.parameters.search_limit - REACH
    high = members.max(axis=0) + problem.parameters.search_limit + REACH
    about = ((problem.centres >= low) & (problem.centres <= high)).all(axis=1)
    gap = segment_point_distance(problem.start, problem.target, problem.centres) - problem.keep
    return np.sort(np.lexsort((gap, ~about))[:MOST_CIRCLES])


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


def _best_first(problem: WaypointProblem, candidates: Floats, count: int, complete: bool) -> Seeds:
    """The best feasible candidates first, then those not looked at, then the least violating ones.

    They are taken in order of length, the constraints on the waypoint itself (g1, g2) first, for they are
    cheap and sort out most; then the straight legs; then the flown curve. No longer one can be better once
    the best costs less than its length alone. In traffic the swarm searches on from what is found here, so
    many are looked at; else the cheapest that their straight legs allow nearly always passes, which proves it
    the best if the candidates are `complete`: all points where curves meet that bound the feasible set.
    """
    length = path_length(candidates, problem.start, problem.target)
    order = np.argsort(length, kind="stable")
    least_cost = problem.parameters.path_weight * length[order]
    alone = problem.alone
    size, chunk = (BATCH_ALONE, CHUNK_ALONE) if alone else (BATCH, CHUNK)
    chosen, keys, ranks = list[Floats](), list[Floats](), list[Floats]()

    def take(points: Floats, key: Floats, rank: Floats | None = None) -> None:
        chosen.append(points)
        keys.append(key)
        ranks.append(np.full(len(points), np.nan) if rank is None else rank)

    best = cheapest = riskless = math.inf
    begin, tested = 0, 0
    while begin < len(order):
        end = begin + size
        if best < INFEASIBLE:
            if best <= least_cost[begin]:
                break
            end = min(end, int(np.searchsorted(least_cost, best))) if alone else end
        batch, floor = candidates[order[begin:end]], least_cost[begin:end]
        short = problem.waypoint_violation(batch)
        good = short <= 0.0
        take(batch[~good], INFEASIBLE + NO_WAYPOINT + short[~good])
        batch, floor = batch[good], floor[good]
        short = problem.leg_violation(batch)
        good = short <= 0.0
        take(batch[~good], INFEASIBLE + NO_LEG + short[~good])
        riskless = min(riskless, float(floor[good].min(initial=math.inf)))
        batch, cost = _by_cost(problem, batch[good])
        cheapest = min(cheapest, float(cost[:1].min(initial=math.inf)))
        for first, last in _chunks(len(batch), chunk):
            rank = problem.rank_placed(batch[first:last], cost[first:last])
            take(batch[first:last], rank, rank)
            tested += len(rank)
            best = min(best, float(rank.min()))
            if best < INFEASIBLE and not (alone and (cost[last:] < best).any()):
                if alone:
                    take(batch[last:], cost[last:])
                break
        begin, size = begin + size, 2 * size if alone else size
    points, key, rank = np.concatenate(chosen), np.concatenate(keys), np.concatenate(ranks)
    first_ones = np.argsort(key, kind="stable")[:count]
    at_stake = min(RISKY * (best - straight_cost(problem)), AT_STAKE * problem.parameters.path_weight)
    proven = complete and alone and best == cheapest and best - riskless <= at_stake
    return Seeds(points[first_ones], rank[first_ones], tested, proven)


def _by_cost(problem: WaypointProblem, points: Floats) -> tuple[Floats, Floats]:
    """Points in order of cost, and their cost."""
    cost = problem.cost(points)
    order = np.argsort(cost, kind="stable")
    return points[order], cost[order]


def _chunks(count: int, size: int) -> Iterator[tuple[int, int]]:
    """Parts of a row of things: a few at first, then ever more at a time."""
    begin = 0
    while begin < count:
        yield begin, begin + size
        begin, size = begin + size, 2 * size
