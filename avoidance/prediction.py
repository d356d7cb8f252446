"""Own route against intruders that fly on as they do: separation in closed form."""

from __future__ import annotations

import math

import numpy as np

from avoidance.types import Floats


def route_separation(
    points: Floats, speed: float, positions: Floats, velocities: Floats, horizon: float = math.inf
) -> Floats:
    """Least distance between a flight along each polyline and each intruder.

    Parameters
    ----------
    points : array, shape (n, k, 2)
        n polylines, north and east [m], flown from now on at `speed`.
    speed : float
        Own ground speed [m/s].
    positions, velocities : array, shape (q, 2)
        Intruders now: north and east [m], ground velocity [m/s]; they keep it.
    horizon : float
        Look no further ahead than this [s].

    Returns
    -------
    array, shape (n, q)
        Least separation [m].

    Notes
    -----
    On each leg the relative motion is a straight line, so the least distance is that of the origin from a
    segment: the closest point of approach of Algorithm 7 and Eq. (21), exact for the whole leg.
    """
    legs = np.diff(points, axis=1)
    times = np.hypot(legs[..., 0], legs[..., 1]) / speed
    begin = np.concatenate([np.zeros((len(points), 1)), np.cumsum(times, axis=1)[:, :-1]], axis=1)
    until = np.minimum(begin + times, horizon)
    lasting = np.maximum(until - begin, 0.0)
    units = legs / np.maximum(times * speed, 1e-9)[..., None]
    own_velocity = speed * units
    relative = (
        points[:, :-1, None, :] - positions[None, None] - velocities[None, None] * begin[..., None, None]
    )
    closing = own_velocity[:, :, None, :] - velocities[None, None]
    square = np.maximum((closing**2).sum(-1), 1e-12)
    moment = np.clip(-(relative * closing).sum(-1) / square, 0.0, lasting[..., None])
    nearest = relative + closing * moment[..., None]
    distance = np.hypot(nearest[..., 0], nearest[..., 1])
    distance = np.where((begin <= horizon)[..., None], distance, np.inf)
    return np.asarray(distance.min(axis=1))
