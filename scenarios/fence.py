"""A geofence on the map, and when a flight was outside it: closed form, from the track alone."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from avoidance.types import Bools, Floats
from offboard.frames import MapFrame
from offboard.geofence import FenceCircle, FencePolygon, FenceType, GeofenceData
from scenarios.track import Track

if TYPE_CHECKING:
    from avoidance.geofence import Geofence

Place = tuple[float, float]
LEAST = 1e-9
"""Shares of a segment shorter than this are rounding."""


@dataclass(frozen=True, slots=True)
class FenceArea:
    """A polygon or a circle, to stay in or to stay out of."""

    include: bool
    """True to stay in, false to stay out."""
    corners: tuple[Place, ...] = ()
    """North and east of each corner of a polygon [m], the last joined to the first; empty for a circle."""
    centre: Place | None = None
    """North and east of a circle's centre [m]."""
    radius: float | None = None
    """Of a circle [m]."""

    def holds(self, points: Floats) -> Bools:
        """Whether points, shape (n, 2) [m], lie inside the area, shape (n,)."""
        if self.centre is not None and self.radius is not None:
            inside: Bools = np.hypot(*(points - self.centre).T) <= self.radius
            return inside
        return _in_polygon(points, np.array(self.corners))

    def distance_to_edge(self, points: Floats) -> Floats:
        """Distance of points, shape (n, 2), from the edge, shape (n,) [m]."""
        if self.centre is not None and self.radius is not None:
            off: Floats = np.abs(np.hypot(*(points - self.centre).T) - self.radius)
            return off
        closest = np.full(len(points), math.inf)
        line = self.outline()
        for begin, edge in zip(line[:-1], np.diff(line, axis=0), strict=True):
            share = np.clip((points - begin) @ edge / max(float(edge @ edge), 1e-12), 0.0, 1.0)
            closest = np.minimum(closest, np.hypot(*(points - begin - share[:, None] * edge).T))
        return closest

    def crossings(self, start: Floats, step: Floats) -> list[float]:
        """Shares (0 to 1) of the segment from `start` along `step` [m] at which it crosses the edge."""
        if self.centre is not None and self.radius is not None:
            return _across_circle(start - self.centre, step, self.radius)
        return _across_edges(start, step, np.array(self.corners))

    def outline(self) -> Floats:
        """The edge as a closed line, shape (m, 2) [m]."""
        if self.centre is not None and self.radius is not None:
            angles = np.linspace(0.0, 2.0 * math.pi, 121)
            ring: Floats = self.centre + self.radius * np.column_stack((np.cos(angles), np.sin(angles)))
            return ring
        return np.array([*self.corners, self.corners[0]])


def allowed(areas: Sequence[FenceArea], points: Floats) -> Bools:
    """Whether points, shape (n, 2) [m], lie where the fence allows, shape (n,).

    Inside at least one area to stay in, if there are any, and outside all areas to stay out of.
    """
    inclusions = [area.holds(points) for area in areas if area.include]
    good = np.any(inclusions, axis=0) if inclusions else np.ones(len(points), dtype=np.bool_)
    for area in areas:
        if not area.include:
            good &= ~area.holds(points)
    return good


def breaches(track: Track, areas: Sequence[FenceArea]) -> list[tuple[float, float]]:
    """When a flight was outside the fence: begin and end of each time [s]; empty if never.

    Notes
    -----
    Between two samples the flight is a straight line. It is cut where it crosses an edge, and the middle of
    each piece tells on which side the piece lies.
    """
    if not areas or len(track.times) < 2:
        return []
    last = len(track.times) - 1
    inner = [_cuts(track, int(k), areas) for k in np.flatnonzero(_near_an_edge(track, areas))]
    cuts = np.sort(np.concatenate([np.arange(last + 1, dtype=np.float64), *inner]))
    middles = 0.5 * (cuts[:-1] + cuts[1:])
    samples = np.arange(len(track.times), dtype=np.float64)
    points = np.column_stack([np.interp(middles, samples, track.positions[:, axis]) for axis in (0, 1)])
    outside = np.concatenate(([False], ~allowed(areas, points), [False]))
    begins = np.flatnonzero(outside[1:] & ~outside[:-1])
    ends = np.flatnonzero(~outside[1:] & outside[:-1])
    times = np.interp(cuts, samples, track.times)
    return [(float(times[a]), float(times[b])) for a, b in zip(begins, ends, strict=True)]


def geofence_data(areas: Sequence[FenceArea], frame: MapFrame) -> GeofenceData:
    """The fence as plan files have it."""

    def globe(place: Place) -> Place:
        latitude, longitude = frame.to_geodetic(*place)
        return float(latitude), float(longitude)

    def kind(area: FenceArea) -> FenceType:
        return FenceType.INCLUSION if area.include else FenceType.EXCLUSION

    return GeofenceData(
        tuple(FencePolygon(tuple(map(globe, a.corners)), kind(a)) for a in areas if a.corners),
        tuple(
            FenceCircle(globe(a.centre), a.radius, kind(a))
            for a in areas
            if a.centre is not None and a.radius is not None
        ),
    )


def core_fence(areas: Sequence[FenceArea]) -> Geofence:
    """The fence as the avoidance core takes it, which keeps it by code of its own."""
    from avoidance import geofence as core  # noqa: PLC0415

    return core.Geofence([core.FenceArea(a.include, a.corners, a.centre, a.radius) for a in areas])


def _near_an_edge(track: Track, areas: Sequence[FenceArea]) -> Bools:
    """Segments that begin no further from an edge than they are long, shape (m - 1,)."""
    starts = track.positions[:-1, :2]
    lengths = np.hypot(*np.diff(track.positions[:, :2], axis=0).T)
    near = np.zeros(len(starts), dtype=np.bool_)
    for area in areas:
        near |= area.distance_to_edge(starts) <= lengths + 1.0
    return near


def _cuts(track: Track, k: int, areas: Sequence[FenceArea]) -> Floats:
    """Where segment k is cut by an edge, as numbers between k and k + 1."""
    start = track.positions[k, :2]
    step = track.positions[k + 1, :2] - start
    shares = sorted(share for area in areas for share in area.crossings(start, step))
    return k + np.array([share for share in shares if LEAST < share < 1.0 - LEAST])


def _in_polygon(points: Floats, corners: Floats) -> Bools:
    """Even-odd rule."""
    inside = np.zeros(len(points), dtype=np.bool_)
    for (n1, e1), (n2, e2) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        spans = (e1 > points[:, 1]) != (e2 > points[:, 1])
        if e1 != e2:
            at = n1 + (points[:, 1] - e1) / (e2 - e1) * (n2 - n1)
            inside ^= spans & (points[:, 0] < at)
    return inside


def _across_edges(start: Floats, step: Floats, corners: Floats) -> list[float]:
    edges = np.roll(corners, -1, axis=0) - corners
    between = corners - start
    denominator = step[0] * edges[:, 1] - step[1] * edges[:, 0]
    safe = np.where(denominator == 0.0, 1.0, denominator)
    with np.errstate(over="ignore", invalid="ignore"):  # almost parallel: far beyond the ends
        along = (between[:, 0] * edges[:, 1] - between[:, 1] * edges[:, 0]) / safe
        on_edge = (between[:, 0] * step[1] - between[:, 1] * step[0]) / safe
    hit = (denominator != 0.0) & (along >= 0.0) & (along <= 1.0) & (on_edge >= 0.0) & (on_edge <= 1.0)
    found: list[float] = along[hit].tolist()
    return found


def _across_circle(start: Floats, step: Floats, radius: float) -> list[float]:
    square, along = float(step @ step), float(start @ step)
    discriminant = along**2 - square * (float(start @ start) - radius**2)
    if square == 0.0 or discriminant <= 0.0:
        return []
    root = math.sqrt(discriminant)
    return [share for share in ((-along - root) / square, (-along + root) / square) if 0.0 <= share <= 1.0]
