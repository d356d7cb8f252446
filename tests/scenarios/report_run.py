"""A made-up run directory for the report's tests: the files of a flight past some obstacles."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import numpy as np

from offboard.frames import MapFrame
from offboard.mission import MissionItem, MissionPlan
from offboard.plan_files import PlanFile, write_plan
from scenarios.recorded import read_run, recomputed

HEADERS = {
    "track.csv": "vehicle,t_s,north_m,east_m,altitude_m,airspeed_m_s,heading_deg,bank_deg",
    "obstacles.csv": "id,kind,north_m,east_m,altitude_m,radius_m,appears_at_s",
    "traffic.csv": "t_s,id,north_m,east_m,altitude_m",
    "waypoints.csv": "waypoint,north_m,east_m,goal_north_m,goal_east_m,shift_m,passed_at_s,missed_by_m",
}
HOME = (14.39, 76.60, 600.0)
MISSION = ((0.0, 0.0), (20_000.0, 500.0), (60_000.0, 4_000.0))

SUMMARY = {
    "completed": True,
    "waypoints_replaced": 0,
    "wall_s": 2.5,
    "real_time_factor": 1600.0,
    "seed": 0,
    "preset": "default",
    "version": "0.1.0",
}


def write_run(directory, *, obstacles=((10_000.0, 300.0, 1000.0),), detour=True, traffic=False, **summary):
    """Write the files of a run along `MISSION`, round each of the `obstacles` (north, east, radius).

    Parameters
    ----------
    directory : Path
        Made if it is not there.
    detour : bool
        False flies the mission's legs and takes no decisions.
    traffic : bool
        Whether one intruder crosses.
    **summary
        Keys of summary.json that shall differ.
    """
    directory.mkdir(parents=True, exist_ok=True)
    bends = [(n, e + r + 30.0, i) for i, (n, e, r) in enumerate(obstacles, start=1)] if detour else []
    track = _track([*MISSION, *((n, e) for n, e, _ in bends)])
    decisions = [_decision(number, *bend, track) for number, bend in enumerate(sorted(bends), start=1)]
    rows = [(i, "stationary", n, e, 200.0, r, 0.0) for i, (n, e, r) in enumerate(obstacles, start=1)]
    crossing = [(float(t), 900, 30_000.0, -9_000.0 + 15.0 * (t - 1500.0), 200.0) for t in range(1500, 2400)]
    _write_csv(directory / "track.csv", [("own", *row) for row in track])
    _write_csv(directory / "obstacles.csv", rows)
    _write_csv(directory / "traffic.csv", crossing if traffic else [])
    goals = [(i, *point, *point, 0.0, 0.0, 0.0) for i, point in enumerate(MISSION, start=1)]
    _write_csv(directory / "waypoints.csv", goals)
    _write_plan(directory / "mission.plan", sorted([*MISSION, *((n, e) for n, e, _ in bends)]))
    text = "".join(json.dumps(decision) + "\n" for decision in decisions)
    (directory / "decisions.jsonl").write_text(text, encoding="utf-8")
    (directory / "scenario.toml").write_text(_scenario(obstacles, traffic), encoding="utf-8")
    content = SUMMARY | {"replans": len(decisions)}
    (directory / "summary.json").write_text(json.dumps(content), encoding="utf-8")
    content |= recomputed(read_run(directory))
    content |= {"optimum_length_m": content["path_length_m"] - 9.0} | summary
    (directory / "summary.json").write_text(json.dumps(content), encoding="utf-8")
    return directory


def _write_plan(file, corners):
    frame = MapFrame(*HOME)
    items = [MissionItem(*frame.to_geodetic(north, east), 200.0) for north, east in corners]
    write_plan(file, PlanFile(MissionPlan.of(items), *HOME, 15.0))


def _track(corners):
    """Rows of track.csv (without the vehicle) at 1 Hz and 15 m/s through the corners from south to north."""
    points = np.array(sorted(set(corners)))
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    times = np.arange(0.0, along[-1] / 15.0 + 1.0)
    north, east = (np.interp(times * 15.0, along, points[:, axis]) for axis in (0, 1))
    heading = np.degrees(np.arctan2(np.gradient(east), np.gradient(north))) % 360.0
    bank = np.clip(np.gradient(np.unwrap(heading, period=360.0)) * 2.7, -30.0, 30.0)
    altitude = np.minimum(100.0 + 2.0 * times, 200.0)
    return np.column_stack([times, north, east, altitude, 15.0 + 0.2 * np.sin(times / 40.0), heading, bank])


def _decision(number, north, east, obstacle, track):
    moment = track[max(0, int(np.searchsorted(track[:, 1], north - 9_800.0)))]
    return {
        "t_s": float(moment[0]),
        "vehicle": "own",
        "north_m": float(moment[1]),
        "east_m": float(moment[2]),
        "threat": {"ids": [obstacle], "distance_m": 9_000.0, "time_s": 600.0},
        "decision": "detour",
        "why": f"obstacle {obstacle} <ahead> & near the leg: round it by the right",
        "waypoint": {"north_m": north, "east_m": east, "altitude_m": 200.0},
        "waypoints": [{"north_m": north, "east_m": east, "altitude_m": 200.0}],
        "cost": 5_032.4 + number,
        "search_gap": 0.0004,
        "length_to_optimum": 1.00002,
        "decision_ms": 3.2,
    }


def _scenario(obstacles, traffic):
    lines = ['name = "made-up"', 'description = "A short mission past <some> obstacles"']
    for north, east in MISSION:
        lines += ["[[mission]]", f"north_m = {north}", f"east_m = {east}", "altitude_m = 200.0"]
    for number, (north, east, radius) in enumerate(obstacles, start=1):
        lines += ["[[obstacles]]", f"id = {number}", f"north_m = {north}", f"east_m = {east}"]
        lines += ["altitude_m = 200.0", f"safety_radius_m = {radius}"]
    if traffic:
        lines += ["[[traffic]]", "id = 900", "starts_at_s = 1500.0", "waypoints = ["]
        lines += ["{ north_m = 30000.0, east_m = -9000.0 }, { north_m = 30000.0, east_m = 4500.0 } ]"]
    return "\n".join(lines) + "\n"


def _write_csv(path: Path, rows) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(HEADERS[path.name].split(","))
        writer.writerows(
            [f"{v:.3f}" if isinstance(v, float) and math.isfinite(v) else v for v in row] for row in rows
        )
