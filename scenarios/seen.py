"""What a radar on a link has shown during a flight, as obstacles and moving tracks for the record."""

from __future__ import annotations

import math

import numpy as np

from avoidance import RadarScan
from avoidance.types import Floats
from offboard.link import Radar, VehicleState
from scenarios.scenario import TRAFFIC_VIOLATION_RADIUS, Obstacle
from scenarios.track import MovingTrack, rounded

MOVED = 150.0
"""What has been seen at places further apart than this moves [m]."""
UNNAMED = 2_000_000_000
"""Identities from here on are numbers without meaning."""
CELL = 200.0
"""Returns without an identity that lie in one square of this size are one obstacle [m]."""
GAP = 20.0
"""Between two sightings further apart than this nothing is known of where it was [s]."""

Row = tuple[float, float, float, float, float]
"""Time [s], north, east, altitude [m], safety radius [m] or NaN."""


class SeenLog:
    """A `Radar` that keeps what another one has shown.

    Parameters
    ----------
    radar : Radar
        The other one.
    safety_radius : float
        Of what says none itself [m].
    """

    def __init__(self, radar: Radar, safety_radius: float) -> None:
        self._radar = radar
        self._safety_radius = safety_radius
        self._rows: dict[int, list[Row]] = {}

    @property
    def anything(self) -> bool:
        """True if anything was ever seen."""
        return bool(self._rows)

    def scan(self, state: VehicleState, now: float) -> RadarScan:
        """The other's sweep."""
        scan = self._radar.scan(state, now)
        for identity, place, radius in zip(
            scan.ids.tolist(), scan.positions.tolist(), scan.radii.tolist(), strict=True
        ):
            if identity >= UNNAMED:
                identity = UNNAMED + hash((round(place[0] / CELL), round(place[1] / CELL))) % 10**8  # noqa: PLW2901
            self._rows.setdefault(identity, []).append((scan.time, *place, radius))
        return scan

    def found(self, times: Floats) -> tuple[tuple[Obstacle, ...], list[MovingTrack]]:
        """What stood still, and where what moved was at the times of the own track [s]."""
        standing, moving = [], []
        for identity, rows in self._rows.items():
            table = np.array(rows)
            places = table[:, 1:4]
            radius = float(table[-1, 4])
            if np.ptp(places, axis=0).max() <= MOVED:
                place = np.median(places, axis=0)
                north, east, altitude = (round(float(value), 3) for value in place)
                known = self._safety_radius if math.isnan(radius) else radius
                standing.append(Obstacle(identity, north, east, altitude, known, kind="seen"))
            else:
                moving.append(MovingTrack(identity, TRAFFIC_VIOLATION_RADIUS, rounded(_along(table, times))))
        return tuple(standing), moving


def _along(table: Floats, times: Floats) -> Floats:
    """Places at given times [s], NaN where nothing is known."""
    seen, first = np.unique(table[:, 0], return_index=True)
    places = table[first, 1:4]
    there = np.column_stack([np.interp(times, seen, places[:, axis]) for axis in range(3)])
    after = np.searchsorted(seen, times)
    inside = (times >= seen[0]) & (times <= seen[-1])
    before_index = np.clip(after - 1, 0, len(seen) - 1)
    after_index = np.clip(after, 0, len(seen) - 1)
    inside &= seen[after_index] - seen[before_index] <= GAP
    there[~inside] = math.nan
    return there
