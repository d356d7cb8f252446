"""Where the search for a way round traffic starts: a fan ahead, refined about its best points."""

from __future__ import annotations

import math

import numpy as np

from avoidance.problem import WaypointProblem
from avoidance.types import Floats

WIDEST, STEP = math.radians(100.0), math.radians(5.0)
"""Half of the fan, and the angle between its rays [rad]."""
RANGES = 14
"""Points on a ray, nearer ones closer together."""
NEAREST = 300.0
"""The first of them [m]."""
FURTHEST = 15_000.0
"""The last of them [m]."""
SECTOR = math.radians(25.0)
"""The best point of each such sector is refined [rad]."""
REFINED = 6
"""So many sectors at most."""
HALVINGS = 6
"""Times that the spacing is halved."""


def traffic_seeds(problem: WaypointProblem) -> Floats:
    """Waypoints that keep from the intruders what is to be kept, the shortest of each sector.

    Parameters
    ----------
    problem : WaypointProblem
        The search; only its traffic is looked at.

    Returns
    -------
    array, shape (m, 2)
        Best first [m].
    """
    start = np.array(problem.start)
    away = np.array(problem.target) - start
    bearing, distance = math.atan2(away[1], away[0]), float(np.hypot(*away))
    furthest = max(min(FURTHEST, 0.98 * distance), 1.0)
    reaches = np.geomspace(min(NEAREST, 0.5 * furthest), furthest, RANGES)
    angles = np.arange(-WIDEST, WIDEST + 1e-6, STEP)
    angle, reach = (grid.ravel() for grid in np.meshgrid(angles, reaches, indexing="ij"))
    centres = _best_of_sectors(angle, reach, _rank(problem, bearing, angle, reach))
    spacing, ratio = STEP, math.log(reaches[1] / reaches[0])
    offsets = np.array([(i, j) for i in (-1.0, 0.0, 1.0) for j in (-1.0, 0.0, 1.0)])
    for _ in range(HALVINGS):
        spacing, ratio = 0.5 * spacing, 0.5 * ratio
        angle = centres[:, 0, None] + spacing * offsets[:, 0]
        reach = np.minimum(centres[:, 1, None] * np.exp(ratio * offsets[:, 1]), furthest)
        rank = _rank(problem, bearing, angle.ravel(), reach.ravel()).reshape(angle.shape)
        best = np.argmin(rank, axis=1)[:, None]
        centres = np.concatenate(
            [np.take_along_axis(values, best, axis=1) for values in (angle, reach, rank)], axis=1
        )
    centres = centres[np.argsort(centres[:, 2], kind="stable")]
    return _places(problem, bearing, centres[:, 0], centres[:, 1])


def _places(problem: WaypointProblem, bearing: float, angle: Floats, reach: Floats) -> Floats:
    rays = np.stack([np.cos(bearing + angle), np.sin(bearing + angle)], axis=-1)
    return np.asarray(np.array(problem.start) + reach[..., None] * rays)


def _rank(problem: WaypointProblem, bearing: float, angle: Floats, reach: Floats) -> Floats:
    """Cost, and above every cost the shortfall of those that come too near, shape (n,)."""
    return problem.traffic_rank(_places(problem, bearing, angle, reach))


def _best_of_sectors(angle: Floats, reach: Floats, rank: Floats) -> Floats:
    """Angle, distance and rank of the best point of the best sectors, shape (c, 3)."""
    order = np.argsort(rank, kind="stable")
    _, first = np.unique(np.floor(angle[order] / SECTOR), return_index=True)
    chosen = order[np.sort(first)[:REFINED]]
    return np.stack([angle[chosen], reach[chosen], rank[chosen]], axis=1)
