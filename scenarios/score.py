"""The summary of a flight: every figure of `summary.json`, and the fate of every waypoint."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from avoidance import Hold, Performance
from avoidance.parameters import Parameters
from avoidance.tangent_graph import shortest_path
from avoidance.types import Floats
from offboard.frames import MapFrame
from offboard.mission import MissionPlan
from scenarios import __version__
from scenarios.goals import Goal, ReplacementRule, discs, goals
from scenarios.metrics import Separation, first_pass, nearest_pass, path_length, separations
from scenarios.run import Flown, LoggedDecision
from scenarios.scenario import Obstacle, Point
from scenarios.track import Track


@dataclass(frozen=True, slots=True)
class Fate:
    """What became of one waypoint of the mission."""

    goal: Goal
    """Where it could be reached."""
    passed_at: float | None
    """When it, or what stands for it, was passed within the acceptance radius [s]; None if never."""
    missed_by: float | None
    """Least distance of the track from the goal [m]; None if there is no goal."""

    @property
    def met(self) -> bool:
        """True if it was passed, and for a waypoint that nothing can stand for."""
        return self.passed_at is not None or self.goal.point is None


@dataclass(frozen=True, slots=True)
class Energy:
    """What a flight has left of the battery."""

    state_of_charge: float
    """At the end, 0 to 1."""
    reserve_used: bool
    """Whether the reserve was touched at any time: a long hold or detour can do that."""


@dataclass(frozen=True, slots=True)
class Score:
    """A flight, judged."""

    summary: dict[str, Any]
    """What `summary.json` holds, in its order."""
    fates: tuple[Fate, ...]
    """One per waypoint of the mission."""
    separations: tuple[Separation, ...]
    """One per obstacle that existed."""

    @property
    def safe(self) -> bool:
        """True if the mission was completed and no sphere entered."""
        return bool(self.summary["completed"]) and self.summary["violations"] == 0


def score(flown: Flown, energy: Energy | None = None) -> Score:
    """Judge a flight from its track alone, with all obstacles known; the battery is as the plant tells.

    Notes
    -----
    Completed: the vehicle reached the end of its mission, and every waypoint, or the point that
    `scenarios.goals` finds for it, was passed in order within the acceptance radius.
    """
    scenario = flown.scenario
    rule = replacement_rule(flown.parameters, flown.performance)
    targets = goals(scenario.mission, scenario.obstacles, rule)
    fates = waypoint_fates(flown.track, targets, flown.performance.acceptance_radius)
    approaches = separations(flown.track, scenario.obstacles, flown.traffic)
    wall = flown.wall.total
    duration = float(flown.track.times[-1])
    summary = {
        "completed": flown.ending == "finished" and all(fate.met for fate in fates),
        **approach_summary(approaches),
        "path_length_m": round(path_length(flown.track.positions), 3),
        "plan_length_m": round(plan_length(flown.plan, flown.frame), 3),
        "optimum_length_m": optimum_length(scenario.mission, targets, scenario.obstacles),
        "flight_time_s": duration,
        "waypoints_replaced": replaced_waypoints(flown.decisions),
        "replans": sum(changes_route(entry) for entry in flown.decisions),
        "state_of_charge": None if energy is None else round(energy.state_of_charge, 4),
        "reserve_used": None if energy is None else energy.reserve_used,
        "decision_ms": decision_times([round(entry.milliseconds, 3) for entry in flown.decisions]),
        "wall_s": round(wall, 3),
        "real_time_factor": round(duration / wall, 1) if wall > 0.0 else None,
        "seed": flown.seed,
        "preset": flown.parameters.name,
        "version": __version__,
    }
    return Score(summary, tuple(fates), tuple(approaches))


def approach_summary(approaches: Sequence[Separation]) -> dict[str, Any]:
    """The part of the summary that speaks of obstacles; null where there are none."""
    closest = min(approaches, key=lambda s: s.distance, default=None)
    return {
        "violations": sum(s.entries for s in approaches),
        "min_separation_m": None if closest is None else round(closest.distance, 3),
        "min_margin_m": round(min(s.margin for s in approaches), 3) if approaches else None,
        "closest_obstacle": None if closest is None else closest.id,
        "violation_radius_m": None if closest is None else closest.radius,
    }


def replacement_rule(parameters: Parameters, performance: Performance) -> ReplacementRule:
    """The published margins of a preset.

    By default a waypoint needs RS + margin + room to turn, and so does what replaces it. The paper
    replaces what lies inside the sphere, by a point at RS + tolerance.
    """
    margin = max(parameters.margin, performance.tracking_error)
    turn = performance.turn_room
    if parameters.all_obstacles:
        return ReplacementRule(margin, turn, (turn, 0.5 * turn))
    return ReplacementRule(margin, 0.0, (parameters.tolerance - parameters.margin, turn))


def waypoint_fates(track: Track, targets: Sequence[Goal], radius: float) -> list[Fate]:
    """Which goals were passed within `radius` [m], in their order; the waypoint itself counts as well."""
    fates = []
    after = -math.inf
    for goal in targets:
        places = [(goal.north, goal.east)] + ([goal.point] if goal.point and goal.replaced else [])
        passes = [t for p in places if (t := first_pass(track, p, radius, after)) is not None]
        passed = min(passes, default=None)
        missed = None if goal.point is None else nearest_pass(track, goal.point)
        fates.append(Fate(goal, passed, missed))
        after = after if passed is None else passed
    return fates


def plan_length(plan: MissionPlan, frame: MapFrame) -> float:
    """Horizontal length of the polyline through all items [m]."""
    items = plan.mission_items
    latitudes = np.array([item.latitude_deg for item in items])
    longitudes = np.array([item.longitude_deg for item in items])
    north, east = frame.to_map(latitudes, longitudes)
    return path_length(np.column_stack((north, east)))


def optimum_length(
    mission: Sequence[Point], targets: Sequence[Goal], obstacles: Sequence[Obstacle]
) -> float | None:
    """Length of the shortest way through all goals outside every sphere, leg by leg [m].

    With full knowledge and without a margin; spheres are cut at the altitude of each leg's end. None if
    there is no way.
    """
    total = 0.0
    here = (mission[0].north, mission[0].east)
    for goal in targets[1:]:
        if goal.point is None:
            continue
        length = _leg_optimum(here, goal.point, *discs(obstacles, mission[goal.waypoint].altitude))
        if length is None:
            return None
        total += length
        here = goal.point
    return round(total, 3)


def _leg_optimum(
    start: tuple[float, float], goal: tuple[float, float], centres: Floats, radii: Floats
) -> float | None:
    for end in (start, goal):  # a leg may begin inside a circle cut at the height of its end
        if (np.hypot(*(centres - end).T) < radii * (1.0 - 1e-9)).any():
            return None
    path = shortest_path(start, goal, centres, radii)
    return None if path is None else path.length


def changes_route(entry: LoggedDecision) -> bool:
    """True for a decision that changed what is flown."""
    return entry.decision.route is not None or isinstance(entry.decision, Hold)


def replaced_waypoints(decisions: Iterable[LoggedDecision]) -> int:
    """How many waypoints of the mission were finally moved or skipped by the decisions of a flight."""
    replaced: dict[int, bool] = {}
    for entry in decisions:
        if entry.decision.route is None:
            continue
        kept = {w.item: w.moved for w in entry.decision.route if w.item is not None}
        ahead = {w.item for w in entry.route.waypoints if w.item is not None}
        replaced |= dict.fromkeys(ahead - kept.keys(), True)
        replaced |= kept
    return sum(replaced.values())


def decision_times(milliseconds: Sequence[float]) -> dict[str, float | None]:
    """Median and 99th percentile [ms]; null without decisions."""
    if not milliseconds:
        return {"median": None, "p99": None}
    return {
        "median": round(float(np.median(milliseconds)), 3),
        "p99": round(float(np.percentile(milliseconds, 99)), 3),
    }
