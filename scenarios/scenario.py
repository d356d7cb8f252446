"""A scenario: what is flown, where, and what is in the way. Plain immutable values, already validated."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path
from typing import Literal

import numpy as np

from scenarios.fence import FenceArea

NEAR = 3000.0
"""Within this distance of anything that could be hit, flights are recorded at 10 Hz [m]."""
TRAFFIC_VIOLATION_RADIUS = 1000.0
"""Coming closer than this to moving traffic is a violation unless the scenario says otherwise [m]."""
START_ROOM = 500.0
"""No drawn obstacle's sphere comes nearer to the start than this [m]."""
LEAST_AIR_MARGIN = 3.0
"""The wind must be slower than the airspeed by at least this [m/s]."""

_AIR = 2**32 - 1
"""Where the seeds of turbulence branch off those of the flight; `streams` does not get there."""

OWN = "own"
"""Name of a vehicle that flies alone."""

Fidelity = Literal["6dof", "kinematic"]
Turbulence = Literal["none", "light", "moderate", "severe"]
WIND_AT_20_FT: dict[Turbulence, float] = {"none": 0.0, "light": 7.72, "moderate": 15.43, "severe": 23.15}
"""W20, the wind 20 ft above ground that makes turbulence [m/s]: 15, 30 and 45 kt (MIL-F-8785C, 3.7.2.1)."""
Motion = Literal["6dof", "kinematic", "point"]
TURBULENCES: dict[str, Turbulence] = {word: word for word in WIND_AT_20_FT}
"""Intensities of turbulence by the name that users give."""
FIDELITIES: dict[str, Fidelity] = {"6dof": "6dof", "kinematic": "kinematic"}
"""Equations of motion by the name that users give."""


@dataclass(frozen=True, slots=True)
class Home:
    """Origin of the map."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float
    """Of the ground, above mean sea level."""


@dataclass(frozen=True, slots=True)
class Point:
    """A point to fly through, in the map frame."""

    north: float
    """North of home [m]."""
    east: float
    """East of home [m]."""
    altitude: float
    """Above home [m]."""
    speed: float | None = None
    """Airspeed from there on [m/s]; None leaves it as it is."""


@dataclass(frozen=True, slots=True)
class Obstacle:
    """Something that stands still, with the sphere round it that may not be entered."""

    id: int
    north: float
    """North of home [m]."""
    east: float
    """East of home [m]."""
    altitude: float
    """Above home [m]."""
    safety_radius: float
    """RS, the radius of its sphere [m]."""
    appears_at: float = 0.0
    """It exists from this time on [s]."""
    kind: str = "stationary"
    """A word for tables and maps."""


@dataclass(frozen=True, slots=True)
class Traffic:
    """A moving obstacle: flies its own waypoints from `starts_at` on and is gone after the last."""

    id: int
    waypoints: tuple[Point, ...]
    speed: float = 15.0
    """True airspeed of an aircraft, ground speed of a point [m/s]."""
    starts_at: float = 0.0
    """It exists from this time on [s]."""
    motion: Motion = "6dof"
    """An aircraft of the same kind (6dof, kinematic), or a point at constant speed over ground."""
    violation_radius: float | None = None
    """Coming closer is a violation [m]; None takes the usual radius and the core decides what to keep."""

    @property
    def radius(self) -> float:
        """Violation radius [m]."""
        return TRAFFIC_VIOLATION_RADIUS if self.violation_radius is None else self.violation_radius


@dataclass(frozen=True, slots=True)
class Wind:
    """Velocity of the air over ground [m/s]: a steady part, and turbulence about it."""

    north: float = 0.0
    east: float = 0.0
    turbulence: Turbulence = "none"
    """Intensity by MIL-F-8785C; the gusts are seeded by the flight's seed."""

    @property
    def speed(self) -> float:
        """Magnitude of the steady part [m/s]."""
        return math.hypot(self.north, self.east)

    @property
    def gusts(self) -> float:
        """Two standard deviations of the gusts along one horizontal axis [m/s].

        At 100 m above ground; at 200 m they are a fifth less.
        """
        return 2.0 * 0.138 * WIND_AT_20_FT[self.turbulence]


@dataclass(frozen=True, slots=True)
class RadarSettings:
    """What the simulated radar can do; its faults are off unless asked for."""

    range: float = 10_000.0
    """It sees up to this distance [m]."""
    period: float = 1.0
    """Time between sweeps [s]."""
    range_noise: float = 0.0
    """Standard deviation of a measured range [m]."""
    bearing_noise: float = 0.0
    """Standard deviation of a measured bearing [rad]."""
    detection_probability: float = 1.0
    """Chance that one sweep shows an obstacle in range."""
    field_of_view: float = 2.0 * math.pi
    """Full opening angle about the nose [rad]."""
    latency: float = 0.0
    """Age of a sweep when it is delivered [s]."""
    false_tracks: float = 0.0
    """Mean number of returns per sweep from nothing at all."""
    id_swaps: float = 0.0
    """Chance that a sweep exchanges the identities of two obstacles for good."""


@dataclass(frozen=True, slots=True)
class VehicleSettings:
    """The own vehicle."""

    aircraft: str = "skywalker_x8"
    """Name of a parameter set."""
    fidelity: Fidelity = "6dof"
    plant: Path | None = None
    """A user's own FMU in its place: the mapping file (`fmu.mapping`), absolute."""
    airspeed: float = 15.0
    """Cruise true airspeed [m/s]."""
    acceptance_radius: float | None = None
    """A waypoint counts as reached within this distance [m]; None takes the preset's."""
    heading: float | None = None
    """Direction of the nose at the start [rad]; None points along the first leg."""
    position_error: float = 0.0
    """Standard deviation of the horizontal position that the vehicle reports [m]."""
    decision_latency: float = 0.0
    """Time that a decision takes which changes the route [s]."""


@dataclass(frozen=True, slots=True)
class Member:
    """One of several own vehicles; all are alike."""

    id: int
    """How the others' radars name it."""
    name: str
    mission: tuple[Point, ...]
    """The first point is where it begins."""


@dataclass(frozen=True, slots=True)
class RandomField:
    """Obstacles scattered about the waypoints (the paper's Sec. 5.6)."""

    count: int = 40
    """How many obstacles."""
    sigma: float = 3000.0
    """Standard deviation about the waypoint, per axis [m]."""
    clear_of_start: float = 2000.0
    """A draw this close to the start is drawn again [m]."""
    safety_radius: float = 1000.0
    """RS of each [m]; the least of them if they differ."""
    largest_safety_radius: float | None = None
    """Radii are uniform up to this [m]; None makes all alike."""

    @property
    def largest(self) -> float:
        """Largest RS that can be drawn [m]."""
        return self.safety_radius if self.largest_safety_radius is None else self.largest_safety_radius


@dataclass(frozen=True, slots=True)
class Scenario:
    """Everything a flight depends on beside the seed."""

    name: str
    home: Home
    mission: tuple[Point, ...]
    """The first point is where the flight begins."""
    description: str = ""
    start_time_utc: datetime = datetime(2020, 3, 21, 2, 30, tzinfo=UTC)
    obstacles: tuple[Obstacle, ...] = ()
    traffic: tuple[Traffic, ...] = ()
    wind: Wind = field(default_factory=Wind)
    radar: RadarSettings = field(default_factory=RadarSettings)
    vehicle: VehicleSettings = field(default_factory=VehicleSettings)
    random: RandomField | None = None
    """Obstacles still to be drawn; None once they are."""
    time_limit: float | None = None
    """The flight is broken off after this time [s]; None takes twice the nominal time."""
    seed: int = 0
    """All randomness of a flight comes from it, unless another one is given."""
    preset: str = "default"
    """Parameters of the avoidance core it is flown with, unless others are given."""
    planner: str = "pso"
    """Planner of ways round it is flown with, unless another is given."""
    geofence: tuple[FenceArea, ...] = ()
    """Where vehicles may be; empty for everywhere."""
    rally: tuple[Point, ...] = ()
    """Rally points: where to wait if no way is free; empty for the spot."""
    vehicles: tuple[Member, ...] = ()
    """Several own vehicles, each with its mission; empty for one that flies `mission`."""

    @property
    def fleet(self) -> tuple[Member, ...]:
        """All own vehicles."""
        return self.vehicles or (Member(-1, OWN, self.mission),)

    @property
    def limit(self) -> float:
        """Time after which the flight is broken off [s]."""
        if self.time_limit is not None:
            return self.time_limit
        return 2.0 * max(nominal_time(self, member.mission) for member in self.fleet)


def ground_speed(airspeed: float, wind: Wind, north: float, east: float) -> float:
    """Speed over ground along the direction (north, east) when crabbing into the wind [m/s].

    Raises
    ------
    ValueError
        If the wind blows the vehicle backwards or off the leg.
    """
    length = math.hypot(north, east)
    along = (wind.north * north + wind.east * east) / length
    across = (wind.east * north - wind.north * east) / length
    if abs(across) >= airspeed:
        raise ValueError(f"a crosswind of {abs(across):.1f} m/s cannot be flown at airspeed {airspeed:g} m/s")
    speed = math.sqrt(airspeed**2 - across**2) + along
    if speed <= 0.0:
        raise ValueError(f"a headwind of {-along:.1f} m/s cannot be flown at airspeed {airspeed:g} m/s")
    return speed


def nominal_time(scenario: Scenario, mission: Sequence[Point] | None = None) -> float:
    """Time of a mission without obstacles: leg by leg, length over ground speed in the wind [s]."""
    mission = scenario.mission if mission is None else mission
    total = 0.0
    speed = scenario.vehicle.airspeed
    for start, end in pairwise(mission):
        north, east = end.north - start.north, end.east - start.east
        speed = speed if start.speed is None else start.speed
        if north or east:
            total += math.hypot(north, east) / ground_speed(speed, scenario.wind, north, east)
    return total


def scatter(scenario: Scenario, rng: np.random.Generator) -> Scenario:
    """Draw the obstacles of the `random` table.

    Returns
    -------
    Scenario
        The same with the drawn obstacles added and no `random` left; positions on whole millimetres.

    Notes
    -----
    Sec. 5.6: a normal distribution about each waypoint. Obstacle i belongs to waypoint i mod n; a draw too
    close to the start is drawn again.
    """
    settings = scenario.random
    if settings is None:
        return scenario
    start = scenario.mission[0]
    others = (scenario.obstacles, scenario.traffic, scenario.vehicles)
    used = {one.id for group in others for one in group}
    free_ids = (i for i in range(1, settings.count + len(used) + 1) if i not in used)
    drawn = []
    for index in range(settings.count):
        waypoint = scenario.mission[index % len(scenario.mission)]
        radius = settings.safety_radius
        if settings.largest_safety_radius is not None:
            radius = round(float(rng.uniform(radius, settings.largest_safety_radius)), 3)
        clear = max(settings.clear_of_start, radius + START_ROOM)
        while True:
            north, east = rng.normal((waypoint.north, waypoint.east), settings.sigma)
            if math.hypot(north - start.north, east - start.east) >= clear:
                break
        drawn.append(
            Obstacle(
                id=next(free_ids),
                north=round(float(north), 3),
                east=round(float(east), 3),
                altitude=waypoint.altitude,
                safety_radius=radius,
                kind="random",
            )
        )
    return replace(scenario, obstacles=scenario.obstacles + tuple(drawn), random=None)


def turbulence_seed(seed: int, number: int) -> int:
    """Seed of the gusts about one aircraft, from that of the flight: each flies in air of its own.

    Parameters
    ----------
    seed : int
        Of the flight.
    number : int
        Of the aircraft, own vehicles first.

    Returns
    -------
    int
        Within 0 to 2³¹ − 1; independent of everything that `streams` gives.
    """
    children = np.random.SeedSequence(seed, spawn_key=(_AIR, number))
    return int(children.generate_state(1)[0] >> 1)


def streams(seed: int, vehicle: int = 0) -> Mapping[str, np.random.Generator]:
    """Independent random number generators, all from one seed.

    Parameters
    ----------
    seed : int
        Of the flight.
    vehicle : int
        Number of the own vehicle; each has its own generators, "world" is that of number 0.
    """
    names = ("world", "radar", "planner", "navigation")
    key = (len(names) + vehicle,) if vehicle else ()
    children = np.random.SeedSequence(seed, spawn_key=key).spawn(len(names))
    return {name: np.random.default_rng(child) for name, child in zip(names, children, strict=True)}
