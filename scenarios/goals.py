"""Which waypoints could be reached, judged with full knowledge by code that shares nothing with the planner.

A waypoint nearer to an obstacle than its radius + margin + room to turn cannot be flown to and turned away
from safely: it is replaced by the nearest point that can, or by none. Spheres are cut where they are widest
within the published altitude tolerance of the waypoint.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from avoidance.types import Floats
from scenarios.scenario import Obstacle, Point

SLACK = 1e-6
"""Rounding allowed when a point on a circle is tested against that circle [m]."""


@dataclass(frozen=True, slots=True)
class ReplacementRule:
    """When a waypoint counts as unreachable, and how far out its replacement lies."""

    margin: float
    """Nothing is flown nearer to a sphere than this [m]."""
    needed: float
    """A waypoint with less room than this beyond the margin is replaced [m]."""
    rooms: tuple[float, ...]
    """Room of the replacement beyond the margin; the first that allows a point [m]."""
    altitude_tolerance: float = 0.0
    """The vehicle may be this much above or below a waypoint [m]."""


@dataclass(frozen=True, slots=True)
class Goal:
    """What stands for one waypoint of the mission."""

    waypoint: int
    """Index in the mission."""
    north: float
    """Where the mission wants it [m]."""
    east: float
    """Where the mission wants it [m]."""
    point: tuple[float, float] | None
    """Where it can be reached, north and east [m]; None if nowhere."""
    shift: float
    """Distance between the two [m]; 0 for a waypoint that can be reached, and where there is no point."""

    @property
    def replaced(self) -> bool:
        """True if the waypoint itself cannot be reached."""
        return self.point != (self.north, self.east)


def goals(mission: Sequence[Point], obstacles: Sequence[Obstacle], rule: ReplacementRule) -> list[Goal]:
    """The reachable goal of every waypoint, with all obstacles known.

    Parameters
    ----------
    mission : sequence of Point
        The first is where the flight begins and stays what it is.
    obstacles : sequence of Obstacle
        Everything that stands still, whenever it appears.
    rule : ReplacementRule
        When a waypoint is replaced, and by what.
    """
    start = mission[0]
    origin = (start.north, start.east)
    found = [Goal(0, start.north, start.east, origin, 0.0)]
    for index, waypoint in enumerate(mission[1:], start=1):
        here = (waypoint.north, waypoint.east)
        centres, radii = discs(obstacles, waypoint.altitude, rule.altitude_tolerance)
        walls = radii + rule.margin
        point: tuple[float, float] | None = None
        if (np.hypot(*(centres - here).T) >= walls + rule.needed - SLACK).all():
            point = None if separated(origin, here, centres, walls) else here
        for room in rule.rooms:
            point = point or nearest_reachable(here, origin, centres, walls, walls + room)
        shift = 0.0 if point is None else float(np.hypot(point[0] - here[0], point[1] - here[1]))
        found.append(Goal(index, waypoint.north, waypoint.east, point, shift))
    return found


def discs(obstacles: Sequence[Obstacle], altitude: float, tolerance: float = 0.0) -> tuple[Floats, Floats]:
    """Spheres cut where they are widest within `tolerance` of an altitude [m].

    Returns
    -------
    centres, radii : array, shape (n, 2) and (n,)
        Of the spheres that reach there [m].
    """
    heights = [(o, max(abs(o.altitude - altitude) - tolerance, 0.0)) for o in obstacles]
    kept = [(o, height) for o, height in heights if height < o.safety_radius]
    centres = np.array([(o.north, o.east) for o, _ in kept], dtype=np.float64).reshape(-1, 2)
    radii = [math.sqrt(o.safety_radius**2 - height**2) for o, height in kept]
    return centres, np.array(radii, dtype=np.float64)


def nearest_reachable(
    target: tuple[float, float], start: tuple[float, float], centres: Floats, walls: Floats, safe: Floats
) -> tuple[float, float] | None:
    """The point nearest to `target` that lies outside every disc of radius `safe` and can be reached.

    Parameters
    ----------
    target, start : tuple
        North and east [m].
    centres : array, shape (n, 2)
        Of the discs [m].
    walls : array, shape (n,)
        Radii that no way may enter [m].
    safe : array, shape (n,)
        Radii that the point itself must keep out of [m], no smaller.

    Returns
    -------
    tuple or None
        North and east [m]: the target itself if it will do; None if no point can be reached.

    Notes
    -----
    The nearest point of what discs leave free is the target, its foot on one circle, or a crossing of two.
    Where the target is a centre every point of the circle is as near; its foot is then towards the start.
    """
    for north, east in _candidates(np.asarray(target, dtype=np.float64), np.asarray(start), centres, safe):
        if not separated(start, (north, east), centres, walls):
            return north, east
    return None


def separated(a: tuple[float, float], b: tuple[float, float], centres: Floats, radii: Floats) -> bool:
    """True if every way between two free points crosses a disc.

    Notes
    -----
    The line between the centres of two discs that overlap lies inside them. So a closed walk from centre to
    centre that winds round one of the points and not round the other is a wall between them, and if there is
    a wall there is such a walk. Winding differs on some closed walk exactly if the angles that the edges
    subtend at a, less those at b, are not the differences of one potential over the centres.
    """
    from scipy.sparse import csr_matrix  # noqa: PLC0415
    from scipy.sparse.csgraph import breadth_first_order, connected_components  # noqa: PLC0415

    if len(radii) < 3:
        return False
    first, second = np.nonzero(np.triu(_distances(centres, centres) < radii[:, None] + radii[None, :], k=1))
    turns = _subtended(a, centres, first, second) - _subtended(b, centres, first, second)
    shape = (len(radii), len(radii))
    graph = csr_matrix((np.ones(len(first)), (first, second)), shape=shape)
    edge = {(int(i), int(j)): float(t) for i, j, t in zip(first, second, turns, strict=True)}
    potential = np.zeros(len(radii))
    count, labels = connected_components(graph, directed=False)
    for label in range(count):
        root = int(np.flatnonzero(labels == label)[0])
        order, parents = breadth_first_order(graph, root, directed=False)
        for node in order[1:].tolist():
            parent = int(parents[node])
            turn = edge[parent, node] if (parent, node) in edge else -edge[node, parent]
            potential[node] = potential[parent] + turn
    mismatch = potential[first] + turns - potential[second]
    return bool((np.abs(mismatch) > np.pi).any())


def _candidates(
    target: Floats, start: Floats, centres: Floats, radii: Floats
) -> Iterator[tuple[float, float]]:
    """Free points, nearest to the target first: itself, feet on circles, crossings of circles."""
    points = np.concatenate(
        (target[None, :], _feet(target, start, centres, radii), _crossings(centres, radii))
    )
    free = (_distances(points, centres) >= radii[None, :] - SLACK).all(axis=1)
    points = points[free]
    away = np.hypot(points[:, 0] - target[0], points[:, 1] - target[1])
    yield from ((north, east) for north, east in points[np.argsort(away, kind="stable")].tolist())


def _feet(target: Floats, start: Floats, centres: Floats, radii: Floats) -> Floats:
    out = target - centres
    out[(out == 0.0).all(axis=1)] = start - target if (start != target).any() else (1.0, 0.0)
    return centres + out * (radii / np.hypot(out[:, 0], out[:, 1]))[:, None]


def _crossings(centres: Floats, radii: Floats) -> Floats:
    between = _distances(centres, centres)
    meets = (between <= radii[:, None] + radii[None, :]) & (
        between >= np.abs(radii[:, None] - radii[None, :])
    )
    i, j = np.nonzero(np.triu(meets & (between > 0.0), k=1))
    d = between[i, j]
    along = (d**2 + radii[i] ** 2 - radii[j] ** 2) / (2.0 * d)
    across = np.sqrt(np.maximum(radii[i] ** 2 - along**2, 0.0))
    unit = (centres[j] - centres[i]) / d[:, None]
    middle = centres[i] + along[:, None] * unit
    normal = np.column_stack((-unit[:, 1], unit[:, 0])) * across[:, None]
    return np.concatenate((middle + normal, middle - normal))


def _subtended(
    point: tuple[float, float], centres: Floats, first: NDArray[np.intp], second: NDArray[np.intp]
) -> Floats:
    """Signed angle at `point` from centre `first` to centre `second` [rad], shape (edges,)."""
    out = centres - np.asarray(point)
    u, v = out[first], out[second]
    cross = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    angles: Floats = np.arctan2(cross, np.einsum("ij,ij->i", u, v))
    return angles


def _distances(a: Floats, b: Floats) -> Floats:
    """Distance of every point of a from every point of b [m], shape (len(a), len(b))."""
    away = a[:, None, :] - b[None, :, :]
    distances: Floats = np.hypot(away[..., 0], away[..., 1])
    return distances
