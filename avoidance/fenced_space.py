"""The nearest place to a target within the geofence that is free and can be reached."""

from __future__ import annotations

import numpy as np

from avoidance.free_space import FreeSpace, free_candidates
from avoidance.geofence import Geofence, Walls
from avoidance.geometry import Point, distances, point_distances, segments_clearance
from avoidance.tangent_graph import shortest_path
from avoidance.types import Bools, Floats

OUTSIDE = 0.01
"""Candidates lie this much further from walls than they must [m]."""
MOST_WALLS = 60
"""Walls nearest to the target among which candidates are looked for."""
MOST_WAYS = 20
"""Candidates to which a way is looked for; those seen from one that has none need not be asked for."""


def nearest_within(
    target: Point,
    reach_from: Point,
    centres: Floats,
    radii_safe: Floats,
    radii_pass: Floats,
    fence: Geofence,
    room_pass: float,
    room_safe: float,
) -> tuple[float, float] | None:
    """Find the safe point within the fence nearest to a target that can be reached.

    Parameters
    ----------
    target, reach_from : Point
        The point wanted, and where the way to it begins (north, east) [m].
    centres, radii_safe, radii_pass : Floats
        Discs, what the point keeps from their centres, what the way there keeps, as for
        `avoidance.free_space.nearest_free`.
    fence : Geofence
        Where one may fly.
    room_pass, room_safe : float
        What the way there and the point keep from the edges of the fence [m].

    Returns
    -------
    (float, float) or None
        North and east [m]; None if there is no such point, or none among the nearest.

    Notes
    -----
    Algorithm 4. Candidates are those of free space without the fence, the feet and crossings of the lines
    beside the walls, and where these lines meet the circles; that it can be reached is shown by a way.
    """
    goal = np.array([float(target[0]), float(target[1])])
    lines = _lines_beside(goal, fence.walls, room_safe + OUTSIDE)
    points = np.concatenate(
        [free_candidates(target, centres, radii_safe), *_beside(goal, lines, centres, radii_safe)]
    )
    inside = fence.allows(points) & (distances(points, centres) >= radii_safe - 1e-6).all(axis=1)
    points = points[inside]
    points = points[Walls(fence.walls).clearance(points, points) >= room_safe]
    points = points[np.argsort(point_distances(points, goal), kind="stable")]
    here = np.array([float(reach_from[0]), float(reach_from[1])])
    walls = Walls(fence.walls, room_pass)
    space = FreeSpace.of(centres, np.minimum(radii_pass, point_distances(centres, here)))
    home = space.component(here)
    left = points[[space.component(point) == home for point in points]]
    for _ in range(MOST_WAYS):
        if not len(left):
            return None
        point = left[0]
        free = np.minimum(point_distances(centres, here), point_distances(centres, point)) - 0.5
        if (
            shortest_path(here, point, centres, np.maximum(np.minimum(radii_pass, free), 0.0), walls)
            is not None
        ):
            return float(point[0]), float(point[1])
        left = left[~_seen_from(point, left, centres, radii_pass, walls)]
    return None


def _seen_from(point: Floats, others: Floats, centres: Floats, radii: Floats, walls: Walls) -> Bools:
    """Which points can be flown straight to from one, itself among them: they are no better to reach."""
    begin = np.broadcast_to(point, others.shape)
    clear = (segments_clearance(begin, others, centres) >= radii - 1e-3).all(axis=1)
    seen = clear & (walls.clearance(begin, others) >= walls.room)
    return np.asarray(seen | (others == point).all(axis=1))


def _lines_beside(goal: Floats, walls: Floats, room: float) -> Floats:
    """Lines on both sides of the walls nearest to a point, shape (k, 2, 2) [m]."""
    gaps = Walls(walls).clearances(goal[None], goal[None])[0]
    near = walls[np.argsort(gaps, kind="stable")[:MOST_WALLS]]
    along = near[:, 1] - near[:, 0]
    normal = room * np.column_stack((-along[:, 1], along[:, 0])) / np.hypot(*along.T)[:, None]
    return np.concatenate([near + normal[:, None], near - normal[:, None]])


def _beside(goal: Floats, lines: Floats, centres: Floats, radii: Floats) -> list[Floats]:
    """Feet of a point on lines, crossings of lines, and their crossings with circles, shapes (m, 2)."""
    along = lines[:, 1] - lines[:, 0]
    length = np.hypot(along[:, 0], along[:, 1])
    unit = along / length[:, None]
    share = np.clip(((goal - lines[:, 0]) * unit).sum(axis=1), 0.0, length)
    feet = lines[:, 0] + share[:, None] * unit
    found = [feet, lines[:, 0], lines[:, 1]]
    one, other = np.triu_indices(len(lines), 1)
    determinant = unit[one, 0] * unit[other, 1] - unit[one, 1] * unit[other, 0]
    keep = np.abs(determinant) > 1e-6
    one, other, determinant = one[keep], other[keep], determinant[keep]
    between = lines[other, 0] - lines[one, 0]
    reach = (between[:, 0] * unit[other, 1] - between[:, 1] * unit[other, 0]) / determinant
    found.append(lines[one, 0] + reach[:, None] * unit[one])
    offset = centres[None] - lines[:, 0, None]
    forward = (offset * unit[:, None]).sum(axis=2)
    across = unit[:, None, 0] * offset[..., 1] - unit[:, None, 1] * offset[..., 0]
    square = (radii + OUTSIDE) ** 2 - across**2
    line, _ = np.nonzero(square >= 0.0)
    half = np.sqrt(square[square >= 0.0])
    middle = lines[line, 0] + forward[square >= 0.0][:, None] * unit[line]
    return [*found, middle - half[:, None] * unit[line], middle + half[:, None] * unit[line]]
