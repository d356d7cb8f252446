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
from avoidance.geometry import segment_point_distance, segments_clearance
from avoidance.problem import INFEASIBLE, WaypointProblem
from avoidance.refine import refined
from avoidance.traffic_seeds import traffic_seeds
from avoidance.types import Bools, Floats, Ints

OUTSIDE = 0.02
"""Seeds lie this far outside the curves they stand on [m]."""
CORNER_PADS = (OUTSIDE, 6.0, 20.0, 60.0)
"""Tangents that meet near their circle are drawn this far outside, so that the turn stays outside too [m]."""
BATCH = 256
"""Candidates whose own place is tested at once."""
CHUNK = 48
"""Candidates whose flown curve is tested at once."""
NO_WAYPOINT = 1e6
"""Violation of a candidate whose own place breaks a constraint, beside how much it breaks it [m]."""
MOST_OBSTACLES = 40
"""Obstacles whose curves are intersected; more would not fit a decision's budget."""
CIRCLE_POINTS = 12
"""Points on each circle that the waypoint must keep clear of."""
ROUNDS = 3
"""Steps that the best seed is moved by."""
ROUNDS_FROM_AFAR = 8
"""The same, where none of the curves led to a feasible point."""
REACH = 2000.0
"""Obstacles this much further than the search limit cannot bound the search [m]."""


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


def rule_seeds(problem: WaypointProblem, count: int) -> tuple[Floats, int]:
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
    evaluated : int
        Candidates whose feasibility was tested.

    Notes
    -----
    Intersections of tangents with tangents, tangents with circles, circles with circles, and points along
    the circles. Candidates are taken in order of cost, so the first feasible one is the best of all; turns
    and risk move the best waypoint off these points a little, so it is then refined. Where no candidate is
    feasible (the turn on to the first leg can ask for more room than the curves give) points in a fan are
    tried.
    """
    if not len(problem.avoided) and not len(problem.intruders):
        return _fan(problem)[:count], 0
    seeds, ranks, tested = _best_first(problem, _candidates(problem), count)
    rounds = ROUNDS
    if ranks[0] >= INFEASIBLE:
        seeds, ranks, more = _best_first(problem, np.concatenate([seeds, _fan(problem)]), count)
        tested += more
        rounds = ROUNDS_FROM_AFAR
    if ranks[0] < INFEASIBLE:
        best, _, more = refined(problem, seeds[0], float(ranks[0]), rounds)
        seeds = np.concatenate([best[None], seeds])[:count]
        tested += more
    return seeds, tested


def _candidates(problem: WaypointProblem) -> Floats:
    """Points where curves that bound the feasible set meet, shape (m, 2)."""
    near = _near(problem)
    candidates = [traffic_seeds(problem)] if len(problem.intruders) else []
    if len(near):
        centres = problem.centres[near]
        keep = problem.keep[near]
        keep_waypoint = (keep if "g1" in problem.relaxed else problem.keep_waypoint[near]) + OUTSIDE
        start_open = _open_tangents(problem, problem.start, centres, keep)
        target_open = _open_tangents(problem, problem.target, centres, keep)
        for pad in CORNER_PADS:
            from_start = _tangent_directions(problem.start, centres, keep + pad)[start_open]
            from_target = _tangent_directions(problem.target, centres, keep + pad)[target_open]
            candidates.append(_cross(problem.start, from_start, problem.target, from_target))
        from_start = _tangent_directions(problem.start, centres, keep + OUTSIDE)[start_open]
        from_target = _tangent_directions(problem.target, centres, keep + OUTSIDE)[target_open]
        candidates += [
            _pierce(problem.start, from_start, centres, keep_waypoint),
            _pierce(problem.target, from_target, centres, keep_waypoint),
            *_on_search_limit(problem, from_start, from_target),
            _circle_crossings(centres, keep_waypoint),
            _circle_points(problem, centres, keep_waypoint),
        ]
    return np.concatenate(candidates)


def _near(problem: WaypointProblem) -> Ints:
    """Obstacles that can bound the search: about what is avoided, the nearest to the straight leg first."""
    if not len(problem.avoided):
        return problem.avoided
    members = problem.centres[problem.avoided]
    low = members.min(axis=0) - problem.parameters.search_limit - REACH
    high = members.max(axis=0) + problem.parameters.search_limit + REACH
    inside = np.flatnonzero(((problem.centres >= low) & (problem.centres <= high)).all(axis=1))
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


def _tangent_directions(point: tuple[float, float], centres: Floats, radii: Floats) -> Floats:
    """Directions of the left, then of the right tangent from a point to each circle, shape (2d,) [rad]."""
    offset = centres - np.array(point)
    distance = np.hypot(offset[:, 0], offset[:, 1])
    bearing = np.arctan2(offset[:, 1], offset[:, 0])
    opening = np.arcsin(np.minimum(radii / np.maximum(distance, 1e-9), 1.0))
    return np.concatenate([bearing - opening, bearing + opening])


def _open_tangents(
    problem: WaypointProblem, point: tuple[float, float], centres: Floats, radii: Floats
) -> Bools:
    """Which of the tangents from a point nothing blocks before they touch their circle, shape (2d,)."""
    offset = centres - np.array(point)
    square = (offset**2).sum(axis=1) - (radii + OUTSIDE) ** 2
    reach = np.tile(np.sqrt(np.maximum(square, 0.0)), 2)
    angle = _tangent_directions(point, centres, radii + OUTSIDE)
    touch = reach[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1) + np.array(point)
    gap = segments_clearance(np.broadcast_to(np.array(point), touch.shape), touch, problem.centres)
    return np.asarray((gap >= problem.keep - OUTSIDE).all(axis=1) & (np.tile(square, 2) > 0.0))


def _cross(start: tuple[float, float], first: Floats, target: tuple[float, float], second: Floats) -> Floats:
    """Intersections of rays from the start with rays from the target, shape (m, 2)."""
    a, b = np.meshgrid(first, second, indexing="ij")
    determinant = np.sin(b - a)
    parallel = np.abs(determinant) < 1e-12
    determinant = np.where(parallel, 1.0, determinant)
    north, east = target[0] - start[0], target[1] - start[1]
    along_first = (north * np.sin(b) - east * np.cos(b)) / determinant
    along_second = (north * np.sin(a) - east * np.cos(a)) / determinant
    good = ~parallel & (along_first > 0.0) & (along_second > 0.0)
    length, angle = along_first[good], a[good]
    return np.stack([start[0] + length * np.cos(angle), start[1] + length * np.sin(angle)], axis=1)


def _pierce(point: tuple[float, float], directions: Floats, centres: Floats, radii: Floats) -> Floats:
    """Where rays from a point meet circles, shape (m, 2)."""
    unit = np.stack([np.cos(directions), np.sin(directions)], axis=1)
    offset = centres - np.array(point)
    along = unit @ offset.T
    across = unit[:, None, 0] * offset[None, :, 1] - unit[:, None, 1] * offset[None, :, 0]
    square = radii[None] ** 2 - across**2
    half = np.sqrt(np.maximum(square, 0.0))
    found = []
    for length in (along - half, along + half):
        row, column = np.nonzero((square >= 0.0) & (length > 0.0))
        found.append(np.array(point) + length[row, column, None] * unit[row])
    return np.concatenate(found)


def _on_search_limit(problem: WaypointProblem, from_start: Floats, from_target: Floats) -> tuple[Floats, ...]:
    """Where rays leave the search space (g2), each of shape (m, 2)."""
    if "g2" in problem.relaxed:
        return ()
    members = problem.centres[problem.avoided]
    limit = np.full(len(members), problem.parameters.search_limit - OUTSIDE)
    rays = ((problem.start, from_start), (problem.target, from_target))
    return tuple(_pierce(point, directions, members, limit) for point, directions in rays)


def _circle_crossings(centres: Floats, radii: Floats) -> Floats:
    """Intersections of all pairs of circles, shape (m, 2)."""
    first, second = np.triu_indices(len(centres), 1)
    offset = centres[second] - centres[first]
    distance = np.maximum(np.hypot(offset[:, 0], offset[:, 1]), 1e-9)
    along = (distance**2 + radii[first] ** 2 - radii[second] ** 2) / (2.0 * distance)
    square = radii[first] ** 2 - along**2
    good = square >= 0.0
    unit = offset[good] / distance[good, None]
    foot = centres[first[good]] + along[good, None] * unit
    half = np.sqrt(square[good])[:, None]
    normal = np.stack([-unit[:, 1], unit[:, 0]], axis=1)
    return np.concatenate([foot + half * normal, foot - half * normal])


def _circle_points(problem: WaypointProblem, centres: Floats, radii: Floats) -> Floats:
    """Points along each circle, and where it comes nearest to the straight leg, shape (m, 2)."""
    angle = np.linspace(0.0, 2.0 * math.pi, CIRCLE_POINTS, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    along = np.array(problem.target) - np.array(problem.start)
    across = np.array([-along[1], along[0]]) / max(float(np.hypot(*along)), 1e-9)
    directions = np.concatenate([ring, across[None], -across[None]])
    return np.asarray(centres[:, None] + radii[:, None, None] * directions[None]).reshape(-1, 2)


def _fan(problem: WaypointProblem) -> Floats:
    """Points ahead of the start in a fan, for obstacles that move, shape (m, 2)."""
    bearing = math.atan2(problem.target[1] - problem.start[1], problem.target[0] - problem.start[0])
    distance = min(math.dist(problem.start, problem.target), 12_000.0)
    angle = bearing + np.radians(np.arange(-90.0, 90.1, 5.0))
    radius = distance * np.array([0.1, 0.2, 0.35, 0.5, 0.7, 0.9])
    grid = radius[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)[None]
    return np.asarray(np.array(problem.start) + grid).reshape(-1, 2)


def _best_first(problem: WaypointProblem, candidates: Floats, count: int) -> tuple[Floats, Floats, int]:
    """The best feasible candidates first, then the least violating ones; their ranks; how many were tested.

    They are taken in order of length, the constraints on the waypoint itself (g1, g2) first, for they are
    cheap and sort out most; then the flown curve. No longer one can be better once the best costs less
    than its length alone.
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
        for points in _chunks(problem, batch[good]):
            chosen.append(points)
            ranks.append(problem.rank(points))
            tested += len(points)
            best = min(best, float(ranks[-1].min()))
            if best < INFEASIBLE:
                break
    points, rank = np.concatenate(chosen), np.concatenate(ranks)
    first = np.argsort(rank, kind="stable")[:count]
    return points[first], rank[first], tested


def _chunks(problem: WaypointProblem, points: Floats) -> Iterator[Floats]:
    """Points in order of cost, a few at a time."""
    points = points[np.argsort(problem.cost(points), kind="stable")]
    for begin in range(0, len(points), CHUNK):
        yield points[begin : begin + CHUNK]
