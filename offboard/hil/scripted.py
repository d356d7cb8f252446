"""A stand-in for an autopilot: simple controllers that take off, hold altitude and heading, and turn.

It is no product: it stands on the other side of the protocols in tests and in `--self-test`, where no
firmware may be assumed. Its gains suit aircraft like the Skywalker X8.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from offboard.hil.plant import NEUTRAL, Axes

GRAVITY = 9.81


class Believed(NamedTuple):
    """What the stand-in knows of its aircraft."""

    time: float
    """[s]"""
    bank: float
    """[rad]"""
    pitch: float
    """[rad]"""
    heading: float
    """True [rad]."""
    p: float
    """Roll rate [rad/s]."""
    q: float
    """Pitch rate [rad/s]."""
    r: float
    """Yaw rate [rad/s]."""
    altitude: float
    """Above the start [m]."""
    climb: float
    """[m/s]"""
    airspeed: float
    """[m/s]"""


@dataclass(frozen=True, slots=True)
class Task:
    """What is flown until a time."""

    until: float
    """[s]"""
    heading: float = 0.0
    """True [rad]."""
    altitude: float = 60.0
    """Above the start [m]; negative: glide down with the engine off."""
    airspeed: float = 15.0
    """[m/s]"""
    bank: float | None = None
    """Held instead of the heading [rad]."""
    armed: bool = True
    """False: everything neutral."""


FLIGHT = (
    Task(until=2.0, armed=False),
    Task(until=25.0),
    Task(until=45.0, heading=math.radians(90.0)),
    Task(until=math.inf, heading=math.radians(30.0), altitude=70.0),
)
"""Take off northward, climb, turn right, then left and higher."""


@dataclass(slots=True)
class ScriptedPilot:
    """Cascades of proportional and integral control, aileron and elevator last."""

    tasks: Sequence[Task] = FLIGHT
    """What to fly, in order."""
    max_bank: float = math.radians(30.0)
    """[rad]"""
    runway: float = 0.0
    """Kept while low [rad]."""
    _time: float | None = field(default=None, init=False, repr=False)
    _roll_integral: float = field(default=0.0, init=False, repr=False)
    _climb_integral: float = field(default=0.0, init=False, repr=False)
    _speed_integral: float = field(default=0.0, init=False, repr=False)
    _pitch_integral: float = field(default=0.0, init=False, repr=False)

    def task(self, time: float) -> Task:
        """What is flown at a time [s]."""
        return next(task for task in self.tasks if time < task.until)

    def fly(self, b: Believed) -> Axes:
        """Surfaces and throttle for what is believed now."""
        period = 0.0 if self._time is None else min(max(b.time - self._time, 0.0), 0.1)
        self._time = b.time
        task = self.task(b.time)
        if not task.armed:
            return NEUTRAL
        if b.airspeed < 8.0 and b.altitude < 3.0:  # rolling, or about to
            return Axes(0.0, 0.0, 0.0, 1.0 if task.altitude >= 0.0 else 0.0)
        bank = self._bank(b, task) if task.bank is None else task.bank
        lean = bank - b.bank
        if abs(lean) < 0.15:
            self._roll_integral = _clamp(self._roll_integral + 0.5 * lean * period, 0.3)
        roll = _clamp(1.5 * lean - 0.1 * b.p + self._roll_integral, 1.0)
        pitch, climb = self._pitch(b, task, period)
        error = pitch - b.pitch
        turn = GRAVITY / max(b.airspeed, 8.0) * math.sin(b.bank) * math.tan(b.bank)
        self._pitch_integral = _clamp(self._pitch_integral + 0.8 * error * period, 0.4)
        nose = _clamp(1.1 * error + 0.15 * (turn - b.q) + self._pitch_integral, 1.0)
        return Axes(roll, nose, 0.0, self._throttle(b, task, climb, period))

    def _bank(self, b: Believed, task: Task) -> float:
        wanted = task.heading if b.altitude > 15.0 else self.runway
        error = math.remainder(wanted - b.heading, math.tau)
        return _clamp(1.2 * error, self.max_bank if b.altitude > 15.0 else 0.1)

    def _pitch(self, b: Believed, task: Task, period: float) -> tuple[float, float]:
        """Pitch and climb that bring the aircraft to its altitude."""
        if task.altitude < 0.0:
            return -0.02, -1.5
        climb = min(max(0.3 * (task.altitude - b.altitude), -1.5), 2.5)
        error = climb - b.climb
        self._climb_integral = _clamp(self._climb_integral + 0.02 * error * period, 0.15)
        level = 0.06 / max(math.cos(b.bank), 0.5)
        pitch = level + climb / 15.0 + 0.03 * error + self._climb_integral
        return min(max(pitch, -0.25), 0.3), climb

    def _throttle(self, b: Believed, task: Task, climb: float, period: float) -> float:
        if task.altitude < 0.0:
            return 0.0
        error = task.airspeed - b.airspeed
        self._speed_integral = _clamp(self._speed_integral + 0.05 * error * period, 0.3)
        return min(max(0.36 + 0.14 * climb + 0.15 * error + self._speed_integral, 0.0), 1.0)


def _clamp(value: float, limit: float) -> float:
    return min(max(value, -limit), limit)
