"""The aircraft of a simulated autopilot: a plant, the ground below it, a clock that runs before it flies."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from enum import Enum
from typing import Protocol

from avoidance import Ownship, Performance
from offboard.frames import MapFrame
from offboard.link import Plant, PlantState, VehicleState
from offboard.orbit import Orbit
from offboard.sitl.flight import AHEAD, Course

ORBIT_TURN_RADII = 1.5
"""Least radius of a circle, in turn radii at the bank limit."""
LARGEST_ORBIT = 10_000.0
"""No circle is flown wider than this [m]."""
LOWEST, HIGHEST = -500.0, 15_000.0
"""Altitudes above home that can be asked for [m]."""
SPEEDS = (0.8, 1.6)
"""Least and greatest airspeed that can be asked for, in cruise airspeeds."""
ON_GROUND = 0.5
"""Lower than this above home, coming down, an aircraft has landed [m]."""


class Phase(Enum):
    """Where a flight is."""

    HELD = "held"
    """Not launched: on its catapult, or held in the air where the scenario begins."""
    FLYING = "flying"
    LANDED = "landed"
    """Over: what has landed does not start again."""


class Launcher(Protocol):
    """A plant that stands on the ground until it is launched."""

    def launch(self) -> None:
        """Let go."""


class Aircraft:
    """A plant that is held until it is launched, flies what it is told, and lands.

    Parameters
    ----------
    plant : Plant
        Where the flight begins.
    frame : MapFrame
        The map about home.
    performance : Performance
        What the aircraft can do.
    launcher : Launcher, optional
        Lets a plant go that stands on the ground; without one the flight begins in the air.
    charge : callable
        State of charge of the battery, 0 to 1.
    wind : tuple of float
        Velocity of the air over ground, north and east, for telemetry [m/s].
    """

    def __init__(
        self,
        plant: Plant,
        frame: MapFrame,
        performance: Performance,
        launcher: Launcher | None = None,
        charge: Callable[[], float] = lambda: 1.0,
        wind: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        self.plant = plant
        self.frame = frame
        self.performance = performance
        self.charge = charge
        self.wind = wind
        self.phase = Phase.HELD
        self.clock = 0.0
        """Time since the autopilot was switched on [s]; the plant's own time begins at the launch."""
        self.airspeed = performance.airspeed
        """Commanded where nothing else says [m/s]."""
        self.starts_on_ground = launcher is not None
        self.aim: Orbit | Course | None = None
        """What the plant was told last."""
        self._launcher = launcher
        self._been_up = launcher is None

    @property
    def state(self) -> PlantState:
        """State of the plant."""
        return self.plant.state

    @property
    def moving(self) -> bool:
        """True in flight."""
        return self.phase is Phase.FLYING

    @property
    def least_orbit(self) -> float:
        """No circle is flown narrower than this [m]."""
        return ORBIT_TURN_RADII * self.performance.turn_radius

    def ownship(self) -> Ownship:
        """Position and motion, at rest while it is held or has landed."""
        state = self.plant.state
        still = not self.moving
        return Ownship(
            time=state.time,
            north=state.north,
            east=state.east,
            altitude=state.altitude,
            velocity_north=0.0 if still else state.velocity_north,
            velocity_east=0.0 if still else state.velocity_east,
            climb_rate=0.0 if still else state.climb_rate,
            airspeed=0.0 if still else state.airspeed,
            heading=state.heading,
            bank=state.bank,
        )

    def vehicle_state(self) -> VehicleState:
        """The same as a world takes it."""
        return VehicleState(self.ownship())

    def launch(self) -> None:
        """Fly, if the aircraft has been held."""
        if self.phase is Phase.HELD:
            self.phase = Phase.FLYING
            if self._launcher is not None:
                self._launcher.launch()

    def advance(self, duration: float) -> None:
        """Let `duration` seconds pass."""
        self.clock += duration
        if not self.moving:
            return
        self.plant.step(duration)
        altitude = self.plant.state.altitude
        self._been_up = self._been_up or altitude > 10.0 * ON_GROUND
        if self._been_up and altitude <= ON_GROUND:
            self.phase = Phase.LANDED
            self.aim = None

    def fly(self, aim: Orbit | Course) -> None:
        """Fly a leg or a circle, within what can be flown; the plant is told only if it is another one."""
        if aim == self.aim:
            return
        self.aim = aim
        if isinstance(aim, Orbit):
            bounded = replace(aim, altitude=_within(aim.altitude, LOWEST, HIGHEST))
            bounded.command(self.plant, self.speed(self.airspeed))
        else:
            altitude = _within(aim[4], LOWEST, HIGHEST)
            self.plant.fly_leg(aim[0], aim[1], aim[2], aim[3], altitude, self.speed(aim[5]))

    def speed(self, wanted: float) -> float:
        """The airspeed that is flown when this one is asked for [m/s]."""
        cruise = self.performance.airspeed
        return _within(wanted, SPEEDS[0] * cruise, SPEEDS[1] * cruise)

    def orbit_radius(self, wanted: float) -> float:
        """The radius that is flown when this one is asked for [m]."""
        return _within(abs(wanted), self.least_orbit, LARGEST_ORBIT)

    def circle(self) -> Orbit:
        """A right-hand circle that begins here."""
        return Orbit.from_here(self.plant.state, self.least_orbit)

    def ahead(self, altitude: float | None = None) -> Course:
        """Straight on, at this altitude or another."""
        state = self.plant.state
        course = math.atan2(state.velocity_east, state.velocity_north) if self.moving else state.heading
        end = (state.north + AHEAD * math.cos(course), state.east + AHEAD * math.sin(course))
        at = state.altitude if altitude is None else altitude
        return (state.north, state.east, *end, at, self.airspeed)


def _within(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)
