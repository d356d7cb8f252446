"""One rule of the road for all: who gives way to whom, and on which side."""

from __future__ import annotations

import math

import numpy as np

from avoidance.prediction import Intruders, leg_approaches
from avoidance.types import Bools, Floats

AHEAD = math.radians(15.0)
"""Within this of the nose an intruder is met head-on, not crossed [rad]."""
ABAFT = math.radians(112.5)
"""Whoever comes from further aft than this overtakes [rad]."""
SAME_WAY = math.radians(30.0)
"""Courses this near to one another cross nowhere soon [rad]."""


def gives_way(course: float, start: tuple[float, float], intruders: Intruders) -> Bools:
    """To whom the own vehicle gives way: it is to leave them on its left.

    Parameters
    ----------
    course : float
        Direction in which the own vehicle wants to go [rad].
    start : (float, float)
        Where it is [m].
    intruders : Intruders
        q of them.

    Returns
    -------
    array, shape (q,)
        True for whoever is ahead or comes from the right. Left on the left means: head-on both turn to the
        right, and whoever crosses from the right is passed behind. Overtaking is free on both sides.
    """
    away = intruders.positions - np.array(start)
    bearing = _wrapped(np.arctan2(away[:, 1], away[:, 0]) - course)
    turned = _wrapped(np.arctan2(intruders.velocities[:, 1], intruders.velocities[:, 0]) - course)
    return np.asarray((bearing > -AHEAD) & (bearing < ABAFT) & (np.abs(turned) > SAME_WAY))


def wrong_side(points: Floats, speeds: Floats | float, intruders: Intruders, yielding: Bools) -> Floats:
    """How many of those that it gives way to a flight leaves on its right, shape (n,).

    Parameters
    ----------
    points, speeds, intruders
        As of `leg_approaches`.
    yielding : array, shape (q,)
        See `gives_way`.
    """
    separation, times = leg_approaches(points, speeds, intruders)
    leg = separation.argmin(axis=1)[:, None]
    when = np.take_along_axis(times, leg, axis=1)[:, 0]
    legs = points[:, 1:] - points[:, :-1]
    lasting = np.hypot(legs[..., 0], legs[..., 1]) / speeds
    begin = np.cumsum(lasting, axis=1) - lasting
    leg = leg[:, 0]
    row = np.arange(len(points))[:, None]
    along = legs[row, leg] / np.maximum(lasting[row, leg], 1e-9)[..., None]
    own = points[row, leg] + along * (when - begin[row, leg])[..., None]
    away = intruders.positions + intruders.velocities * when[..., None] - own
    on_right = along[..., 0] * away[..., 1] - along[..., 1] * away[..., 0] > 0.0
    return np.asarray((on_right & yielding).sum(axis=1), dtype=np.float64)


def _wrapped(angle: Floats) -> Floats:
    """The same between -π and π [rad]."""
    return np.asarray(np.remainder(angle + math.pi, 2.0 * math.pi) - math.pi)
