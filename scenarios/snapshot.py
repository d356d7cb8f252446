"""What exists at one instant, and the part of it that lies about an observer."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from avoidance.types import Bools, Floats, Ints

Rows: TypeAlias = Bools | NDArray[np.intp]
SLACK = 2000.0
"""An observer that has moved further than this looks round again [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot:
    """Everything that exists at one instant, as read-only arrays."""

    ids: Ints
    """Identities, shape (n,)."""
    positions: Floats
    """North, east, altitude [m], shape (n, 3)."""
    radii: Floats
    """Safety radius of each [m], NaN where it is not known to a radar, shape (n,)."""

    def chosen(self, rows: Rows) -> Snapshot:
        """Some of it."""
        return _read_only(self.ids[rows], self.positions[rows], self.radii[rows])

    def joined(self, other: Snapshot) -> Snapshot:
        """Both together."""
        return _read_only(
            np.concatenate((self.ids, other.ids)),
            np.concatenate((self.positions, other.positions)),
            np.concatenate((self.radii, other.radii)),
        )


class Neighbourhood:
    """The part of a snapshot within reach of somebody who moves; the whole is looked through seldom.

    Parameters
    ----------
    whole : Snapshot
        Any number of obstacles: 100,000 cost no more per look than the few that are near.
    reach : float
        What is nearer than this is always found [m]; what is up to 2 km further away may be too.
    """

    def __init__(self, whole: Snapshot, reach: float) -> None:
        self.whole = whole
        self._reach = reach
        self._centre = (math.inf, math.inf, math.inf)
        self._near = whole

    def around(self, here: tuple[float, float, float]) -> Snapshot:
        """What lies about a place, north, east, altitude [m]; the same object while it will do."""
        if not math.dist(here, self._centre) <= SLACK:
            away = self.whole.positions - here
            distances = np.sqrt(np.einsum("ij,ij->i", away, away))
            self._near = self.whole.chosen(distances <= self._reach + SLACK)
            self._centre = here
        return self._near


def snapshot_of(seen: Sequence[tuple[int, tuple[float, float, float], float]]) -> Snapshot:
    """From identity, place [m] and radius [m] of each."""
    return _read_only(
        np.array([identity for identity, _, _ in seen], dtype=np.int64),
        np.array([position for _, position, _ in seen], dtype=np.float64).reshape(-1, 3),
        np.array([radius for _, _, radius in seen], dtype=np.float64),
    )


def _read_only(ids: Ints, positions: Floats, radii: Floats) -> Snapshot:
    for values in (ids, positions, radii):
        values.flags.writeable = False
    return Snapshot(ids, positions, radii)
