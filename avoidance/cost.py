"""What a waypoint costs: path length and risk (Eqs. 2-6), on arrays of candidates."""

from __future__ import annotations

import numpy as np

from avoidance.geometry import distances, within_reach
from avoidance.types import Floats


def path_length(points: Floats, start: tuple[float, float], target: tuple[float, float]) -> Floats:
    """f1, the length of start -> waypoint -> target of each candidate.

    Parameters
    ----------
    points : array, shape (n, 2)
        Candidate waypoints, north and east [m].
    start, target : (float, float)
        Position of the vehicle and end of the leg [m].

    Returns
    -------
    array, shape (n,)
        Length [m].

    Notes
    -----
    Eq. (2).
    """
    first = np.hypot(points[:, 0] - start[0], points[:, 1] - start[1])
    second = np.hypot(points[:, 0] - target[0], points[:, 1] - target[1])
    return np.asarray(first + second)


def risk(points: Floats, centres: Floats, risk_distance: float, squared_metres: bool) -> Floats:
    """f2, the risk that the obstacles near a candidate impose.

    Parameters
    ----------
    points : array, shape (n, 2)
        Candidate waypoints [m].
    centres : array, shape (d, 2)
        Known obstacles [m].
    risk_distance : float
        MXRSK [m].
    squared_metres : bool
        True for the square of the sum as printed [m²].

    Returns
    -------
    array, shape (n,)
        Risk, in square metres or without dimension.

    Notes
    -----
    Eqs. (3)-(5). Differs from the paper: E19, MXRSK is never given and Eq. (5) mixes m² with m, so that f2
    acts as a wall at MXRSK; unless `squared_metres`, each obstacle adds ((MXRSK - dis)/MXRSK)².
    """
    if not len(centres) or not len(points):
        return np.zeros(len(points))
    distance = distances(points, centres[within_reach(points, centres, risk_distance)])
    intrusion = np.maximum(risk_distance - distance, 0.0)
    if squared_metres:
        return np.asarray(intrusion.sum(axis=1) ** 2)
    return np.asarray(((intrusion / risk_distance) ** 2).sum(axis=1))
