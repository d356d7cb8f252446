"""Waypoint searches without a flight: Table 7, Figs. 24 and 25, and the bound of Table 4."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from avoidance import Performance
from avoidance.parameters import Parameters
from avoidance.prediction import Intruders
from avoidance.problem import INFEASIBLE, WaypointProblem, search_box
from avoidance.search import OPTIMISERS
from avoidance.seeds import rule_seeds, sphere_seeds
from avoidance.types import Floats
from avoidance.yardsticks import best_waypoint
from scenarios.paper.published import published

RADAR_RANGE = 10_000.0
CASES: dict[str, tuple[int, tuple[int, ...]]] = {"obstacle 2": (3, (1,)), "obstacles 3-5": (4, (2, 3, 4))}
"""Leg (counted from 0) and obstacles of each case of Table 7."""
READINGS = ("as printed", "W_t = 1")
"""Eq. (6) from where the radar shows the obstacle; or the length alone, from the leg's start (E07)."""
PERFORMANCE = Performance(
    airspeed=15.0, max_bank=math.radians(30.0), roll_time=1.0, acceptance_radius=100.0, tracking_error=5.0
)
"""15 m/s and 30 degrees, as the paper has them."""


@dataclass(frozen=True, slots=True)
class Iteration:
    """One iteration of a planner."""

    points: Floats
    """What it asked, shape (n, 2) [m]."""
    costs: Floats
    """f of Eq. (6) of each, shape (n,)."""
    feasible: Floats
    """Which of them meet every constraint, shape (n,)."""
    best: float
    """Best feasible f so far; infinite if there was none."""


def problem(case: str, reading: str, parameters: Parameters) -> WaypointProblem:
    """The search of a case of Table 7.

    Parameters
    ----------
    case : str
        One of `CASES`.
    reading : str
        One of `READINGS`.
    parameters : Parameters
        Preset and planner.
    """
    leg, members = CASES[case]
    paper = published()
    begin, end = (np.array(paper.mission[i][:2], dtype=np.float64) for i in (leg, leg + 1))
    centres = np.array([paper.obstacles[i][:2] for i in members], dtype=np.float64)
    along = (end - begin) / np.hypot(*(end - begin))
    start = begin
    if reading == READINGS[0]:
        start = begin + along * _first_seen(begin, along, centres)
    else:
        parameters = replace(parameters, path_weight=1.0)
    count = len(centres)
    return WaypointProblem(
        start=(float(start[0]), float(start[1])),
        target=(float(end[0]), float(end[1])),
        course=math.atan2(along[1], along[0]),
        before=None,
        centres=centres,
        keep=np.full(count, paper.safety_radius + parameters.margin),
        keep_waypoint=np.full(count, paper.safety_radius + parameters.tolerance),
        avoided=np.arange(count),
        intruders=Intruders(),
        delay=0.0,
        wind=(0.0, 0.0),
        performance=PERFORMANCE,
        parameters=parameters,
    )


def iterations(question: WaypointProblem, rng: np.random.Generator) -> Iterator[Iteration]:
    """Run the planner that the problem's parameters name, one iteration after the other."""
    parameters = question.parameters
    count = parameters.swarm.particles
    seeds = (
        rule_seeds(question, count).points if parameters.rule_seeds else sphere_seeds(question, count, rng)
    )
    planner = OPTIMISERS[parameters.optimiser](seeds, search_box(question), parameters.swarm, rng)
    while not planner.finished:
        points = planner.ask().copy()
        ranks = question.rank(points)
        planner.tell(ranks)
        best = planner.best_cost if planner.best_cost < INFEASIBLE else math.inf
        yield Iteration(points, question.cost(points), np.asarray(ranks < INFEASIBLE), best)


def optimum(question: WaypointProblem) -> float:
    """f of the best single waypoint under the same constraints."""
    best = best_waypoint(question)
    if best is None:
        raise ValueError("question: no waypoint meets every constraint")
    return best[1]


def full_knowledge_bound(parameters: Parameters) -> float:
    """Length of the mission with the best single waypoint of each case put in, all known beforehand [m].

    The waypoint keeps 2 km, its legs 1 km, from what it avoids.
    """
    exactly = replace(parameters, margin=0.0, turn_limit=None, risk_weight=0.0)
    corners = np.array([point[:2] for point in published().mission], dtype=np.float64)
    total = float(np.hypot(*np.diff(corners, axis=0).T).sum())
    for case, (leg, _) in CASES.items():
        straight = math.dist(corners[leg], corners[leg + 1])
        question = replace(problem(case, READINGS[1], exactly), course=None)
        total += optimum(question) - straight
    return total


def _first_seen(begin: Floats, along: Floats, centres: Floats) -> float:
    """Distance along the leg at which the first obstacle comes within the radar's range [m]."""
    offset = centres - begin
    ahead = offset @ along
    across = along[0] * offset[:, 1] - along[1] * offset[:, 0]
    return float((ahead - np.sqrt(RADAR_RANGE**2 - across**2)).min())
