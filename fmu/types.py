"""The nouns of this package: how an aircraft moves and what it can do."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple


class PlantState(NamedTuple):
    """Motion of the aircraft; map metres about home, radians, m/s."""

    time: float
    """Since the start [s]."""
    north: float
    """North of home [m]."""
    east: float
    """East of home [m]."""
    altitude: float
    """Above home [m]."""
    velocity_north: float
    """Over ground [m/s]."""
    velocity_east: float
    """Over ground [m/s]."""
    climb_rate: float
    """Upward velocity [m/s]."""
    airspeed: float
    """True airspeed [m/s]."""
    heading: float
    """Direction of the nose, clockwise from north, -π to π [rad]."""
    bank: float
    """Right wing down positive [rad]."""
    pitch: float
    """Nose up positive [rad]."""
    p: float
    """Roll rate, body [rad/s]."""
    q: float
    """Pitch rate, body [rad/s]."""
    r: float
    """Yaw rate, body [rad/s]."""
    alpha: float
    """Angle of attack [rad]."""
    beta: float
    """Sideslip, wind from the right positive [rad]."""


@dataclass(frozen=True, slots=True)
class PlantLimits:
    """What this aircraft under this guidance can do."""

    cruise_airspeed: float
    """Cruise true airspeed [m/s]."""
    min_airspeed: float
    """Commands below it are raised to it [m/s]."""
    max_airspeed: float
    """Commands above it are lowered to it [m/s]."""
    max_bank: float
    """Bank limit of the guidance [rad]."""
    climb_rate: float
    """Fastest commanded climb [m/s]."""
    sink_rate: float
    """Fastest commanded descent [m/s]."""
    roll_rate: float
    """Fastest commanded roll [rad/s]."""
    roll_lag: float
    """Lag of the bank near its command: attitude loop, surface, and as much again for roll damping [s]."""
    turn_factor: float
    """Turn rate over g tan φ / V; below one where turns are flown with sideslip [-]."""
    gravity: float
    """[m/s²]"""

    @property
    def roll_time(self) -> float:
        """Time from level to 95 % of the bank limit [s]: at the rate limit, then first order."""
        bend = min(self.roll_lag * self.roll_rate, self.max_bank)
        return (self.max_bank - bend) / self.roll_rate + self.roll_lag * math.log(
            bend / (0.05 * self.max_bank)
        )

    def turn_radius(self, speed: float) -> float:
        """Radius of a turn at the bank limit, V²/(f g tan φ) [m] (Eq. 13 with the turn factor f)."""
        return speed**2 / (self.turn_factor * self.gravity * math.tan(self.max_bank))
