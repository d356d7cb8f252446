"""A point that flies legs and orbits with a limited rate of turn: enough aircraft to test a vehicle with."""

from __future__ import annotations

import math
from dataclasses import dataclass

from avoidance import Performance
from offboard.frames import MapFrame

HOME = MapFrame(14.39, 76.60, 600.0)
PERFORMANCE = Performance(
    airspeed=15.0,
    max_bank=math.radians(30.0),
    roll_time=1.0,
    acceptance_radius=100.0,
    tracking_error=5.0,
)
TURN_RATE = 9.81 * math.tan(PERFORMANCE.max_bank) / PERFORMANCE.airspeed


@dataclass(slots=True)
class FakeState:
    """State of the point; map metres, radians, m/s."""

    time: float = 0.0
    north: float = 0.0
    east: float = 0.0
    altitude: float = 200.0
    heading: float = 0.0
    airspeed: float = 15.0
    climb_rate: float = 0.0
    bank: float = 0.0
    pitch: float = 0.0

    @property
    def velocity_north(self) -> float:
        return self.airspeed * math.cos(self.heading)

    @property
    def velocity_east(self) -> float:
        return self.airspeed * math.sin(self.heading)


class FakePlant:
    """Satisfies `offboard.link.Plant`; keeps the commands it was given."""

    def __init__(self, north: float = 0.0, east: float = 0.0, heading: float = 0.0) -> None:
        self._state = FakeState(north=north, east=east, heading=heading)
        self.commands: list[tuple[str, tuple[float, ...]]] = []
        self.track: list[tuple[float, float]] = []

    @property
    def state(self) -> FakeState:
        return self._state

    @property
    def command(self) -> tuple[str, tuple[float, ...]]:
        return self.commands[-1]

    def fly_leg(self, *leg: float) -> None:
        self.commands.append(("leg", leg))

    def fly_orbit(self, *orbit: float) -> None:
        self.commands.append(("orbit", orbit))

    def set_wind(self, north: float, east: float, down: float = 0.0) -> None:
        raise NotImplementedError("the point flies in still air")

    def step(self, duration: float) -> None:
        substeps = max(1, round(duration / 0.2))
        for _ in range(substeps):
            self._move(duration / substeps)
        self.track.append((self._state.north, self._state.east))

    def _move(self, dt: float) -> None:
        state = self._state
        kind, numbers = self.command
        altitude, airspeed = numbers[-2:]
        course = self._leg_course(*numbers[:4]) if kind == "leg" else self._orbit_course(*numbers[:4])
        error = math.remainder(course - state.heading, math.tau)
        state.heading += max(-TURN_RATE * dt, min(TURN_RATE * dt, error))
        state.airspeed = airspeed
        state.altitude += max(-3.0 * dt, min(3.0 * dt, altitude - state.altitude))
        state.north += state.velocity_north * dt
        state.east += state.velocity_east * dt
        state.time += dt

    def _leg_course(self, from_north: float, from_east: float, to_north: float, to_east: float) -> float:
        along = math.atan2(to_east - from_east, to_north - from_north)
        north, east = self._state.north - from_north, self._state.east - from_east
        cross = east * math.cos(along) - north * math.sin(along)
        return along - math.atan(cross / 40.0)

    def _orbit_course(self, north: float, east: float, radius: float, direction: float) -> float:
        out_north, out_east = self._state.north - north, self._state.east - east
        outward = math.atan2(out_east, out_north)
        excess = math.hypot(out_north, out_east) - radius
        return outward + direction * (0.5 * math.pi + math.atan(excess / 40.0))
