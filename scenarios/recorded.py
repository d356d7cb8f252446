"""A run directory read back, and its figures computed again from the files alone."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from offboard.errors import PlanFileError
from offboard.frames import MapFrame
from offboard.plan_files import read_plan
from scenarios.errors import RunDirectoryError, ScenarioError
from scenarios.fence import breaches
from scenarios.load import load
from scenarios.metrics import path_length, separations
from scenarios.record import plan_name
from scenarios.scenario import TRAFFIC_VIOLATION_RADIUS, Obstacle, Scenario
from scenarios.score import approach_summary, decision_times, plan_length
from scenarios.track import MovingTrack, Track

TOLERANCE = 0.002
"""Figures of the same run may differ by this much: files are written to the millimetre."""


@dataclass(frozen=True, slots=True, eq=False)
class Recorded:
    """The files of one run."""

    directory: Path
    vehicle: str
    """Whose view it is."""
    fleet: tuple[str, ...]
    """Names of all own vehicles."""
    scenario: Scenario
    """With the mission of this vehicle."""
    summary: dict[str, Any]
    """The figures of this vehicle, and what belongs to the whole flight."""
    track: Track
    obstacles: tuple[Obstacle, ...]
    traffic: tuple[MovingTrack, ...]
    """Everything that moved beside it, other own vehicles included."""
    decisions: tuple[dict[str, Any], ...]
    waypoints: tuple[dict[str, str], ...]
    plan_file: Path
    """Its mission as finally flown."""
    plan_length: float
    """Of that file [m]."""

    def name_of(self, moving: int) -> str:
        """A word for something that moves."""
        names = {member.id: f"vehicle {member.name}" for member in self.scenario.vehicles}
        return names.get(moving, "traffic")


def read_fleet(directory: Path) -> list[Recorded]:
    """Read a run directory once for each own vehicle.

    Raises
    ------
    RunDirectoryError
        If a file is missing or cannot be understood; says which.
    """
    first = read_run(directory)
    return [first, *(read_run(directory, name) for name in first.fleet[1:])]


def read_run(directory: Path, vehicle: str | None = None) -> Recorded:
    """Read a run directory as seen by one own vehicle, the first unless another is named.

    Raises
    ------
    RunDirectoryError
        If a file is missing or cannot be understood; says which.
    """
    if not directory.is_dir():
        raise RunDirectoryError(directory, "no such directory")
    try:
        scenario = load(directory / "scenario.toml")
        tracks = _tracks(directory / "track.csv")
        names = [member.name for member in scenario.fleet]
        number = names.index(vehicle) if vehicle is not None else 0
        name = names[number]
        track = tracks[name]
        home = scenario.home
        frame = MapFrame(home.latitude_deg, home.longitude_deg, home.altitude_m)
        plan_file = directory / plan_name(name, number)
        others = [_beside(tracks[m.name], track, m.id) for m in scenario.vehicles if m.name != name]
        return Recorded(
            directory=directory,
            vehicle=name,
            fleet=tuple(names),
            scenario=replace(scenario, mission=scenario.fleet[number].mission),
            summary=_summary(directory / "summary.json", name),
            track=track,
            obstacles=_obstacles(directory / "obstacles.csv"),
            traffic=(*_traffic(directory / "traffic.csv", scenario, track), *others),
            decisions=tuple(d for d in _decisions(directory / "decisions.jsonl") if _is_of(d, name)),
            waypoints=tuple(w for w in _rows(directory / "waypoints.csv") if _is_of(w, name)),
            plan_file=plan_file,
            plan_length=plan_length(read_plan(plan_file).plan, frame),
        )
    except (OSError, ScenarioError, PlanFileError) as error:
        raise RunDirectoryError(directory, f"holds no run that can be read: {error}") from error
    except (ValueError, KeyError, TypeError, IndexError) as error:
        raise RunDirectoryError(directory, f"a file is damaged ({error})") from error


def recomputed(run: Recorded) -> dict[str, Any]:
    """Those figures of the summary that the files determine."""
    outside = breaches(run.track, run.scenario.geofence)
    fence = {
        "fence_breaches": len(outside),
        "outside_fence_s": round(sum(end - begin for begin, end in outside), 3),
    }
    return {
        **(fence if run.scenario.geofence else {}),
        **approach_summary(separations(run.track, run.obstacles, run.traffic)),
        "path_length_m": round(path_length(run.track.positions), 3),
        "plan_length_m": round(run.plan_length, 3),
        "flight_time_s": float(run.track.times[-1]),
        "decision_ms": decision_times([row["decision_ms"] for row in run.decisions]),
    }


def differences(run: Recorded) -> list[str]:
    """Where the summary and the other files of a run disagree, in words."""
    found = []
    for key, value in recomputed(run).items():
        stated = run.summary.get(key)
        if not _same(value, stated):
            found.append(f"{key}: summary.json says {stated}, the files give {value}")
    return found if len(run.fleet) == 1 else [f"vehicle {run.vehicle}, {text}" for text in found]


def _same(a: object, b: object) -> bool:
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(_same(a[key], b[key]) for key in a)
    if isinstance(a, float) and isinstance(b, int | float):
        return abs(a - b) <= TOLERANCE
    return a == b


def _rows(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def _is_of(row: Mapping[str, Any], vehicle: str) -> bool:
    """True for a row about a vehicle; files written before there were fleets do not name it."""
    return not isinstance(row, Mapping) or bool(row.get("vehicle", vehicle) == vehicle)


def _summary(file: Path, vehicle: str) -> dict[str, Any]:
    whole: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    return {**whole, **whole.get("vehicles", {}).get(vehicle, {})}


def _tracks(file: Path) -> dict[str, Track]:
    """The tracks of all own vehicles by name; each vehicle's lines are in one piece."""
    lines = file.read_text(encoding="utf-8").splitlines()[1:]
    found = {}
    for vehicle, mine in groupby(lines, key=lambda line: line.split(",", 1)[0]):
        table = np.loadtxt([line.split(",", 1)[1] for line in mine], delimiter=",", ndmin=2)
        found[vehicle] = Track(vehicle, table[:, 0], table[:, 1:4], table[:, 4], table[:, 5], table[:, 6])
    return found


def _beside(other: Track, own: Track, identity: int) -> MovingTrack:
    """Another own vehicle as something that moves, at the times of the own track."""
    positions = np.full((len(own.times), 3), np.nan)
    known = other.positions[: len(own.times)]
    positions[: len(known)] = known
    return MovingTrack(identity, TRAFFIC_VIOLATION_RADIUS, positions)


def _obstacles(file: Path) -> tuple[Obstacle, ...]:
    return tuple(
        Obstacle(
            id=int(row["id"]),
            north=float(row["north_m"]),
            east=float(row["east_m"]),
            altitude=float(row["altitude_m"]),
            safety_radius=float(row["radius_m"]),
            appears_at=float(row["appears_at_s"]),
            kind=row["kind"],
        )
        for row in _rows(file)
    )


def _traffic(file: Path, scenario: Scenario, track: Track) -> tuple[MovingTrack, ...]:
    if not scenario.traffic:
        return ()
    lines = file.read_text(encoding="utf-8").splitlines()[1:]
    table = np.array([line.split(",") for line in lines], dtype=np.float64).reshape(-1, 5)
    found = []
    for plan in scenario.traffic:
        mine = table[(table[:, 1] == plan.id) & (table[:, 0] <= track.times[-1])]
        positions = np.full((len(track.times), 3), np.nan)
        positions[np.searchsorted(track.times, mine[:, 0])] = mine[:, 2:]
        found.append(MovingTrack(plan.id, plan.radius, positions))
    return tuple(found)


def _decisions(file: Path) -> tuple[dict[str, Any], ...]:
    lines: Sequence[str] = file.read_text(encoding="utf-8").splitlines()
    return tuple(json.loads(line) for line in lines if line)
