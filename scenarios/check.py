"""Mistakes that only show between the fields of a scenario."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from scenarios.errors import Problem
from scenarios.fence import Place, allowed
from scenarios.scenario import LEAST_AIR_MARGIN, TRAFFIC_VIOLATION_RADIUS, Point, Scenario
from scenarios.schema import ScenarioTable
from scenarios.user_plant import plant_problems

Key = Callable[..., str]
LEAST_BREADTH = 1.0
"""The corners of a geofence's polygon lie further than this from being on one line [m]."""
AIRCRAFT_SPEEDS = (12.0, 22.0)
"""Airspeeds the aircraft model is made for [m/s]."""


def semantic_problems(scenario: Scenario, table: ScenarioTable, key: Key) -> list[Problem]:
    """All mistakes between fields; `key(list, index, key)` names a place in the file."""
    return [
        *_mission(scenario, key),
        *_ids(scenario, table, key),
        *_start(scenario, key),
        *_traffic(scenario, key),
        *_vehicles(scenario, key),
        *_fence(scenario, key),
        *_rally(scenario, key),
        *_random(scenario),
        *_airspeeds(scenario, key),
        *_aircraft(scenario),
        *plant_problems(scenario),
        *wind_problems(scenario),
    ]


def wind_problems(scenario: Scenario) -> list[Problem]:
    """A wind that the vehicle cannot be flown in."""
    points = [point for member in scenario.fleet for point in member.mission]
    speeds = [scenario.vehicle.airspeed, *(p.speed for p in points if p.speed is not None)]
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
    groups = (scenario.obstacles, scenario.traffic, scenario.vehicles)
    counts = Counter(one.id for group in groups for one in group)
    places = [("obstacles", i, row.id) for i, row in enumerate(table.obstacles)]
    places += [("traffic", i, row.id) for i, row in enumerate(table.traffic)]
    places += [("vehicles", i, row.id) for i, row in enumerate(table.vehicles)]
    seen = set()
    problems = []
    for name, index, identity in places:
        if identity is None or counts[identity] < 2:
            continue
        if identity in seen:
            message = "is used twice; ids must differ among all obstacles, traffic and vehicles"
            problems.append(Problem(key(name, index, "id"), identity, message))
        seen.add(identity)
    return problems


def _start(scenario: Scenario, key: Key) -> list[Problem]:
    problems = []
    for index, obstacle in enumerate(scenario.obstacles):
        centre = Point(obstacle.north, obstacle.east, obstacle.altitude)
        distance = min(_apart(centre, member.mission[0]) for member in scenario.fleet)
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


def _vehicles(scenario: Scenario, key: Key) -> list[Problem]:
    problems = []
    for index, member in enumerate(scenario.vehicles):
        before = scenario.vehicles[:index]
        if any(member.name == other.name for other in before):
            problems.append(Problem(key("vehicles", index, "name"), member.name, "is used twice"))
        for start, end in pairwise(member.mission):
            if math.hypot(end.north - start.north, end.east - start.east) < 1.0:
                message = "two waypoints in a row must be at least 1 m apart"
                problems.append(Problem(key("vehicles", index, "mission"), None, message))
                break
        distance = min((_apart(member.mission[0], other.mission[0]) for other in before), default=math.inf)
        if distance <= TRAFFIC_VIOLATION_RADIUS:
            message = (
                f"begins {distance:.0f} m from another vehicle; they must begin more than "
                f"{TRAFFIC_VIOLATION_RADIUS:g} m apart"
            )
            problems.append(Problem(key("vehicles", index), None, message))
    return problems


def _fence(scenario: Scenario, key: Key) -> list[Problem]:
    problems = []
    for index, area in enumerate(scenario.geofence):
        if area.corners and _breadth(area.corners) < LEAST_BREADTH:
            message = "encloses nothing: its corners lie on one line, or on one spot"
            problems.append(Problem(key("geofence", index, "polygon"), None, message))
    if problems:
        return problems
    for index, member in enumerate(scenario.fleet):
        outside = [
            number
            for number, point in enumerate(member.mission, start=1)
            if not allowed(scenario.geofence, np.array([[point.north, point.east]]))[0]
        ]
        if outside:
            place = key("vehicles", index) if scenario.vehicles else key("mission", outside[0] - 1)
            which = f"waypoint {outside[0]} lies"
            if len(outside) > 1:
                which = f"waypoints {', '.join(map(str, outside))} lie"
            problems.append(Problem(place, None, f"{which} outside the geofence"))
    return problems


def _rally(scenario: Scenario, key: Key) -> list[Problem]:
    return [
        Problem(key("rally", index), None, "lies outside the geofence, where nobody may wait")
        for index, point in enumerate(scenario.rally)
        if not allowed(scenario.geofence, np.array([[point.north, point.east]]))[0]
    ]


def _breadth(corners: Sequence[Place]) -> float:
    """How far corners lie off the line that fits them best, root of the summed squares [m]."""
    off = np.array(corners) - np.mean(corners, axis=0)
    return float(np.linalg.svd(off, compute_uv=False)[-1])


def _apart(a: Point, b: Point) -> float:
    return math.dist((a.north, a.east, a.altitude), (b.north, b.east, b.altitude))


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
    problems = []
    if settings.largest < settings.safety_radius:
        message = f"must be at least safety_radius_m, {settings.safety_radius:g}"
        problems.append(Problem("random.largest_safety_radius_m", settings.largest, message))
    least = max(settings.clear_of_start, settings.largest) / 4.0
    if settings.sigma < least:
        message = f"must be at least {least:g}, or nearly every draw falls too close to the start"
        problems.append(Problem("random.sigma_m", settings.sigma, message))
    return problems


def _airspeeds(scenario: Scenario, key: Key) -> list[Problem]:
    """Airspeeds that the aircraft model is not made for; a plant of the user's own has limits of its own."""
    if scenario.vehicle.plant is not None:
        return []
    low, high = AIRCRAFT_SPEEDS
    speeds = [("vehicle.airspeed_m_s", scenario.vehicle.airspeed)]
    speeds += [(key("mission", i, "speed_m_s"), p.speed) for i, p in enumerate(scenario.mission) if p.speed]
    for index, member in enumerate(scenario.vehicles):
        speeds += [(key("vehicles", index, "mission"), p.speed) for p in member.mission if p.speed]
    message = f"must be at least {low:g} and at most {high:g}"
    return [Problem(place, speed, message) for place, speed in speeds if not low <= speed <= high]


def _aircraft(scenario: Scenario) -> list[Problem]:
    from fmu.parameters import aircraft_names  # noqa: PLC0415

    names = aircraft_names()
    if scenario.vehicle.aircraft in names:
        return []
    return [Problem("vehicle.aircraft", scenario.vehicle.aircraft, f"is unknown; known: {', '.join(names)}")]
