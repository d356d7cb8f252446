"""Scenario ↔ plan file ↔ WPL file."""

from __future__ import annotations

import math
from pathlib import Path

from offboard.errors import PlanFileError
from offboard.frames import MapFrame
from offboard.geofence import FenceType, GeofenceData
from offboard.mission_files import MissionFile, lost_in_wpl, read_mission_file, write_mission_file
from offboard.plan_items import FileItem
from offboard.raw_mission import CHANGE_SPEED, FLOWN_TO, MISSION, WAYPOINT, RawMission
from scenarios.errors import ScenarioError
from scenarios.fence import FenceArea, geofence_data
from scenarios.load import load
from scenarios.rally import rally_data, rally_points
from scenarios.scenario import Home, Point, Scenario, VehicleSettings
from scenarios.toml_text import to_toml

PLAN, WPL, TOML = ".plan", (".waypoints", ".wpl", ".txt", ".mission"), ".toml"
"""Endings of files."""
SAME = 1.0
"""A scenario's waypoints are at least so far apart [m]."""


def convert(source: str, target: Path) -> list[str]:
    """Write what a file or scenario says to another file; what that has no place for, in words.

    Raises
    ------
    ScenarioError, PlanFileError
        If it cannot be read or written.
    """
    suffix = target.suffix.lower()
    if suffix not in (PLAN, *WPL, TOML):
        raise ScenarioError(target, f"must end in {PLAN}, {TOML} or, for WPL, one of {', '.join(WPL)}")
    if suffix == TOML:
        scenario, lost = _as_scenario(source)
        try:
            target.write_text(to_toml(scenario), encoding="utf-8", newline="\n")
        except OSError as error:
            raise PlanFileError(target, f"cannot be written: {error}") from error
        return lost
    content, lost = _as_mission(source)
    write_mission_file(target, content)
    return lost + (lost_in_wpl(content) if suffix != PLAN else [])


def is_mission_file(text: str) -> bool:
    """True for the name of a plan or WPL file, false for a scenario's."""
    return Path(text).suffix.lower() in (PLAN, *WPL)


def mission_file_of(scenario: Scenario) -> MissionFile:
    """A scenario's mission, geofence and rally points; obstacles, wind and all else have no place there."""
    home = scenario.home
    frame = MapFrame(home.latitude_deg, home.longitude_deg, home.altitude_m)
    items = []
    for point in scenario.mission:
        there = frame.to_geodetic(point.north, point.east)
        items.append(FileItem(WAYPOINT, 3, (0.0, 0.0, 0.0, math.nan, *there, point.altitude)))
        if point.speed is not None:
            items.append(FileItem(CHANGE_SPEED, MISSION, (0.0, point.speed, -1.0, 0.0, 0.0, 0.0, 0.0)))
    fence = geofence_data(scenario.geofence, frame)
    place = (home.latitude_deg, home.longitude_deg, home.altitude_m)
    rally = rally_data(scenario.rally, frame)
    return MissionFile(tuple(items), place, scenario.vehicle.airspeed, fence, rally)


def scenario_of_file(content: MissionFile, name: str) -> Scenario:
    """A mission file as a scenario without obstacles: its waypoints, speeds, geofence and rally points."""
    mission = content.mission()
    home = content.home
    if home is None:
        first = content.items[mission.flown_to[0]].params
        home = (first[4], first[5], 0.0)
    frame = MapFrame(*home)
    points: list[Point] = []
    for item in mission.plan(home[2]).mission_items:
        north, east = frame.to_map(item.latitude_deg, item.longitude_deg)
        speed = None if math.isnan(item.speed_m_s) else item.speed_m_s
        there = Point(round(north, 3), round(east, 3), item.relative_altitude_m, speed)
        if points and math.hypot(points[-1].north - north, points[-1].east - east) < SAME:
            points.pop()
        points.append(there)
    return Scenario(
        name=name,
        description=f"Mission of {name}.",
        home=Home(*home),
        mission=tuple(points),
        vehicle=VehicleSettings(airspeed=mission.first_speed() or content.cruise_speed_m_s),
        geofence=fence_areas(content.geofence, frame),
        rally=rally_points(content.rally, frame),
    )


def fence_areas(fence: GeofenceData, frame: MapFrame) -> tuple[FenceArea, ...]:
    """A plan file's geofence on the map."""
    polygons = [
        FenceArea(
            p.fence_type is FenceType.INCLUSION,
            corners=tuple(frame.to_map(latitude, longitude) for latitude, longitude in p.points),
        )
        for p in fence.polygons
    ]
    circles = [
        FenceArea(c.fence_type is FenceType.INCLUSION, centre=frame.to_map(*c.point), radius=c.radius_m)
        for c in fence.circles
    ]
    return (*polygons, *circles)


def _as_mission(source: str) -> tuple[MissionFile, list[str]]:
    if is_mission_file(source):
        return read_mission_file(Path(source)), []
    scenario = load(source)
    lost = []
    if scenario.obstacles or scenario.traffic or scenario.random:
        lost.append("obstacles and traffic")
    if scenario.vehicles:
        lost.append("the missions of the other vehicles")
    return mission_file_of(scenario), lost


def _as_scenario(source: str) -> tuple[Scenario, list[str]]:
    if not is_mission_file(source):
        return load(source), []
    content = read_mission_file(Path(source))
    known = FLOWN_TO | {CHANGE_SPEED}
    other = sorted({item.command for item in content.items if item.command not in known})
    lost = [f"items of other kinds than waypoints (commands {', '.join(map(str, other))})"] if other else []
    RawMission.of([item.raw() for item in content.items])
    return scenario_of_file(content, Path(source).stem), lost
