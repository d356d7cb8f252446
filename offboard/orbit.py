"""Circles on which a vehicle waits."""

from __future__ import annotations

import math
from dataclasses import dataclass

from avoidance import Waypoint
from offboard.link import Plant, PlantState


@dataclass(frozen=True, slots=True)
class Orbit:
    """A circle to fly until something else is wanted."""

    north: float
    """Centre, north of home [m]."""
    east: float
    """Centre, east of home [m]."""
    altitude: float
    """Altitude above home [m]."""
    radius: float
    """Radius [m]."""
    direction: int = 1
    """+1 clockwise seen from above, -1 anticlockwise."""

    def __post_init__(self) -> None:
        """Refuse a radius that is not above zero, and a direction other than ±1, with a `ValueError`."""
        if not 0.0 < self.radius < math.inf:
            raise ValueError(f"radius = {self.radius}, must be above 0")
        if self.direction not in (-1, 1):
            raise ValueError(f"direction = {self.direction}, must be 1 (clockwise) or -1")

    @classmethod
    def about(cls, centre: Waypoint, radius: float, direction: int = 1) -> Orbit:
        """The orbit about a waypoint, at its altitude."""
        return cls(centre.north, centre.east, centre.altitude, radius, direction)

    @classmethod
    def from_here(cls, state: PlantState, radius: float) -> Orbit:
        """The clockwise orbit on which the vehicle already is, but for the bank."""
        course = math.atan2(state.velocity_east, state.velocity_north)
        north = state.north - radius * math.sin(course)
        east = state.east + radius * math.cos(course)
        return cls(north, east, state.altitude, radius)

    def command(self, plant: Plant, airspeed: float) -> None:
        """Tell a plant to fly it at an airspeed [m/s]."""
        plant.fly_orbit(self.north, self.east, self.radius, self.direction, self.altitude, airspeed)
