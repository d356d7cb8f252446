"""Mission files with everything in them: QGroundControl `.plan` and `QGC WPL 110`, without loss.

`offboard.plan_files` reads what an aircraft in process can fly and refuses the rest. Here every item is
kept as it stands in the file, known or not, geofence and rally points too; a `.plan` that was read is
written again with the same content.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from offboard.errors import PlanFileError
from offboard.geofence import GeofenceData, fence_object, fence_of
from offboard.plan_files import PX4, document_of, mission_object, numbers, rally_of, write_whole
from offboard.plan_items import FileItem, entry_of, items_of
from offboard.raw_mission import RawMission

HEADER = "QGC WPL 110"
COLUMNS = 12
"""Of a line of a WPL file."""
HOME_FRAME, HOME_COMMAND = 0, 16
"""Of the first line of a WPL file, which is home."""


@dataclass(frozen=True, slots=True)
class MissionFile:
    """What a mission file says."""

    items: tuple[FileItem, ...]
    """All items that a vehicle is sent, in their order; complex ones of a plan are written out."""
    home: tuple[float, float, float] | None = None
    """Latitude, longitude [deg] and altitude above mean sea level [m] of the planned home."""
    cruise_speed_m_s: float = 15.0
    """Where the mission gives none."""
    geofence: GeofenceData = field(default_factory=GeofenceData)
    rally: tuple[tuple[float, float, float], ...] = ()
    """Latitude, longitude [deg] and altitude above home [m] of each rally point."""
    document: Mapping[str, object] | None = None
    """The `.plan` as it was read, so that nothing of it is lost."""

    def mission(self) -> RawMission:
        """As a vehicle takes it.

        Raises
        ------
        LinkError
            If nothing in it is flown to.
        """
        return RawMission.of([item.raw() for item in self.items])


def read_mission_file(file: Path) -> MissionFile:
    """Read a `.plan` or a WPL file; which it is, its content says.

    Raises
    ------
    PlanFileError
        If it is neither, or cannot be understood; names the item, counted from 0 as in the file.
    """
    try:
        begin = file.read_bytes()[: len(HEADER)]
    except OSError as error:
        raise PlanFileError(file, f"cannot be read: {error}") from error
    return _read_wpl(file) if begin.startswith(b"QGC WPL") else _read_plan(file)


def write_mission_file(file: Path, content: MissionFile) -> None:
    """Write a `.plan` or, where the name ends otherwise, a WPL file; whole or not at all.

    Raises
    ------
    PlanFileError
        If the file cannot hold the content, or the disk refuses.
    """
    text = _plan_text(content) if file.suffix.lower() == ".plan" else _wpl_text(file, content)
    try:
        write_whole(file, text)
    except (OSError, ValueError) as error:
        raise PlanFileError(file, f"cannot be written: {error}") from error


def lost_in_wpl(content: MissionFile) -> list[str]:
    """What of a mission a WPL file has no place for, in words."""
    lost = []
    if content.geofence.polygons or content.geofence.circles:
        lost.append("the geofence")
    if content.rally:
        lost.append("the rally points")
    return lost


def _read_plan(file: Path) -> MissionFile:
    document = document_of(file)
    mission = mission_object(file, document)
    try:
        geofence = fence_of(document.get("geoFence"))
    except ValueError as error:
        raise PlanFileError(file, f"geoFence: {error}") from error
    home = numbers(file, mission, "plannedHomePosition", 3)
    (speed,) = numbers(file, {"cruiseSpeed": [mission.get("cruiseSpeed", 15.0)]}, "cruiseSpeed", 1)
    entries = mission.get("items")
    if not isinstance(entries, list):
        raise PlanFileError(file, "mission.items is missing or no list")
    items = [item for index, entry in enumerate(entries) for item in items_of(file, index, entry)]
    rally = rally_of(file, document.get("rallyPoints"))
    return MissionFile(tuple(items), (home[0], home[1], home[2]), speed, geofence, rally, document)


def _plan_text(content: MissionFile) -> str:
    """A `.plan`: the one that was read, or a new one."""
    document = content.document
    if document is None:
        home = content.home or _first_place(content)
        document = {
            "fileType": "Plan",
            "version": 1,
            "groundStation": "Sidestep",
            "mission": {
                "version": 2,
                "firmwareType": PX4,
                "vehicleType": 1,
                "cruiseSpeed": content.cruise_speed_m_s,
                "hoverSpeed": content.cruise_speed_m_s,
                "globalPlanAltitudeMode": 1,
                "plannedHomePosition": list(home),
                "items": [entry_of(item, number) for number, item in enumerate(content.items, start=1)],
            },
            "geoFence": fence_object(content.geofence),
            "rallyPoints": {"version": 2, "points": [list(point) for point in content.rally]},
        }
    return json.dumps(document, indent=4, allow_nan=False) + "\n"


def _first_place(content: MissionFile) -> tuple[float, float, float]:
    """A home for a mission without one: under its first waypoint, at sea level."""
    first = content.mission()
    item = content.items[first.flown_to[0]]
    return item.params[4], item.params[5], 0.0


def _wpl_text(file: Path, content: MissionFile) -> str:
    """A WPL file: home in the first line, a line for each item."""
    rows: list[tuple[int, int, int, tuple[float, ...], int]] = []
    if content.home is not None:
        rows.append((1, HOME_FRAME, HOME_COMMAND, (0.0, 0.0, 0.0, 0.0, *content.home), 1))
    for item in content.items:
        if any(math.isinf(value) for value in item.params):
            raise PlanFileError(file, f"params = {item.params} cannot be written", len(rows))
        rows.append((0, item.frame, item.command, item.params, int(item.autocontinue)))
    lines = [HEADER]
    for number, (current, frame, command, params, autocontinue) in enumerate(rows):
        cells = [number, current, frame, command, *(_shown(value) for value in params), autocontinue]
        lines.append("\t".join(str(cell) for cell in cells))
    return "\n".join(lines) + "\n"


def _shown(value: float) -> str:
    """A number that reads back as the same."""
    return "nan" if math.isnan(value) else repr(float(value))


def _read_wpl(file: Path) -> MissionFile:
    try:
        lines = file.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise PlanFileError(file, f"cannot be read: {error}") from error
    if lines[0].strip() != HEADER:
        raise PlanFileError(file, f"begins with {lines[0].strip()!r}, must be {HEADER!r}")
    rows = [_row(file, index, line) for index, line in enumerate(line for line in lines[1:] if line.strip())]
    home = None
    if rows and (rows[0].frame, rows[0].command) == (HOME_FRAME, HOME_COMMAND):
        params = rows.pop(0).params
        home = (params[4], params[5], params[6])
    return MissionFile(tuple(rows), home)


def _row(file: Path, index: int, line: str) -> FileItem:
    """One line of a WPL file."""
    cells = line.split()
    if len(cells) != COLUMNS:
        raise PlanFileError(file, f"has {len(cells)} columns, must have {COLUMNS}", index)
    try:
        number, _, frame, command, autocontinue = (int(float(cells[i])) for i in (0, 1, 2, 3, 11))
        params = tuple(float(cell) for cell in cells[4:11])
    except (ValueError, OverflowError) as error:
        raise PlanFileError(file, f"{line.strip()!r} holds something that is no number", index) from error
    if number != index:
        raise PlanFileError(file, f"is numbered {number}, must be {index}", index)
    if any(math.isinf(value) for value in params):
        raise PlanFileError(file, "holds an infinite number", index)
    item = FileItem(command, frame, params, bool(autocontinue))
    if (problem := item.problem()) is not None:
        raise PlanFileError(file, problem, index)
    return item
