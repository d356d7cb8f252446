"""One flight boiled down to a record: small, plain, and enough for tables and maps of many flights."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from avoidance.parameters import Parameters
from avoidance.types import Floats, Search
from avoidance.yardsticks import search_gap
from scenarios.flown import Flown, LoggedDecision
from scenarios.record import new_waypoints
from scenarios.report_geometry import simplified
from scenarios.scenario import Scenario
from scenarios.score import changes_route, score
from scenarios.track import MovingTrack
from scenarios.trial import aircraft_model, feasible, fly_through

Record = dict[str, Any]
"""What is left of a flight: JSON, keys and units as `flight_record` says."""

TRACK_TOLERANCE = 5.0
"""The track is thinned so that the line drawn is never further from it than this [m]."""
TRAFFIC_STEP = 20
"""Every how many samples of traffic are kept."""


@dataclass(frozen=True, slots=True)
class Job:
    """One flight to be flown."""

    name: str
    """Says what it is, in a way that files can be named; one name, one flight."""
    scenario: Scenario
    """The world, its random obstacles drawn; its seed is the flight's."""
    parameters: Parameters
    """Preset and planner."""
    avoidance: bool = True
    """False flies on whatever the radar shows."""
    gaps: bool = False
    """True to compare each waypoint found with the best there is (a refined grid: slow)."""


def fly_job(job: Job) -> Record:
    """Fly and judge.

    Raises
    ------
    PlantError
        If the aircraft model does not load.
    """
    flown = fly_through(job.scenario, job.parameters, aircraft_model(), avoidance=job.avoidance)
    return flight_record(flown, gaps=job.gaps)


def flight_record(flown: Flown, *, gaps: bool = False) -> Record:
    """The record of a flight.

    Returns
    -------
    dict
        `summary` (as in summary.json), `safe`, `feasible` (start not walled in), `algorithm_s` (wall time
        of all decisions) and `decision_ms` of each, `searches` (one per single waypoint looked for),
        `changes` (of the route), `mission`, `plan` (final waypoints, [north, east, altitude] in metres),
        `track`, `traffic` (id, radius, track, and the places of both at the closest pass), `obstacles`
        ([id, north, east, radius]).
    """
    judged = score(flown)
    changes = [entry for entry in flown.decisions if changes_route(entry)]
    items = flown.plan.mission_items
    north, east = flown.frame.to_map(
        np.array([item.latitude_deg for item in items]), np.array([item.longitude_deg for item in items])
    )
    altitudes = [item.relative_altitude_m for item in items]
    return {
        "summary": judged.summary,
        "safe": judged.safe,
        "feasible": feasible(flown),
        "planner": flown.parameters.optimiser,
        "preset": flown.parameters.name,
        "algorithm_s": round(sum(entry.milliseconds for entry in flown.decisions) / 1e3, 6),
        "decision_ms": [round(entry.milliseconds, 3) for entry in flown.decisions],
        "searches": [_search(s, gaps) for s in _searches(flown.decisions)],
        "changes": [_change(entry) for entry in changes],
        "mission": [[p.north, p.east, p.altitude] for p in flown.scenario.mission],
        "plan": np.round(np.column_stack((north, east, altitudes)), 3).tolist(),
        "track": thinned(flown.track.positions[:, :2]),
        "traffic": [_traffic(mover, flown.track.positions) for mover in flown.traffic],
        "obstacles": [[o.id, o.north, o.east, o.safety_radius] for o in flown.scenario.obstacles],
    }


def thinned(positions: Floats) -> list[list[float]]:
    """Corners of a line that is nowhere further than `TRACK_TOLERANCE` from the track [m]."""
    kept = np.round(positions[simplified(positions, TRACK_TOLERANCE)], 1)
    return [[float(north), float(east)] for north, east in kept]


def _searches(decisions: Iterable[LoggedDecision]) -> list[Search]:
    """Searches for single waypoints; the exact planner and OMPL look for routes."""
    every = (entry.decision.search for entry in decisions)
    return [s for s in every if s is not None and (s.found is not None or s.iterations > 0)]


def _search(search: Search, gaps: bool) -> Record:
    """A search for a single waypoint; `first_feasible` is the paper's CS."""
    gap = search_gap(search) if gaps else None
    return {
        "planner": search.planner,
        "found": search.found is not None,
        "cost": round(search.cost, 4) if math.isfinite(search.cost) else None,
        "iterations": search.iterations,
        "evaluations": search.evaluations,
        "first_feasible": search.first_feasible,
        "gap": None if gap is None else round(gap, 9),
    }


def _change(entry: LoggedDecision) -> Record:
    decision, state = entry.decision, entry.state
    return {
        "t_s": round(state.time, 3),
        "place": [round(state.north, 1), round(state.east, 1)],
        "decision": decision.name,
        "rung": decision.rung.name.lower(),
        "why": decision.why,
        "waypoints": [[round(w.north, 3), round(w.east, 3)] for w in new_waypoints(entry)],
    }


def _traffic(mover: MovingTrack, own: Floats) -> Record:
    """The path of something that moves, and where both were when they were nearest (of all samples)."""
    there = mover.positions[: len(own)]
    exists = np.flatnonzero(np.isfinite(there[:, 0]))
    if not exists.size:
        return {"id": mover.id, "radius": mover.radius, "track": [], "closest": []}
    apart = np.linalg.norm(own[exists] - there[exists], axis=1)
    nearest = exists[int(np.argmin(apart))]
    closest = np.round([own[nearest, :2], there[nearest, :2]], 1)
    places = np.round(there[exists[::TRAFFIC_STEP], :2], 1)
    return {
        "id": mover.id,
        "radius": mover.radius,
        "track": places.tolist(),
        "closest": closest.tolist(),
    }
