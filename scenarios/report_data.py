"""What the report shows of a recorded run: everything with a sphere, the decisions with their places."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from avoidance.types import Bools, Floats
from offboard.frames import MapFrame
from offboard.plan_files import read_plan
from scenarios.errors import RunDirectoryError
from scenarios.metrics import Separation, separations
from scenarios.recorded import Recorded, differences, read_run
from scenarios.scenario import Scenario
from scenarios.track import Track

SAME_PLACE = 1.0
"""A waypoint is part of the final mission if that has one within this distance [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Hazard:
    """Something with a sphere round it: an obstacle that stands still, or traffic that moves."""

    id: int
    kind: str
    """A word for it: "stationary", "traffic" …"""
    radius: float
    """Entering a sphere of this radius is a violation [m]."""
    appears_at: float
    """It exists from this time on [s]."""
    places: Floats
    """North, east, altitude [m]: shape (1, 3) where it stands, or (m, 3) at the times of the own track, NaN
    while it does not exist."""
    closest: Separation | None
    """The closest pass; None if it never existed during the flight."""
    moving: bool = False
    """True for traffic."""

    def exists(self, times: Floats) -> Bools:
        """Whether it was there at the times of the own track, shape (m,)."""
        since: Bools = times >= self.appears_at
        there: Bools = np.isfinite(self.places[:, 0])
        return since & there

    def place(self, times: Floats) -> Floats:
        """Where it is drawn: where it stands, or where it was at the closest pass; shape (3,) [m]."""
        if not self.moving:
            standing: Floats = self.places[0]
            return standing
        if self.closest is None:
            return np.full(3, math.nan)
        return position(times, self.places, self.closest.time)


@dataclass(frozen=True, slots=True)
class Mark:
    """One line of decisions.jsonl."""

    number: int
    """Counted from 1."""
    time: float
    """Time [s]."""
    north: float
    """Where the vehicle was, north of home [m]."""
    east: float
    """East of home [m]."""
    waypoints: tuple[tuple[float, float], ...]
    """Waypoints put into the route, north and east [m]."""
    kept: tuple[bool, ...]
    """Whether the mission as finally flown still has each of them."""
    row: Mapping[str, Any]
    """The line itself."""


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """Everything the report shows."""

    summary: Mapping[str, Any]
    scenario: Scenario
    track: Track
    hazards: tuple[Hazard, ...]
    """Obstacles in the order of the file, then traffic."""
    decisions: tuple[Mark, ...]
    disagreements: tuple[str, ...]
    """Where the summary and the other files disagree, in words."""
    vehicle: str
    """Whose flight is shown."""
    fleet: tuple[str, ...]
    """Names of all own vehicles."""

    @property
    def mission(self) -> Floats:
        """The waypoints of the mission as planned, north and east [m], shape (n, 2)."""
        return np.array([(point.north, point.east) for point in self.scenario.mission])


def read(directory: Path) -> Run:
    """Read a run directory as seen by its first vehicle.

    Raises
    ------
    RunDirectoryError
        If a file is missing or cannot be understood; names it.
    """
    return shown(read_run(directory))


def shown(recorded: Recorded) -> Run:
    """What the report shows of one vehicle's flight."""
    return Run(
        summary=recorded.summary,
        scenario=recorded.scenario,
        track=recorded.track,
        hazards=_hazards(recorded),
        decisions=_decisions(recorded, _final_mission(recorded)),
        disagreements=tuple(differences(recorded)),
        vehicle=recorded.vehicle,
        fleet=recorded.fleet,
    )


def position(times: Floats, places: Floats, time: float) -> Floats:
    """Position at `time` [s], linear between samples, the known one next to a gap; shape (3,) [m]."""
    after = min(max(int(np.searchsorted(times, time)), 1), len(times) - 1)
    before, behind = places[after - 1], places[after]
    share = min(max((time - times[after - 1]) / (times[after] - times[after - 1]), 0.0), 1.0)
    between: Floats = before + share * (behind - before)
    for place in (between, before, behind):
        if np.isfinite(place).all():
            return place
    return between


def _hazards(recorded: Recorded) -> tuple[Hazard, ...]:
    passes = separations(recorded.track, recorded.obstacles, recorded.traffic)
    by_id = {(found.id, found.moving): found for found in passes}
    still = [
        Hazard(
            o.id,
            o.kind,
            o.safety_radius,
            o.appears_at,
            np.array([[o.north, o.east, o.altitude]]),
            by_id.get((o.id, False)),
        )
        for o in recorded.obstacles
    ]
    moving = [
        Hazard(
            t.id,
            recorded.name_of(t.id),
            t.radius,
            -math.inf,
            t.positions,
            by_id.get((t.id, True)),
            moving=True,
        )
        for t in recorded.traffic
    ]
    return (*still, *moving)


def _final_mission(recorded: Recorded) -> Floats:
    home = recorded.scenario.home
    frame = MapFrame(home.latitude_deg, home.longitude_deg, home.altitude_m)
    items = read_plan(recorded.plan_file).plan.mission_items
    return np.array([frame.to_map(item.latitude_deg, item.longitude_deg) for item in items]).reshape(-1, 2)


def _decisions(recorded: Recorded, final: Floats) -> tuple[Mark, ...]:
    marks = []
    for number, row in enumerate(recorded.decisions, start=1):
        try:
            points = tuple((float(w["north_m"]), float(w["east_m"])) for w in row["waypoints"])
            where = (float(row["t_s"]), float(row["north_m"]), float(row["east_m"]))
        except (KeyError, TypeError, ValueError) as error:
            file = recorded.directory / "decisions.jsonl"
            raise RunDirectoryError(file, f"line {number} cannot be understood ({error!r})") from error
        marks.append(Mark(number, *where, points, _kept(points, final), row))
    return tuple(marks)


def _kept(points: Sequence[tuple[float, float]], final: Floats) -> tuple[bool, ...]:
    return tuple(bool((np.linalg.norm(final - point, axis=1) < SAME_PLACE).any()) for point in points)
