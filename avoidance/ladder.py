"""From a blocked leg to a way round it: one waypoint if there is one, else the exact planner's route.

Constraints are given up in a fixed, reported order: the turn limit (g4), the search limit (g2), the
tolerance (g1); never RS. Then comes a route of several waypoints, then none: the caller must hold. A
waypoint that keeps the tolerance but costs much more than one without, or than the exact route, gives way
to it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TypeAlias

import numpy as np

from avoidance.contingency import room_outside
from avoidance.flown import SEQUENCING_DELAY, flown_segments
from avoidance.geometry import point_distances, segment_point_distance, segments_clearance
from avoidance.problem import WaypointProblem
from avoidance.search import search_waypoint
from avoidance.tangent_graph import shortest_path
from avoidance.traffic_route import two_waypoints
from avoidance.types import Floats, Performance, Rung, Search

RUNGS: tuple[tuple[Rung, frozenset[str]], ...] = (
    (Rung.WAYPOINT, frozenset()),
    (Rung.WIDE_TURN, frozenset({"g4"})),
    (Rung.FAR, frozenset({"g4", "g2"})),
    (Rung.CLOSE, frozenset({"g4", "g2", "g1"})),
)
"""Single-waypoint rungs and the constraints given up on each."""

Corners: TypeAlias = tuple[tuple[float, float], ...]
"""Waypoints in order, north and east [m]."""

LARGEST_CORNER = math.radians(15.0)
"""Heading change of a corner of an exact route [rad]."""

HARDLY = 0.025
"""By how much circles are widened where more would shut the way, in turn radii."""
ROUNDS = 6
"""How often circles are widened until a route can be flown."""

ROOM_LEFT = 50.0
"""A separation from an intruder is worth a change of route if it is better by this [m]."""

IN_TRAFFIC = 150.0
"""With intruders about, no plan gives way to one that is shorter by less than this [m]."""
LONG_WAY = 600.0
"""Round several intruders, two waypoints are tried as well where one is longer than the straight way by more
than this [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """A way round."""

    rung: Rung
    """How far down the ladder it was found."""
    waypoints: Corners
    """New waypoints in order, north and east [m]."""
    search: Search
    """The waypoint search made first (with every constraint), or the one that found the waypoint."""
    saved: float = 0.0
    """How much longer the way on an earlier rung is that it was preferred to [m]; 0 if there was none."""
    expecting: bool = False
    """True if what it goes round is expected to go on where nobody has looked."""


Way = Callable[[WaypointProblem, np.random.Generator], Plan | None]
"""Whatever finds a way round, or None; draws from the generator."""


def way_round(problem: WaypointProblem, rng: np.random.Generator) -> Plan | None:
    """The first rung on which there is a way, or None.

    Parameters
    ----------
    problem : WaypointProblem
        The search with every constraint.
    rng : numpy.random.Generator
        The planner's randomness.
    """
    search = None
    for rung, relaxed in RUNGS if len(problem.centres) else RUNGS[:2]:
        search = search_waypoint(replace(problem, relaxed=relaxed), rng)
        if search.found is not None:
            return _cheapest(problem, Plan(rung, (search.found,), search), rng)
        if rung is RUNGS[0][0] and not _any_way(problem):
            return None
    route = _kept_from_intruders(problem, exact_route(problem))
    if route is None and len(problem.intruders):
        route, lacking = _through_traffic(problem, rng)
        route = route if lacking <= 0.0 else None
    return None if route is None or search is None else Plan(Rung.ROUTE, route, search)


def _cheapest(problem: WaypointProblem, plan: Plan, rng: np.random.Generator) -> Plan:
    """The plan, or one further down the ladder if that is much shorter."""
    relaxing, several = _worth(problem)
    length = _length(problem, plan.waypoints)
    straight = math.dist(problem.start, problem.target)
    if length - straight < relaxing:
        return plan
    if len(problem.intruders) > 1 and length - straight > LONG_WAY:
        route, lacking = _through_traffic(problem, rng)
        if route is not None and lacking <= 0.0 and _length(problem, route) < length - several:
            return Plan(Rung.ROUTE, route, plan.search, length - _length(problem, route))
    first, least = length, _at_least(problem)
    if plan.rung is not Rung.CLOSE and length - least >= relaxing:
        close = replace(problem, relaxed=RUNGS[-1][1], longest=length - relaxing)
        search = search_waypoint(close, rng)
        if search.found is not None and _length(problem, (search.found,)) < close.longest:
            length = _length(problem, (search.found,))
            plan = Plan(Rung.CLOSE, (search.found,), search, first - length)
    if length - least < several:
        return plan
    route = _kept_from_intruders(problem, exact_route(problem, length - several))
    return plan if not route else Plan(Rung.ROUTE, route, plan.search, first - _length(problem, route))


def _at_least(problem: WaypointProblem) -> float:
    """Length that no way can fall below: the way round one circle alone, whichever needs the longest [m].

    Two tangents and the arc between them, on the side on which it is shorter; radii as `exact_route` has.
    """
    away, off = (
        point_distances(problem.centres, problem.start),
        point_distances(problem.centres, problem.target),
    )
    straight = math.dist(problem.start, problem.target)
    radii = np.minimum(np.minimum(problem.keep, away - 0.5), off - 0.5)
    cut = segment_point_distance(problem.start, problem.target, problem.centres) < radii
    away, off, radii = away[cut], off[cut], radii[cut]
    between = np.arccos(np.clip((away**2 + off**2 - straight**2) / (2.0 * away * off), -1.0, 1.0))
    arc = between - np.arccos(radii / away) - np.arccos(radii / off)
    round_it = np.sqrt(away**2 - radii**2) + np.sqrt(off**2 - radii**2) + radii * arc
    return float(round_it.max(initial=straight))


def _worth(problem: WaypointProblem) -> tuple[float, float]:
    """By how much a nearer waypoint, and a route of several, must be shorter to be preferred [m]."""
    p = problem.parameters
    if not len(problem.intruders):
        return p.worth_relaxing, p.worth_route
    return max(p.worth_relaxing, IN_TRAFFIC), max(p.worth_route, IN_TRAFFIC)


def widest_way(problem: WaypointProblem, rng: np.random.Generator, lacking: float = math.inf) -> Plan | None:
    """The way that keeps furthest from intruders where d + h cannot be kept from all of them.

    Parameters
    ----------
    problem : WaypointProblem
        The search with every constraint.
    rng : numpy.random.Generator
        The planner's randomness.
    lacking : float
        What the route that is being flown lacks [m]: another must lack less by `ROOM_LEFT`.

    Notes
    -----
    First with the present estimate taken as sure, without the doubt about it; then the least violating way of
    one or of two waypoints that is clear of all that stands still.
    """
    intruders = problem.intruders
    surely = np.zeros(len(intruders))
    sure = replace(intruders, sigma=surely, speed_sigma=surely)
    plan = way_round(replace(problem, intruders=sure), rng)
    if plan is not None:
        return plan
    search = search_waypoint(replace(problem, relaxed=RUNGS[-1][1]), rng)
    single: Corners = (search.least_violating,)
    found = [(problem.separation_shortfall(single), single)]
    route, short = _through_traffic(problem, rng)
    if route is not None:
        found.append((short, route))
    for short, route in sorted(found, key=lambda pair: pair[0]):
        if short < min(lacking, problem.separation_shortfall(())) - ROOM_LEFT and _clear(problem, route):
            return Plan(Rung.CLOSE if len(route) == 1 else Rung.ROUTE, route, search)
    return None


def _through_traffic(problem: WaypointProblem, rng: np.random.Generator) -> tuple[Corners | None, float]:
    """The best way by two waypoints that is clear of what stands still, and what it lacks to d + h [m]."""
    pairs, _ = two_waypoints(problem, rng)
    for pair in pairs.tolist():
        route = ((pair[0][0], pair[0][1]), (pair[1][0], pair[1][1]))
        if _clear(problem, route):
            return route, problem.separation_shortfall(route)
    return None, math.inf


def _clear(problem: WaypointProblem, route: Corners) -> bool:
    return flyable(problem, np.array([problem.start, *route, problem.target]))


def _kept_from_intruders(problem: WaypointProblem, route: Corners | None) -> Corners | None:
    """The route, if it keeps from intruders what is to be kept."""
    if route is None or problem.separation_shortfall(route) > 0.0:
        return None
    return route


def exact_route(
    problem: WaypointProblem, longest: float = math.inf, room: Floats | float = 0.0
) -> Corners | None:
    """Waypoints of the shortest path round everything known that can be flown, or None if over `longest` [m].

    The path keeps `room`, shape (d,) or one for all, more from each obstacle that is not nearer to its ends
    [m]; of the flown curve, with its turns, that is not asked. First with what leaves room for orbits beside;
    where that shuts the way, with hardly any. Intruders are not considered. No waypoints at all: the straight
    way leads out of a margin that the vehicle is already inside.
    """
    performance = problem.performance
    beside = room_outside(performance, LARGEST_CORNER) - problem.parameters.margin
    for pad in (max(_cut(performance), beside), HARDLY * performance.turn_radius):
        route = _as_flown(problem, problem.keep + pad + room, pad, longest)
        if route is not None:
            return route
    return None


def _as_flown(problem: WaypointProblem, keep: Floats, pad: float, longest: float) -> Corners | None:
    """The same round circles of radii `keep`, shape (d,), and walls wider by `pad` [m].

    Those that the flown curve, with its turns, comes too near to are widened further until it is clear; for
    walls all are, as the circles about their ends must not be smaller.
    """
    free_start = point_distances(problem.centres, problem.start) - 0.5
    free_target = point_distances(problem.centres, problem.target) - 0.5
    room, last = problem.walls.room + pad, None
    for _ in range(ROUNDS):
        radii = np.maximum(np.minimum(np.minimum(keep, free_start), free_target), 0.0)
        if last is not None and room == last[1] and np.array_equal(radii, last[0]):
            return None  # what would have to be wider begins or ends here
        last = (radii, room)
        walls = replace(problem.walls, room=room)
        path = shortest_path(problem.start, problem.target, problem.centres, radii, walls, longest)
        if path is None:
            return None
        corners = path.polyline(LARGEST_CORNER)
        lacking, outside = _shortfalls(problem, corners)
        if not lacking.any() and outside <= 0.0:
            return tuple((float(point[0]), float(point[1])) for point in corners[1:-1])
        wider = 2.0 * outside + 1.0 if outside > 0.0 else 0.0
        keep = keep + np.maximum(np.where(lacking > 0.0, 2.0 * lacking + 1.0, 0.0), wider)
        room += wider
    return None


def _cut(performance: Performance) -> float:
    """How far the corners of an exact route, which lie outside of a circle, are cut towards it at most [m].

    The vehicle leaves a leg up to `run` before the corner and is led on to the next one, which touches the
    circle halfway.
    """
    run = performance.acceptance_radius + SEQUENCING_DELAY * performance.airspeed
    return 0.5 * run * math.sin(LARGEST_CORNER)


def _any_way(problem: WaypointProblem) -> bool:
    """Whether a point could get to the target, however sharply it turned: if not, no waypoint helps."""
    free_start = point_distances(problem.centres, problem.start) - 0.5
    free_target = point_distances(problem.centres, problem.target) - 0.5
    radii = np.maximum(np.minimum(np.minimum(problem.keep, free_start), free_target), 0.0)
    return shortest_path(problem.start, problem.target, problem.centres, radii, problem.walls) is not None


def _length(problem: WaypointProblem, waypoints: Corners) -> float:
    corners = (problem.start, *waypoints, problem.target)
    return sum(math.dist(a, b) for a, b in pairwise(corners))


def flyable(problem: WaypointProblem, corners: Floats) -> bool:
    """True if a route, flown with its turns, keeps clear of what stands still and of the geofence.

    `corners`, shape (k, 2) [m], begin at the start and end at the target.
    """
    lacking, outside = _shortfalls(problem, corners)
    return not lacking.any() and outside <= 0.0


def _shortfalls(problem: WaypointProblem, corners: Floats) -> tuple[Floats, float]:
    """By how much a route, flown with its turns, comes too near to each circle, shape (d,), and walls [m]."""
    if problem.before is not None:
        corners = np.concatenate([np.array([problem.before]), corners])
    starts, ends, extra = flown_segments(corners[None], problem.course, problem.performance)
    skip = 0 if problem.before is None else 1
    starts, ends, extra = starts[:, skip:], ends[:, skip:], extra[:, skip:]
    lacking = np.zeros(len(problem.centres))
    if len(lacking):
        clearance = segments_clearance(starts[0], ends[0], problem.centres) - extra[0][:, None]
        lacking = np.maximum(problem.keep - 0.5 - clearance.min(axis=0), 0.0)
    return lacking, max(float(problem.walls.shortfall(starts, ends, extra)[0]) - 0.5, 0.0)
