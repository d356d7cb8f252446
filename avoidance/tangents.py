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

    i: Ints
    """Disc left, shape (t,)."""
    j: Ints
    """Disc reached, shape (t,)."""
    sense_i: Ints
    """Sense of rotation on disc i, +1 clockwise, shape (t,)."""
    sense_j: Ints
    """Sense of rotation on disc j, shape (t,)."""
    point: Floats
    """Where it leaves disc i (north, east) [m], shape (t, 2)."""
    course: Floats
    """Unit vector of travel, shape (t, 2)."""
    length: Floats
    """Length [m], shape (t,)."""
    angle_i: Floats
    """Angle of the point on disc i, [0, 2π] from north [rad], shape (t,)."""
    angle_j: Floats
    """Angle of the point on disc j [rad], shape (t,)."""

    def __len__(self) -> int:
        """Return the number of tangents."""
        return len(self.i)

    def take(self, which: Bools | Ints) -> Tangents:
        """Return the tangents chosen by a mask or by indices."""
        return Tangents(
            i=self.i[which],
            j=self.j[which],
            sense_i=self.sense_i[which],
            sense_j=self.sense_j[which],
            point=self.point[which],
            course=self.course[which],
            length=self.length[which],
            angle_i=self.angle_i[which],
            angle_j=self.angle_j[which],
        )

    def reversed(self) -> Tangents:
        """Return the same tangents flown the other way."""
        return Tangents(
            i=self.j,
            j=self.i,
            sense_i=-self.sense_j,
            sense_j=-self.sense_i,
            point=self.end,
            course=-self.course,
            length=self.length,
            angle_i=self.angle_j,
            angle_j=self.angle_i,
        )

    @property
    def end(self) -> Floats:
        """Where each reaches disc j (north, east) [m], shape (t, 2)."""
        return np.asarray(self.point + self.length[:, None] * self.course)

    def joined(self, other: Tangents) -> Tangents:
        """Return these tangents followed by others."""
        return Tangents(
            i=np.concatenate([self.i, other.i]),
            j=np.concatenate([self.j, other.j]),
            sense_i=np.concatenate([self.sense_i, other.sense_i]),
            sense_j=np.concatenate([self.sense_j, other.sense_j]),
            point=np.concatenate([self.point, other.point]),
            course=np.concatenate([self.course, other.course]),
            length=np.concatenate([self.length, other.length]),
            angle_i=np.concatenate([self.angle_i, other.angle_i]),
            angle_j=np.concatenate([self.angle_j, other.angle_j]),
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
    i, j = np.repeat(i, 4), np.repeat(j, 4)
    senses = np.tile(SENSES, (len(i) // 4, 1))
    sense_i, sense_j = senses[:, 0], senses[:, 1]
    k = sense_j * radii[j] - sense_i * radii[i]
    between = centres[j] - centres[i]
    distance = np.hypot(between[:, 0], between[:, 1])
    real = (distance > 0.0) & (distance >= np.abs(k) * (1.0 - TOUCHING))
    real &= ((radii[i] > 0.0) | (sense_i > 0)) & ((radii[j] > 0.0) | (sense_j > 0))
    i, j, sense_i, sense_j = i[real], j[real], sense_i[real], sense_j[real]
    k, between, distance = k[real], between[real], distance[real]
    length = np.sqrt(np.maximum((distance - k) * (distance + k), 0.0))
    scale = distance * np.hypot(length, k)
    north = (length * between[:, 0] + k * between[:, 1]) / scale
    east = (length * between[:, 1] - k * between[:, 0]) / scale
    offset = sense_i * radii[i]
    point = np.column_stack([centres[i, 0] + offset * east, centres[i, 1] - offset * north])
    angle_i = np.mod(np.arctan2(-sense_i * north, sense_i * east), math.tau)
    angle_j = np.mod(np.arctan2(-sense_j * north, sense_j * east), math.tau)
    course = np.column_stack([north, east])
    return Tangents(i, j, sense_i, sense_j, point, course, length, angle_i, angle_j)


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
