"""Obstacles that belong together: hills (Algorithm 3)."""

from __future__ import annotations

import numpy as np

from avoidance.types import Floats, Ints


def clusters(positions: Floats, radii: Floats, link_distance: float, join_spheres: bool) -> Ints:
    """Group obstacles that belong together: hills.

    Parameters
    ----------
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
    array, shape (n,)
        Label of the group that each belongs to.

    Notes
    -----
    Algorithm 3, single linkage. Differs from the paper: E36, spheres of 1 km leave no gap although their
    centres are 1 to 2 km apart; with `join_spheres` what cannot be passed is treated as one.
    """
    count = len(positions)
    if count == 0:
        return np.empty(0, dtype=np.int64)
    offset = positions[:, None] - positions[None]
    distance = np.hypot(offset[..., 0], offset[..., 1])
    linked = distance < link_distance
    if join_spheres:
        linked |= distance < radii[:, None] + radii[None]
    np.fill_diagonal(linked, val=True)
    labels = np.arange(count)
    while True:  # each obstacle takes the least label among its neighbours until nothing changes
        least = np.where(linked, labels[None], count).min(axis=1)
        least = least[least]
        if np.array_equal(least, labels):
            return np.asarray(labels, dtype=np.int64)
        labels = least
