"""What sensors on a link have reported lately, kept until the next scan."""

from __future__ import annotations

import math
from dataclasses import dataclass

from avoidance import Contact, RadarScan


@dataclass(frozen=True, slots=True)
class Sighting:
    """One report of one obstacle."""

    id: int
    north: float
    """North of home [m]."""
    east: float
    """East of home [m]."""
    altitude: float
    """Above home [m]."""
    time: float
    """When it was there [s]."""
    velocity_north: float = 0.0
    """As reported, 0 if it is not [m/s]."""
    velocity_east: float = 0.0
    """As reported, 0 if it is not [m/s]."""
    climb_rate: float = 0.0
    """As reported, 0 if it is not [m/s]."""
    radius: float | None = None
    """Safety radius, if the sensor knows it [m]."""

    def at(self, time: float) -> Contact:
        """Where it is at another time, moved on at the reported velocity."""
        age = time - self.time
        return Contact(
            self.id,
            self.north + age * self.velocity_north,
            self.east + age * self.velocity_east,
            self.altitude + age * self.climb_rate,
            self.radius,
        )


class Sightings:
    """The latest report of each obstacle.

    Parameters
    ----------
    keep : float
        A report is used for so long [s]; the core remembers by itself what stands still.
    """

    def __init__(self, keep: float) -> None:
        self._keep = keep
        self._latest: dict[int, Sighting] = {}

    def put(self, sighting: Sighting) -> None:
        """Take over a report; one that is no place at all is left out."""
        values = (sighting.north, sighting.east, sighting.altitude, sighting.time)
        if all(map(math.isfinite, values)):
            self._latest[sighting.id] = sighting

    def scan(self, time: float) -> RadarScan:
        """A sweep of all that has been reported lately, each where it is now."""
        self._latest = {i: s for i, s in self._latest.items() if time - s.time <= self._keep}
        return RadarScan.of(time, [sighting.at(time) for sighting in self._latest.values()])
