"""A recorded flight as a story: what happened when, from the files of its directory."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from avoidance.types import Floats
from scenarios.metrics import separations
from scenarios.recorded import Recorded

TOLD_WITHIN = 5000.0
"""Approaches closer than this are told [m]."""


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened."""

    time: float
    """When [s]."""
    distance: float
    """Path flown until then [m]."""
    text: str
    """What, in words."""
    style: str = ""
    """How a terminal shows it."""


def timeline(run: Recorded) -> list[Event]:
    """Everything that happened in a flight, in order of time."""
    flown = _flown(run)
    times = run.track.times
    told = sorted([*_waypoints(run), *_appearances(run), *_decisions(run), *_approaches(run)])
    start = Event(0.0, 0.0, f"{run.scenario.name}: the flight begins", "bold")
    end = (
        "the mission is completed"
        if run.summary.get("completed")
        else "the flight ends, mission not completed"
    )
    return [
        start,
        *(Event(t, float(np.interp(t, times, flown)), text, style) for t, text, style in told),
        Event(float(times[-1]), float(flown[-1]), end, "bold"),
    ]


def _flown(run: Recorded) -> Floats:
    """Path flown at each sample [m]."""
    steps = np.diff(run.track.positions[:, :2], axis=0)
    return np.concatenate(([0.0], np.cumsum(np.hypot(steps[:, 0], steps[:, 1]))))


def _waypoints(run: Recorded) -> Iterator[tuple[float, str, str]]:
    for row in run.waypoints[1:]:
        if row["passed_at_s"]:
            shift = float(row["shift_m"])
            instead = f", {shift:.0f} m from where it was planned" if shift else ""
            yield float(row["passed_at_s"]), f"waypoint {int(row['waypoint']) + 1} passed{instead}", ""


def _appearances(run: Recorded) -> Iterator[tuple[float, str, str]]:
    for obstacle in run.obstacles:
        if 0.0 < obstacle.appears_at <= run.track.times[-1]:
            yield obstacle.appears_at, f"obstacle {obstacle.id} appears", "yellow"


def _decisions(run: Recorded) -> Iterator[tuple[float, str, str]]:
    for row in run.decisions:
        yield float(row["t_s"]), f"{row['decision']}: {row['why']}", "cyan"


def _approaches(run: Recorded) -> Iterator[tuple[float, str, str]]:
    for near in separations(run.track, run.obstacles, run.traffic):
        if near.distance >= max(TOLD_WITHIN, near.radius) or not math.isfinite(near.distance):
            continue
        what = "traffic" if near.moving else "obstacle"
        text = f"closest to {what} {near.id}: {near.distance:.1f} m, sphere {near.radius:.0f} m"
        inside = near.distance < near.radius
        yield near.time, text + (", ENTERED" if inside else ""), "bold red" if inside else "green"
