"""Small worlds in which nothing is ever first seen nearer than its sphere 1 km away, and flights in them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import pairwise

import numpy as np

from avoidance import RadarScan
from avoidance.agent import Agent
from avoidance.parameters import DEFAULT
from fmu.library import FmuLibrary
from scenarios.fence import FenceArea, breaches, core_fence
from scenarios.hangar import Hangar
from scenarios.load import load
from scenarios.metrics import Separation, separations
from scenarios.scenario import Fidelity, Obstacle, Point
from scenarios.track import Track

ALTITUDE = 200.0
ROOM = 1000.0
"""Nothing that is new is nearer than its radius and this [m]."""
NEAR = 400.0
"""Nearer to a sphere or the fence than this the track is taken ten times a second, else once [m]."""


@dataclass(frozen=True)
class Disc:
    """Something that stands still."""

    north: float
    east: float
    radius: float


@dataclass(frozen=True)
class PopUp:
    """Something that begins to exist at a time, seen from where the vehicle is then."""

    time: float
    """[s]"""
    bearing_deg: float
    """From the vehicle's course."""
    further: float
    """Further away than it must be [m]."""
    radius: float


@dataclass(frozen=True)
class Walls:
    """Two walls of discs along a corridor, perhaps closed at its far end."""

    north: float
    east: float
    """Middle of the mouth."""
    bearing_deg: float
    width: float
    """Between the spheres, at the narrowest."""
    length: float
    radius: float
    closed: bool
    open_side: int = 0
    """-1: no left wall, +1: no right wall."""

    def discs(self) -> list[Disc]:
        """The discs."""
        half, spacing = 0.5 * self.width + self.radius, 0.8 * self.radius
        steps = range(int(self.length / spacing) + 1)
        places = [(spacing * k, side * half) for k in steps for side in (-1, 1) if side != self.open_side]
        if self.closed:
            count = int(2.0 * half / spacing) + 1
            places += [(spacing * steps[-1], -half + 2.0 * half * k / count) for k in range(1, count)]
        cosine, sine = math.cos(math.radians(self.bearing_deg)), math.sin(math.radians(self.bearing_deg))
        return [
            Disc(self.north + cosine * a - sine * b, self.east + sine * a + cosine * b, self.radius)
            for a, b in places
        ]


@dataclass(frozen=True)
class World:
    """What is flown."""

    mission: tuple[tuple[float, float], ...] = ((12_000.0, 0.0),)
    """After the start at the origin."""
    discs: tuple[Disc, ...] = ()
    walls: tuple[Walls, ...] = ()
    pop_ups: tuple[PopUp, ...] = ()
    wind: tuple[float, float] = (0.0, 0.0)
    sight: float = 10_000.0
    """Range of the radar [m]."""
    fence: tuple[FenceArea, ...] = ()
    """Areas to stay in and out of; those that would bar the start are left out."""


@dataclass(frozen=True)
class Flight:
    """What came of it."""

    entries: tuple[Separation, ...]
    """Spheres that were entered."""
    breaches: tuple[tuple[float, float], ...]
    """When the vehicle was outside the geofence [s]."""
    finished: bool
    decisions: tuple[str, ...]
    """Each that was not to keep on, with its time."""
    track: Track = field(repr=False)


@cache
def _library() -> FmuLibrary:
    return FmuLibrary.open()


def fly(world: World, fidelity: Fidelity = "kinematic") -> Flight:
    """Fly a world; obstacles that stand too near to the start to be seen in time are left out."""
    standing = [d for d in (*world.discs, *(d for w in world.walls for d in w.discs())) if _in_time(d)]
    scenario = load("single")
    start = scenario.mission[0]
    places = ((0.0, 0.0), *world.mission)
    points = tuple(replace(start, north=n, east=e, altitude=ALTITUDE) for n, e in places)
    scenario = replace(
        scenario,
        mission=points,
        wind=replace(scenario.wind, north=world.wind[0], east=world.wind[1]),
        vehicle=replace(scenario.vehicle, fidelity=fidelity),
    )
    with Hangar(scenario, DEFAULT, _library()) as hangar:
        return _flown(world, standing, points, hangar)


def _in_time(disc: Disc) -> bool:
    return math.hypot(disc.north, disc.east) >= disc.radius + ROOM


def _flown(world: World, standing: list[Disc], points: tuple[Point, ...], hangar: Hangar) -> Flight:
    vehicle = hangar.own_vehicle(points)
    fence = tuple(area for area in world.fence if _lets_start(area))
    agent = Agent(vehicle.performance, DEFAULT, np.random.default_rng(0), geofence=core_fence(fence))
    obstacles = [_obstacle(k, disc, 0.0) for k, disc in enumerate(standing)]
    due = sorted(world.pop_ups, key=lambda p: p.time)
    table = _table(obstacles)
    samples, said = [], []
    legs = [math.dist((a.north, a.east), (b.north, b.east)) for a, b in pairwise(points)]
    limit = 600.0 + 2.0 * sum(legs) / 8.0
    now = 0.0
    while not vehicle.finished and now < limit:
        own = vehicle.state().ownship
        samples.append((own.time, own.north, own.east, own.altitude))
        while due and due[0].time <= now:
            new, due = due[0], due[1:]
            angle, away = own.course + math.radians(new.bearing_deg), new.radius + ROOM + new.further
            disc = Disc(own.north + away * math.cos(angle), own.east + away * math.sin(angle), new.radius)
            obstacles.append(_obstacle(len(obstacles), disc, own.time))
            table = _table(obstacles)
        distance = np.hypot(table[:, 1] - own.north, table[:, 2] - own.east)
        seen = np.flatnonzero(distance <= world.sight)
        scan = RadarScan(own.time, table[seen, 0].astype(np.int64), table[seen, 1:4], table[seen, 4])
        decision = agent.decide(own, vehicle.route(), scan)
        if decision.name != "keep":
            said.append(f"{now:.0f} s ({own.north:.0f}, {own.east:.0f}) {decision.name}: {decision.why}")
        vehicle.begin(decision)
        here = np.array([[own.north, own.east]])
        near = (distance - table[:, 4] < NEAR).any() or any(a.distance_to_edge(here)[0] < NEAR for a in fence)
        steps = 10 if near else 1
        for step in range(1, steps + 1):
            vehicle.advance(1.0 / steps)
            if step < steps:
                own = vehicle.state().ownship
                samples.append((own.time, own.north, own.east, own.altitude))
        now += 1.0
    values = np.array(samples)
    idle = np.zeros(len(values))
    track = Track("own", values[:, 0], values[:, 1:4], idle, idle, idle)
    entered = tuple(s for s in separations(track, obstacles) if s.entries)
    outside = tuple(breaches(track, fence))
    return Flight(entered, outside, vehicle.finished, tuple(said), track)


def _lets_start(area: FenceArea) -> bool:
    """Whether the start lies well on the right side of an area."""
    start = np.zeros((1, 2))
    return bool(area.holds(start)[0]) == area.include and float(area.distance_to_edge(start)[0]) >= ROOM


def _obstacle(number: int, disc: Disc, time: float) -> Obstacle:
    return Obstacle(number + 1, disc.north, disc.east, ALTITUDE, disc.radius, time)


def _table(obstacles: list[Obstacle]) -> np.ndarray:
    rows = [(o.id, o.north, o.east, o.altitude, o.safety_radius) for o in obstacles]
    return np.array(rows, dtype=np.float64).reshape(-1, 5)
