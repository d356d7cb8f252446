"""The picture of the current scan alone, as the paper has it (Algorithm 2 as printed)."""

from __future__ import annotations

import numpy as np

from avoidance.picture import Picture
from avoidance.types import Ownship, RadarScan


class CurrentScan:
    """Contacts in, picture out, nothing remembered but the ranges of the last scan.

    Notes
    -----
    Algorithm 2 as printed: what changes its range by more than the vehicle has flown moves. Differs from
    the paper: nothing; erratum E31 says what it misses, `avoidance.tracking` does not.
    """

    def __init__(self) -> None:
        self._last_own: tuple[float, float] | None = None
        self._last_range: dict[int, float] = {}
        self._picture: Picture | None = None
        self._version = 0

    def update(self, scan: RadarScan, own: Ownship) -> Picture:
        """The picture of one scan."""
        distance = np.hypot(scan.positions[:, 0] - own.north, scan.positions[:, 1] - own.east)
        last = self._last_own
        travelled = 0.0 if last is None else float(np.hypot(own.north - last[0], own.east - last[1]))
        keys = scan.ids.tolist()
        before = np.array([self._last_range.get(key, np.nan) for key in keys], dtype=np.float64)
        change = np.abs(distance - before)
        moving = np.where(np.isnan(before), False, change > 1.02 * travelled + 0.5)
        self._last_own = (own.north, own.east)
        self._last_range = dict(zip(keys, distance.tolist(), strict=True))
        shown = self._picture
        if shown is None or not (
            np.array_equal(shown.ids, scan.ids)
            and np.array_equal(shown.positions, scan.positions)
            and np.array_equal(shown.moving, moving)
        ):
            self._version += 1
        count = len(keys)
        self._picture = Picture(
            ids=scan.ids,
            positions=scan.positions,
            velocities=np.zeros((count, 2)),
            climbs=np.zeros(count),
            ages=np.zeros(count),
            radii=scan.radii,
            sigma=np.zeros(count),
            speed_sigma=np.zeros(count),
            moving=moving.astype(np.bool_),
            confirmed=np.ones(count, dtype=np.bool_),
            time=scan.time,
            version=self._version,
        )
        return self._picture
