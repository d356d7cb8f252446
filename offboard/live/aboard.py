"""What all parts of a live vehicle share."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from avoidance import Ownship, Performance
from offboard.frames import MapFrame
from offboard.live.autopilots import Home, Mode, Rules
from offboard.live.facts import Fix
from offboard.live.limits import EditTimes
from offboard.live.messages import Session
from offboard.live.telemetry import Telemetry
from offboard.live.vehicle_clock import VehicleClock

RATES = {33: 10.0, 30: 5.0, 74: 5.0, 87: 5.0, 42: 2.0, 245: 1.0, 2: 1.0, 242: 0.5, 147: 0.2}
"""Times a second that each message is asked for; positions, attitude, airspeed, target, mission, ..."""


def request_rates(session: Session) -> None:
    """Ask for what we need, as often as we need it; an autopilot that restarts forgets."""
    for message, rate in RATES.items():
        session.request_rate(message, rate)


@dataclass(frozen=True, slots=True)
class Event:
    """Something a pilot must know."""

    time: float
    """Seconds since the start, vehicle's clock."""
    severity: str
    """info, warning or alarm."""
    text: str
    """In a pilot's words."""


@dataclass(slots=True)
class Aboard:
    """The link, the map, what the vehicle can do and what it has told."""

    session: Session
    telemetry: Telemetry
    rules: Rules
    frame: MapFrame
    performance: Performance
    times: EditTimes
    parameters: dict[str, float]
    """Those that were asked for, by name."""
    clock: VehicleClock
    simulated: bool = False
    """True if the vehicle says that it is a simulation."""
    listener: Callable[[Event], None] | None = None
    """Called with each event."""
    events: list[Event] = field(default_factory=list)
    """All that has happened."""

    @property
    def time(self) -> float:
        """Seconds since the start."""
        return self.clock.now()

    @property
    def mode(self) -> Mode:
        """What the vehicle does."""
        return self.rules.mode(self.telemetry.custom_mode)

    @property
    def mode_name(self) -> str:
        """The same in the autopilot's word."""
        return self.rules.mode_name(self.telemetry.custom_mode)

    @property
    def home(self) -> Home:
        """Where the vehicle's home is; the map's if it does not tell."""
        known = self.telemetry.home
        if known is not None:
            return Home(*known)
        return Home(self.frame.latitude_deg, self.frame.longitude_deg, self.frame.altitude_m)

    def begin(self) -> None:
        """The flight begins: seconds count from now on; what was told before has times below zero."""
        before = self.time
        self.clock.restart()
        self.events[:] = [replace(event, time=round(event.time - before, 3)) for event in self.events]

    def tell(self, severity: str, text: str) -> None:
        """Note something that a pilot must know."""
        event = Event(round(self.time, 3), severity, text)
        self.events.append(event)
        if self.listener is not None:
            self.listener(event)

    def ownship(self) -> Ownship:
        """The latest position and motion; moved on at its velocity while nothing is heard."""
        fix = self._fix()
        now, then = self.time, self.clock.ours(fix.time)
        age = now - then
        if age < 1.0:
            return self._ownship(fix, then, 0.0)
        return self._ownship(fix, now, age)

    def ownship_at(self, time: float) -> Ownship:
        """Position and motion at a time of the last half minute [s]."""
        fix = self.telemetry.at(self.clock.vehicle(time)) or self._fix()
        return self._ownship(fix, time, max(time - self.clock.ours(fix.time), 0.0))

    def _fix(self) -> Fix:
        fix = self.telemetry.fix
        if fix is None:
            raise ValueError("the vehicle has told no position")
        return fix

    def _ownship(self, fix: Fix, time: float, age: float) -> Ownship:
        north, east = self.frame.to_map(fix.latitude_deg, fix.longitude_deg)
        airspeed = self.telemetry.airspeed
        attitude = self.telemetry.attitude
        heading = attitude.yaw if math.isnan(fix.heading) and attitude is not None else fix.heading
        return Ownship(
            time=time,
            north=north + age * fix.velocity_north,
            east=east + age * fix.velocity_east,
            altitude=fix.altitude,
            velocity_north=fix.velocity_north,
            velocity_east=fix.velocity_east,
            climb_rate=fix.climb_rate,
            airspeed=self.performance.airspeed if math.isnan(airspeed) else airspeed,
            heading=0.0 if math.isnan(heading) else heading,
            bank=0.0 if attitude is None else attitude.roll,
        )
