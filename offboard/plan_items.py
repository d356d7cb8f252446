"""Items of a mission file: simple ones, and what QGroundControl's complex ones are written out as."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from offboard.errors import PlanFileError
from offboard.plan_files import numbers, read_entry
from offboard.raw_mission import DEGREE, FLOWN_TO, LAND, LOITER_TO_ALTITUDE, RawItem

DO_LAND_START = 189
"""MAV_CMD number."""
RELATIVE, ABSOLUTE, MISSION = 3, 0, 2
"""MAV_FRAME numbers."""
POSITIONED = frozenset({0, 3, 5, 6, 10, 11})
"""MAV_FRAME numbers of items with latitude and longitude."""


@dataclass(frozen=True, slots=True)
class FileItem:
    """One item as a file has it."""

    command: int
    """MAV_CMD."""
    frame: int
    """MAV_FRAME."""
    params: tuple[float, ...]
    """Seven parameters; where the frame has a place, the last three are latitude, longitude, altitude."""
    autocontinue: bool = True

    def problem(self) -> str | None:
        """Why no vehicle can fly it; None for all that may be flown, understood or not."""
        latitude_deg, longitude_deg, altitude = self.params[4:7]
        if not 0 <= self.command <= 65535:
            return f"command = {self.command}, must be between 0 and 65535"
        if self.command not in FLOWN_TO or self.frame not in POSITIONED:
            return None
        for name, value, limit in (
            ("latitude_deg", latitude_deg, 90.0),
            ("longitude_deg", longitude_deg, 180.0),
            ("altitude", altitude, 1e5),
        ):
            if not abs(value) <= limit:
                return f"{name} = {value}, must be between {-limit:g} and {limit:g}"
        return None

    def raw(self) -> RawItem:
        """As MAVLink has it."""
        a, b, c, d, x, y, z = self.params
        scale = DEGREE if self.frame in POSITIONED else 1.0 if self.frame == MISSION else 1e4
        x, y = (0.0 if math.isnan(value) else value * scale for value in (x, y))
        frame = {0: 5, 3: 6, 10: 11}.get(self.frame, self.frame)
        z = 0.0 if math.isnan(z) else z
        return RawItem(self.command, frame, (a, b, c, d), round(x), round(y), z, int(self.autocontinue))


def items_of(file: Path, index: int, entry: object) -> list[FileItem]:
    """What one entry of a `.plan` is sent as.

    Raises
    ------
    PlanFileError
        If it is not understood.
    """
    if isinstance(entry, Mapping) and entry.get("type") == "ComplexItem":
        return _complex(file, index, entry)
    command, frame, params = read_entry(file, index, entry)
    keep = bool(entry.get("autoContinue", True)) if isinstance(entry, Mapping) else True
    item = FileItem(command, frame, tuple(params), keep)
    if (problem := item.problem()) is not None:
        raise PlanFileError(file, problem, index)
    return [item]


def entry_of(item: FileItem, number: int) -> dict[str, object]:
    """An item as a `SimpleItem` of a `.plan`; NaN is null."""
    return {
        "type": "SimpleItem",
        "command": item.command,
        "frame": item.frame,
        "params": [None if math.isnan(value) else value for value in item.params],
        "autoContinue": item.autocontinue,
        "doJumpId": number,
    }


def _complex(file: Path, index: int, entry: Mapping[str, object]) -> list[FileItem]:
    kind = entry.get("complexItemType")
    if kind == "fwLandingPattern":
        return _landing(file, index, entry)
    transect = entry.get("TransectStyleComplexItem")
    holder = transect if isinstance(transect, Mapping) else entry
    inner = holder.get("Items")
    if not isinstance(inner, list):
        raise PlanFileError(file, f"complexItemType = {kind} is not understood and not written out", index)
    return [item for one in inner for item in items_of(file, index, one)]


def _landing(file: Path, index: int, entry: Mapping[str, object]) -> list[FileItem]:
    """QGroundControl's landing pattern: descend on a circle, then land straight."""
    key = "landingApproachCoordinate" if "landingApproachCoordinate" in entry else "finalApproachCoordinate"
    approach = numbers(file, entry, key, 3, index)
    land = numbers(file, entry, "landCoordinate", 3, index)
    (radius,) = numbers(file, {"loiterRadius": [entry.get("loiterRadius", 75.0)]}, "loiterRadius", 1, index)
    turn = radius if entry.get("loiterClockwise", True) else -radius
    frame = RELATIVE if entry.get("altitudesAreRelative", True) else ABSOLUTE
    return [
        FileItem(DO_LAND_START, MISSION, (0.0,) * 7),
        FileItem(LOITER_TO_ALTITUDE, frame, (1.0, turn, 0.0, 1.0, *approach)),
        FileItem(LAND, frame, (0.0, 0.0, 0.0, 0.0, *land)),
    ]
