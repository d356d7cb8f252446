"""Missions as QGroundControl `.plan` files.

The format is QGroundControl's "Plan File Format" (JSON, version 1; its mission object version 2). MAVLink's
commands are numbers there: an item is a waypoint (16), a timed orbit (19), a take-off (22) or a landing
(21), each with seven parameters; a change of speed (178) is an entry of its own behind the item from which
it holds.
"""

from __future__ import annotations

import json
import math
import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from offboard.errors import PlanFileError
from offboard.geofence import GeofenceData, fence_object, fence_of
from offboard.mission import CameraAction, MissionItem, MissionPlan, VehicleAction

WAYPOINT, LOITER_TIME, LAND, TAKEOFF, CHANGE_SPEED = 16, 19, 21, 22, 178
"""MAV_CMD numbers."""
GLOBAL_RELATIVE = {3, 6}
"""MAV_FRAME numbers with altitude above home."""
GLOBAL_AMSL = {0, 5}
"""MAV_FRAME numbers with altitude above mean sea level."""
FRAME_MISSION = 2
"""MAV_FRAME number of an entry without a position."""
PX4 = 12
"""MAV_AUTOPILOT number, by which QGroundControl chooses what it offers for editing."""
FIXED_WING = 1
"""MAV_TYPE number."""
ALTITUDE_ABOVE_HOME = 1
"""QGroundControl's altitude mode."""

_ACTIONS = {TAKEOFF: VehicleAction.TAKEOFF, LAND: VehicleAction.LAND}
_UNWRITABLE = (
    ("gimbal_pitch_deg", math.nan),
    ("gimbal_yaw_deg", math.nan),
    ("camera_action", CameraAction.NONE),
    ("camera_photo_interval_s", math.nan),
    ("camera_photo_distance_m", math.nan),
)
"""Fields that must be unset in an item to be written, and what unset is."""


@dataclass(frozen=True, slots=True)
class PlanFile:
    """What a plan file says."""

    plan: MissionPlan
    """The mission."""
    home_latitude_deg: float
    """Planned home position [deg]."""
    home_longitude_deg: float
    """Planned home position [deg]."""
    home_altitude_m: float
    """Planned home position, above mean sea level [m]."""
    cruise_speed_m_s: float
    """Speed where the mission gives none [m/s]."""
    geofence: GeofenceData = field(default_factory=GeofenceData)
    """Where the vehicle may be; whoever flies the plan must keep to it."""
    rally: tuple[tuple[float, float, float], ...] = ()
    """Latitude, longitude [deg] and altitude above home [m] of each rally point."""


def write_plan(file: Path, content: PlanFile) -> None:
    """Write a `.plan` file, whole or not at all.

    Raises
    ------
    PlanFileError
        If an item asks for something that this writer cannot express, or the disk refuses.
    """
    entries: list[dict[str, object]] = []
    for index, item in enumerate(content.plan.mission_items):
        _refuse_unwritable(file, index, item)
        entries.append(_entry(item, len(entries) + 1))
        if not math.isnan(item.speed_m_s):
            entries.append(_speed_entry(item.speed_m_s, len(entries) + 1))
    document = {
        "fileType": "Plan",
        "version": 1,
        "groundStation": "Sidestep",
        "mission": {
            "version": 2,
            "firmwareType": PX4,
            "vehicleType": FIXED_WING,
            "cruiseSpeed": content.cruise_speed_m_s,
            "hoverSpeed": content.cruise_speed_m_s,
            "globalPlanAltitudeMode": ALTITUDE_ABOVE_HOME,
            "plannedHomePosition": [
                content.home_latitude_deg,
                content.home_longitude_deg,
                content.home_altitude_m,
            ],
            "items": entries,
        },
        "geoFence": fence_object(content.geofence),
        "rallyPoints": {"version": 2, "points": [list(point) for point in content.rally]},
    }
    try:
        write_whole(file, json.dumps(document, indent=2, allow_nan=False) + "\n")
    except (OSError, ValueError) as error:
        raise PlanFileError(file, f"cannot be written: {error}") from error


def read_plan(file: Path) -> PlanFile:
    """Read a `.plan` file.

    Raises
    ------
    PlanFileError
        If the file is missing, is no plan, or holds something that cannot be flown as it says; names the
        item, counted from 0 as in the file.
    """
    document = document_of(file)
    mission = mission_object(file, document)
    try:
        geofence = fence_of(document.get("geoFence"))
    except ValueError as error:
        raise PlanFileError(file, f"geoFence: {error}") from error
    latitude_deg, longitude_deg, altitude_m = numbers(file, mission, "plannedHomePosition", 3)
    (speed,) = numbers(file, {"cruiseSpeed": [mission.get("cruiseSpeed", 15.0)]}, "cruiseSpeed", 1)
    entries = mission.get("items")
    if not isinstance(entries, list):
        raise PlanFileError(file, "mission.items is missing or no list")
    items: list[MissionItem] = []
    for index, entry in enumerate(entries):
        command, frame, params = read_entry(file, index, entry)
        if command != CHANGE_SPEED:
            items.append(_item(file, index, (command, frame, params), altitude_m))
        elif not 0.0 < params[1] < math.inf:
            raise PlanFileError(file, f"speed = {params[1]}, must be above 0", index)
        elif items:
            items[-1] = replace(items[-1], speed_m_s=params[1])
        else:
            speed = params[1]
    if not items:
        raise PlanFileError(file, "mission.items holds nothing to fly to")
    return PlanFile(
        MissionPlan.of(items),
        latitude_deg,
        longitude_deg,
        altitude_m,
        speed,
        geofence,
        rally_of(file, document.get("rallyPoints")),
    )


def _entry(item: MissionItem, number: int) -> dict[str, object]:
    """One item as a `SimpleItem`."""
    yaw = None if math.isnan(item.yaw_deg) else item.yaw_deg
    radius = 0 if math.isnan(item.acceptance_radius_m) else item.acceptance_radius_m
    command, first = WAYPOINT, [0, radius, 0, yaw]
    if item.vehicle_action is not VehicleAction.NONE:
        command = next(number for number, action in _ACTIONS.items() if action is item.vehicle_action)
        first = [0, 0, 0, yaw]
    elif item.loiter_time_s > 0.0:
        command, first = LOITER_TIME, [item.loiter_time_s, 0, 0, 0]
    return {
        "type": "SimpleItem",
        "command": command,
        "frame": 3,
        "params": [*first, item.latitude_deg, item.longitude_deg, item.relative_altitude_m],
        "Altitude": item.relative_altitude_m,
        "AltitudeMode": ALTITUDE_ABOVE_HOME,
        "AMSLAltAboveTerrain": None,
        "autoContinue": True,
        "doJumpId": number,
    }


def _speed_entry(speed: float, number: int) -> dict[str, object]:
    """A change of airspeed (type 0), throttle as it is (-1)."""
    return {
        "type": "SimpleItem",
        "command": CHANGE_SPEED,
        "frame": FRAME_MISSION,
        "params": [0, speed, -1, 0, 0, 0, 0],
        "autoContinue": True,
        "doJumpId": number,
    }


def _refuse_unwritable(file: Path, index: int, item: MissionItem) -> None:
    """Refuse an item with fields that would be lost."""
    for name, unset in _UNWRITABLE:
        value = getattr(item, name)
        if value != unset and not (math.isnan(unset) and math.isnan(value)):
            raise PlanFileError(file, f"{name} = {value} cannot be written", index)
    if item.vehicle_action not in (VehicleAction.NONE, *_ACTIONS.values()):
        raise PlanFileError(file, f"vehicle_action = {item.vehicle_action.name} cannot be written", index)


def write_whole(file: Path, text: str) -> None:
    """Write a text file so that it appears whole or not at all."""
    handle, name = tempfile.mkstemp(dir=file.parent, prefix=f".{file.name}.")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(text)
        Path(name).chmod(0o644)
        Path(name).replace(file)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def rally_of(file: Path, value: object) -> tuple[tuple[float, float, float], ...]:
    """Latitude, longitude [deg] and altitude above home [m] of each rally point of a plan.

    Raises
    ------
    PlanFileError
        If they cannot be understood.
    """
    if value is None:
        return ()
    points = value.get("points") if isinstance(value, Mapping) else None
    if not isinstance(points, list):
        raise PlanFileError(file, "rallyPoints has no list of points")
    found = [numbers(file, {"rallyPoints": point}, "rallyPoints", 3) for point in points]
    for place in found:
        if not (abs(place[0]) <= 90.0 and abs(place[1]) <= 180.0 and math.isfinite(place[2])):
            raise PlanFileError(
                file, f"rallyPoints = {place}: is no latitude (±90), longitude (±180), altitude"
            )
    return tuple((a, b, c) for a, b, c in found)


def document_of(file: Path) -> Mapping[str, object]:
    """A plan file whose outer form is right."""
    try:
        document = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise PlanFileError(file, f"cannot be read: {error}") from error
    except json.JSONDecodeError as error:
        problem = f"is not JSON: {error.msg} in line {error.lineno}, column {error.colno}"
        raise PlanFileError(file, problem) from error
    if not isinstance(document, dict) or document.get("fileType") != "Plan":
        raise PlanFileError(file, 'is no plan: fileType must be "Plan"')
    if document.get("version") != 1:
        raise PlanFileError(file, f"version = {document.get('version')}, must be 1")
    return document


def mission_object(file: Path, document: Mapping[str, object]) -> Mapping[str, object]:
    """The mission object of a plan file."""
    mission = document.get("mission")
    if not isinstance(mission, dict) or mission.get("version") != 2:
        raise PlanFileError(file, "mission is missing or its version is not 2")
    return mission


def numbers(
    file: Path, holder: Mapping[str, object], key: str, count: int, index: int | None = None
) -> list[float]:
    """A list of finite numbers; null stands for NaN in an item's parameters."""
    values = holder.get(key)
    if not isinstance(values, list) or len(values) != count:
        raise PlanFileError(file, f"{key} = {values}, must be {count} numbers", index)
    found = [math.nan if value is None and index is not None else value for value in values]
    if not all(isinstance(number, (int, float)) and not isinstance(number, bool) for number in found):
        raise PlanFileError(file, f"{key} = {values}, must be {count} numbers", index)
    return [float(number) for number in found]


def read_entry(file: Path, index: int, entry: object) -> tuple[int, int, list[float]]:
    """Command, frame and parameters of one entry."""
    if not isinstance(entry, dict):
        raise PlanFileError(file, "is no object", index)
    if entry.get("type") != "SimpleItem":
        kind = entry.get("complexItemType", entry.get("type"))
        raise PlanFileError(file, f"type = {kind}: only SimpleItem can be flown", index)
    if "coordinate" in entry:  # files of QGroundControl before 3.3 part the position from the parameters
        params = numbers(file, entry, "params", 4, index) + numbers(file, entry, "coordinate", 3, index)
    else:
        params = numbers(file, entry, "params", 7, index)
    command, frame = entry.get("command"), entry.get("frame")
    if not isinstance(command, int) or not isinstance(frame, int):
        raise PlanFileError(file, f"command = {command}, frame = {frame}, must be whole numbers", index)
    return command, frame, params


def _item(file: Path, index: int, entry: tuple[int, int, list[float]], home_altitude: float) -> MissionItem:
    """The mission item of an entry with a position."""
    command, frame, params = entry
    first, second, _, yaw, latitude_deg, longitude_deg, altitude = params
    if command not in (WAYPOINT, LOITER_TIME, LAND, TAKEOFF):
        raise PlanFileError(file, f"command = {command} cannot be flown", index)
    if frame not in GLOBAL_RELATIVE | GLOBAL_AMSL:
        raise PlanFileError(file, f"frame = {frame}: only altitudes above home or sea level", index)
    item = MissionItem(
        latitude_deg=latitude_deg,
        longitude_deg=longitude_deg,
        relative_altitude_m=altitude - home_altitude if frame in GLOBAL_AMSL else altitude,
        loiter_time_s=first if command == LOITER_TIME and first > 0.0 else math.nan,
        acceptance_radius_m=second if command == WAYPOINT and second > 0.0 else math.nan,
        yaw_deg=math.nan if command == LOITER_TIME else yaw,
        vehicle_action=_ACTIONS.get(command, VehicleAction.NONE),
    )
    if problems := item.problems():
        raise PlanFileError(file, "; ".join(problems), index)
    return item
