"""What no way may enter, as discs and straight walls with room beside them, and which places they part."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from avoidance.types import Bools, Floats
from scenarios.fence import FenceArea

Ints = NDArray[np.intp]
Place = tuple[float, float]

SAGITTA = 0.5
"""A circle to stay in is walled by chords that leave it by no more than this [m] ..."""
MOST_CHORDS = 720
"""... or by so many: beyond a radius of 52 km they leave it by up to 10⁻⁵ of that."""
BESIDE = 1e-3
"""Which side of an edge may be flown over is looked up this far beside it [m]."""


@dataclass(frozen=True, eq=False)
class Shapes:
    """All that is nearer to a piece of straight line than a radius; a disc's line is a point.

    Without slots: what overlaps is found once and kept.
    """

    starts: Floats
    """Begin of each line, north and east, shape (n, 2) [m]."""
    ends: Floats
    """End of each line, shape (n, 2) [m]."""
    radii: Floats
    """Shape (n,) [m]."""

    @classmethod
    def discs(cls, centres: Floats, radii: Floats) -> Shapes:
        """Discs about centres of shape (n, 2) [m]."""
        return cls(centres, centres, radii)

    def __len__(self) -> int:
        """How many there are."""
        return len(self.radii)

    def joined(self, other: Shapes) -> Shapes:
        """These and others."""
        pairs = ((self.starts, other.starts), (self.ends, other.ends), (self.radii, other.radii))
        return Shapes(*(np.concatenate(pair) for pair in pairs))

    def sized(self, radii: Floats) -> Shapes:
        """The same lines with other radii, shape (n,) [m]."""
        return Shapes(self.starts, self.ends, radii)

    def distances(self, points: Floats) -> Floats:
        """Distance of points, shape (m, 2), from the lines, shape (m, n) [m]."""
        return _off(points[:, None] - _nearest(self.starts, self.ends, points[:, None]))

    @cached_property
    def links(self) -> Links:
        """Every pair that overlaps, and a way from one to the other inside the two."""
        middles, halves = 0.5 * (self.starts + self.ends), 0.5 * _off(self.ends - self.starts)
        reach = halves + self.radii
        near = _off(middles[:, None] - middles[None]) < reach[:, None] + reach[None]
        first, second = np.nonzero(np.triu(near, k=1))
        here, there = _closest(self.starts[first], self.ends[first], self.starts[second], self.ends[second])
        touching = _off(here - there) < self.radii[first] + self.radii[second]
        first, second, here, there = first[touching], second[touching], here[touching], there[touching]
        ways = np.stack((self.starts[first], here, there, self.starts[second]), axis=1)
        return Links(first, second, ways)


@dataclass(frozen=True, slots=True, eq=False)
class Links:
    """Pairs of shapes that overlap."""

    first: Ints
    """Shape (k,)."""
    second: Ints
    """Shape (k,)."""
    ways: Floats
    """From the begin of the first line along it, across, and along the second to its begin, (k, 4, 2) [m]."""

    def turns(self, point: Place) -> Floats:
        """Angle through which one who stands at `point` sees somebody walk each way [rad], shape (k,)."""
        out = self.ways - np.asarray(point)
        u, v = out[:, :-1], out[:, 1:]
        cross = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
        angles: Floats = np.arctan2(cross, (u * v).sum(axis=-1)).sum(axis=1)
        return angles


def separated(a: Place, b: Place, shapes: Shapes) -> bool:
    """True if every way between two points outside of all shapes crosses one.

    Notes
    -----
    Shapes are convex, so two that overlap hold a way from one to the other, and all such ways are alike. A
    closed walk over shapes that overlap, which winds round one of the points and not round the other, is a
    wall between them, and if there is a wall there is such a walk. Winding differs on some closed walk
    exactly if the angles that its steps subtend at a, less those at b, are not the differences of one
    potential.
    """
    from scipy.sparse import csr_matrix  # noqa: PLC0415
    from scipy.sparse.csgraph import breadth_first_order, connected_components  # noqa: PLC0415

    count = len(shapes)
    links = shapes.links
    if count < 3 or len(links.first) < 3:
        return False
    turns = links.turns(a) - links.turns(b)
    graph = csr_matrix((np.ones(len(turns)), (links.first, links.second)), shape=(count, count))
    pairs = zip(links.first.tolist(), links.second.tolist(), turns.tolist(), strict=True)
    edge = {(i, j): turn for i, j, turn in pairs}
    potential = np.zeros(count)
    groups, labels = connected_components(graph, directed=False)
    for label in range(groups):
        root = int(np.flatnonzero(labels == label)[0])
        order, parents = breadth_first_order(graph, root, directed=False)
        for node in order[1:].tolist():
            parent = int(parents[node])
            turn = edge[parent, node] if (parent, node) in edge else -edge[node, parent]
            potential[node] = potential[parent] + turn
    mismatch = potential[links.first] + turns - potential[links.second]
    return bool((np.abs(mismatch) > np.pi).any())


def fence_shapes(areas: Sequence[FenceArea], room: float) -> Shapes:
    """A geofence as shapes: its edges with `room` beside them [m], and circles to stay out of.

    Notes
    -----
    Where areas to stay in overlap, an edge of one that runs inside another parts nothing and is left out.
    """
    allowing = [FenceArea(True, tuple(map(tuple, _outline(area).tolist()))) for area in areas if area.include]
    lines = [line for area in allowing for line in _parting(area, allowing)]
    for area in areas:
        if not area.include and area.corners:
            lines += _pieces(np.array(area.corners))
    table = np.array(lines, dtype=np.float64).reshape(-1, 2, 2)
    out = [(*a.centre, a.radius) for a in areas if not a.include and a.centre is not None and a.radius]
    circles = np.array(out, dtype=np.float64).reshape(-1, 3)
    walls = Shapes(table[:, 0], table[:, 1], np.full(len(table), room))
    return walls.joined(Shapes.discs(circles[:, :2], circles[:, 2] + room))


def _pieces(corners: Floats) -> list[Floats]:
    """The sides of a polygon, ends of shape (2, 2) each."""
    sides = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    return [np.stack(side) for side in sides if (side[0] != side[1]).any()]


def _parting(area: FenceArea, allowing: Sequence[FenceArea]) -> list[Floats]:
    """Pieces of a polygon's sides that part what all areas to stay in hold from what none does."""
    others = [other for other in allowing if other is not area]
    pieces = _pieces(np.array(area.corners))
    if not (others and pieces):
        return pieces
    cut = np.array([part for piece in pieces for part in _cut_up(piece, others)])
    step = cut[:, 1] - cut[:, 0]
    length = _off(step)
    cut, step, length = cut[length > BESIDE], step[length > BESIDE], length[length > BESIDE]
    beside = BESIDE / length[:, None] * np.column_stack((-step[:, 1], step[:, 0]))
    middle = cut.mean(axis=1)
    one, other = (
        np.any([each.holds(side) for each in allowing], axis=0) for side in (middle + beside, middle - beside)
    )
    return list(cut[~(one & other)])


def _cut_up(piece: Floats, others: Sequence[FenceArea]) -> list[Floats]:
    """A side of a polygon, cut where edges of other areas cross it."""
    begin, step = piece[0], piece[1] - piece[0]
    shares = sorted({0.0, 1.0, *(share for other in others for share in other.crossings(begin, step))})
    return [np.stack((begin + low * step, begin + high * step)) for low, high in pairwise(shares)]


def _outline(area: FenceArea) -> Floats:
    """Corners of a polygon, or of one inscribed in a circle, shape (k, 2) [m]."""
    if area.centre is None or area.radius is None:
        return np.array(area.corners, dtype=np.float64)
    share = max(1.0 - SAGITTA / area.radius, 0.5)
    count = min(max(8, math.ceil(math.pi / math.acos(share))), MOST_CHORDS)
    angles = math.tau / count * np.arange(count)
    ring: Floats = area.centre + area.radius * np.column_stack((np.cos(angles), np.sin(angles)))
    return ring


def _nearest(starts: Floats, ends: Floats, points: Floats) -> Floats:
    """The point of each line nearest to a point; shapes as numpy broadcasts them, (..., 2)."""
    along = ends - starts
    square = (along**2).sum(axis=-1)
    share = ((points - starts) * along).sum(axis=-1) / np.where(square == 0.0, 1.0, square)
    nearest: Floats = starts + np.clip(share, 0.0, 1.0)[..., None] * along
    return nearest


def _closest(a: Floats, b: Floats, c: Floats, d: Floats) -> tuple[Floats, Floats]:
    """Points of lines a-b and of lines c-d nearest to each other, shape (k, 2) each."""
    here = np.stack((a, b, _nearest(a, b, c), _nearest(a, b, d)))
    there = np.stack((_nearest(c, d, a), _nearest(c, d, b), c, d))
    best = np.argmin(_off(here - there), axis=0)
    row = np.arange(len(a))
    here, there = here[best, row], there[best, row]
    one = b - a
    share, cut = crossing_shares(a, one, c, d - c)
    crossing = a + share[:, None] * one
    return np.where(cut[:, None], crossing, here), np.where(cut[:, None], crossing, there)


def crossing_shares(
    begins: Floats, steps: Floats, others: Floats, other_steps: Floats
) -> tuple[Floats, Bools]:
    """Where pieces of straight line cross, pair by pair.

    Parameters
    ----------
    begins, steps : array, shape (k, 2)
        Of the first of each pair, and from there to its end [m].
    others, other_steps : array, shape (k, 2)
        Of the second.

    Returns
    -------
    shares : array, shape (k,)
        Of the first one's step; 0 where they do not cross.
    cut : array, shape (k,)
        True where they do.
    """
    between = others - begins
    determinant = steps[:, 0] * other_steps[:, 1] - steps[:, 1] * other_steps[:, 0]
    safe = np.where(determinant == 0.0, 1.0, determinant)
    with np.errstate(over="ignore", invalid="ignore"):  # almost parallel: far beyond the ends
        s = (between[:, 0] * other_steps[:, 1] - between[:, 1] * other_steps[:, 0]) / safe
        t = (between[:, 0] * steps[:, 1] - between[:, 1] * steps[:, 0]) / safe
    cut = (determinant != 0.0) & (s >= 0.0) & (s <= 1.0) & (t >= 0.0) & (t <= 1.0)
    return np.where(cut, s, 0.0), cut


def _off(vectors: Floats) -> Floats:
    """Lengths of vectors of shape (..., 2) [m]."""
    lengths: Floats = np.hypot(vectors[..., 0], vectors[..., 1])
    return lengths
