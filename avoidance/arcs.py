"""Which parts of a circle other discs cover: the arrangement under the exact planner.

Angles are measured from north towards east, in [0, 2π]. Between two covered arcs lies a gap, a free piece
of the circle; a gap bears the number of the covered arc before it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from avoidance.types import Bools, Floats, Ints

TAU = math.tau
STRIDE = 8.0
"""Distance between two circles on the common axis of sorted angles; more than a full turn."""
ON_CIRCLE = 1e-6
"""A point this much of a radius inside a disc counts as on its circle (vehicles fly along arcs)."""

Pairs: TypeAlias = tuple[Ints, Ints, Floats]
"""Covered disc, disc that covers it, half of the covered angle [rad]."""
Barred: TypeAlias = tuple[Ints, Floats, Floats]
"""Disc, first angle of an arc of its circle in [0, 2π), last angle up to a full turn later [rad]."""


@dataclass(frozen=True, slots=True, eq=False)
class CoveredArcs:
    """Arcs of n circles that lie inside other discs, merged, sorted by circle and angle."""

    count: int
    """Number of circles n."""
    disc: Ints
    """Circle of each arc, shape (k,)."""
    begin: Floats
    """First angle [rad], shape (k,)."""
    end: Floats
    """Last angle [rad], shape (k,); an arc over north is split there."""
    opener: Ints
    """Disc that covers the first angle, shape (k,)."""
    closer: Ints
    """Disc that covers the last angle, shape (k,)."""

    @property
    def following(self) -> Ints:
        """Index of the next covered arc on the same circle, going round, shape (k,)."""
        first = np.searchsorted(self.disc, self.disc, side="left")
        last = np.searchsorted(self.disc, self.disc, side="right") - 1
        index = np.arange(len(self.disc), dtype=np.int64)
        return np.asarray(np.where(index == last, first, index + 1), dtype=np.int64)

    def gap(self, disc: Ints, angle: Floats) -> Ints:
        """Gap in which each free point lies.

        Parameters
        ----------
        disc : Ints
            Circle of each point, shape (m,).
        angle : Floats
            Its angle in [0, 2π] [rad], shape (m,).

        Returns
        -------
        Ints
            Number of the gap, that of the covered arc before it (going round); k + disc on a circle
            without covered arcs. Shape (m,).
        """
        if not len(self.disc):
            return disc
        before = np.searchsorted(self.disc * STRIDE + self.begin, disc * STRIDE + angle, side="right") - 1
        on_disc = (before >= 0) & (self.disc[before] == disc)
        if on_disc.all():
            return np.asarray(before, dtype=np.int64)
        last = np.searchsorted(self.disc, disc, side="right") - 1
        around = np.where(self.disc[last] == disc, last, len(self.disc) + disc)
        return np.asarray(np.where(on_disc, before, around), dtype=np.int64)

    def covers(self, disc: Ints, angle: Floats) -> Bools:
        """Whether each point (as for `gap`) lies strictly inside a covered arc, shape (m,)."""
        if not len(self.disc):
            return np.zeros(len(disc), dtype=np.bool_)
        before = np.searchsorted(self.disc * STRIDE + self.begin, disc * STRIDE + angle, side="right") - 1
        return np.asarray((before >= 0) & (self.disc[before] == disc) & (self.end[before] > angle))


def uncovered(count: int) -> CoveredArcs:
    """No arcs on some circles: what discs apart from one another have."""
    none = np.empty(0, dtype=np.int64)
    return CoveredArcs(count, none, np.empty(0), np.empty(0), none, none)


def overlapping_pairs(centres: Floats, radii: Floats, covering: Floats) -> Pairs:
    """Pairs of discs of which one covers a part of the other's circle.

    Parameters
    ----------
    centres : Floats
        Centres (north, east) [m], shape (n, 2).
    radii : Floats
        Radii of the circles [m], shape (n,).
    covering : Floats
        Radii of the same discs when they cover another's circle [m], shape (n,).

    Returns
    -------
    covered, coverer : Ints
        Disc numbers, shape (k,), sorted by `covered`.
    half_width : Floats
        Half of the covered angle [rad], shape (k,); π where the circle is covered altogether.
    """
    count = len(radii)
    rows = max(1, 1_000_000 // max(count, 1))
    found: list[Pairs] = []
    for first in range(0, count, rows):
        part = slice(first, first + rows)
        distance = np.hypot(centres[part, 0, None] - centres[:, 0], centres[part, 1, None] - centres[:, 1])
        own = radii[part, None]
        touched = (distance < own + covering) & (distance + covering > own)
        touched[np.arange(len(distance)), np.arange(first, first + len(distance))] = False
        row, coverer = np.nonzero(touched)
        gap, circle, cover = distance[row, coverer], radii[part][row], covering[coverer]
        with np.errstate(divide="ignore", invalid="ignore"):
            cosine = ((circle - cover) * (circle + cover) / gap + gap) / (2.0 * circle)
        cosine[gap + circle <= cover] = -1.0
        found.append((row + first, coverer, np.arccos(np.clip(cosine, -1.0, 1.0))))
    if len(found) == 1:
        return found[0]
    if not found:
        return np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0)
    covered, coverers, widths = zip(*found, strict=True)
    return np.concatenate(covered), np.concatenate(coverers), np.concatenate(widths)


def covered_arcs(
    centres: Floats,
    radii: Floats,
    covering: Floats,
    pairs: Pairs | None = None,
    barred: Barred | None = None,
) -> CoveredArcs:
    """Find the arcs of each circle that lie inside other discs.

    Parameters
    ----------
    centres : Floats
        Centres (north, east) [m], shape (n, 2).
    radii : Floats
        Radii of the circles [m], shape (n,).
    covering : Floats
        Radii of the same discs when they cover another's circle [m], shape (n,): a little smaller than
        `radii`, points on two circles at once stay free.
    pairs : Pairs, optional
        The result of `overlapping_pairs` where it is known already.
    barred : Barred, optional
        Further arcs that are covered, by no disc.

    Returns
    -------
    CoveredArcs
        The arcs, merged where they overlap.
    """
    disc, by, half = pairs or overlapping_pairs(centres, radii, covering)
    if not len(disc) and (barred is None or not len(barred[0])):
        return uncovered(len(radii))
    away = centres[by] - centres[disc]
    begin = np.mod(np.arctan2(away[:, 1], away[:, 0]) - half, TAU)
    end = begin + 2.0 * half
    whole = half >= math.pi
    begin[whole], end[whole] = 0.0, TAU
    if barred is not None:
        disc, by = np.concatenate([disc, barred[0]]), np.concatenate([by, np.full(len(barred[0]), -1)])
        begin, end = np.concatenate([begin, barred[1]]), np.concatenate([end, barred[2]])
    over = end > TAU
    if over.any():
        disc, by = np.concatenate([disc, disc[over]]), np.concatenate([by, by[over]])
        begin = np.concatenate([begin, np.zeros(int(over.sum()))])
        end = np.concatenate([np.minimum(end, TAU), end[over] - TAU])
    order = np.argsort(disc * STRIDE + begin, kind="stable")
    disc, by, begin, end = disc[order], by[order], begin[order], end[order]
    reach = np.maximum.accumulate(disc * STRIDE + end)
    fresh = np.ones(len(disc), dtype=np.bool_)
    fresh[1:] = disc[1:] * STRIDE + begin[1:] > reach[:-1]
    first = np.flatnonzero(fresh)
    last_end = np.maximum.reduceat(end, first)
    block = np.cumsum(fresh) - 1
    ends_here = np.flatnonzero(end == last_end[block])
    closer = by[ends_here[np.searchsorted(block[ends_here], np.arange(len(first)))]]
    return CoveredArcs(len(radii), disc[first], begin[first], last_end, by[first], closer)


def checked_discs(centres: Floats, radii: Floats) -> tuple[Floats, Floats]:
    """Discs as arrays of shape (n, 2) and (n,).

    Raises
    ------
    ValueError
        If the numbers of centres and radii differ, a number is not finite or a radius negative.
    """
    world = np.asarray(centres, dtype=np.float64).reshape(-1, 2)
    sizes = np.asarray(radii, dtype=np.float64).reshape(-1)
    if len(world) != len(sizes):
        raise ValueError(f"centres and radii must be as many: {len(world)} and {len(sizes)}")
    if not (np.isfinite(world).all() and np.isfinite(sizes).all()):
        raise ValueError("centres and radii must be finite")
    if (sizes < 0.0).any():
        raise ValueError(f"radii must not be negative: {float(sizes.min())}")
    return world, sizes


def admit(
    points: dict[str, tuple[float, float]], centres: Floats, radii: Floats, tolerance: float = ON_CIRCLE
) -> Floats:
    """Radii of the discs so that the given points are on or outside their circles.

    Parameters
    ----------
    points : dict[str, tuple[float, float]]
        Points (north, east) [m] by the name a message gives them.
    centres : Floats
        Centres (north, east) [m], shape (n, 2).
    radii : Floats
        Radii [m], shape (n,).
    tolerance : float
        Largest part of a radius by which a point may lie inside.

    Returns
    -------
    Floats
        Radii, those of discs that hold a point within the tolerance shrunk to it [m], shape (n,).

    Raises
    ------
    ValueError
        If a point is not finite or lies deeper inside a disc; names the point and the disc.
    """
    for name, (north, east) in points.items():
        if not (math.isfinite(north) and math.isfinite(east)):
            raise ValueError(f"{name} must be finite: north {north}, east {east}")
        distance = np.hypot(centres[:, 0] - north, centres[:, 1] - east)
        inside = distance < radii
        if not inside.any():
            continue
        deep = np.flatnonzero(distance < radii * (1.0 - tolerance))
        if len(deep):
            k = int(deep[0])
            raise ValueError(
                f"{name} ({north:.3f}, {east:.3f}) lies inside disc {k}: "
                f"{float(distance[k]):.3f} m from its centre, radius {float(radii[k]):.3f} m"
            )
        radii = np.minimum(radii, distance)
    return radii
