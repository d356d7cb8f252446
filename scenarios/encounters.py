"""Encounters with traffic, drawn so that without avoidance every one comes too near."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from scenarios.scenario import TRAFFIC_VIOLATION_RADIUS, Home, Motion, Point, RadarSettings, Scenario, Traffic

LEG = 20_000.0
"""Length of the leg that is flown [m]."""
AIRSPEED = 15.0
"""Of the own vehicle [m/s]."""
ALTITUDE = 200.0
"""Everybody flies here [m]: nothing is solved by height."""
SLOWEST, FASTEST = 5.0, 60.0
"""Ground speeds of intruders [m/s]."""
LARGEST_MISS = 0.95 * TRAFFIC_VIOLATION_RADIUS
"""Closest approach of two that both fly straight on is at most this [m]."""
FIRST_SEEN_ONE, FIRST_SEEN_SEVERAL = 8_000.0, 10_000.0
"""An intruder is first seen no nearer than this, alone or as one of several [m]."""
AIRCRAFT_SPEEDS = (12.0, 22.0)
"""Intruders of these speeds can be flown by the aircraft model [m/s]."""
TURNS = (0.2, 0.7)
"""An intruder that turns does so between these parts of the time until it is nearest."""
LARGEST_TURN = math.pi / 2.0
"""It turns by no more than this [rad]."""
TURNS_FROM = 3_000.0
"""It is no nearer than this then [m]."""
RUN_OUT = 20_000.0
"""An intruder flies on for so far after the own vehicle's time limit [m]."""


@dataclass(frozen=True, slots=True)
class Intruder:
    """Constant velocity, and when and how near it would pass."""

    north: float
    """Where it is at the start [m]."""
    east: float
    """Where it is at the start [m]."""
    velocity_north: float
    """Over ground [m/s]."""
    velocity_east: float
    """Over ground [m/s]."""
    passes_at: float
    """Time of closest approach if nobody gives way [s]."""
    miss: float
    """Distance then [m]."""
    turns: tuple[float, float] | None = None
    """Time of a turn on to this course [s], and by how much it turns [rad]; None if it flies straight."""

    @property
    def speed(self) -> float:
        """Over ground [m/s]."""
        return math.hypot(self.velocity_north, self.velocity_east)

    def at(self, time: float) -> tuple[float, float]:
        """North and east at a time of the straight flight [m]."""
        return self.north + time * self.velocity_north, self.east + time * self.velocity_east

    @property
    def start(self) -> tuple[float, float]:
        """North and east at the start, before any turn [m]."""
        if self.turns is None:
            return self.north, self.east
        time, angle = self.turns
        north, east = self.at(time)
        course = math.atan2(self.velocity_east, self.velocity_north) - angle
        return north - time * self.speed * math.cos(course), east - time * self.speed * math.sin(course)

    @property
    def start_distance(self) -> float:
        """From the own vehicle at the start [m]."""
        return math.hypot(*self.start)


def draw_intruder(rng: np.random.Generator, first_seen: float) -> Intruder:
    """One intruder for an own vehicle that flies north from the origin at 15 m/s.

    Parameters
    ----------
    rng : Generator
        The only source of randomness.
    first_seen : float
        It is at least this far away at the start [m].

    Notes
    -----
    Speed, course and miss distance are uniform, so is the moment of closest approach among those on the leg
    at which it began far enough away. Only what closes so slowly that no such moment exists is drawn again.
    """
    duration = LEG / AIRSPEED
    while True:
        speed = rng.uniform(SLOWEST, FASTEST)
        course = rng.uniform(-math.pi, math.pi)
        miss = rng.uniform(-LARGEST_MISS, LARGEST_MISS)
        share = rng.random()
        north, east = speed * math.cos(course), speed * math.sin(course)
        closing_north, closing_east = north - AIRSPEED, east
        closing = math.hypot(closing_north, closing_east)
        earliest = math.sqrt(first_seen**2 - miss**2) / max(closing, 1e-9)
        if earliest >= duration:
            continue
        when = earliest + share * (duration - earliest)
        across = (-closing_east / closing * miss, closing_north / closing * miss)
        return Intruder(
            north=across[0] - closing_north * when,
            east=across[1] - closing_east * when,
            velocity_north=north,
            velocity_east=east,
            passes_at=when,
            miss=abs(miss),
        )


def draw_turning(rng: np.random.Generator, first_seen: float) -> Intruder:
    """One that turns on to its course while it is watched; arguments as of `draw_intruder`."""
    while True:
        straight = draw_intruder(rng, first_seen)
        time = rng.uniform(*TURNS) * straight.passes_at
        turning = replace(straight, turns=(time, rng.uniform(-LARGEST_TURN, LARGEST_TURN)))
        north, east = straight.at(time)
        distance = math.hypot(north - AIRSPEED * time, east)
        if turning.start_distance >= first_seen and distance >= TURNS_FROM:
            return turning


def encounter(
    rng: np.random.Generator,
    home: Home,
    *,
    intruders: int = 1,
    aircraft: bool = False,
    turning: bool = False,
) -> Scenario:
    """One leg of 20 km and the intruders that would pass within 1 km of whoever flies straight along it.

    Parameters
    ----------
    rng : Generator
        The only source of randomness.
    home : Home
        Origin of the map.
    intruders : int
        How many.
    aircraft : bool
        True flies those between 12 and 22 m/s on the aircraft model; the others are points.
    turning : bool
        True lets each turn on to its course on the way.

    Returns
    -------
    Scenario
        With a perfect radar.
    """
    first_seen = FIRST_SEEN_ONE if intruders == 1 else FIRST_SEEN_SEVERAL
    draw = draw_turning if turning else draw_intruder
    drawn = [draw(rng, first_seen) for _ in range(intruders)]
    mission = (Point(0.0, 0.0, ALTITUDE), Point(LEG, 0.0, ALTITUDE))
    return Scenario(
        name="encounter",
        description=describe(drawn),
        home=home,
        mission=mission,
        traffic=tuple(_traffic(k, one, aircraft) for k, one in enumerate(drawn, start=1)),
        radar=RadarSettings(),
    )


def describe(intruders: Sequence[Intruder]) -> str:
    """The encounters in words: speed, and from where relative to the own nose."""
    return "; ".join(_words(one) for one in intruders)


def _words(intruder: Intruder) -> str:
    bearing = math.degrees(math.atan2(*reversed(intruder.start)))
    side = "right" if bearing >= 0.0 else "left"
    turn = ""
    if intruder.turns is not None:
        time, angle = intruder.turns
        where = "right" if angle >= 0.0 else "left"
        turn = f", turns {math.degrees(abs(angle)):.0f} deg to the {where} after {time:.0f} s"
    return (
        f"{intruder.speed:.1f} m/s from {abs(bearing):.0f} deg {side}{turn}, would pass at "
        f"{intruder.miss:.0f} m after {intruder.passes_at:.0f} s"
    )


def _traffic(identity: int, intruder: Intruder, aircraft: bool) -> Traffic:
    lasts = 2.0 * LEG / AIRSPEED + RUN_OUT / intruder.speed
    corners = [intruder.start, intruder.at(lasts)]
    if intruder.turns is not None:
        corners.insert(1, intruder.at(intruder.turns[0]))
    points = tuple(Point(round(north, 3), round(east, 3), ALTITUDE) for north, east in corners)
    low, high = AIRCRAFT_SPEEDS
    motion: Motion = "6dof" if aircraft and low <= intruder.speed <= high else "point"
    return Traffic(identity, points, speed=intruder.speed, motion=motion)
