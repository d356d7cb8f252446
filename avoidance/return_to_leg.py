"""When a detour round traffic may be undone."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from avoidance.conflicts import first_conflict, wind_estimate
from avoidance.known import Known
from avoidance.prediction import ground_speeds, leg_approaches
from avoidance.types import Ints, Ownship, Performance, Route

PERSISTENT = 5.0
"""An intruder that has not passed must have been out of the way for this long, one that has turned must have
flown straight on for this long [s]."""
PASSED = 1.0
"""An intruder whose closest approach is sooner than this has passed [s]."""


class ReturnToLeg:
    """Decides whether the vehicle may leave a detour and fly the mission's own leg again.

    It may at once when everything that it avoids has passed. Before that the direct way must have been
    clear for a while; and if such a return has led to the same conflict again, as it does with others that
    give way as well, the next one waits until they have passed.

    Parameters
    ----------
    performance : Performance
        What the vehicle can fly.
    """

    def __init__(self, performance: Performance) -> None:
        self._performance = performance
        self._returned: set[int] = set()
        self._regretted: set[int] = set()
        self._clear_since: float | None = None

    def avoiding(self, ids: Iterable[int]) -> None:
        """A detour round these has begun."""
        self._regretted |= self._returned.intersection(ids)
        self._clear_since = None

    def allows(self, own: Ownship, direct: Route, known: Known, avoided: frozenset[int]) -> bool:
        """True if the direct route may be taken up now."""
        if first_conflict(own, direct, known, self._performance, resuming=True) is not None:
            self._clear_since = None
            return False
        rows = np.flatnonzero(np.isin(known.intruder_ids, list(avoided)))
        if (known.intruders.ages[rows] < PERSISTENT).any():
            return False
        ahead = self._not_passed(own, direct, known, rows)
        if ahead & self._regretted:
            return False
        self._returned |= avoided
        if not ahead:
            return True
        if self._clear_since is None:
            self._clear_since = own.time
        return own.time - self._clear_since >= PERSISTENT

    def _not_passed(self, own: Ownship, direct: Route, known: Known, rows: Ints) -> set[int]:
        """Those of some intruders that would still come nearer on the direct route."""
        if not len(rows):
            return set()
        points = np.array([(own.north, own.east), *((w.north, w.east) for w in direct.waypoints)])[None]
        wind = wind_estimate(own, self._performance)
        speeds = ground_speeds(np.diff(points, axis=1), self._performance.airspeed, wind)
        separation, times = leg_approaches(points, speeds, known.intruders)
        leg = separation[0].argmin(axis=0)
        nearing = times[0, leg, np.arange(len(leg))] > PASSED
        return set(known.intruder_ids[rows[nearing[rows]]].tolist())
