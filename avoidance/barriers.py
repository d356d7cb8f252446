"""Walls in the exact planner: which tangents they cut, and which arcs of circles."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from avoidance.arcs import TAU, Barred
from avoidance.geofence import Walls
from avoidance.geometry import segments_clearance
from avoidance.types import Bools, Floats

TOUCH = 1e-6
"""A path may come this part of its room nearer to a wall: tangents and arcs touch its ends."""


@dataclass(frozen=True, slots=True, eq=False)
class Barriers:
    """Walls with what is kept from each: capsules that no path enters."""

    walls: Walls
    """The segments."""
    rooms: Floats
    """What is kept from each [m], shape (k,)."""

    @classmethod
    def of(cls, walls: Walls | None, ends: Floats, origin: Floats) -> Barriers:
        """Walls about an origin, each with as much room as both ends of a path, shape (2, 2), leave [m]."""
        if walls is None or not len(walls):
            return cls(Walls(), np.empty(0))
        nearest = segments_clearance(walls.segments[:, 0], walls.segments[:, 1], ends).min(axis=1)
        return cls(Walls(walls.segments - origin, walls.room), np.minimum(walls.room, nearest))

    def __len__(self) -> int:
        """How many there are."""
        return len(self.walls)

    def at_ends(self, points: Floats) -> Bools:
        """Which points, shape (n, 2), are ends of walls, shape (n,)."""
        corners = self.walls.segments.reshape(-1, 2)
        north = points[:, 0, None] - corners[:, 0]
        east = points[:, 1, None] - corners[:, 1]
        return np.asarray((np.hypot(north, east) < 1e-2).any(axis=1))

    def clear(self, starts: Floats, ends: Floats) -> Bools:
        """Which segments, ends of shape (m, 2), keep from all walls what is to be kept, shape (m,)."""
        rooms = self.rooms * (1.0 - TOUCH)
        good = np.ones(len(starts), dtype=np.bool_)
        rows = max(1, 40_000 // max(len(self), 1))
        for first in range(0, len(starts), rows):
            part = slice(first, first + rows)
            good[part] = (self.walls.clearances(starts[part], ends[part]) >= rooms).all(axis=1)
        return good

    def arcs(self, centres: Floats, radii: Floats) -> Barred:
        """Arcs of circles that lie inside the capsules.

        Parameters
        ----------
        centres : array, shape (n, 2)
            Centres of the circles [m].
        radii : array, shape (n,)
            Their radii [m].

        Returns
        -------
        discs, begin, end : array, shape (m,)
            The arcs, clockwise from `begin` to `end`.
        """
        one, other = self.walls.segments[:, 0], self.walls.segments[:, 1]
        nearest = segments_clearance(one, other, centres).T
        furthest = np.maximum(
            np.hypot(*np.moveaxis(centres[:, None] - one, -1, 0)),
            np.hypot(*np.moveaxis(centres[:, None] - other, -1, 0)),
        )
        reached = (nearest < radii[:, None] + self.rooms) & (furthest > radii[:, None] - self.rooms)
        found: list[tuple[int, float, float]] = []
        rooms = self.rooms * (1.0 - TOUCH)
        for disc, wall in np.argwhere(reached & (radii > 0.0)[:, None]).tolist():
            inside = _inside(centres[disc], float(radii[disc]), one[wall], other[wall], float(rooms[wall]))
            found += [(disc, begin, end) for begin, end in inside]
        table = np.array(found, dtype=np.float64).reshape(-1, 3)
        return table[:, 0].astype(np.int64), table[:, 1], table[:, 2]


def _inside(centre: Floats, radius: float, a: Floats, b: Floats, room: float) -> list[tuple[float, float]]:
    """Arcs of a circle that are nearer to a segment than `room`: first and last angle of each [rad]."""
    cuts = sorted({angle % TAU for angle in _crossings(centre, radius, a, b, room)})
    if not cuts:
        cuts = [0.0]
    spans = zip(cuts, [*cuts[1:], cuts[0] + TAU], strict=True)
    kept = []
    for begin, end in spans:
        middle = 0.5 * (begin + end)
        point = centre + radius * np.array([math.cos(middle), math.sin(middle)])
        if end > begin and float(segments_clearance(a[None], b[None], point[None])[0, 0]) < room:
            kept.append((begin, end))
    return kept


def _crossings(centre: Floats, radius: float, a: Floats, b: Floats, room: float) -> list[float]:
    """Angles at which a circle meets the rim of the capsule about a segment [rad]."""
    along = b - a
    length = float(np.hypot(*along))
    unit = along / length
    offset = centre - a
    forward, across = float(offset @ unit), float(unit[0] * offset[1] - unit[1] * offset[0])
    heading = math.atan2(float(unit[1]), float(unit[0]))
    angles = []
    for side in (room, -room):
        sine = (side - across) / radius
        if abs(sine) <= 1.0:
            lean = math.asin(sine)
            both = (lean, math.pi - lean)
            angles += [heading + t for t in both if 0.0 <= forward + radius * math.cos(t) <= length]
    for end in (a, b):
        away = end - centre
        distance = float(np.hypot(*away))
        if distance > 0.0 and abs(radius - room) <= distance <= radius + room:
            cosine = (radius**2 + distance**2 - room**2) / (2.0 * radius * distance)
            half = math.acos(max(-1.0, min(1.0, cosine)))
            bearing = math.atan2(float(away[1]), float(away[0]))
            angles += [bearing - half, bearing + half]
    return angles
