"""What lies outside all discs: is there a way, is it a pocket, where is the nearest free point.

Discs that overlap form clusters. A cluster parts the plane by the closed loops of arcs on its rim, one round
the outside and one round each pocket; two points are connected if every cluster shows both the same loop.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from avoidance.arcs import TAU, CoveredArcs, admit, checked_discs, covered_arcs, overlapping_pairs
from avoidance.geometry import Point
from avoidance.types import Floats, Ints

GRAIN = 1e-8
"""Radii are shrunk by one to two of this part, each by its own share: no three circles then share a point,
no two coincide, and discs that only touch leave a way."""
GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
OUTSIDE = 1e-9
"""Part of a radius by which free points are put outside a circle, so that rounding leaves them outside."""


@dataclass(frozen=True, slots=True, eq=False)
class FreeSpace:
    """The free components of the plane among discs; build it with `FreeSpace.of`."""

    centres: Floats
    """Centres of the discs (north, east) [m], shape (n, 2)."""
    radii: Floats
    """Radii, shrunk by at most 2e-8 of themselves [m], shape (n,)."""
    arcs: CoveredArcs
    """Covered arcs of their circles."""
    loops: Ints
    """Loop to which each gap between covered arcs belongs, shape (k,)."""
    clusters: tuple[tuple[Ints, int], ...]
    """Discs and outer loop of each cluster that has pockets."""

    @classmethod
    def of(cls, centres: Floats, radii: Floats) -> FreeSpace:
        """Find the clusters and loops of n discs; time and memory grow with n².

        Parameters
        ----------
        centres : Floats
            Centres (north, east) [m], shape (n, 2).
        radii : Floats
            Radii [m], shape (n,); discs may overlap, contain or equal one another.

        Returns
        -------
        FreeSpace
            The components.

        Raises
        ------
        ValueError
            If the shapes differ, a number is not finite or a radius negative.
        """
        world, sizes = checked_discs(centres, radii)
        share = np.mod(np.arange(len(sizes)) * GOLDEN, 1.0)
        sizes = sizes * (1.0 - GRAIN * (1.0 + share))
        pairs = overlapping_pairs(world, sizes, sizes)
        arcs = covered_arcs(world, sizes, sizes, pairs)
        loops = _loops(arcs)
        cluster = _merged(len(sizes), pairs[0], pairs[1])
        pocketed: list[tuple[Ints, int]] = []
        for label in np.unique(cluster[arcs.disc]).tolist():
            if len(np.unique(loops[(cluster[arcs.disc] == label) & (loops >= 0)])) > 1:
                members = np.flatnonzero(cluster == label)
                top = members[np.argmax(world[members, 0] + sizes[members])]
                outer = int(loops[arcs.gap(np.array([top]), np.zeros(1))[0]])
                pocketed.append((members, outer))
        return cls(world, sizes, arcs, loops, tuple(pocketed))

    def component(self, point: Point) -> tuple[int, ...]:
        """Name of the free component that holds a free point.

        Parameters
        ----------
        point : Point
            A point outside all discs or on their circles (north, east) [m].

        Returns
        -------
        tuple[int, ...]
            The loop that each cluster with pockets shows the point; equal for points of one component.
        """
        return tuple(self._facing(point, members) for members, _ in self.clusters)

    def unbounded(self, point: Point) -> bool:
        """Whether a free point (as for `component`) lies in the component that has no bounds."""
        return all(self._facing(point, members) == outer for members, outer in self.clusters)

    def _facing(self, point: Point, members: Ints) -> int:
        """Loop of a cluster that faces a point: the one with the point of the cluster nearest to it."""
        north = float(point[0]) - self.centres[members, 0]
        east = float(point[1]) - self.centres[members, 1]
        nearest = int(np.argmin(np.hypot(north, east) - self.radii[members]))
        angle = math.atan2(float(east[nearest]), float(north[nearest])) % TAU
        gap = int(self.arcs.gap(members[nearest : nearest + 1], np.array([angle]))[0])
        return int(self.loops[gap])


def _loops(arcs: CoveredArcs) -> Ints:
    """Loop of each gap between covered arcs, named by its least gap; -1 for no gap, shape (k,)."""
    following = arcs.following
    real = (arcs.end < TAU) | (arcs.begin[following] > 0.0)
    gaps = np.flatnonzero(real)
    # A gap on disc i begins where disc j lets go of it; at that point a gap on disc j ends at disc i.
    begins = arcs.closer[gaps] * arcs.count + arcs.disc[gaps]
    ends = arcs.disc[gaps] * arcs.count + arcs.opener[following[gaps]]
    _, one, other = np.intersect1d(begins, ends, assume_unique=True, return_indices=True)
    loops = _merged(len(real), gaps[one], gaps[other])
    loops[~real] = -1
    return loops


def _merged(count: int, one: Ints, other: Ints) -> Ints:
    """Connected components of n things linked in pairs, each named by its least member, shape (n,)."""
    labels = np.arange(count, dtype=np.int64)
    while True:
        least = np.minimum(labels[one], labels[other])
        linked = labels.copy()
        for side in (one, other):
            np.minimum.at(linked, labels[side], least)
            np.minimum.at(linked, side, least)
        linked = linked[linked]
        if np.array_equal(linked, labels):
            return labels
        labels = linked


def connected(a: Point, b: Point, centres: Floats, radii: Floats) -> bool:
    """Whether a point can move from one place to another without entering a disc.

    Parameters
    ----------
    a, b : Point
        Free points (north, east) [m]; they may lie on a circle.
    centres : Floats
        Centres of the discs (north, east) [m], shape (n, 2).
    radii : Floats
        Radii [m], shape (n,); discs may overlap, contain or equal one another.

    Returns
    -------
    bool
        True if both lie in the same free component. Discs that touch leave a way between them.

    Raises
    ------
    ValueError
        If a point lies inside a disc by more than 1e-6 of its radius, or a number makes no sense.
    """
    world, sizes = checked_discs(centres, radii)
    space = FreeSpace.of(world, admit({"a": _pair(a), "b": _pair(b)}, world, sizes))
    return space.component(a) == space.component(b)


def enclosed(point: Point, centres: Floats, radii: Floats) -> bool:
    """Whether the discs shut a point in: its free component is bounded.

    Parameters
    ----------
    point : Point
        A free point (north, east) [m]; it may lie on a circle.
    centres, radii : Floats
        The discs, as for `connected`.

    Returns
    -------
    bool
        True if no way leads away from all discs.

    Raises
    ------
    ValueError
        As `connected`.
    """
    world, sizes = checked_discs(centres, radii)
    return not FreeSpace.of(world, admit({"point": _pair(point)}, world, sizes)).unbounded(point)


def free_candidates(target: Point, centres: Floats, radii: Floats) -> Floats:
    """List the places that can be the free point nearest to a target.

    Parameters
    ----------
    target : Point
        The point wanted (north, east) [m].
    centres : Floats
        Centres of the discs (north, east) [m], shape (n, 2).
    radii : Floats
        Radii [m], shape (n,).

    Returns
    -------
    Floats
        Points outside all discs (north, east) [m], nearest first, shape (m, 2): the target itself, the
        nearest point of each circle, and the corners where two circles meet. In each free component the
        point nearest to the target is among them. None is inside a disc, not even by rounding.
    """
    world, sizes = checked_discs(centres, radii)
    goal = np.array(_pair(target))
    wide = sizes * (1.0 + OUTSIDE)
    away = goal - world
    distance = np.hypot(away[:, 0], away[:, 1])
    apart = distance > OUTSIDE * wide
    feet = world[apart] + away[apart] * (wide[apart] / distance[apart])[:, None]
    compass = np.array([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)])
    round_target = world[~apart][:, None] + wide[~apart][:, None, None] * compass
    arcs = covered_arcs(world, wide, wide)
    disc, angle = np.tile(arcs.disc, 2), np.concatenate([arcs.begin, arcs.end])
    corners = world[disc] + wide[disc, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    points = np.concatenate([goal[None], feet, round_target.reshape(-1, 2), corners])
    to_centres = np.hypot(points[:, 0, None] - world[:, 0], points[:, 1, None] - world[:, 1])
    points = points[(to_centres >= sizes).all(axis=1)]
    order = np.argsort(np.hypot(points[:, 0] - goal[0], points[:, 1] - goal[1]), kind="stable")
    return np.asarray(points[order])


def nearest_free(
    target: Point, reach_from: Point, centres: Floats, radii_safe: Floats, radii_pass: Floats
) -> tuple[float, float] | None:
    """Find the safe point nearest to a target that can be reached.

    Parameters
    ----------
    target : Point
        The point wanted (north, east) [m], free or not.
    reach_from : Point
        Where the way to it begins (north, east) [m]. A disc that holds it is shrunk to it for the way.
    centres : Floats
        Centres of the discs (north, east) [m], shape (n, 2).
    radii_safe : Floats
        What the point itself must keep from each centre [m], shape (n,).
    radii_pass : Floats
        What the way there must keep [m], shape (n,), nowhere more than `radii_safe`.

    Returns
    -------
    tuple[float, float] or None
        The point (north, east) [m], the target itself if that will do; None if there is no such point.

    Raises
    ------
    ValueError
        If a radius to pass exceeds the safe one, or a number makes no sense.

    Notes
    -----
    Algorithm 4, for a waypoint that lies where nothing may fly. Differs from the paper: the point is the
    nearest of all and can be reached, with room to turn if `radii_safe` contains it.
    """
    world, passing = checked_discs(centres, radii_pass)
    if (passing > np.asarray(radii_safe, dtype=np.float64)).any():
        raise ValueError("radii_pass must not exceed radii_safe")
    space = FreeSpace.of(world, admit({"reach_from": _pair(reach_from)}, world, passing, tolerance=1.0))
    here = space.component(reach_from)
    for north, east in free_candidates(target, world, radii_safe).tolist():
        if not here or space.component((north, east)) == here:
            return north, east
    return None


def _pair(point: Point) -> tuple[float, float]:
    """Coordinates of a point as plain numbers."""
    return float(point[0]), float(point[1])
