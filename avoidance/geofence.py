"""Where the mission allows flying at all: areas to stay in, areas to stay out of.

A place is allowed inside at least one area to stay in, if there are any, and outside all areas to stay out
of. Circles to stay out of are discs, as obstacles are. The edges of everything else are walls: straight
pieces that no flight may come near; circles to stay in become polygons inscribed within a metre.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from avoidance.geometry import segments_clearance
from avoidance.types import Bools, Floats

FENCE = -1
"""Identity of the geofence among obstacles."""
SAGITTA = 1.0
"""An inscribed polygon leaves its circle by no more than this [m] ..."""
MOST_CORNERS = 720
"""... or has so many corners."""
BESIDE = 1e-3
"""On which side of an edge one may fly is looked up this far beside it [m]."""


@dataclass(frozen=True, slots=True)
class FenceArea:
    """A polygon or a circle, to stay in or to stay out of.

    Raises
    ------
    ValueError
        If it is neither, or both, or a number makes no sense.
    """

    include: bool
    """True to stay in, false to stay out."""
    corners: tuple[tuple[float, float], ...] = ()
    """North and east of each corner of a polygon [m], the last joined to the first; empty for a circle."""
    centre: tuple[float, float] | None = None
    """North and east of a circle's centre [m]."""
    radius: float | None = None
    """Of a circle [m]."""

    def __post_init__(self) -> None:
        """Refuse what is no area."""
        if (self.centre is None) != (self.radius is None) or (self.centre is None) != bool(self.corners):
            raise ValueError("an area has either corners, or centre and radius")
        if self.radius is not None and not 0.0 < self.radius < math.inf:
            raise ValueError(f"radius = {self.radius}, must be above 0")
        if self.corners and len(self.corners) < 3:
            raise ValueError(f"corners = {len(self.corners)}, must be at least 3")
        numbers = [c for corner in (*self.corners, self.centre or (0.0, 0.0)) for c in corner]
        if not all(map(math.isfinite, numbers)):
            raise ValueError("corners and centre must be finite")

    def outline(self) -> Floats:
        """Corners of the polygon, or of one inscribed in the circle, shape (k, 2) [m]."""
        if self.centre is None or self.radius is None:
            return np.array(self.corners)
        share = max(1.0 - SAGITTA / self.radius, 0.5)
        count = min(max(8, math.ceil(math.pi / math.acos(share))), MOST_CORNERS)
        angles = math.tau / count * np.arange(count)
        ring: Floats = np.array(self.centre) + self.radius * np.column_stack((np.cos(angles), np.sin(angles)))
        return ring

    def holds(self, points: Floats) -> Bools:
        """Whether points, shape (n, 2) [m], lie inside, shape (n,)."""
        if self.centre is not None and self.radius is not None and not self.include:
            inside: Bools = np.hypot(*(points - self.centre).T) < self.radius
            return inside
        return _in_polygon(points, self.outline())


@dataclass(frozen=True, slots=True, eq=False)
class Walls:
    """Straight pieces that no flight may come near."""

    segments: Floats = field(default_factory=lambda: np.empty((0, 2, 2)))
    """Their ends, north and east [m], shape (k, 2, 2)."""
    room: float = 0.0
    """What is kept from them [m]."""

    def __len__(self) -> int:
        """How many there are."""
        return len(self.segments)

    def clearance(self, starts: Floats, ends: Floats) -> Floats:
        """Distance of some segments from the nearest wall [m].

        Parameters
        ----------
        starts, ends : array, shape (m, 2)
            Ends of the segments [m]; a segment may be a point.

        Returns
        -------
        array, shape (m,)
            0 where a wall is crossed, infinite where there are none.
        """
        return np.asarray(self.clearances(starts, ends).min(axis=1, initial=math.inf))

    def clearances(self, starts: Floats, ends: Floats) -> Floats:
        """The same for each wall, shape (m, k)."""
        if not len(self):
            return np.empty((len(starts), 0))
        one, other = self.segments[:, 0], self.segments[:, 1]
        least = np.minimum(segments_clearance(starts, ends, one), segments_clearance(starts, ends, other))
        least = np.minimum(least, segments_clearance(one, other, starts).T)
        least = np.minimum(least, segments_clearance(one, other, ends).T)
        least[_cross(starts, ends, one, other)] = 0.0
        return least

    def shortfall(self, starts: Floats, ends: Floats, extra: Floats) -> Floats:
        """How much some flown curves come too near [m], shape (n,).

        Parameters
        ----------
        starts, ends : array, shape (n, m, 2)
            Segments whose hull holds each curve, see `avoidance.flown` [m].
        extra : array, shape (n, m)
            How far the curve may leave them [m].
        """
        if not len(self):
            return np.zeros(len(starts))
        gap = self.clearance(starts.reshape(-1, 2), ends.reshape(-1, 2)).reshape(extra.shape)
        return np.asarray(np.maximum((self.room + extra - gap).max(axis=1), 0.0))


class Geofence:
    """All areas of a mission.

    Parameters
    ----------
    areas : sequence of FenceArea
        Areas to stay in and areas to stay out of; none allows everything.
    """

    def __init__(self, areas: Sequence[FenceArea] = ()) -> None:
        self.areas = tuple(areas)

    def allows(self, points: Floats) -> Bools:
        """Whether points, shape (n, 2) [m], lie where one may fly, shape (n,)."""
        return _allowed(self.areas, points)

    @cached_property
    def discs(self) -> Floats:
        """Circles to stay out of: north, east, radius [m], shape (c, 3)."""
        rows = [(*a.centre, a.radius) for a in self.areas if not a.include and a.centre is not None]
        return np.array(rows, dtype=np.float64).reshape(-1, 3)

    @cached_property
    def walls(self) -> Floats:
        """Pieces of edges that part where one may fly from where one may not, shape (k, 2, 2) [m]."""
        edges = [_edges(area.outline()) for area in self._walled]
        if not edges:
            return np.empty((0, 2, 2))
        every = np.concatenate(edges)
        pieces = np.concatenate([_split(edge, every) for edge in every])
        along = pieces[:, 1] - pieces[:, 0]
        length = np.hypot(along[:, 0], along[:, 1])
        pieces, along, length = pieces[length > BESIDE], along[length > BESIDE], length[length > BESIDE]
        beside = BESIDE / length[:, None] * np.column_stack((-along[:, 1], along[:, 0]))
        middle = pieces.mean(axis=1)
        areas = self._walled  # a circle to stay out of would hide the pieces whose middle it covers
        return np.asarray(pieces[_allowed(areas, middle + beside) != _allowed(areas, middle - beside)])

    @cached_property
    def posts(self) -> Floats:
        """Ends of walls round which a shortest way can bend, shape (p, 2) [m]."""
        walls = self.walls
        if not len(walls):
            return np.empty((0, 2))
        ends = np.concatenate([walls[:, 0], walls[:, 1]])
        others = np.concatenate([walls[:, 1], walls[:, 0]])
        which = np.unique(np.round(ends, 3), axis=0, return_inverse=True)[1].reshape(-1)
        kept = []
        for k in range(int(which.max()) + 1):
            place = ends[which == k].mean(axis=0)
            away = others[which == k] - place
            if len(away) == 2:
                inner = (away / np.hypot(*away.T)[:, None]).sum(axis=0)
                bend = float(np.hypot(*inner))
                if bend < 1e-9 or _allowed(self._walled, place[None] + BESIDE / bend * inner)[0]:
                    continue  # straight on, or a corner that points outwards
            kept.append(place)
        return np.array(kept).reshape(-1, 2)

    @property
    def _walled(self) -> list[FenceArea]:
        return [area for area in self.areas if area.include or area.centre is None]


OPEN = Geofence()
"""No geofence: everything is allowed."""


def _allowed(areas: Sequence[FenceArea], points: Floats) -> Bools:
    inside = [area.holds(points) for area in areas if area.include]
    good = np.any(inside, axis=0) if inside else np.ones(len(points), dtype=np.bool_)
    for area in areas:
        if not area.include:
            good &= ~area.holds(points)
    return np.asarray(good)


def _edges(corners: Floats) -> Floats:
    return np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)


def _split(edge: Floats, others: Floats) -> Floats:
    """An edge cut where others cross or touch it, shape (k, 2, 2)."""
    along = edge[1] - edge[0]
    square = max(float(along @ along), 1e-12)
    step = others[:, 1] - others[:, 0]
    between = others[:, 0] - edge[0]
    determinant = along[0] * step[:, 1] - along[1] * step[:, 0]
    apart = np.abs(determinant) > 1e-9
    safe = np.where(apart, determinant, 1.0)
    share = (between[:, 0] * step[:, 1] - between[:, 1] * step[:, 0]) / safe
    on_other = (between[:, 0] * along[1] - between[:, 1] * along[0]) / safe
    crossing = share[apart & (on_other > -1e-9) & (on_other < 1.0 + 1e-9)]
    ends = np.concatenate([others[:, 0], others[:, 1]]) - edge[0]
    on_line = np.abs(along[0] * ends[:, 1] - along[1] * ends[:, 0]) < 1e-6 * math.sqrt(square)
    touching = (ends[on_line] @ along) / square
    shares = np.concatenate([[0.0, 1.0], crossing, touching])
    shares = np.unique(np.clip(shares, 0.0, 1.0))
    points = edge[0] + shares[:, None] * along
    return np.stack([points[:-1], points[1:]], axis=1)


def _cross(starts: Floats, ends: Floats, one: Floats, other: Floats) -> Bools:
    """Which of m segments cross which of k others, shape (m, k)."""

    def side(a: Floats, b: Floats, p: Floats) -> Floats:
        """On which side of the lines a-b, rows, points p, columns, lie."""
        step = b - a
        north, east = p[:, 0] - a[:, 0, None], p[:, 1] - a[:, 1, None]
        return np.asarray(step[:, 0, None] * east - step[:, 1, None] * north)

    apart = side(starts, ends, one) * side(starts, ends, other) < 0.0
    return np.asarray(apart & (side(one, other, starts) * side(one, other, ends) < 0.0).T)


def _in_polygon(points: Floats, corners: Floats) -> Bools:
    """Even-odd rule, shape (n,)."""
    begin, end = corners, np.roll(corners, -1, axis=0)
    north, east = points[:, 0, None], points[:, 1, None]
    spans = (begin[:, 1] > east) != (end[:, 1] > east)
    rise = np.where(end[:, 1] == begin[:, 1], 1.0, end[:, 1] - begin[:, 1])
    at = begin[:, 0] + (east - begin[:, 1]) / rise * (end[:, 0] - begin[:, 0])
    return np.asarray((spans & (north < at)).sum(axis=1) % 2 == 1)


__all__ = ["FENCE", "OPEN", "FenceArea", "Geofence", "Walls"]
