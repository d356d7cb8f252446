"""Is the remaining route clear? If not, which leg is blocked first, and by what (Algorithms 5 and 6)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from avoidance.flown import flown_segments
from avoidance.geofence import FENCE, Walls
from avoidance.geometry import distances, point_distances, segments_clearance
from avoidance.known import Known
from avoidance.types import Bools, Floats, Ints, Ownship, Performance, Route, Threat

FENCE_SLACK = 10.0
"""A route is left alone until it comes this much nearer to the geofence than is to be kept [m]."""
FENCE_STEP = 50.0
"""How exactly it is told where a route comes too near to the geofence [m]."""
LEVEL = 5.0
"""A vehicle this near to the altitude of its waypoint flies level [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Blocked:
    """The first leg of a route that cannot be flown."""

    threat: Threat
    """What blocks it, for the record."""
    leg: int
    """Index of the waypoint at its end."""
    blockers: Ints
    """Rows of `Known` of the obstacles that cut it, nearest first; empty for an intruder."""


def remaining_points(own: Ownship, route: Route, tracking_error: float, capture_distance: float) -> Floats:
    """The route as it will be flown from here, shape (1, k, 2) [m].

    While the vehicle is off its leg it flies back on to it, so a point on the leg one capture distance
    ahead is put between; the number of such points (0 or 1) is k - 1 - len(route.waypoints).
    """
    points = [(own.north, own.east)]
    first, origin = route.waypoints[0], route.origin
    north, east = first.north - origin.north, first.east - origin.east
    length = math.hypot(north, east)
    if length > 1.0:
        north, east = north / length, east / length
        along = (own.north - origin.north) * north + (own.east - origin.east) * east
        across = (own.east - origin.east) * north - (own.north - origin.north) * east
        ahead = along + capture_distance
        if abs(across) > tracking_error and 0.0 < ahead < length:
            points.append((origin.north + ahead * north, origin.east + ahead * east))
    points += [(waypoint.north, waypoint.east) for waypoint in route.waypoints]
    return np.array(points)[None]


def first_blocked_leg(
    own: Ownship,
    route: Route,
    known: Known,
    performance: Performance,
    slack: float = 1.0,
    strict: Bools | None = None,
) -> Blocked | None:
    """The first leg of the remaining route that something stationary cuts, or None.

    Parameters
    ----------
    own : Ownship
        Where the vehicle is.
    route : Route
        What it is to fly.
    known : Known
        Obstacles.
    performance : Performance
        How it turns and follows legs.
    slack : float
        Share of `known.slack` that a route may come nearer than `known.keep`: 1 for a route that is being
        flown, 0 for one that is to be taken up.
    strict : array, shape (d,), optional
        Obstacles of `known` to which a route may come no nearer than `known.keep` all the same.

    Returns
    -------
    Blocked or None

    Notes
    -----
    Algorithms 5 and 6, Eqs. (22)-(26), on the curve that will be flown. Differs from the paper: E17, a
    segment is tested and not an infinite line, which makes Algorithm 5 superfluous.
    """
    if not (len(known.ids) or len(known.walls)) or not route.waypoints:
        return None
    points = remaining_points(own, route, performance.tracking_error, performance.capture_distance)
    inserted = points.shape[1] - 1 - len(route.waypoints)
    starts, ends, extra = flown_segments(points, own.course, performance, begun=slack > 0.0)
    legs = _leg_of_segment(points.shape[1], inserted)
    first: Blocked | None = None
    for band, owners in altitude_bands(own, route).items():
        circles = known.circles(*band)
        mine = np.flatnonzero((legs[:, None] == owners).any(axis=1))
        distance = segments_clearance(starts[0, mine], ends[0, mine], circles.centres)
        spare = slack * circles.slack
        if strict is not None:
            spare[strict[circles.rows]] = 0.0
        cut = distance < (circles.keep - spare) + extra[0, mine, None]
        segments = cut.any(axis=1)
        if not segments.any():
            continue
        leg = int(legs[mine][segments].min())
        if first is not None and first.leg <= leg:
            continue
        on_leg = (legs[mine] == leg) & segments
        clearance = distance[on_leg].min(axis=0)
        blockers = np.flatnonzero(cut[on_leg].any(axis=0))
        corner = leg + inserted + 1
        begin = 0 if leg == 0 else corner - 1
        entries = _entry_distances(
            points[0, begin], points[0, corner], circles.centres[blockers], circles.keep[blockers]
        )
        order = np.argsort(entries, kind="stable")
        nearest = int(blockers[order[0]])
        ahead = _length(points[0, : begin + 1]) + float(entries[order[0]])
        rows = circles.rows[blockers[order]]
        threat = Threat(
            ids=tuple(dict.fromkeys(known.ids[rows].tolist())),
            leg=leg,
            distance=ahead,
            time=ahead / max(own.ground_speed, 1.0),
            clearance=float(clearance[nearest]),
            required=float(circles.keep[nearest]),
        )
        first = Blocked(threat, leg, rows)
    if len(known.walls):
        fenced = _first_fenced_leg(own, points[0], (starts[0], ends[0], extra[0], legs), known, slack)
        if fenced is not None and (first is None or _order(fenced) < _order(first)):
            return fenced
    return first


def _order(blocked: Blocked) -> tuple[int, float]:
    return blocked.leg, blocked.threat.distance


def _first_fenced_leg(
    own: Ownship, points: Floats, curve: tuple[Floats, Floats, Floats, Ints], known: Known, slack: float
) -> Blocked | None:
    """The first leg that comes too near to an edge of the geofence."""
    starts, ends, extra, legs = curve
    gaps = known.walls.clearances(starts, ends)
    room = known.walls.room - slack * min(FENCE_SLACK, known.walls.room)
    cut = gaps < room + extra[:, None]
    if not cut.any():
        return None
    leg = int(legs[cut.any(axis=1)].min())
    on_leg = (legs == leg) & cut.any(axis=1)
    crossed = known.walls.segments[cut[on_leg].any(axis=0)].reshape(-1, 2)
    near = distances(known.centres, crossed).min(axis=1, initial=math.inf) < 1.0
    rows = np.flatnonzero((known.ids == FENCE) & near)
    rows = rows[np.argsort(point_distances(known.centres[rows], points[0]), kind="stable")]
    begin = len(points) - 1 - (int(legs.max()) + 1 - leg)
    ahead = _length(points[: begin + 1]) + _reached_after(points[begin], points[begin + 1], known.walls)
    threat = Threat(
        ids=(FENCE,),
        leg=leg,
        distance=ahead,
        time=ahead / max(own.ground_speed, 1.0),
        clearance=float(gaps[on_leg].min()),
        required=known.walls.room,
    )
    return Blocked(threat, leg, rows)


def _reached_after(begin: Floats, end: Floats, walls: Walls) -> float:
    """How far along a segment the walls come too near, to within `FENCE_STEP` [m]."""
    length = float(np.hypot(*(end - begin)))
    along = np.arange(0.0, length + FENCE_STEP, FENCE_STEP)
    places = begin + np.minimum(along, length)[:, None] * (end - begin) / max(length, 1e-9)
    close = np.flatnonzero(walls.clearance(places[:-1], places[1:]) < walls.room)
    return float(along[close[0]]) if len(close) else length


def altitude_bands(own: Ownship, route: Route) -> dict[tuple[float, float], list[int]]:
    """Legs by the altitudes between which they are flown, lowest and highest [m]."""
    bands: dict[tuple[float, float], list[int]] = {}
    before = own.altitude
    for leg, waypoint in enumerate(route.waypoints):
        after = waypoint.altitude
        if abs(after - before) < LEVEL:
            before = after
        bands.setdefault((min(before, after), max(before, after)), []).append(leg)
        before = after
    return bands


def _leg_of_segment(corners: int, inserted: int) -> Ints:
    """Which leg each of the segments of `flown_segments` belongs to."""
    legs = np.arange(corners - 1)
    bends = np.arange(1, corners - 1)
    owner = np.concatenate([legs, bends, bends, [0, 0]]) - inserted
    return np.asarray(np.maximum(owner, 0))


def _entry_distances(begin: Floats, end: Floats, centres: Floats, radii: Floats) -> Floats:
    """Distance along a segment to where it enters each circle, or to the point nearest to it [m]."""
    along = end - begin
    length = max(float(np.hypot(*along)), 1e-9)
    unit = along / length
    offset = centres - begin
    forward = offset @ unit
    across = unit[0] * offset[:, 1] - unit[1] * offset[:, 0]
    half = np.sqrt(np.maximum(radii**2 - across**2, 0.0))
    return np.asarray(np.clip(forward - half, 0.0, length))


def _length(points: Floats) -> float:
    return sum((math.dist(a, b) for a, b in pairwise(points.tolist())), 0.0)
