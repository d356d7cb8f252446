"""What single messages of a vehicle say, in plain units."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Fix:
    """One GLOBAL_POSITION_INT in plain units."""

    time: float
    """Vehicle's clock [s]."""
    latitude_deg: float
    longitude_deg: float
    altitude: float
    """Above the vehicle's home [m]."""
    amsl: float
    """Above mean sea level [m]."""
    velocity_north: float
    velocity_east: float
    climb_rate: float
    """Over ground [m/s]."""
    heading: float
    """[rad], NaN if unknown."""


@dataclass(frozen=True, slots=True)
class Attitude:
    """One ATTITUDE; radians."""

    time: float
    """Vehicle's clock [s]."""
    roll: float
    pitch: float
    yaw: float


@dataclass(frozen=True, slots=True)
class MissionShown:
    """One MISSION_CURRENT."""

    current: int
    """Sequence number of the current item."""
    total: int
    """Number of items as the autopilot counts them."""
    state: int = 0
    """MISSION_STATE: 0 unknown, 1 none, 2 not started, 3 active, 4 paused, 5 complete."""
    mission_id: int = 0
    """PX4's checksum; 0 if it sends none."""
    arrived: float = 0.0
    """Wall clock [s]."""


@dataclass(frozen=True, slots=True)
class TargetShown:
    """One POSITION_TARGET_GLOBAL_INT: where the autopilot is flying to."""

    latitude_deg: float
    longitude_deg: float
    arrived: float = 0.0
    """Wall clock [s]."""
