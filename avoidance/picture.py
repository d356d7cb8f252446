"""What is known of the obstacles after a scan: one row per track."""

from __future__ import annotations

from dataclasses import dataclass

from avoidance.types import Bools, Floats, Ints


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """Everything known of the obstacles after a scan; arrays of one row per track."""

    ids: Ints
    """Identity the radar last gave, shape (n,)."""
    positions: Floats
    """North, east, altitude [m], shape (n, 3)."""
    velocities: Floats
    """North, east over ground [m/s], 0 for what stands still, shape (n, 2)."""
    climbs: Floats
    """Climb rate [m/s], 0 unless significant, shape (n,)."""
    radii: Floats
    """Safety radius RS that the sensor gave [m], NaN where it gave none, shape (n,)."""
    sigma: Floats
    """Standard deviation of the horizontal position [m], shape (n,)."""
    speed_sigma: Floats
    """Standard deviation of the estimated speed, also of what is taken to stand [m/s], shape (n,)."""
    ages: Floats
    """Time since it was first seen, or last turned [s], shape (n,)."""
    moving: Bools
    """True for what moves, shape (n,)."""
    confirmed: Bools
    """Seen often enough to be believed, shape (n,)."""
    time: float
    """When the positions were true [s]."""
    version: int
    """Changes whenever what stands still has changed: a new, lost or shifted obstacle."""

    @property
    def size(self) -> int:
        """How many tracks there are."""
        return len(self.ids)
