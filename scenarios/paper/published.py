"""What the paper prints, as numbers (`published.toml`)."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

Points = tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class FieldRow:
    """A row of Table 3."""

    obstacles: str
    """How many, or "40+hill", "40+moving"."""
    flight_min: float
    """UAV flying time [min]."""
    algorithm_s: float | None
    """Algorithm's running time [s]."""
    path_length_m: float
    """"Optimized path length" [m]."""


@dataclass(frozen=True, slots=True)
class ListRow:
    """A row of Table 4."""

    planner: str
    """Our name of it."""
    length_m: float
    """Printed length [m]."""
    time_s: float
    """Algorithm's running time [s]."""
    waypoints: Points
    """Printed list, x and y [m]."""


@dataclass(frozen=True, slots=True)
class PlannerRow:
    """A row of Table 6."""

    obstacles: int
    planner: str
    """Our name of it."""
    plr: float
    """Path length ratio."""
    time_s: float
    """TC [s]."""
    cs: float
    """Iteration in which all constraints are met."""
    successes: int
    """Of ten runs."""


@dataclass(frozen=True, slots=True)
class FitnessRow:
    """A row of Table 7."""

    case: str
    """"obstacle 2" or "obstacles 3-5"."""
    planner: str
    """Our name of it."""
    mean: float
    median: float


@dataclass(frozen=True, slots=True)
class Published:
    """All of it."""

    mission: tuple[tuple[float, float, float], ...]
    """Sec. 5.1, its two misprints put right: x, y, z [m]."""
    printed_x: tuple[float, ...]
    """x as printed there [m]."""
    obstacles: tuple[tuple[float, float, float], ...]
    """Of Table 4: x, y, z [m]."""
    safety_radius: float
    """RS [m]."""
    table3: tuple[FieldRow, ...]
    table4: tuple[ListRow, ...]
    table6: tuple[PlannerRow, ...]
    table7: tuple[FitnessRow, ...]


@cache
def published() -> Published:
    """Read the file."""
    raw = tomllib.loads((files("scenarios.paper") / "published.toml").read_text(encoding="utf-8"))
    return Published(
        mission=_points(raw["mission"]["waypoints_m"]),
        printed_x=tuple(raw["mission"]["printed_x_m"]),
        obstacles=_points(raw["obstacles"]["places_m"]),
        safety_radius=raw["obstacles"]["safety_radius_m"],
        table3=tuple(FieldRow(**({"algorithm_s": None} | row)) for row in raw["table3"]),
        table4=tuple(
            ListRow(row["planner"], row["length_m"], row["time_s"], _points(row["waypoints_m"]))
            for row in raw["table4"]
        ),
        table6=tuple(PlannerRow(**row) for row in raw["table6"]),
        table7=tuple(FitnessRow(**row) for row in raw["table7"]),
    )


def _points(rows: list[list[float]]) -> Any:  # noqa: ANN401 (pairs or triples, as the file has them)
    return tuple(tuple(row) for row in rows)
