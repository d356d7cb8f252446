"""The vehicle's clock as seconds since the start, which goes on while nothing is heard. Pure."""

from __future__ import annotations

SILENCE = 2.0
"""Nothing heard for so long: time is counted by the wall clock until something is [s]."""
RATE_OVER = 2.0
"""The vehicle's clock is compared with the wall's over at least this time [s]."""
FASTEST = 100.0
"""No simulation is believed to run faster than this."""


class VehicleClock:
    """Seconds since the start by the vehicle's clock; never goes back, also not when the autopilot restarts.

    It moves only when somebody has listened (`heard`): messages that wait unread are no silence. In silence
    it goes on no faster than the wall's: a simulation at twenty times real time that stands still for three
    seconds is not a minute further on. One that turns out to have stood still goes on from the time that has
    been shown meanwhile.

    Parameters
    ----------
    first : float
        Vehicle's clock at the start [s].
    wall : float
        Wall clock then [s].
    """

    def __init__(self, first: float, wall: float) -> None:
        self.rate = 1.0
        """Vehicle seconds in a second of wall time."""
        self._epoch = first
        self._newest = first
        self._heard = wall
        self._listened = wall
        self._mark = (first, wall)
        self._shown = 0.0

    def heard(self, newest: float, wall: float) -> None:
        """All that has come in has been read: the vehicle's newest time stamp, and the wall clock now [s]."""
        self._listened = wall
        if newest < self._newest - 1.0:  # it has been switched off and on
            self._epoch = newest - self.now()
            self._mark = (newest, wall)
            self._newest = newest
        elif newest > self._newest:
            self._newest = newest
            self._epoch = min(self._epoch, newest - self._shown)
        else:
            return
        self._heard = wall
        before, then = self._mark
        if wall - then >= RATE_OVER:
            self.rate = min(max((newest - before) / (wall - then), 0.1), FASTEST)
            self._mark = (newest, wall)

    def restart(self) -> None:
        """Count the seconds from the newest time stamp on: the flight begins."""
        self._epoch, self._shown = self._newest, 0.0

    def now(self) -> float:
        """Seconds since the start, when somebody last listened."""
        silent = max(self._listened - self._heard - SILENCE, 0.0)
        self._shown = max(self._shown, self._newest - self._epoch + min(self.rate, 1.0) * silent)
        return self._shown

    def ours(self, vehicle: float) -> float:
        """A time of the vehicle's clock as seconds since the start."""
        return vehicle - self._epoch

    def vehicle(self, ours: float) -> float:
        """Seconds since the start as a time of the vehicle's clock."""
        return ours + self._epoch
