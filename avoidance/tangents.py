"""Common tangents of discs and which of them are free: the edges of the tangent graph."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from avoidance.types import Bools, Floats, Ints

SENSES = np.array([(1, 1), (1, -1), (-1, 1), (-1, -1)], dtype=np.int64)
"""Senses of rotation on the first and second disc, +1 clockwise: the four common tangents."""
TOUCHING = 1e-9
"""Discs that overlap by less than this part of their distance count as touching."""
CHUNK = 40_000
"""Pairs of tangent and disc tested at once: what fits a processor's cache."""


@dataclass(frozen=True, slots=True, eq=False)
class Tangents:
    """Directed tangents: leave disc i turning with one sense, arrive on disc j turning with another."""

    ends: Ints
    """Disc i, sense on it (+1 clockwise), disc j, sense on it, shape (t, 4)."""
    lines: Floats
    """Point left (north, east) [m], unit vector of travel (north, east), length [m], angles of the ends on
    discs i and j, [0, 2π] from north [rad], shape (t, 7)."""

    @classmethod
    def none(cls) -> Tangents:
        """Return no tangents."""
        return cls(np.empty((0, 4), dtype=np.int64), np.empty((0, 7)))

    @property
    def i(self) -> Ints:
        """Disc left, shape (t,)."""
        return self.ends[:, 0]

    @property
    def sense_i(self) -> Ints:
        """Sense of rotation on disc i, +1 clockwise, shape (t,)."""
        return self.ends[:, 1]

    @property
    def j(self) -> Ints:
        """Disc reached, shape (t,)."""
        return self.ends[:, 2]

    @property
    def sense_j(self) -> Ints:
        """Sense of rotation on disc j, shape (t,)."""
        return self.ends[:, 3]

    @property
    def point(self) -> Floats:
        """Where each leaves disc i (north, east) [m], shape (t, 2)."""
        return self.lines[:, 0:2]

    @property
    def course(self) -> Floats:
        """Unit vector of travel, shape (t, 2)."""
        return self.lines[:, 2:4]

    @property
    def length(self) -> Floats:
        """Length [m], shape (t,)."""
        return self.lines[:, 4]

    @property
    def angle_i(self) -> Floats:
        """Angle of the end on disc i [rad], shape (t,)."""
        return self.lines[:, 5]

    @property
    def angle_j(self) -> Floats:
        """Angle of the end on disc j [rad], shape (t,)."""
        return self.lines[:, 6]

    @property
    def end(self) -> Floats:
        """Where each reaches disc j (north, east) [m], shape (t, 2)."""
        return np.asarray(self.point + self.lines[:, 4:5] * self.course)

    def __len__(self) -> int:
        """Return the number of tangents."""
        return len(self.ends)

    def take(self, which: Bools | Ints) -> Tangents:
        """Return the tangents chosen by a mask or by indices."""
        return Tangents(self.ends[which], self.lines[which])

    def reversed(self) -> Tangents:
        """Return the same tangents flown the other way."""
        ends = self.ends[:, [2, 3, 0, 1]]
        ends[:, 1::2] *= -1
        lines = self.lines[:, [0, 1, 2, 3, 4, 6, 5]]
        lines[:, 0:2] = self.end
        lines[:, 2:4] *= -1.0
        return Tangents(ends, lines)

    def joined(self, *others: Tangents) -> Tangents:
        """Return these tangents followed by others."""
        return Tangents(
            np.concatenate([self.ends, *(other.ends for other in others)]),
            np.concatenate([self.lines, *(other.lines for other in others)]),
        )


def common_tangents(i: Ints, j: Ints, centres: Floats, radii: Floats) -> Tangents:
    """Return the common tangents of pairs of discs.

    Parameters
    ----------
    i, j : Ints
        Discs of each pair, shape (p,). A disc of radius 0 (a point) has one sense, +1.
    centres : Floats
        Centres (north, east) [m], shape (n, 2).
    radii : Floats
        Radii [m], shape (n,).

    Returns
    -------
    Tangents
        Those from i to j: up to four of each pair, two where one is a point or the discs overlap, none
        where one contains the other.

    Notes
    -----
    With signed radii ρ = sense × radius, D the vector between the centres, n the course turned by 90° and
    k = ρ_j − ρ_i: the tangent leaves at c_i − ρ_i n, has the length L = √(D² − k²) and the course
    (L D − k n(D)) / D². It is the generalisation of Eq. (27) to two circles.
    """
    radius_i, radius_j = radii[i, None], radii[j, None]
    offset = SENSES[:, 0] * radius_i
    k = SENSES[:, 1] * radius_j - offset
    between = centres[j] - centres[i]
    distance = np.hypot(between[:, 0], between[:, 1])
    real = (distance > 0.0)[:, None] & (distance[:, None] >= np.abs(k) * (1.0 - TOUCHING))
    real &= (radius_i > 0.0) | (SENSES[:, 0] > 0)
    real &= (radius_j > 0.0) | (SENSES[:, 1] > 0)
    pair, senses = np.nonzero(real)
    ends = np.empty((len(pair), 4), dtype=np.int64)
    ends[:, 0], ends[:, 1::2], ends[:, 2] = i[pair], SENSES[senses], j[pair]
    sense_i, sense_j = ends[:, 1], ends[:, 3]
    k, offset, between, distance = k[real], offset[real], between[pair], distance[pair]
    lines = np.empty((len(ends), 7))
    length = np.sqrt(np.maximum((distance - k) * (distance + k), 0.0))
    scale = distance * np.hypot(length, k)
    north = (length * between[:, 0] + k * between[:, 1]) / scale
    east = (length * between[:, 1] - k * between[:, 0]) / scale
    lines[:, 0:2] = centres[ends[:, 0]]
    lines[:, 0] += offset * east
    lines[:, 1] -= offset * north
    lines[:, 2], lines[:, 3], lines[:, 4] = north, east, length
    lines[:, 5] = np.mod(np.arctan2(-sense_i * north, sense_i * east), math.tau)
    lines[:, 6] = np.mod(np.arctan2(-sense_j * north, sense_j * east), math.tau)
    return Tangents(ends, lines)


def unobstructed(tangents: Tangents, discs: Ints, centres: Floats, radii: Floats) -> Bools:
    """Tell which tangents enter none of some discs.

    Parameters
    ----------
    tangents : Tangents
        The t tangents.
    discs : Ints
        Numbers of the discs to test against, shape (m,); a tangent's own two never obstruct it.
    centres : Floats
        Centres of these discs (north, east) [m], shape (m, 2).
    radii : Floats
        Closest permitted distance from each [m], shape (m,).

    Returns
    -------
    Bools
        True where the tangent is free, shape (t,).
    """
    free = np.ones(len(tangents), dtype=np.bool_)
    if not len(discs):
        return free
    north, east = np.ascontiguousarray(centres[:, 0]), np.ascontiguousarray(centres[:, 1])
    rows = max(1, CHUNK // len(discs))
    limit = radii * radii
    for first in range(0, len(tangents), rows):
        part = slice(first, first + rows)
        unit_north, unit_east = tangents.course[part, :1], tangents.course[part, 1:]
        away_north = north - tangents.point[part, :1]
        away_east = east - tangents.point[part, 1:]
        along = away_north * unit_north
        along += away_east * unit_east
        across = away_east * unit_north
        across -= away_north * unit_east
        across *= across
        beyond = np.maximum(-along, along - tangents.length[part, None])
        np.maximum(beyond, 0.0, out=beyond)
        beyond *= beyond
        across += beyond
        entered = across < limit
        entered &= (tangents.i[part, None] != discs) & (tangents.j[part, None] != discs)
        free[part] = ~entered.any(axis=1)
    return free
