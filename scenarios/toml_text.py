"""A scenario as the text of a TOML file that loads as the same scenario."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping

from scenarios.fence import FenceArea
from scenarios.scenario import Obstacle, Point, Scenario, Traffic


def to_toml(scenario: Scenario) -> str:
    """The whole scenario, every default spelled out; drawn obstacles are listed one by one."""
    radar, vehicle = scenario.radar, scenario.vehicle
    heading = None if vehicle.heading is None else math.degrees(vehicle.heading)
    random = scenario.random
    parts = [
        _table(
            "",
            name=scenario.name,
            description=scenario.description,
            start_time_utc=_Bare(scenario.start_time_utc.isoformat().replace("+00:00", "Z")),
            time_limit_s=scenario.time_limit,
            seed=scenario.seed,
            preset=scenario.preset,
            planner=scenario.planner,
        ),
        _table(
            "[home]",
            latitude_deg=scenario.home.latitude_deg,
            longitude_deg=scenario.home.longitude_deg,
            altitude_m=scenario.home.altitude_m,
        ),
        _table(
            "[wind]",
            north_m_s=scenario.wind.north,
            east_m_s=scenario.wind.east,
            turbulence=scenario.wind.turbulence,
        ),
        _table(
            "[radar]",
            range_m=radar.range,
            period_s=radar.period,
            range_noise_m=radar.range_noise,
            bearing_noise_deg=math.degrees(radar.bearing_noise),
            detection_probability=radar.detection_probability,
            field_of_view_deg=min(math.degrees(radar.field_of_view), 360.0),
            latency_s=radar.latency,
            false_tracks_per_scan=radar.false_tracks,
            id_swap_probability=radar.id_swaps,
        ),
        _table(
            "[vehicle]",
            aircraft=vehicle.aircraft,
            fidelity=vehicle.fidelity,
            plant=None if vehicle.plant is None else str(vehicle.plant),
            airspeed_m_s=vehicle.airspeed,
            acceptance_radius_m=vehicle.acceptance_radius,
            heading_deg=heading,
            position_error_m=vehicle.position_error,
            decision_latency_s=vehicle.decision_latency,
        ),
    ]
    if random is not None:
        parts.append(
            _table(
                "[random]",
                count=random.count,
                sigma_m=random.sigma,
                clear_of_start_m=random.clear_of_start,
                safety_radius_m=random.safety_radius,
                largest_safety_radius_m=random.largest_safety_radius,
            )
        )
    parts += [_table("[[mission]]", **_point(p)) for p in scenario.mission]
    parts += [_table("[[obstacles]]", **_obstacle(o)) for o in scenario.obstacles]
    parts += [_table("[[traffic]]", **_traffic(t)) for t in scenario.traffic]
    parts += [_table("[[geofence]]", **_area(area)) for area in scenario.geofence]
    parts += [_table("[[rally]]", **_point(point)) for point in scenario.rally]
    parts += [
        _table("[[vehicles]]", id=m.id, name=m.name, mission=[_point(p) for p in m.mission])
        for m in scenario.vehicles
    ]
    return "\n".join(parts)


class _Bare(str):
    """Text that goes into the file without quotes."""

    __slots__ = ()


def _point(point: Point) -> dict[str, object]:
    return {
        "north_m": point.north,
        "east_m": point.east,
        "altitude_m": point.altitude,
        "speed_m_s": point.speed,
    }


def _obstacle(obstacle: Obstacle) -> dict[str, object]:
    return {
        "id": obstacle.id,
        "kind": obstacle.kind,
        "north_m": obstacle.north,
        "east_m": obstacle.east,
        "altitude_m": obstacle.altitude,
        "safety_radius_m": obstacle.safety_radius,
        "appears_at_s": obstacle.appears_at,
    }


def _area(area: FenceArea) -> dict[str, object]:
    corners = [{"north_m": north, "east_m": east} for north, east in area.corners]
    centre = None if area.centre is None else {"north_m": area.centre[0], "east_m": area.centre[1]}
    return {
        "type": "include" if area.include else "exclude",
        "polygon": corners or None,
        "centre": centre,
        "radius_m": area.radius,
    }


def _traffic(traffic: Traffic) -> dict[str, object]:
    return {
        "id": traffic.id,
        "motion": traffic.motion,
        "speed_m_s": traffic.speed,
        "starts_at_s": traffic.starts_at,
        "violation_radius_m": traffic.violation_radius,
        "waypoints": [_point(p) for p in traffic.waypoints],
    }


def _table(header: str, **values: object) -> str:
    lines = [header] if header else []
    lines += [f"{key} = {_value(value)}" for key, value in values.items() if value is not None]
    return "\n".join(lines) + "\n"


def _value(value: object) -> str:
    if isinstance(value, _Bare):
        return str(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, Mapping):
        pairs = (f"{key} = {_value(item)}" for key, item in value.items() if item is not None)
        return "{" + ", ".join(pairs) + "}"
    if isinstance(value, Iterable):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    return str(value)
