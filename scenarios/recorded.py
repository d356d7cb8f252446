"""A run directory read back, and its figures computed again from the files alone."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from offboard.errors import PlanFileError
from offboard.frames import MapFrame
from offboard.plan_files import read_plan
from scenarios.errors import RunDirectoryError, ScenarioError
from scenarios.load import load
from scenarios.metrics import path_length, separations
from scenarios.scenario import Obstacle, Scenario
from scenarios.score import approach_summary, decision_times, plan_length
from scenarios.track import MovingTrack, Track

TOLERANCE = 0.002
"""Figures of the same run may differ by this much: files are written to the millimetre."""


@dataclass(frozen=True, slots=True, eq=False)
class Recorded:
    """The files of one run."""

    directory: Path
    scenario: Scenario
    summary: dict[str, Any]
    track: Track
    obstacles: tuple[Obstacle, ...]
    traffic: tuple[MovingTrack, ...]
    decisions: tuple[dict[str, Any], ...]
    waypoints: tuple[dict[str, str], ...]
    plan_length: float
    """Of `mission.plan` [m]."""


def read_run(directory: Path) -> Recorded:
    """Read a run directory.

    Raises
    ------
    RunDirectoryError
        If a file is missing or cannot be understood; says which.
    """
    if not directory.is_dir():
        raise RunDirectoryError(directory, "no such directory")
    try:
        scenario = load(directory / "scenario.toml")
        track = _track(directory / "track.csv")
        home = scenario.home
        frame = MapFrame(home.latitude_deg, home.longitude_deg, home.altitude_m)
        return Recorded(
            directory=directory,
            scenario=scenario,
            summary=json.loads((directory / "summary.json").read_text(encoding="utf-8")),
            track=track,
            obstacles=_obstacles(directory / "obstacles.csv"),
            traffic=_traffic(directory / "traffic.csv", scenario, track),
            decisions=_decisions(directory / "decisions.jsonl"),
            waypoints=tuple(_rows(directory / "waypoints.csv")),
            plan_length=plan_length(read_plan(directory / "mission.plan").plan, frame),
        )
    except (OSError, ScenarioError, PlanFileError) as error:
        raise RunDirectoryError(directory, f"holds no run that can be read: {error}") from error
    except (ValueError, KeyError, TypeError, IndexError) as error:
        raise RunDirectoryError(directory, f"a file is damaged ({error})") from error


def recomputed(run: Recorded) -> dict[str, Any]:
    """Those figures of the summary that the files determine."""
    return {
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
    return found


def _same(a: object, b: object) -> bool:
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(_same(a[key], b[key]) for key in a)
    if isinstance(a, float) and isinstance(b, int | float):
        return abs(a - b) <= TOLERANCE
    return a == b


def _rows(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def _track(file: Path) -> Track:
    with file.open(encoding="utf-8") as stream:
        columns = stream.readline().strip().split(",")
        vehicle = stream.readline().split(",", 1)[0]
    table = np.loadtxt(file, delimiter=",", skiprows=1, usecols=range(1, len(columns)), ndmin=2)
    return Track(vehicle, table[:, 0], table[:, 1:4], table[:, 4], table[:, 5], table[:, 6])


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
        mine = table[table[:, 1] == plan.id]
        positions = np.full((len(track.times), 3), np.nan)
        positions[np.searchsorted(track.times, mine[:, 0])] = mine[:, 2:]
        found.append(MovingTrack(plan.id, plan.radius, positions))
    return tuple(found)


def _decisions(file: Path) -> tuple[dict[str, Any], ...]:
    lines: Sequence[str] = file.read_text(encoding="utf-8").splitlines()
    return tuple(json.loads(line) for line in lines if line)
