"""Run a planner on one waypoint search."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Protocol

import numpy as np

from avoidance.parameters import SwarmSettings
from avoidance.problem import INFEASIBLE, WaypointProblem, search_box
from avoidance.pso import Pso
from avoidance.rivals.ga import Ga
from avoidance.rivals.gcpso import Gcpso
from avoidance.rivals.mpso import Mpso
from avoidance.rivals.sa import Sa
from avoidance.rivals.theta_mafoa import ThetaMafoa
from avoidance.seeds import rule_seeds, sphere_seeds
from avoidance.types import Floats, Search


class Optimiser(Protocol):
    """A planner of single waypoints: it proposes points, is told their costs, and knows its best.

    Built with (seeds of shape (m, 2), search box of shape (2, 2), settings, random generator). Infeasible
    points are told costs above every feasible one's, growing with their violation, so that all planners
    order candidates alike.
    """

    def __init__(
        self, seeds: Floats, box: Floats, settings: SwarmSettings, rng: np.random.Generator
    ) -> None: ...

    @property
    def best(self) -> Floats: ...
    @property
    def best_cost(self) -> float: ...
    @property
    def finished(self) -> bool: ...
    def ask(self) -> Floats: ...
    def tell(self, costs: Floats) -> None: ...


HOPELESS = 3
"""Rule seeds find a feasible point if there is one; a swarm that has none after so many iterations stops."""

OUT_OF_PLACE = 2.0 * INFEASIBLE
"""Rank of seeds that break a constraint by their own place or legs, where it does not matter by how much."""

OPTIMISERS: dict[str, type[Optimiser]] = {
    "pso": Pso,
    "gcpso": Gcpso,
    "mpso": Mpso,
    "ga": Ga,
    "sa": Sa,
    "theta-mafoa": ThetaMafoa,
}
"""Planners by name."""


def search_waypoint(problem: WaypointProblem, rng: np.random.Generator) -> Search:
    """Find a waypoint with the planner that the problem's parameters name.

    Parameters
    ----------
    problem : WaypointProblem
        What is asked.
    rng : numpy.random.Generator
        The planner's randomness.

    Returns
    -------
    Search
        `found` is None if no candidate met every constraint.

    Notes
    -----
    Algorithm 10. Round what stands still the rules find the best point but for centimetres: a planner that
    sets out from it stops at the first iteration that brings nothing, not after as many as the settings say;
    and at once where nothing can be better (`avoidance.seeds.rule_seeds`).
    """
    parameters = problem.parameters
    settings = parameters.swarm
    evaluations, searching = 0, True
    if parameters.rule_seeds:
        found = rule_seeds(problem, settings.particles)
        seeds, ranks, evaluations = found.points, found.ranks, found.tested
        searching = not found.proven and (found.feasible or math.isinf(problem.longest))
        best_known = found.feasible and bool(len(problem.avoided)) and problem.alone
        if best_known:
            settings = replace(settings, stop_iterations=1)
        if best_known or not searching:
            ranks = np.where(np.isnan(ranks), OUT_OF_PLACE, ranks)
    else:
        seeds = sphere_seeds(problem, settings.particles, rng)
        ranks = np.full(len(seeds), np.nan)
    optimiser = OPTIMISERS[parameters.optimiser](seeds, search_box(problem), settings, rng)
    iterations = 0
    first_feasible: int | None = None
    while not optimiser.finished and (searching or not iterations):
        points = optimiser.ask()
        if not iterations and np.array_equal(points, seeds) and not np.isnan(ranks).any():
            optimiser.tell(ranks)
        else:
            optimiser.tell(problem.rank(points))
            evaluations += len(points)
        iterations += 1
        if first_feasible is None:
            if optimiser.best_cost < INFEASIBLE:
                first_feasible = iterations
            elif parameters.rule_seeds and iterations >= HOPELESS:
                break
    feasible = optimiser.best_cost < INFEASIBLE
    best = (float(optimiser.best[0]), float(optimiser.best[1]))
    return Search(
        start=problem.start,
        target=problem.target,
        centres=problem.centres,
        radii=problem.keep,
        planner=parameters.optimiser,
        found=best if feasible else None,
        least_violating=best,
        cost=optimiser.best_cost if feasible else float("nan"),
        iterations=iterations,
        evaluations=evaluations,
        first_feasible=first_feasible,
        problem=problem,
    )
