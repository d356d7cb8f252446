"""TOML files and catalogue names → validated scenarios, with all mistakes of a file told at once."""

from __future__ import annotations

import bisect
import difflib
import math
import re
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from scenarios import explain
from scenarios.check import semantic_problems
from scenarios.errors import Problem, ScenarioError
from scenarios.fence import FenceArea
from scenarios.places import Places
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
from scenarios.schema import FenceTable, MemberTable, ScenarioTable

CATALOGUE = Path(__file__).parent / "catalogue"
DEFAULT_SCENARIO = "table4"
DEFAULT_ALTITUDE = 200.0
"""Altitude of a waypoint that gives none [m]."""
LISTS = ("mission", "obstacles", "traffic", "vehicles", "geofence", "rally")


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
    try:
        if path.is_file():
            if path.suffix.lower() == ".plan":
                to = path.with_suffix(".toml").name
                raise ScenarioError(
                    text, f"is a mission; sidestep plan convert {text} {to} makes a scenario of it"
                )
            return path
        if looks_like_path:
            raise ScenarioError(text, "is a directory" if path.is_dir() else "no such file")
    except OSError as error:  # a name that is too long, a directory that may not be read
        raise ScenarioError(text, f"cannot be read: {error.strerror}") from error
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
        text = path.read_bytes().decode("utf-8-sig")
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
    except RecursionError as error:
        message = f"not valid TOML: nested too deeply (at line {_line_too_deep(text)})"
        raise ScenarioError(file, message) from error
    except ValueError as error:  # TOMLDecodeError, or a whole number of thousands of digits
        raise ScenarioError(file, f"not valid TOML: {error}") from error
    name = _name_of(file)
    table, problems = _validate(raw)
    scenario = None
    if table is not None:
        found, scenario = _build(table, name, Path(file).parent)
        problems += found
    if problems or scenario is None:
        raise ScenarioError(file, problems)
    return scenario


def _line_too_deep(text: str) -> int:
    """Line at which the parser gives up, counted from 1."""
    lines = text.split("\n")
    counts = range(1, len(lines))
    return 1 + bisect.bisect_left(counts, True, key=lambda count: _too_deep("\n".join(lines[:count])))


def _too_deep(text: str) -> bool:
    try:
        tomllib.loads(text)
    except RecursionError:
        return True
    except ValueError:
        return False
    return False


def _name_of(file: str | Path) -> str:
    """The name of a file as one of a scenario: a dash for what those may not hold."""
    return re.sub(r"[^A-Za-z0-9._-]+", "-", Path(file).stem).lstrip("._-")[:64] or "scenario"


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


def _build(located: _Located, default_name: str, folder: Path) -> tuple[list[Problem], Scenario]:
    table = located.table
    places = Places(table.home)
    mission = places.points(table.mission, DEFAULT_ALTITUDE, partial(located.key, "mission"))
    cruise = max(p.altitude for p in mission)
    obstacles = places.points(table.obstacles, cruise, partial(located.key, "obstacles"))
    traffic = [
        places.points(flight.waypoints, cruise, partial(_entry, located.key("traffic", index, "waypoints")))
        for index, flight in enumerate(table.traffic)
    ]
    missions = [
        _own_mission(places, member, mission, partial(_entry, located.key("vehicles", index, "mission")))
        for index, member in enumerate(table.vehicles)
    ]
    geofence = tuple(
        _area(places, area, located.key("geofence", index)) for index, area in enumerate(table.geofence)
    )
    rally = tuple(places.points(table.rally, cruise, partial(located.key, "rally")))
    problems = list(places.problems)
    if _utc(table.start_time_utc) is None:
        message = "must lie within the years 1 to 9999 in UTC"
        problems.append(Problem("start_time_utc", str(table.start_time_utc), message))
    scenario = _assemble(table, default_name, mission, obstacles, traffic, missions)
    scenario = replace(scenario, geofence=geofence, rally=rally, vehicle=_vehicle(table, folder))
    return problems + semantic_problems(scenario, table, located.key), scenario


def _entry(name: str, index: int) -> str:
    return f"{name} #{index + 1}"


def _utc(time: datetime) -> datetime | None:
    """The same instant in UTC; None if that is before the year 1 or after 9999."""
    try:
        return time.astimezone(UTC)
    except OverflowError:
        return None


def _area(places: Places, table: FenceTable, key: str) -> FenceArea:
    """One area of the geofence."""
    include = table.type == "include"
    if table.centre is not None and table.radius_m is not None:
        centre = places.place(table.centre, f"{key}, centre")
        return FenceArea(include, centre=centre, radius=table.radius_m)
    corners = tuple(places.place(corner, f"{key}, polygon") for corner in table.polygon or ())
    return FenceArea(include, corners=corners)


def _own_mission(
    places: Places, member: MemberTable, common: Sequence[Point], key: Callable[[int], str]
) -> list[Point]:
    """The mission of one of several vehicles: its own, or the common one moved aside."""
    if member.mission is not None:
        return places.points(member.mission, DEFAULT_ALTITUDE, key)
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
        start_time_utc=_utc(table.start_time_utc) or table.start_time_utc,
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
        wind=Wind(table.wind.north_m_s, table.wind.east_m_s, table.wind.turbulence),
        radar=_radar(table),
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
        planner=table.planner,
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


def _vehicle(table: ScenarioTable, folder: Path) -> VehicleSettings:
    vehicle = table.vehicle
    return VehicleSettings(
        aircraft=vehicle.aircraft,
        fidelity=vehicle.fidelity,
        plant=None if vehicle.plant is None else (folder / vehicle.plant).resolve(),
        airspeed=vehicle.airspeed_m_s,
        acceptance_radius=vehicle.acceptance_radius_m,
        heading=None if vehicle.heading_deg is None else math.radians(vehicle.heading_deg),
        position_error=vehicle.position_error_m,
        decision_latency=vehicle.decision_latency_s,
    )
