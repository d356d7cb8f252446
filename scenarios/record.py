"""The files of a run: a directory that is written whole or not at all (docs/run-directory.md)."""

from __future__ import annotations

import csv
import io
import json
import math
import shutil
import tempfile
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from avoidance import Detour, Hold, Replace, Reroute, Threat, Waypoint
from avoidance.types import Floats
from avoidance.yardsticks import length_to_optimum, search_gap
from offboard.plan_files import PlanFile, write_plan
from scenarios.errors import RunDirectoryError
from scenarios.fence import geofence_data
from scenarios.flown import Flown, LoggedDecision
from scenarios.rally import rally_data
from scenarios.scenario import OWN, Obstacle
from scenarios.score import Score, replacement_rule
from scenarios.target import PREFIX, check_target, followed
from scenarios.toml_text import to_toml
from scenarios.track import MovingTrack, Track

if TYPE_CHECKING:
    from offboard.live.aboard import Event


def write_run(
    directory: Path, flown: Flown, score: Score, report: Callable[[Path], object] | None = None
) -> None:
    """Write all files of a run; a previous run there is replaced at the end, in one go.

    Parameters
    ----------
    directory : Path
        Where to.
    flown, score : Flown, Score
        The flight and its judgement.
    report : callable, optional
        Called with the directory before it takes its final name, to add the report.

    Raises
    ------
    RunDirectoryError
        If it cannot be written; nothing is left behind then.
    """
    check_target(directory)
    target = followed(directory)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        temporary = Path(tempfile.mkdtemp(prefix=PREFIX, dir=target.parent))
        try:
            _write_files(temporary, flown, score)
            if report is not None:
                report(temporary)
            temporary.chmod(0o755)
            _take_place(temporary, target)
        finally:
            shutil.rmtree(temporary, ignore_errors=True)
    except OSError as error:
        raise RunDirectoryError(directory, f"cannot be written ({error})") from error


def _take_place(temporary: Path, directory: Path) -> None:
    """Put a finished directory where it belongs; what was there goes only once that has worked."""
    if not directory.exists():
        temporary.rename(directory)
        return
    aside = Path(tempfile.mkdtemp(prefix=f"{PREFIX}old-", dir=directory.parent))
    directory.rename(aside / "run")
    try:
        temporary.rename(directory)
    except OSError:
        (aside / "run").rename(directory)
        raise
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def _write_files(directory: Path, flown: Flown, score: Score) -> None:
    home = flown.scenario.home
    texts = {
        "scenario.toml": to_toml(flown.scenario),
        "summary.json": summary_text(score.summary),
        "track.csv": track_text([vehicle.track for vehicle in flown.vehicles]),
        "obstacles.csv": obstacles_text(flown.scenario.obstacles),
        "traffic.csv": traffic_text(_longest(flown), flown.traffic),
        "waypoints.csv": waypoints_text(score),
        "decisions.jsonl": "".join(json_line(row) for row in decision_rows(flown)),
        "run.json": json.dumps(run_facts(flown), indent=2, allow_nan=False) + "\n",
    }
    if flown.events is not None:
        texts["events.jsonl"] = "".join(json_line(event_row(event)) for event in flown.events)
    for name, text in texts.items():
        (directory / name).write_text(text, encoding="utf-8", newline="\n")
    cruise = flown.scenario.vehicle.airspeed
    for number, vehicle in enumerate(flown.vehicles):
        place = (home.latitude_deg, home.longitude_deg, home.altitude_m)
        fence = geofence_data(flown.scenario.geofence, flown.frame)
        rally = rally_data(flown.scenario.rally, flown.frame)
        plan = PlanFile(vehicle.plan, *place, cruise, fence, rally)
        write_plan(directory / plan_name(vehicle.name, number), plan)


def plan_name(vehicle: str, number: int) -> str:
    """File of the mission that an own vehicle has finally flown; `number` counts from 0."""
    return "mission.plan" if number == 0 else f"mission-{vehicle}.plan"


def _longest(flown: Flown) -> Floats:
    """Times of the longest track."""
    return max((vehicle.track.times for vehicle in flown.vehicles), key=len)


def summary_text(summary: dict[str, Any]) -> str:
    """`summary.json`, and what `--json` prints."""
    return json.dumps(summary, indent=2, allow_nan=False) + "\n"


def json_line(row: dict[str, Any]) -> str:
    """One line of `decisions.jsonl`."""
    return json.dumps(row, ensure_ascii=False, allow_nan=False) + "\n"


def track_text(tracks: Sequence[Track]) -> str:
    """`track.csv`."""
    text = "vehicle,t_s,north_m,east_m,altitude_m,airspeed_m_s,heading_deg,bank_deg\n"
    for track in tracks:
        table = np.column_stack(
            (track.times, track.positions, track.airspeeds, track.headings_deg, track.banks_deg)
        )
        text += _lines(f"{track.vehicle}," + ",".join(["%.3f"] * 7), table)
    return text


def obstacles_text(obstacles: Iterable[Obstacle]) -> str:
    """`obstacles.csv`: what stands still."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("id", "kind", "north_m", "east_m", "altitude_m", "radius_m", "appears_at_s"))
    for o in obstacles:
        numbers = (o.north, o.east, o.altitude, o.safety_radius, o.appears_at)
        writer.writerow((o.id, o.kind, *(f"{value:.3f}" for value in numbers)))
    return text.getvalue()


def traffic_text(times: Floats, traffic: Iterable[MovingTrack]) -> str:
    """`traffic.csv`: what moves, while it exists, one obstacle after the other."""
    text = "t_s,id,north_m,east_m,altitude_m\n"
    for mover in traffic:
        exists = np.isfinite(mover.positions[:, 0])
        table = np.column_stack((times[exists], mover.positions[exists]))
        text += _lines(f"%.3f,{mover.id},%.3f,%.3f,%.3f", table)
    return text


def waypoints_text(score: Score) -> str:
    """`waypoints.csv`: what became of each waypoint of the mission; empty where there is no value."""
    text = "vehicle,waypoint,north_m,east_m,goal_north_m,goal_east_m,shift_m,passed_at_s,missed_by_m\n"
    for vehicle in score.vehicles:
        for fate in vehicle.fates:
            goal = fate.goal
            point = goal.point or (None, None)
            values = (goal.north, goal.east, *point, goal.shift, fate.passed_at, fate.missed_by)
            shown = ("" if value is None else f"{value:.3f}" for value in values)
            text += ",".join((vehicle.name, str(goal.waypoint), *shown)) + "\n"
    return text


def event_row(event: Event) -> dict[str, Any]:
    """One line of `events.jsonl` as a dict."""
    return {"t_s": round(event.time, 3), "severity": event.severity, "text": event.text}


def run_facts(flown: Flown) -> dict[str, Any]:
    """`run.json`: how the run was made, and where its wall time went."""
    rule = replacement_rule(flown.parameters, flown.performance)
    live = {} if flown.events is None else {"reckoned_s": [list(span) for span in flown.reckoned]}
    return {
        "scenario": flown.scenario.name,
        "seed": flown.seed,
        "preset": flown.parameters.name,
        "planner": flown.parameters.optimiser,
        "avoidance": flown.avoidance,
        "ending": flown.ending,
        "time_limit_s": round(flown.scenario.limit, 3),
        "acceptance_radius_m": flown.performance.acceptance_radius,
        "turn_radius_m": round(flown.performance.turn_radius, 3),
        "margin_m": round(rule.margin, 3),
        "waypoint_room_m": round(rule.needed, 3),
        "passage_room_m": round(rule.passage, 3),
        "narrow_stretch_m": round(rule.stretch, 3),
        "wall_s": {
            "flight": round(flown.wall.total, 3),
            "avoidance": round(flown.wall.avoidance, 3),
            "radar": round(flown.wall.radar, 3),
            "plant_and_world": round(flown.wall.world, 3),
        },
        **live,
    }


def decision_rows(flown: Flown) -> list[dict[str, Any]]:
    """All lines of `decisions.jsonl`, in order of time."""
    rows = [decision_row(entry, one.name) for one in flown.vehicles for entry in one.decisions]
    return sorted(rows, key=lambda row: row["t_s"])


def decision_row(entry: LoggedDecision, vehicle: str = OWN) -> dict[str, Any]:
    """One line of `decisions.jsonl` as a dict; keys and units in docs/run-directory.md."""
    decision, state, search = entry.decision, entry.state, entry.decision.search
    new = new_waypoints(entry)
    return {
        "t_s": round(state.time, 3),
        "vehicle": vehicle,
        "north_m": round(state.north, 3),
        "east_m": round(state.east, 3),
        "altitude_m": round(state.altitude, 3),
        "threat": None if decision.threat is None else _threat(decision.threat),
        "decision": decision.name,
        "rung": decision.rung.name.lower(),
        "why": decision.why,
        "waypoint": _point(new[0]) if new else None,
        "waypoints": [_point(waypoint) for waypoint in new],
        "hold_radius_m": decision.radius if isinstance(decision, Hold) else None,
        "route": None if decision.route is None else [_route_point(w) for w in decision.route],
        "planner": None if search is None else search.planner,
        "cost": None if search is None else _number(search.cost),
        "iterations": None if search is None else search.iterations,
        "evaluations": None if search is None else search.evaluations,
        "first_feasible": None if search is None else search.first_feasible,
        "search_gap": None if search is None else _number(search_gap(search), 9),
        "length_to_optimum": None if search is None else _number(length_to_optimum(search), 9),
        "decision_ms": round(entry.milliseconds, 3),
    }


def new_waypoints(entry: LoggedDecision) -> tuple[Waypoint, ...]:
    """The waypoints that a decision put in; of a hold its centre."""
    match entry.decision:
        case Detour(waypoint=waypoint) | Hold(centre=waypoint):
            return (waypoint,)
        case Replace(waypoint=replacement):
            return () if replacement is None else (replacement,)
        case Reroute(waypoints=waypoints):
            return waypoints
    return ()


def _threat(threat: Threat) -> dict[str, Any]:
    return {
        "ids": list(threat.ids),
        "leg": threat.leg,
        "distance_m": _number(threat.distance),
        "time_s": _number(threat.time),
        "clearance_m": _number(threat.clearance),
        "required_m": _number(threat.required),
        "moving": threat.moving,
    }


def _point(waypoint: Waypoint) -> dict[str, float]:
    return {
        "north_m": round(waypoint.north, 3),
        "east_m": round(waypoint.east, 3),
        "altitude_m": round(waypoint.altitude, 3),
    }


def _route_point(waypoint: Waypoint) -> dict[str, Any]:
    return {**_point(waypoint), "item": waypoint.item, "moved": waypoint.moved}


def _number(value: float | None, digits: int = 3) -> float | None:
    """A rounded number; None where there is none, so that files hold null and never NaN."""
    return None if value is None or not math.isfinite(value) else round(float(value), digits)


def _lines(pattern: str, table: Floats) -> str:
    """All rows of a table by one format, in one go (a formatting call per row costs ten times as much)."""
    return (pattern + "\n") * len(table) % tuple(table.ravel().tolist())
