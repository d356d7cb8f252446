"""The shortest way of several waypoints round everything known that can be flown with its turns."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from typing import TypeAlias

import numpy as np

from avoidance.constraints import feasible_segments
from avoidance.contingency import room_outside
from avoidance.flown import as_complex, as_pairs, early_turn, flown_segments
from avoidance.geometry import point_distances, segments_clearance
from avoidance.problem import WaypointProblem
from avoidance.tangent_graph import shortest_path
from avoidance.types import Floats, Performance

Corners: TypeAlias = tuple[tuple[float, float], ...]
"""Waypoints in order, north and east [m]."""

LARGEST_CORNER = math.radians(9.0)
"""Heading change of a corner of an exact route [rad]."""

HARDLY = 0.025
"""By how much circles are widened where more would shut the way, in turn radii."""
ROUNDS = 6
"""How often circles are widened until a route can be flown."""

ASIDE = np.radians([*range(-75, 0, 5), *range(5, 80, 5)])
"""Where a way may begin whose first turn is too wide, from the shortest way's first leg [rad]."""
CAPTURED = (0.6, 1.0, 1.6, 2.4)
"""How long its first leg may be, in distances that capturing a leg takes."""
JOINED = 4
"""At which of its first corners the shortest way may be joined."""
PROMISING = 3
"""How many such ways are looked at as a whole."""


def exact_route(
    problem: WaypointProblem, longest: float = math.inf, room: Floats | float = 0.0
) -> Corners | None:
    """Waypoints of the shortest path round everything known that can be flown, or None if over `longest` [m].

    `longest` bounds the path along arcs; the way by the waypoints is a little longer. The path keeps `room`,
    shape (d,) or one for all, more from each obstacle that is not nearer to its ends [m]; of the flown curve,
    with its turns, that is not asked. First with what leaves room for orbits beside; where that shuts the
    way, with hardly any. Intruders are not considered. No waypoints at all: the straight way leads out of a
    margin that the vehicle is already inside.
    """
    performance = problem.performance
    beside = room_outside(performance, LARGEST_CORNER) - problem.parameters.margin
    for pad in (max(_cut(performance), beside), HARDLY * performance.turn_radius):
        route = _as_flown(problem, room, pad, longest)
        if route is not None:
            return route
    return None


def length_by(problem: WaypointProblem, waypoints: Corners) -> float:
    """Length of the way from the start by some waypoints to the target [m]."""
    corners = (problem.start, *waypoints, problem.target)
    return sum(math.dist(a, b) for a, b in pairwise(corners))


def _as_flown(problem: WaypointProblem, room: Floats | float, pad: float, longest: float) -> Corners | None:
    """The same round circles wider by `room` and `pad`, and walls wider by `pad` [m].

    Those that the flown curve, with its turns, comes too near to are widened further until it is clear; for
    walls all are, as the circles about their ends must not be smaller.
    """
    free_start = point_distances(problem.centres, problem.start) - 0.5
    free_target = point_distances(problem.centres, problem.target) - 0.5
    keep, walled, last = problem.keep + room + pad, problem.walls.room + pad, None
    for _ in range(ROUNDS):
        radii = np.maximum(np.minimum(np.minimum(keep, free_start), free_target), 0.0)
        if last is not None and walled == last[1] and np.array_equal(radii, last[0]):
            return None  # what would have to be wider begins or ends here
        last = (radii, walled)
        walls = replace(problem.walls, room=walled)
        path = shortest_path(problem.start, problem.target, problem.centres, radii, walls, longest)
        if path is None:
            return None
        corners = path.polyline(LARGEST_CORNER, early_turn(problem.performance))
        lacking, outside = _shortfalls(problem, corners)
        if not lacking.any() and outside <= 0.0:
            return _waypoints(corners)
        for turned in _turned_aside(problem, corners, np.minimum(radii, problem.keep + room)):
            lacking, outside = _shortfalls(problem, turned)
            if not lacking.any() and outside <= 0.0:
                route = _waypoints(turned)
                return route if length_by(problem, route) < longest else None
        wider = 2.0 * outside + 1.0 if outside > 0.0 else 0.0
        keep = keep + np.maximum(np.where(lacking > 0.0, 2.0 * lacking + 1.0, 0.0), wider)
        walled += wider
    return None


def _turned_aside(problem: WaypointProblem, corners: Floats, radii: Floats) -> Iterator[Floats]:
    """The way by `corners`, shape (k, 2) [m], beginning more to one side, so that its first turn is free.

    Its straight legs keep out of circles of `radii`, shape (d,) [m]. The shortest come first; none if the
    first turn is not sharp.
    """
    if not _sharp_at_first(problem, corners):
        return
    start, way = complex(*problem.start), as_complex(corners)
    ahead = (way[1] - start) / max(abs(way[1] - start), 1e-9)
    reach = np.maximum(
        problem.performance.capture_distance * np.array(CAPTURED), _not_passed_at_once(problem)
    )
    first = (start + reach[:, None] * ahead * np.exp(1j * ASIDE)).ravel()
    rest = np.append(np.cumsum(np.abs(np.diff(way))[::-1])[::-1], 0.0)
    found: list[tuple[float, complex, int]] = []
    for joined in range(1, min(len(way), JOINED + 1)):
        onward = np.empty((len(first), 3), dtype=np.complex128)
        onward[:, 0], onward[:, 1], onward[:, 2] = first, way[joined], way[min(joined + 1, len(way) - 1)]
        legs = as_pairs(np.column_stack([np.full(len(first), start), first])), as_pairs(onward[:, :2])
        outside = feasible_segments(legs[0], legs[1], np.zeros((len(first), 2)), problem.centres, radii - 0.5)
        free = np.flatnonzero((problem.route_shortfall(onward) <= 0.0) & (outside <= 0.0))
        length = np.abs(first - start) + np.abs(way[joined] - first) + rest[joined]
        found += [(float(length[k]), complex(first[k]), joined) for k in free]
    for _, point, joined in sorted(found, key=lambda way: way[0])[:PROMISING]:
        yield np.concatenate([corners[:1], [[point.real, point.imag]], corners[joined:]])


def _not_passed_at_once(problem: WaypointProblem) -> float:
    """How far from the start a first waypoint must lie so that the turn there does not pass it as well [m].

    Where a waypoint is reached, that may happen at its acceptance radius.
    """
    performance = problem.performance
    early = 0.0 if problem.before is None else early_turn(performance)
    return early + performance.acceptance_radius + 2.0 * performance.turn_radius


def _sharp_at_first(problem: WaypointProblem, corners: Floats) -> bool:
    """True if the first change of course, on to the first leg, is beyond 90 degrees."""
    leg = corners[1] - corners[0]
    if problem.course is not None:
        return bool(leg[0] * math.cos(problem.course) + leg[1] * math.sin(problem.course) < 0.0)
    return problem.before is not None and float((corners[0] - np.array(problem.before)) @ leg) < 0.0


def _waypoints(corners: Floats) -> Corners:
    return tuple((float(point[0]), float(point[1])) for point in corners[1:-1])


def _cut(performance: Performance) -> float:
    """How far the corners of an exact route, which lie outside of a circle, are cut towards it at most [m].

    The vehicle leaves a leg up to `run` before the corner and is led on to the next one, which touches the
    circle halfway.
    """
    return 0.5 * early_turn(performance) * math.sin(LARGEST_CORNER)


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
