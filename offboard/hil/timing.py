"""Where the time of a run in the loop goes, and which steps came late."""

from __future__ import annotations

import time
from dataclasses import dataclass, field

PARTS = ("plant", "sensors", "protocol", "transport", "autopilot")
"""The FMU; noise, GPS, magnetic field; packing and parsing; sockets; the other side, or waiting for it."""


@dataclass(slots=True)
class Timing:
    """Wall time by part of the loop."""

    seconds: dict[str, float] = field(default_factory=lambda: dict.fromkeys(PARTS, 0.0))
    """Wall time by part [s]."""
    steps: int = 0
    """Steps of the plant."""
    _mark: float = field(default=0.0, repr=False)

    def start(self) -> None:
        """From now on time counts for the part that `lap` names next."""
        self._mark = time.perf_counter()

    def lap(self, part: str) -> None:
        """The time since the last mark was this part's."""
        now = time.perf_counter()
        self.seconds[part] += now - self._mark
        self._mark = now

    @property
    def total(self) -> float:
        """Sum over all parts [s]."""
        return sum(self.seconds.values())

    @property
    def rate(self) -> float:
        """Steps per second of all parts together."""
        return self.steps / self.total if self.total > 0.0 else 0.0


@dataclass(slots=True)
class Punctuality:
    """How well a run in real time kept its times."""

    period: float
    """Between two steps [s]."""
    steps: int = 0
    """Steps taken."""
    late: int = 0
    """Steps that began more than one period after their time."""
    worst: float = 0.0
    """Latest beginning after its time [s]."""
    resynchronised: int = 0
    """How often the schedule was moved because it could not be caught up with."""

    def note(self, lateness: float) -> None:
        """One more step, begun this long after its time [s]."""
        self.steps += 1
        if lateness > self.period:
            self.late += 1
        self.worst = max(self.worst, lateness)

    @property
    def late_share(self) -> float:
        """Late steps over steps."""
        return self.late / self.steps if self.steps else 0.0


class Metronome:
    """Beats at a fixed rate of the machine's steady clock; late beats are caught up with, and counted.

    Parameters
    ----------
    period : float
        Simulated time between two steps [s].
    speed : float
        Simulated over real time.
    give_up : float
        Once this far behind [s], the schedule begins anew: a debugger or a suspended machine.
    """

    def __init__(self, period: float, speed: float = 1.0, give_up: float = 0.5) -> None:
        self.period = period / speed
        self.punctuality = Punctuality(self.period)
        self._give_up = give_up
        self._next = time.monotonic()

    def remaining(self) -> float:
        """Time until the next beat [s]; negative if it is overdue."""
        return self._next - time.monotonic()

    def restart(self) -> None:
        """The next beat is due now."""
        self._next = time.monotonic()

    def beat(self) -> None:
        """The step begins now."""
        lateness = -self.remaining()
        self.punctuality.note(lateness)
        if lateness > self._give_up:
            self.punctuality.resynchronised += 1
            self.restart()
        self._next += self.period
