"""The loop's `Clock` on a live vehicle: it waits, by the vehicle's own clock."""

from __future__ import annotations

from offboard.live.vehicle import LiveVehicle


class WaitingClock:
    """Lets time pass by waiting until the vehicle's clock has come so far; edits go on meanwhile.

    Parameters
    ----------
    vehicle : LiveVehicle
        Whose clock counts.
    """

    def __init__(self, vehicle: LiveVehicle) -> None:
        self._vehicle = vehicle
        self._now = vehicle.time

    @property
    def now(self) -> float:
        """Seconds since the start."""
        return self._now

    def advance(self, period: float) -> None:
        """Wait; where the vehicle is ahead by more than a period, scans are left out and not made up for."""
        behind = self._vehicle.time - self._now - period
        self._now += period if behind < period else behind
        self._vehicle.wait_until(self._now)
