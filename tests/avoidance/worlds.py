"""Small worlds that several tests use."""

from __future__ import annotations

import math

import numpy as np

from avoidance import Ownship, Performance, RadarScan, Route, Waypoint
from avoidance.parameters import DEFAULT, Parameters
from avoidance.prediction import Intruders
from avoidance.problem import WaypointProblem

PERFORMANCE = Performance(
    airspeed=15.0, max_bank=math.radians(30.0), roll_time=1.0, acceptance_radius=100.0, tracking_error=5.0
)


def ownship(north: float = 0.0, east: float = 0.0, course_deg: float = 0.0, time: float = 0.0) -> Ownship:
    """A vehicle at 200 m and 15 m/s."""
    course = math.radians(course_deg)
    return Ownship(
        time=time,
        north=north,
        east=east,
        altitude=200.0,
        velocity_north=15.0 * math.cos(course),
        velocity_east=15.0 * math.sin(course),
        airspeed=15.0,
        heading=course,
    )


def route(*points: tuple[float, float], origin: tuple[float, float] = (0.0, 0.0)) -> Route:
    """A route of mission items at 200 m; item 0 is the origin."""
    return Route(
        Waypoint(*origin, 200.0, item=0),
        tuple(Waypoint(north, east, 200.0, item=i + 1) for i, (north, east) in enumerate(points)),
    )


def scan(
    positions: list[tuple[float, float]], time: float = 0.0, radius: float = 1000.0, altitude: float = 200.0
) -> RadarScan:
    """A perfect scan of obstacles at flight altitude, identities from 1."""
    count = len(positions)
    table = np.array([(north, east, altitude) for north, east in positions], dtype=np.float64)
    return RadarScan(time, np.arange(1, count + 1), table.reshape(-1, 3), np.full(count, radius))


def intruders(*rows: tuple[float, float, float, float], margin: float = 100.0) -> Intruders:
    """Surely tracked intruders at flight altitude: north, east and their rates."""
    table = np.array(rows, dtype=np.float64)
    none = np.zeros(len(rows))
    return Intruders(
        positions=table[:, :2],
        velocities=table[:, 2:],
        altitudes=none + 200.0,
        climbs=none,
        radii=none + 1000.0,
        sigma=none,
        speed_sigma=none,
        ages=none + 1000.0,
        most=none + math.inf,
        until=none + math.inf,
        band=(185.0, 215.0),
        margin=margin,
    )


def problem(
    centres: list[tuple[float, float]],
    target: tuple[float, float] = (70_000.0, 0.0),
    parameters: Parameters = DEFAULT,
    relaxed: frozenset[str] = frozenset(),
    intruders: Intruders | None = None,
) -> WaypointProblem:
    """A search from the origin, flying north, round all of some obstacles."""
    table = np.array(centres, dtype=np.float64).reshape(-1, 2)
    count = len(table)
    return WaypointProblem(
        start=(0.0, 0.0),
        target=target,
        course=0.0,
        before=None,
        centres=table,
        keep=np.full(count, 1000.0 + parameters.margin),
        keep_waypoint=np.full(count, 2000.0),
        avoided=np.arange(count),
        intruders=Intruders() if intruders is None else intruders,
        delay=0.0,
        performance=PERFORMANCE,
        parameters=parameters,
        relaxed=relaxed,
    )
