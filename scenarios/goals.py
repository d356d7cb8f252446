"""Which waypoints could be reached, judged with full knowledge by code that shares nothing with the planner.

A waypoint nearer to an obstacle than its radius + margin + the room published for it cannot be flown to and
left again safely: it is replaced by the nearest point that can, or by none. So is one behind a passage too
narrow to turn round in, and one outside the geofence or behind it. The margins and rooms are those that the
core publishes; what follows from them is found here in another way. Spheres are cut where they are widest
within the published altitude tolerance of the waypoint.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from avoidance.types import Bools, Floats
from scenarios.fence import FenceArea, allowed
from scenarios.rims import Rims
from scenarios.scenario import Obstacle, Point
from scenarios.walled import Shapes, fence_shapes, separated

SLACK = 1e-6
"""Rounding allowed when a point on a rim is tested against that rim [m]."""


@dataclass(frozen=True, slots=True)
class ReplacementRule:
    """When a waypoint counts as unreachable, and how far out its replacement lies."""

    margin: float
    """Nothing is flown nearer to a sphere than this [m]."""
    needed: float
    """A waypoint with less room than this beyond the margin is replaced [m]."""
    rooms: tuple[float, ...]
    """Room of the replacement beyond the margin; the first that allows a point [m]."""
    passage: float = 0.0
    """A way in that leaves less room than this beyond the margin on both sides is narrow [m] ..."""
    stretch: float = 0.0
    """... and counts as shut if it is so for longer than this [m]."""
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


def goals(
    mission: Sequence[Point],
    obstacles: Sequence[Obstacle],
    rule: ReplacementRule,
    fence: Sequence[FenceArea] = (),
) -> list[Goal]:
    """The reachable goal of every waypoint, with all obstacles known.

    Parameters
    ----------
    mission : sequence of Point
        The first is where the flight begins and stays what it is.
    obstacles : sequence of Obstacle
        Everything that stands still, whenever it appears.
    rule : ReplacementRule
        When a waypoint is replaced, and by what.
    fence : sequence of FenceArea, optional
        The geofence: a waypoint outside it, too near to its edge, or behind it is replaced as well.
    """
    start = mission[0]
    origin = (start.north, start.east)
    found = [Goal(0, start.north, start.east, origin, 0.0)]
    edges = fence_shapes(fence, rule.margin)
    for index, waypoint in enumerate(mission[1:], start=1):
        here = (waypoint.north, waypoint.east)
        walls = _walls(obstacles, waypoint.altitude, rule).joined(edges)
        point = _goal(here, origin, walls, rule, fence)
        if point is None:  # the start, too, may lie behind a narrow way
            point = _goal(here, origin, walls, replace(rule, passage=0.0), fence)
        shift = 0.0 if point is None else float(np.hypot(point[0] - here[0], point[1] - here[1]))
        found.append(Goal(index, waypoint.north, waypoint.east, point, shift))
    return found


def barred_by_fence(
    mission: Sequence[Point],
    obstacles: Sequence[Obstacle],
    rule: ReplacementRule,
    fence: Sequence[FenceArea],
) -> list[int]:
    """Waypoints with room to turn, by index, that can be reached only by leaving the geofence."""
    origin = (mission[0].north, mission[0].east)
    edges = fence_shapes(fence, rule.margin)
    barred = []
    for index, waypoint in enumerate(mission[1:], start=1):
        here = (waypoint.north, waypoint.east)
        alone = _walls(obstacles, waypoint.altitude, rule)
        walls = alone.joined(edges)
        if not _all_clear(here, walls.sized(walls.radii + rule.needed), fence):
            continue
        if separated(origin, here, walls) and not separated(origin, here, alone):
            barred.append(index)
    return barred


def _walls(obstacles: Sequence[Obstacle], altitude: float, rule: ReplacementRule) -> Shapes:
    """What no way at an altitude may enter of the spheres."""
    centres, radii = discs(obstacles, altitude, rule.altitude_tolerance)
    return Shapes.discs(centres, radii + rule.margin)


def _goal(
    here: tuple[float, float],
    origin: tuple[float, float],
    walls: Shapes,
    rule: ReplacementRule,
    fence: Sequence[FenceArea],
) -> tuple[float, float] | None:
    """The waypoint itself if it can be reached, else the nearest point that can, or None."""
    roomy = _all_clear(here, walls.sized(walls.radii + rule.needed), fence)
    if roomy and not separated(origin, here, _shut(walls, origin, rule)):
        return here
    for room in rule.rooms:
        point = nearest_reachable(here, origin, walls, room, fence, _shut(walls, origin, rule, room))
        if point is not None:
            return point
    return None


def _shut(
    walls: Shapes, origin: tuple[float, float], rule: ReplacementRule, room: float = math.inf
) -> Shapes:
    """Walls so wide that ways too narrow for too long are shut; never by more than `room`, or to the start.

    Notes
    -----
    Between circles of radii a and b a way is wider by s²/2 (1/a + 1/b) a distance s before and behind the
    narrowest place. That is judged circle by circle: a corridor lined by circles counts as open if a way
    between two of them alone would be, and beside straight walls every narrow way counts as shut.
    """
    widens = np.divide(rule.stretch**2, 8.0 * walls.radii, where=walls.radii > 0.0, out=np.zeros(len(walls)))
    straight = (walls.starts != walls.ends).any(axis=1)
    more = np.maximum(rule.passage - np.where(straight, 0.0, widens), 0.0)
    free = np.maximum(walls.distances(np.array([origin]))[0] - SLACK, walls.radii)
    return walls.sized(np.minimum(walls.radii + np.minimum(more, room), free))


def _all_clear(place: tuple[float, float], shapes: Shapes, fence: Sequence[FenceArea]) -> bool:
    return bool(_free(np.array([place]), shapes, fence)[0])


def _free(points: Floats, shapes: Shapes, fence: Sequence[FenceArea]) -> Bools:
    """Which points, shape (n, 2), lie outside all shapes and where the fence allows, shape (n,)."""
    outside = (shapes.distances(points) >= shapes.radii - SLACK).all(axis=1)
    return np.asarray(outside & allowed(fence, points))


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
    target: tuple[float, float],
    start: tuple[float, float],
    walls: Shapes,
    room: float,
    fence: Sequence[FenceArea] = (),
    shut: Shapes | None = None,
) -> tuple[float, float] | None:
    """The point nearest to `target` that keeps `room` from all walls and can be reached.

    Parameters
    ----------
    target, start : tuple
        North and east [m].
    walls : Shapes
        What no way may enter.
    room : float
        What the point itself keeps from them [m].
    fence : sequence of FenceArea, optional
        Where one may fly; its edges are among the walls.
    shut : Shapes, optional
        The walls, wider where ways between them are too narrow.

    Returns
    -------
    tuple or None
        North and east [m]: the target itself if it will do; None if no point can be reached.

    Notes
    -----
    The nearest point of what shapes leave free is the target, its foot on the rim of one, or where two rims
    cross. Rims are circles and lines beside walls. Where the target is a centre every point of the circle is
    as near; its foot is then towards the start.
    """
    safe = walls.sized(walls.radii + room)
    for north, east in _candidates(np.asarray(target, dtype=np.float64), np.asarray(start), safe, fence):
        if not separated(start, (north, east), walls if shut is None else shut):
            return north, east
    return None


def _candidates(
    target: Floats, start: Floats, shapes: Shapes, fence: Sequence[FenceArea]
) -> Iterator[tuple[float, float]]:
    """Free points, nearest to the target first: itself, feet on rims, crossings of rims."""
    rims = Rims.of(shapes)
    points = np.concatenate((target[None, :], rims.feet(target, start), rims.crossings()))
    points = points[_free(points, shapes, fence)]
    away = np.hypot(points[:, 0] - target[0], points[:, 1] - target[1])
    yield from ((north, east) for north, east in points[np.argsort(away, kind="stable")].tolist())
