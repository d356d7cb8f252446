"""One run of a stress campaign: its world flown, judged, and boiled down to what is counted."""

from __future__ import annotations

import atexit
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from avoidance import Replace, Resume
from avoidance.parameters import Parameters
from scenarios.cases import KINDS, Case, scenario_of
from scenarios.flown import Flown
from scenarios.goals import barred_by_fence, discs
from scenarios.hangar import Hangar
from scenarios.metrics import path_length, separations
from scenarios.run import Flight
from scenarios.scenario import Fidelity, Scenario
from scenarios.score import Score, changes_route, replacement_rule, score
from scenarios.track import Track
from scenarios.volumes import NMAC, WELL_CLEAR, entered
from scenarios.walled import Shapes, separated

if TYPE_CHECKING:
    from fmu.library import FmuLibrary

FAR_AWAY = 1e7
"""Whoever can get this far from the start is not walled in [m]."""


@dataclass(frozen=True, slots=True)
class Events:
    """Whether something happened in a run."""

    loss: bool = False
    """An obstacle's sphere was entered: RS of what stands still, 1 km of what moves."""
    well_clear: bool = False
    """Small-UAS well clear was lost."""
    nmac: bool = False
    """Near mid-air collision."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What one run contributes to a table; small, for it travels between processes."""

    case: Case
    feasible: bool = True
    """The start is not walled in."""
    success: bool = False
    """Mission completed without a violation."""
    violations: int = 0
    """Entries into a sphere."""
    min_separation: float | None = None
    """Least distance to anything [m]."""
    min_margin: float | None = None
    """Least distance from any sphere [m]; negative inside."""
    length_ratio: float | None = None
    """Flown length over that of the full-knowledge optimum; of fields."""
    added_path: float | None = None
    """Flown length more than without avoidance [%]; of encounters."""
    events: Events = field(default_factory=Events)
    """With avoidance."""
    unmitigated: Events = field(default_factory=Events)
    """In the same world without."""
    rungs: Mapping[str, int] = field(default_factory=dict)
    """Changes of the route for a blocked leg, by rung of the ladder."""
    replaced: int = 0
    """Decisions that moved or skipped a waypoint."""
    resumed: int = 0
    """Decisions that returned to the mission's own leg."""
    replans: int = 0
    """All decisions that changed what was flown."""
    decision_ms: tuple[float, ...] = ()
    """Wall time of each decision that had a threat or changed the route [ms]."""
    ending: str = "failed"
    """How the flight ended: "finished", "time limit", or "failed" by an error."""
    error: str | None = None
    """What the software died of."""

    @property
    def failing(self) -> bool:
        """True for a run that somebody should look at."""
        return bool(self.violations) or self.error is not None or (self.feasible and not self.success)

    @property
    def why(self) -> str:
        """What went wrong, in words."""
        if self.error is not None:
            return f"the software failed: {self.error}"
        if self.violations:
            return f"{self.violations} entries into a sphere, {-(self.min_margin or 0.0):.1f} m deep"
        return "mission not completed" if self.ending == "finished" else f"not completed: {self.ending}"


def attempt(case: Case, fidelity: Fidelity, parameters: Parameters) -> Outcome:
    """Fly and judge one case.

    An error of the software becomes part of the outcome: it is a finding, not the end of a campaign.

    Raises
    ------
    PlantError
        If the aircraft model does not load.
    """
    library = aircraft_model()
    scenario = scenario_of(case, fidelity, parameters)
    try:
        flown = fly_through(scenario, parameters, library, avoidance=True)
        judged = score(flown)
        if KINDS[case.kind].traffic:
            return _encounter(
                case, flown, judged, fly_through(scenario, parameters, library, avoidance=False)
            )
        return _field(case, flown, judged)
    except Exception as error:
        return Outcome(case, error=f"{type(error).__name__}: {error}")


def _encounter(case: Case, flown: Flown, judged: Score, straight: Flown) -> Outcome:
    alone = path_length(straight.track.positions)
    return _outcome(
        case,
        flown,
        judged,
        added_path=100.0 * (path_length(flown.track.positions) / alone - 1.0),
        events=_traffic_events(flown),
        unmitigated=_traffic_events(straight),
    )


def _field(case: Case, flown: Flown, judged: Score) -> Outcome:
    optimum = judged.summary["optimum_length_m"]
    return _outcome(
        case,
        flown,
        judged,
        feasible=feasible(flown),
        length_ratio=judged.summary["path_length_m"] / optimum if optimum else None,
        events=Events(loss=judged.summary["violations"] > 0),
        unmitigated=Events(loss=_straight_hits(flown.scenario)),
    )


def _outcome(case: Case, flown: Flown, judged: Score, **more: object) -> Outcome:
    summary = judged.summary
    changes = [entry.decision for entry in flown.decisions if changes_route(entry)]
    apart = [type(decision) for decision in changes if isinstance(decision, Replace | Resume)]
    rungs = Counter(d.rung.name.lower() for d in changes if not isinstance(d, Replace | Resume))
    values: dict[str, object] = {
        "success": judged.safe,
        "violations": summary["violations"],
        "min_separation": summary["min_separation_m"],
        "min_margin": summary["min_margin_m"],
        "rungs": dict(rungs),
        "replaced": apart.count(Replace),
        "resumed": apart.count(Resume),
        "replans": summary["replans"],
        "decision_ms": tuple(entry.milliseconds for entry in flown.decisions),
        "ending": flown.ending,
    }
    return Outcome(case, **(values | more))  # type: ignore[arg-type]


def feasible(flown: Flown) -> bool:
    """True if the field lets the vehicle go, and lets it stay within the geofence.

    The start is not walled in by spheres and margins (unbounded component of free space), and no waypoint
    with room to turn can be reached only by leaving the geofence.
    """
    scenario = flown.scenario
    start = scenario.mission[0]
    rule = replacement_rule(flown.parameters, flown.performance)
    centres, radii = discs(scenario.obstacles, start.altitude, rule.altitude_tolerance)
    walls = Shapes.discs(centres, radii + rule.margin)
    if separated((start.north, start.east), (-FAR_AWAY, -FAR_AWAY), walls):
        return False
    return not barred_by_fence(scenario.mission, scenario.obstacles, rule, scenario.geofence)


def _traffic_events(flown: Flown) -> Events:
    near = separations(flown.track, (), flown.traffic)
    return Events(
        loss=any(s.entries for s in near),
        well_clear=any(entered(flown.track, mover, WELL_CLEAR) for mover in flown.traffic),
        nmac=any(entered(flown.track, mover, NMAC) for mover in flown.traffic),
    )


def _straight_hits(scenario: Scenario) -> bool:
    """True if the mission, flown corner to corner, enters a sphere."""
    points = np.array([(p.north, p.east, p.altitude) for p in scenario.mission])
    legs = [float(np.hypot(*(b - a)[:2])) for a, b in pairwise(points)]
    times = np.concatenate(([0.0], np.cumsum(legs)))
    still = np.zeros(len(points))
    straight = Track("own", times, points, still, still, still)
    return any(s.entries for s in separations(straight, scenario.obstacles))


def fly_through(scenario: Scenario, parameters: Parameters, library: FmuLibrary, *, avoidance: bool) -> Flown:
    """Fly a scenario from beginning to end."""
    with Hangar(scenario, parameters, library) as hangar:
        flight = Flight(scenario, hangar, seed=scenario.seed, parameters=parameters, avoidance=avoidance)
        for _ in flight:
            pass
        return flight.result()


@cache
def aircraft_model() -> FmuLibrary:
    """The aircraft model, loaded once in a process and freed at its end."""
    from fmu.library import FmuLibrary  # noqa: PLC0415

    library = FmuLibrary.open()
    atexit.register(library.close)
    return library
