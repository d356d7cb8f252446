"""Obstacles that belong together: hills (Algorithm 3)."""

from __future__ import annotations

import numpy as np

from avoidance.geometry import distances
from avoidance.types import Floats, Ints


def cluster_of(one: int, positions: Floats, radii: Floats, link_distance: float, join_spheres: bool) -> Ints:
    """The hill that an obstacle is part of.

    Parameters
    ----------
    one : int
        Row of the obstacle.
    positions : array, shape (n, 2)
        Obstacles [m].
    radii : array, shape (n,)
        What must be kept from each [m].
    link_distance : float
        Two obstacles nearer than this are one hill [m].
    join_spheres : bool
        Also join two whose circles overlap, since nothing can pass between them.

    Returns
    -------
    array, shape (m,)
        Rows of the obstacles that belong together with it, itself among them, ascending.

    Notes
    -----
    Algorithm 3, single linkage. Differs from the paper: E36, spheres of 1 km leave no gap although their
    centres are 1 to 2 km apart; with `join_spheres` what cannot be passed is treated as one.
    """
    members = np.zeros(len(positions), dtype=np.bool_)
    members[one] = True
    last = np.array([one])
    while len(last):
        distance = distances(positions[last], positions)
        linked = distance < link_distance
        if join_spheres:
            linked |= distance < radii[last, None] + radii
        last = np.flatnonzero(linked.any(axis=0) & ~members)
        members[last] = True
    return np.flatnonzero(members)
