"""The volumes about traffic that aviation counts entries into: well clear, and near mid-air collision."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from avoidance.types import Bools, Floats
from scenarios.track import MovingTrack, Track

FOOT = 0.3048
"""One foot [m]."""


@dataclass(frozen=True, slots=True)
class Cylinder:
    """Upright, with the traffic in its middle."""

    radius: float
    """Horizontal [m]."""
    height: float
    """Up and down from the middle [m]."""


WELL_CLEAR = Cylinder(2000.0 * FOOT, 250.0 * FOOT)
"""Small-UAS well clear (ASTM F3442): 2,000 ft horizontally, 250 ft vertically."""
NMAC = Cylinder(500.0 * FOOT, 100.0 * FOOT)
"""Near mid-air collision: 500 ft horizontally, 100 ft vertically."""


def entered(track: Track, mover: MovingTrack, cylinder: Cylinder) -> bool:
    """True if the flight enters the volume about a moving obstacle.

    Notes
    -----
    Closed form: between samples the relative motion is a straight line, so the times within the radius, and
    within the height, are one interval each.
    """
    relative = track.positions - mover.positions
    starts, steps = relative[:-1], np.diff(relative, axis=0)
    exists = np.isfinite(starts[:, 0]) & np.isfinite(steps[:, 0])
    starts, steps = starts[exists], steps[exists]
    near = _horizontal(starts[:, :2], steps[:, :2], cylinder.radius)
    level = _vertical(starts[:, 2], steps[:, 2], cylinder.height)
    begin = np.maximum(np.maximum(near[0], level[0]), 0.0)
    end = np.minimum(np.minimum(near[1], level[1]), 1.0)
    inside: Bools = begin < end
    return bool(inside.any())


def _horizontal(starts: Floats, steps: Floats, radius: float) -> tuple[Floats, Floats]:
    """Share of each segment at which it enters and leaves a circle about the origin."""
    square = np.einsum("ij,ij->i", steps, steps)
    along = np.einsum("ij,ij->i", starts, steps)
    beyond = np.einsum("ij,ij->i", starts, starts) - radius**2
    root = np.sqrt(np.maximum(along**2 - square * beyond, 0.0))
    moves = square > 0.0
    safe = np.where(moves, square, 1.0)
    meets = along**2 > square * beyond
    begin = np.where(meets, (-along - root) / safe, np.inf)
    end = np.where(meets, (-along + root) / safe, -np.inf)
    resting = np.where(beyond < 0.0, np.inf, -np.inf)
    return np.where(moves, begin, -resting), np.where(moves, end, resting)


def _vertical(starts: Floats, steps: Floats, height: float) -> tuple[Floats, Floats]:
    """Share of each segment at which it enters and leaves the slab."""
    moves = steps != 0.0
    safe = np.where(moves, steps, 1.0)
    low, high = (-height - starts) / safe, (height - starts) / safe
    resting = np.where(np.abs(starts) < height, np.inf, -np.inf)
    begin = np.where(moves, np.minimum(low, high), -resting)
    return begin, np.where(moves, np.maximum(low, high), resting)
