"""Mistakes that only show between the fields of a scenario."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable

from scenarios.errors import Problem
from scenarios.scenario import LEAST_AIR_MARGIN, Scenario
from scenarios.schema import ScenarioTable

Key = Callable[..., str]
AIRCRAFT_SPEEDS = (12.0, 22.0)
"""Airspeeds the aircraft model is made for [m/s]."""


def semantic_problems(scenario: Scenario, table: ScenarioTable, key: Key) -> list[Problem]:
    """All mistakes between fields; `key(list, index, key)` names a place in the file."""
    return [
        *_mission(scenario, key),
        *_ids(scenario, table, key),
        *_start(scenario, key),
        *_traffic(scenario, key),
        *_random(scenario),
        *_aircraft(scenario),
        *wind_problems(scenario),
    ]


def wind_problems(scenario: Scenario) -> list[Problem]:
    """A wind that the vehicle cannot be flown in."""
    speeds = [scenario.vehicle.airspeed, *(p.speed for p in scenario.mission if p.speed is not None)]
    allowed = min(speeds) - LEAST_AIR_MARGIN
    if scenario.wind.speed <= allowed:
        return []
    shown = f"{scenario.wind.north:g},{scenario.wind.east:g}"
    message = (
        f"blows at {scenario.wind.speed:.1f} m/s; allowed are at most {allowed:g} m/s, "
        f"{LEAST_AIR_MARGIN:g} m/s less than the slowest airspeed"
    )
    return [Problem(f"wind {shown}", None, message)]


def _mission(scenario: Scenario, key: Key) -> list[Problem]:
    problems = []
    for index, (before, after) in enumerate(zip(scenario.mission, scenario.mission[1:], strict=False)):
        if math.hypot(after.north - before.north, after.east - before.east) < 1.0:
            message = "lies on the waypoint before it; they must be at least 1 m apart"
            problems.append(Problem(key("mission", index + 1), None, message))
    return problems


def _ids(scenario: Scenario, table: ScenarioTable, key: Key) -> list[Problem]:
    counts = Counter(o.id for o in scenario.obstacles) + Counter(t.id for t in scenario.traffic)
    places = [("obstacles", i, row.id) for i, row in enumerate(table.obstacles)]
    places += [("traffic", i, row.id) for i, row in enumerate(table.traffic)]
    seen = set()
    problems = []
    for name, index, identity in places:
        if identity is None or counts[identity] < 2:
            continue
        if identity in seen:
            message = "is used twice; ids must differ among all obstacles and traffic"
            problems.append(Problem(key(name, index, "id"), identity, message))
        seen.add(identity)
    return problems


def _start(scenario: Scenario, key: Key) -> list[Problem]:
    start = scenario.mission[0]
    problems = []
    for index, obstacle in enumerate(scenario.obstacles):
        away = (obstacle.north - start.north, obstacle.east - start.east, obstacle.altitude - start.altitude)
        distance = math.hypot(*away)
        at_once = obstacle.appears_at <= scenario.radar.period  # nobody can decide anything before
        if distance <= obstacle.safety_radius and at_once:
            message = (
                f"the start is inside its sphere: {distance:.0f} m from its centre, which must be more than "
                f"its radius of {obstacle.safety_radius:g} m"
            )
            problems.append(
                Problem(key("obstacles", index, "safety_radius_m"), obstacle.safety_radius, message)
            )
    return problems


def _traffic(scenario: Scenario, key: Key) -> list[Problem]:
    low, high = AIRCRAFT_SPEEDS
    problems = []
    for index, flight in enumerate(scenario.traffic):
        if flight.motion != "point" and not low <= flight.speed <= high:
            message = f'must be at least {low:g} and at most {high:g} unless motion = "point"'
            problems.append(Problem(key("traffic", index, "speed_m_s"), flight.speed, message))
        if flight.motion != "point" and scenario.wind.speed > flight.speed - LEAST_AIR_MARGIN:
            message = f"is too slow for a wind of {scenario.wind.speed:.1f} m/s"
            problems.append(Problem(key("traffic", index, "speed_m_s"), flight.speed, message))
        for before, after in zip(flight.waypoints, flight.waypoints[1:], strict=False):
            if math.hypot(after.north - before.north, after.east - before.east) < 1.0:
                message = "two waypoints in a row must be at least 1 m apart"
                problems.append(Problem(key("traffic", index, "waypoints"), None, message))
                break
    return problems


def _random(scenario: Scenario) -> list[Problem]:
    settings = scenario.random
    if settings is None:
        return []
    least = max(settings.clear_of_start, settings.safety_radius) / 4.0
    if settings.sigma >= least:
        return []
    message = f"must be at least {least:g}, or nearly every draw falls too close to the start"
    return [Problem("random.sigma_m", settings.sigma, message)]


def _aircraft(scenario: Scenario) -> list[Problem]:
    from fmu.parameters import aircraft_names  # noqa: PLC0415

    names = aircraft_names()
    if scenario.vehicle.aircraft in names:
        return []
    return [Problem("vehicle.aircraft", scenario.vehicle.aircraft, f"is unknown; known: {', '.join(names)}")]
