"""A path among discs: straight segments and arcs, and the waypoints that fly it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from avoidance.geometry import Point, segment_point_distance, segments_clearance
from avoidance.types import Floats, Ints

TOUCH = 1e-9
"""Part of a radius by which a segment may enter a disc and still count as touching it."""
MOST_CORNERS = 4096
"""Corners that one arc may be given to keep it clear of its neighbours."""


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """A path for a point among discs: segments that touch discs, joined by arcs on them."""

    length: float
    """Length [m]."""
    points: Floats
    """Start, ends of segments and arcs, goal (north, east) [m], shape (k, 2)."""
    discs: Ints
    """Disc on whose circle points i and i+1 are joined, -1 for a straight segment, shape (k-1,)."""
    sweeps: Floats
    """Angle turned through between points i and i+1 [rad], clockwise positive, 0 on segments, (k-1,)."""
    centres: Floats
    """Centres of all the discs (north, east) [m], shape (n, 2)."""
    radii: Floats
    """Radii of all the discs [m], shape (n,)."""

    def clearance(self, centres: Floats) -> Floats:
        """Least distance between the path and each of some points.

        Parameters
        ----------
        centres : Floats
            Points (north, east) [m], shape (m, 2).

        Returns
        -------
        Floats
            Distances [m], shape (m,), in closed form.
        """
        straight = np.flatnonzero(self.discs < 0)
        distances = segments_clearance(self.points[straight], self.points[straight + 1], centres)
        least = distances.min(axis=0, initial=math.inf)
        if len(straight) < len(self.discs):
            least = np.minimum(least, self._arcs_clearance(centres))
        return np.asarray(least)

    def polyline(self, max_turn: float = math.radians(30.0), shortest: float = 0.0) -> Floats:
        """Waypoints that fly the path, never inside a disc that the path keeps out of.

        Parameters
        ----------
        max_turn : float
            Largest change of course at a corner put in for an arc, in (0, π/2] [rad].
        shortest : float
            On arcs whose corners would be nearer to one another than this, fewer turn by more, up to 90° [m].

        Returns
        -------
        Floats
            Start, corners, goal (north, east) [m], shape (m, 2). Each arc is replaced by corners outside
            its disc, where the tangents of its parts meet; it is split until no corner turns by more
            than `max_turn`, as far as `shortest` allows, and until no segment enters a neighbouring disc
            (by more than 1e-9 of its radius; an arc squeezed between two discs that touch stops at 4096
            corners).

        Raises
        ------
        ValueError
            If `max_turn` is out of range.
        """
        if not 0.0 < max_turn <= math.pi / 2:
            raise ValueError(f"max_turn must lie in (0, π/2] rad: {max_turn}")
        corners: list[Floats] = [self.points[:1]]
        for k, disc in enumerate(self.discs.tolist()):
            if disc >= 0:
                corners.append(self._corners(k, max_turn, shortest))
            elif k > 0 and self.discs[k - 1] < 0:
                corners.append(self.points[k : k + 1])
        corners.append(self.points[-1:])
        return np.concatenate(corners)

    def _bearing(self, k: int) -> float:
        """Angle of point k seen from the centre of the disc of piece k [rad]."""
        north, east = self.points[k] - self.centres[self.discs[k]]
        return math.atan2(float(east), float(north))

    def _arcs_clearance(self, centres: Floats) -> Floats:
        """Least distance between the arcs and each of some points [m], shape (m,)."""
        arcs = np.flatnonzero(self.discs >= 0)
        discs, sweeps = self.discs[arcs], self.sweeps[arcs, None]
        hubs, radii = self.centres[discs], self.radii[discs, None]
        begin = self.points[arcs] - hubs
        north, east = centres[:, 0] - hubs[:, 0, None], centres[:, 1] - hubs[:, 1, None]
        turned = np.sign(sweeps) * (np.arctan2(east, north) - np.arctan2(begin[:, 1], begin[:, 0])[:, None])
        facing = np.mod(turned, math.tau) <= np.abs(sweeps)
        to_arcs = np.where(facing, np.abs(np.hypot(north, east) - radii), math.inf)
        ends = self.points[np.concatenate([arcs, arcs + 1])]
        to_ends = np.hypot(centres[:, 0] - ends[:, 0, None], centres[:, 1] - ends[:, 1, None])
        return np.asarray(np.minimum(to_arcs.min(axis=0), to_ends.min(axis=0)))

    def _corners(self, k: int, max_turn: float, shortest: float) -> Floats:
        """Corners outside the disc that replace arc k, shape (c, 2) [m]."""
        disc, sweep = int(self.discs[k]), float(self.sweeps[k])
        others = np.arange(len(self.radii)) != disc
        limits = self.radii[others] * (1.0 - TOUCH)
        turn = max(max_turn, min(2.0 * math.atan2(shortest, 2.0 * float(self.radii[disc])), 0.5 * math.pi))
        parts = max(1, math.ceil(abs(sweep) / turn - 1e-9))
        while True:
            angles = self._bearing(k) + sweep / parts * (np.arange(parts) + 0.5)
            reach = float(self.radii[disc]) / math.cos(sweep / parts / 2.0)
            corners = self.centres[disc] + reach * np.column_stack([np.cos(angles), np.sin(angles)])
            chain = np.concatenate([self.points[k : k + 1], corners, self.points[k + 1 : k + 2]])
            free = segments_clearance(chain[:-1], chain[1:], self.centres[others]) >= limits
            if parts >= MOST_CORNERS or bool(free.all()):
                return np.asarray(corners)
            parts *= 2


def clear(a: Point, b: Point, centres: Floats, radii: Floats, tolerance: float = TOUCH) -> bool:
    """Whether a segment keeps out of every disc; touching one is allowed.

    Parameters
    ----------
    a, b : Point
        Ends of the segment (north, east) [m].
    centres : Floats
        Centres (north, east) [m], shape (n, 2).
    radii : Floats
        Radii [m], shape (n,).
    tolerance : float
        Part of a radius by which the segment may come closer.

    Returns
    -------
    bool
        True if no disc is entered.
    """
    return bool((segment_point_distance(a, b, centres) >= radii * (1.0 - tolerance)).all())
