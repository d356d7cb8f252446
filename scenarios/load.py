"""TOML files and catalogue names → validated scenarios, with all mistakes of a file told at once."""

from __future__ import annotations

import difflib
import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import UTC
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from offboard.frames import MapFrame
from scenarios import explain
from scenarios.check import semantic_problems
from scenarios.errors import Problem, ScenarioError
from scenarios.fence import FenceArea
from scenarios.scenario import (
    Home,
    Member,
    Obstacle,
    Point,
    RadarSettings,
    RandomField,
    Scenario,
    Traffic,
    VehicleSettings,
    Wind,
)
from scenarios.schema import FenceTable, MemberTable, PlaceTable, PositionTable, ScenarioTable

CATALOGUE = Path(__file__).parent / "catalogue"
DEFAULT_SCENARIO = "table4"
DEFAULT_ALTITUDE = 200.0
"""Altitude of a waypoint that gives none [m]."""
LISTS = ("mission", "obstacles", "traffic", "vehicles", "geofence")


def catalogue_names() -> list[str]:
    """Names of the scenarios that come with the package, the default first."""
    names = sorted(path.stem for path in CATALOGUE.glob("*.toml"))
    return sorted(names, key=lambda name: name != DEFAULT_SCENARIO)


def find(source: str | Path) -> Path:
    """The file behind a catalogue name or a path.

    Raises
    ------
    ScenarioError
        If there is none; for a name with the known names and the nearest of them.
    """
    text = str(source)
    in_catalogue = CATALOGUE / f"{text}.toml"
    looks_like_path = text.endswith(".toml") or "/" in text or "\\" in text
    if not looks_like_path and text in catalogue_names():
        return in_catalogue
    path = Path(text)
    if path.is_file():
        return path
    if looks_like_path:
        raise ScenarioError(text, "is a directory" if path.is_dir() else "no such file")
    names = catalogue_names()
    near = difflib.get_close_matches(text, names, n=1)
    hint = f"; did you mean {near[0]!r}?" if near else "."
    raise ScenarioError(
        text,
        f"unknown scenario{hint or '.'} Known: {', '.join(names)}. The name of a file must end in .toml.",
    )


def load(source: str | Path) -> Scenario:
    """Load a scenario from the catalogue (by name) or from a TOML file (by path).

    Raises
    ------
    ScenarioError
        With every mistake of the file: key, value and allowed range of each.
    """
    path = find(source)
    try:
        text = path.read_bytes().decode("utf-8")
    except UnicodeDecodeError as error:
        raise ScenarioError(path, f"not a text file in UTF-8 (byte {error.start})") from error
    except OSError as error:
        raise ScenarioError(path, f"cannot be read: {error.strerror}") from error
    return parse(text, path)


def parse(text: str, file: str | Path = "scenario") -> Scenario:
    """Validate the text of a scenario file; `file` is its name in messages.

    Raises
    ------
    ScenarioError
        With every mistake of the text.
    """
    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ScenarioError(file, f"not valid TOML: {error}") from error
    name = Path(file).stem
    table, problems = _validate(raw)
    scenario = None
    if table is not None:
        found, scenario = _build(table, name)
        problems += found
    if problems or scenario is None:
        raise ScenarioError(file, problems)
    return scenario


def _validate(raw: dict[str, Any]) -> tuple[_Located | None, list[Problem]]:
    """Field by field; what survives is validated again so that mistakes between fields show too."""
    try:
        return _Located(ScenarioTable.model_validate(raw), {}), []
    except ValidationError as error:
        errors = error.errors(include_url=False)
    problems = [explain.problem(item, ScenarioTable) for item in errors]
    bad = {item["loc"][:2] if item["loc"][0] in LISTS else item["loc"][:1] for item in errors}
    kept: dict[str, Any] = {}
    numbers: dict[str, list[int]] = {}
    for key, value in raw.items():
        if (key,) in bad:
            continue
        kept[key] = value
        if key in LISTS and isinstance(value, list):
            numbers[key] = [i for i in range(len(value)) if (key, i) not in bad]
            kept[key] = [value[i] for i in numbers[key]]
    try:
        return _Located(ScenarioTable.model_validate(kept), numbers), problems
    except ValidationError:
        return None, problems


class _Located:
    """A validated table, with the place in the file of each entry of its lists."""

    def __init__(self, table: ScenarioTable, numbers: Mapping[str, Sequence[int]]) -> None:
        self.table = table
        self._numbers = numbers

    def key(self, name: str, index: int, key: str = "") -> str:
        """How messages name entry `index` of list `name`."""
        number = self._numbers[name][index] if name in self._numbers else index
        return explain.key_text((name, number, key) if key else (name, number))


def _build(located: _Located, default_name: str) -> tuple[list[Problem], Scenario]:
    table = located.table
    frame = MapFrame(table.home.latitude_deg, table.home.longitude_deg, table.home.altitude_m)
    mission = _positions(frame, table.mission, DEFAULT_ALTITUDE)
    cruise = max(p.altitude for p in mission)
    obstacles = _positions(frame, table.obstacles, cruise)
    traffic = [_positions(frame, flight.waypoints, cruise) for flight in table.traffic]
    missions = [_own_mission(frame, member, mission) for member in table.vehicles]
    scenario = _assemble(table, default_name, mission, obstacles, traffic, missions)
    scenario = replace(scenario, geofence=tuple(_area(frame, area) for area in table.geofence))
    return semantic_problems(scenario, table, located.key), scenario


def _positions(frame: MapFrame, tables: Sequence[PositionTable], altitude: float) -> list[Point]:
    """Map points; `altitude` [m] is for those that give none."""
    points = []
    for table in tables:
        north, east = _place(frame, table)
        height = altitude if table.altitude_m is None else table.altitude_m
        points.append(Point(north, east, height, getattr(table, "speed_m_s", None)))
    return points


def _area(frame: MapFrame, table: FenceTable) -> FenceArea:
    """One area of the geofence."""
    include = table.type == "include"
    if table.centre is not None and table.radius_m is not None:
        return FenceArea(include, centre=_place(frame, table.centre), radius=table.radius_m)
    return FenceArea(include, corners=tuple(_place(frame, corner) for corner in table.polygon or ()))


def _place(frame: MapFrame, table: PlaceTable) -> tuple[float, float]:
    """North and east of home [m]."""
    if table.latitude_deg is not None and table.longitude_deg is not None:
        north, east = frame.to_map(table.latitude_deg, table.longitude_deg)
        return float(north), float(east)
    if table.north_m is None or table.east_m is None:
        raise ValueError("a position table without a position was not validated")
    return table.north_m, table.east_m


def _own_mission(frame: MapFrame, member: MemberTable, common: Sequence[Point]) -> list[Point]:
    """The mission of one of several vehicles: its own, or the common one moved aside."""
    if member.mission is not None:
        return _positions(frame, member.mission, DEFAULT_ALTITUDE)
    north, east = member.north_offset_m, member.east_offset_m
    return [replace(point, north=point.north + north, east=point.east + east) for point in common]


def _assemble(
    table: ScenarioTable,
    default_name: str,
    mission: Sequence[Point],
    obstacles: Sequence[Point],
    traffic: Sequence[Sequence[Point]],
    missions: Sequence[Sequence[Point]],
) -> Scenario:
    numbered = [row.id for rows in (table.obstacles, table.traffic, table.vehicles) for row in rows]
    used = {i for i in numbered if i is not None}
    free = (i for i in range(1, len(numbered) + len(used) + 1) if i not in used)
    ids = [next(free) if i is None else i for i in numbered]
    return Scenario(
        name=table.name or default_name,
        description=table.description,
        start_time_utc=table.start_time_utc.astimezone(UTC),
        home=Home(table.home.latitude_deg, table.home.longitude_deg, table.home.altitude_m),
        mission=tuple(mission),
        obstacles=tuple(
            Obstacle(i, p.north, p.east, p.altitude, o.safety_radius_m, o.appears_at_s, o.kind)
            for i, p, o in zip(ids, obstacles, table.obstacles, strict=False)
        ),
        traffic=tuple(
            Traffic(i, tuple(points), t.speed_m_s, t.starts_at_s, t.motion, t.violation_radius_m)
            for i, points, t in zip(ids[len(table.obstacles) :], traffic, table.traffic, strict=False)
        ),
        wind=Wind(table.wind.north_m_s, table.wind.east_m_s),
        radar=_radar(table),
        vehicle=_vehicle(table),
        random=None
        if table.random is None
        else RandomField(
            table.random.count,
            table.random.sigma_m,
            table.random.clear_of_start_m,
            table.random.safety_radius_m,
            table.random.largest_safety_radius_m,
        ),
        time_limit=table.time_limit_s,
        seed=table.seed,
        preset=table.preset,
        vehicles=tuple(
            Member(i, member.name, tuple(points))
            for i, points, member in zip(ids[-len(missions) :], missions, table.vehicles, strict=False)
        ),
    )


def _radar(table: ScenarioTable) -> RadarSettings:
    radar = table.radar
    return RadarSettings(
        range=radar.range_m,
        period=radar.period_s,
        range_noise=radar.range_noise_m,
        bearing_noise=math.radians(radar.bearing_noise_deg),
        detection_probability=radar.detection_probability,
        field_of_view=math.radians(radar.field_of_view_deg),
        latency=radar.latency_s,
        false_tracks=radar.false_tracks_per_scan,
        id_swaps=radar.id_swap_probability,
    )


def _vehicle(table: ScenarioTable) -> VehicleSettings:
    vehicle = table.vehicle
    return VehicleSettings(
        aircraft=vehicle.aircraft,
        fidelity=vehicle.fidelity,
        airspeed=vehicle.airspeed_m_s,
        acceptance_radius=vehicle.acceptance_radius_m,
        heading=None if vehicle.heading_deg is None else math.radians(vehicle.heading_deg),
        position_error=vehicle.position_error_m,
        decision_latency=vehicle.decision_latency_s,
    )
