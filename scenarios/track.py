"""Tracks: what was flown, kept cheaply while it grows, rounded as files show it."""

from __future__ import annotations

import math
from array import array
from dataclasses import dataclass

import numpy as np

from avoidance.types import Floats, Ownship


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """One vehicle's flight; angles in degrees because these are the numbers of `track.csv`."""

    vehicle: str
    """Its name."""
    times: Floats
    """Seconds since the start, shape (m,)."""
    positions: Floats
    """North, east, altitude above home [m], shape (m, 3)."""
    airspeeds: Floats
    """True airspeed [m/s], shape (m,)."""
    headings_deg: Floats
    """Direction of the nose, 0 up to 360 [deg], shape (m,)."""
    banks_deg: Floats
    """Right wing down positive [deg], shape (m,)."""


@dataclass(frozen=True, slots=True, eq=False)
class MovingTrack:
    """The true path of one moving obstacle."""

    id: int
    """Its identity."""
    radius: float
    """Violation radius [m]."""
    positions: Floats
    """North, east, altitude [m] at the times of the own track, NaN while it does not exist, shape (m, 3)."""


class TrackLog:
    """Growing record of one vehicle; 0.4 µs a sample."""

    COLUMNS = 7

    def __init__(self, vehicle: str) -> None:
        self.vehicle = vehicle
        self._data = array("d")

    def __len__(self) -> int:
        return len(self._data) // self.COLUMNS

    def append(self, time: float, state: Ownship) -> None:
        """Add the state at `time` [s]."""
        self._data.extend(
            (time, state.north, state.east, state.altitude, state.airspeed, state.heading, state.bank)
        )

    def track(self) -> Track:
        """All samples so far, rounded to the digits that files show (mm, ms, mm/s, 0.001 deg)."""
        rows = np.array(self._data, dtype=np.float64).reshape(-1, self.COLUMNS)
        degrees = np.degrees(rows[:, 5:7])
        return Track(
            vehicle=self.vehicle,
            times=rounded(rows[:, 0]),
            positions=rounded(rows[:, 1:4]),
            airspeeds=rounded(rows[:, 4]),
            headings_deg=rounded(degrees[:, 0] % 360.0) % 360.0,
            banks_deg=rounded(degrees[:, 1]),
        )


class MovingLog:
    """Growing record of one moving obstacle, in step with the own track."""

    def __init__(self, identity: int, radius: float) -> None:
        self.id = identity
        self.radius = radius
        self._data = array("d")

    def append(self, position: tuple[float, float, float] | None) -> None:
        """Add its position; None while it does not exist."""
        self._data.extend((math.nan, math.nan, math.nan) if position is None else position)

    def track(self) -> MovingTrack:
        """All samples so far, rounded to millimetres."""
        return MovingTrack(self.id, self.radius, rounded(np.array(self._data).reshape(-1, 3)))


def rounded(values: Floats, digits: int = 3) -> Floats:
    """Round to the decimals of a file, without negative zeros: writing and reading back changes nothing."""
    return np.round(values, digits) + 0.0
