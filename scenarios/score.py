"""The summary of a flight: every figure of `summary.json`, and the fate of every waypoint."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from avoidance import Hold, Performance
from avoidance.contingency import longest_stretch
from avoidance.geofence import Walls
from avoidance.known import ALTITUDE_TOLERANCE, kept_margin
from avoidance.orbits import passage_room, waypoint_room
from avoidance.parameters import Parameters
from avoidance.tangent_graph import shortest_path
from avoidance.types import Floats
from offboard.frames import MapFrame
from offboard.mission import MissionPlan
from scenarios import __version__
from scenarios.fence import FenceArea, Place, breaches, core_fence
from scenarios.flown import Flown, FlownVehicle, LoggedDecision
from scenarios.goals import Goal, ReplacementRule, discs, goals
from scenarios.metrics import Separation, first_pass, nearest_pass, path_length, separations
from scenarios.scenario import Obstacle, Point
from scenarios.track import Track

AT_POSTS = 0.01
"""The shortest way keeps this from edges of the geofence, round whose corners it bends [m]."""


@dataclass(frozen=True, slots=True)
class Fate:
    """What became of one waypoint of the mission."""

    goal: Goal
    """Where it could be reached."""
    passed_at: float | None
    """When the track was as near to it as can be, within the acceptance radius [s]; None if never."""
    missed_by: float | None
    """How much farther than that from it the track stayed at its nearest [m]; None if there is no goal."""

    @property
    def met(self) -> bool:
        """True if it was passed, and for a waypoint that nothing can stand for."""
        return self.passed_at is not None or self.goal.point is None


@dataclass(frozen=True, slots=True)
class VehicleScore:
    """What one own vehicle did, judged."""

    name: str
    figures: dict[str, Any]
    """Its part of the summary."""
    fates: tuple[Fate, ...]
    """One per waypoint of its mission."""
    separations: tuple[Separation, ...]
    """One per obstacle that existed, traffic and other own vehicles included."""


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
    vehicles: tuple[VehicleScore, ...]
    """One per own vehicle."""

    @property
    def safe(self) -> bool:
        """True if all missions were completed, no sphere entered and the geofence kept."""
        kept = self.summary["violations"] == 0 and not self.summary.get("fence_breaches")
        return bool(self.summary["completed"]) and kept

    @property
    def fates(self) -> tuple[Fate, ...]:
        """Of the first vehicle's waypoints."""
        return self.vehicles[0].fates

    @property
    def separations(self) -> tuple[Separation, ...]:
        """Of all vehicles."""
        return tuple(one for vehicle in self.vehicles for one in vehicle.separations)


def score(flown: Flown, energy: Energy | None = None) -> Score:
    """Judge a flight from its tracks alone, with all obstacles known; the battery is as the plant tells.

    Notes
    -----
    Completed: the vehicle reached the end of its mission and, in order, came as near to every waypoint as
    `scenarios.goals` finds possible, within the acceptance radius.
    """
    wall = flown.wall.total
    vehicles = tuple(score_vehicle(flown, vehicle) for vehicle in flown.vehicles)
    figures = vehicles[0].figures
    if len(vehicles) > 1:
        figures = fleet_figures([vehicle.figures for vehicle in vehicles])
        figures["decision_ms"] = _decision_times(flown.decisions)
    duration = figures["flight_time_s"]
    decided = figures["decision_ms"]
    summary = {
        **{key: value for key, value in figures.items() if key != "decision_ms"},
        "state_of_charge": None if energy is None else round(energy.state_of_charge, 4),
        "reserve_used": None if energy is None else energy.reserve_used,
        "decision_ms": decided,
        "wall_s": round(wall, 3),
        "real_time_factor": round(duration / wall, 1) if wall > 0.0 else None,
        "seed": flown.seed,
        "preset": flown.parameters.name,
        "version": __version__,
    }
    if len(vehicles) > 1:
        summary["vehicles"] = {vehicle.name: vehicle.figures for vehicle in vehicles}
    return Score(summary, vehicles)


def score_vehicle(flown: Flown, vehicle: FlownVehicle) -> VehicleScore:
    """Judge what one own vehicle did."""
    obstacles = flown.scenario.obstacles
    rule = replacement_rule(flown.parameters, vehicle.performance)
    targets = goals(vehicle.mission, obstacles, rule, flown.scenario.geofence)
    fates = waypoint_fates(vehicle.track, targets, vehicle.performance.acceptance_radius)
    approaches = separations(vehicle.track, obstacles, vehicle.others)
    names = {member.id for member in flown.scenario.vehicles}
    figures = {
        "completed": vehicle.ending == "finished" and all(fate.met for fate in fates),
        **approach_summary(approaches),
        "path_length_m": round(path_length(vehicle.track.positions), 3),
        "plan_length_m": round(plan_length(vehicle.plan, flown.frame), 3),
        "optimum_length_m": optimum_length(vehicle.mission, targets, obstacles, flown.scenario.geofence),
        "flight_time_s": float(vehicle.track.times[-1]),
        "waypoints_replaced": replaced_waypoints(vehicle.decisions),
        "replans": sum(changes_route(entry) for entry in vehicle.decisions),
        "decision_ms": _decision_times(vehicle.decisions),
    }
    if flown.scenario.geofence:
        outside = breaches(vehicle.track, flown.scenario.geofence)
        figures["fence_breaches"] = len(outside)
        figures["outside_fence_s"] = round(sum(end - begin for begin, end in outside), 3)
    if names:
        figures["violations_of_vehicles"] = sum(s.entries for s in approaches if s.moving and s.id in names)
    return VehicleScore(vehicle.name, figures, tuple(fates), tuple(approaches))


def fleet_figures(vehicles: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """The figures of several own vehicles as one: sums, and the worst.

    An approach of two own vehicles is in the figures of both and counts once.
    """

    def total(key: str) -> float | None:
        values = [figures[key] for figures in vehicles]
        return None if None in values else round(sum(values), 3)

    met = [figures for figures in vehicles if figures["min_separation_m"] is not None]
    closest = min(met, key=lambda figures: figures["min_separation_m"], default=vehicles[0])
    fence: dict[str, Any] = {
        key: round(sum(figures[key] for figures in vehicles), 3)
        for key in ("fence_breaches", "outside_fence_s")
        if key in vehicles[0]
    }
    twice = sum(figures["violations_of_vehicles"] for figures in vehicles) // 2
    return {
        "completed": all(figures["completed"] for figures in vehicles),
        "violations": sum(figures["violations"] for figures in vehicles) - twice,
        "min_separation_m": closest["min_separation_m"],
        "min_margin_m": min((figures["min_margin_m"] for figures in met), default=None),
        "closest_obstacle": closest["closest_obstacle"],
        "violation_radius_m": closest["violation_radius_m"],
        "path_length_m": total("path_length_m"),
        "plan_length_m": total("plan_length_m"),
        "optimum_length_m": total("optimum_length_m"),
        "flight_time_s": max(figures["flight_time_s"] for figures in vehicles),
        "waypoints_replaced": sum(figures["waypoints_replaced"] for figures in vehicles),
        "replans": sum(figures["replans"] for figures in vehicles),
        "decision_ms": None,
        **fence,
    }


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

    By default a waypoint needs RS + margin + room to turn and to wait, and so does what replaces it (where
    there is no such point, room to turn, then half of it); the way in must not be too narrow to turn round in
    for long. The paper replaces what lies inside the sphere, by a point at RS + tolerance. Both keep their
    altitude within `ALTITUDE_TOLERANCE`.
    """
    margin = kept_margin(parameters, performance)
    turn = performance.turn_room
    if not parameters.all_obstacles:
        rooms = (parameters.tolerance - margin, turn)
        return ReplacementRule(margin, 0.0, rooms, altitude_tolerance=ALTITUDE_TOLERANCE)
    needed = waypoint_room(performance, margin)
    passage, stretch = 0.0, 0.0
    if parameters.pop_up_room is not None:
        passage = passage_room(performance, margin)
        stretch = longest_stretch(performance, parameters.pop_up_room)
    return ReplacementRule(margin, needed, (needed, turn, 0.5 * turn), passage, stretch, ALTITUDE_TOLERANCE)


def waypoint_fates(track: Track, targets: Sequence[Goal], radius: float) -> list[Fate]:
    """When each waypoint was met, in their order, within `radius` [m].

    Notes
    -----
    A waypoint that was replaced is met anywhere within its shift + `radius`: several points may be equally
    near to it (all of a circle, if an obstacle stands on it), and none of them is the right one.
    """
    fates = []
    after = -math.inf
    for goal in targets:
        place = (goal.north, goal.east)
        passed = first_pass(track, place, goal.shift + radius, after)
        missed = None if goal.point is None else max(nearest_pass(track, place) - goal.shift, 0.0)
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
    mission: Sequence[Point],
    targets: Sequence[Goal],
    obstacles: Sequence[Obstacle],
    fence: Sequence[FenceArea] = (),
) -> float | None:
    """Length of the shortest way through all goals outside every sphere and within the fence, leg by leg [m].

    With full knowledge and without a margin; spheres are cut at the altitude of each leg's end. None if
    there is no way.
    """
    total = 0.0
    here = (mission[0].north, mission[0].east)
    edges = core_fence(fence)
    posts = np.concatenate((edges.discs, np.column_stack((edges.posts, np.full(len(edges.posts), AT_POSTS)))))
    for goal in targets[1:]:
        if goal.point is None:
            continue
        centres, radii = discs(obstacles, mission[goal.waypoint].altitude)
        centres, radii = np.concatenate((centres, posts[:, :2])), np.concatenate((radii, posts[:, 2]))
        length = _leg_optimum(here, goal.point, centres, radii, Walls(edges.walls, AT_POSTS))
        if length is None:
            return None
        total += length
        here = goal.point
    return round(total, 3)


def _leg_optimum(start: Place, goal: Place, centres: Floats, radii: Floats, walls: Walls) -> float | None:
    for end in (start, goal):  # a leg may begin inside a circle cut at the height of its end
        if (np.hypot(*(centres - end).T) < radii * (1.0 - 1e-9)).any():
            return None
    path = shortest_path(start, goal, centres, radii, walls)
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


def _decision_times(decisions: Iterable[LoggedDecision]) -> dict[str, float | None]:
    return decision_times([round(entry.milliseconds, 3) for entry in decisions])


def decision_times(milliseconds: Sequence[float]) -> dict[str, float | None]:
    """Median and 99th percentile [ms]; null without decisions."""
    if not milliseconds:
        return {"median": None, "p99": None}
    return {
        "median": round(float(np.median(milliseconds)), 3),
        "p99": round(float(np.percentile(milliseconds, 99)), 3),
    }
