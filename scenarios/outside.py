"""Planners of other people's making on the same waypoint searches, for honesty (extra `bench`).

pyswarms and scipy look for one waypoint in the same box, from the same seeds, with as many evaluations of
the same ranking as the swarm has. OMPL's RRT* and BIT* look for a route of several waypoints among the same
discs; the constraints on single waypoints (g1, g2, g4) do not hold for them, nor for the exact planner.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np

from avoidance.exact_route import flyable
from avoidance.ladder import Plan, way_round
from avoidance.problem import INFEASIBLE, WaypointProblem, search_box
from avoidance.seeds import rule_seeds, sphere_seeds
from avoidance.types import Floats, Rung, Search
from scenarios.errors import ScenarioError
from scenarios.outside_ompl import Points, ompl_route

Solver = Callable[[WaypointProblem, np.random.Generator], tuple[Points | None, int]]
"""Waypoints, or None if there are none that may be flown, and how many candidates were evaluated."""


def pyswarms_waypoint(problem: WaypointProblem, rng: np.random.Generator) -> tuple[Points | None, int]:
    """A waypoint by pyswarms' global-best swarm with the coefficients of the problem's own."""
    import pyswarms  # noqa: PLC0415

    settings = problem.parameters.swarm
    low, high = search_box(problem)
    start = np.clip(_population(problem, rng), low, high)
    options = {"c1": settings.cognitive, "c2": settings.social, "w": settings.inertia_start}
    with _numpy_seeded(rng):
        swarm = pyswarms.single.GlobalBestPSO(
            n_particles=len(start),
            dimensions=2,
            options=options,
            bounds=(low, high),
            velocity_clamp=(-settings.largest_step, settings.largest_step),
            init_pos=start,
        )
        cost, best = swarm.optimize(problem.rank, iters=settings.iterations + 1, verbose=False)
    return _single(best, float(cost)), len(start) * (settings.iterations + 1)


def scipy_waypoint(problem: WaypointProblem, rng: np.random.Generator) -> tuple[Points | None, int]:
    """A waypoint by scipy's differential evolution."""
    from scipy.optimize import differential_evolution  # noqa: PLC0415

    settings = problem.parameters.swarm
    low, high = search_box(problem)
    found = differential_evolution(
        lambda points: problem.rank(points.T),
        bounds=np.stack([low, high], axis=1),
        init=np.clip(_population(problem, rng), low, high),
        maxiter=settings.iterations,
        tol=0.0,
        atol=settings.stop_change,
        polish=False,
        vectorized=True,
        updating="deferred",
        rng=rng,
    )
    return _single(found.x, float(found.fun)), (int(found.nit) + 1) * settings.particles


def rrt_star_route(problem: WaypointProblem, rng: np.random.Generator) -> tuple[Points | None, int]:
    """A route by OMPL's RRT*."""
    return ompl_route("RRTstar", problem, rng)


def bit_star_route(problem: WaypointProblem, rng: np.random.Generator) -> tuple[Points | None, int]:
    """A route by OMPL's BIT*."""
    return ompl_route("BITstar", problem, rng)


OUTSIDE: dict[str, tuple[str, Solver]] = {
    "pyswarms": ("pyswarms", pyswarms_waypoint),
    "scipy-de": ("scipy", scipy_waypoint),
    "ompl-rrtstar": ("ompl", rrt_star_route),
    "ompl-bitstar": ("ompl", bit_star_route),
}
"""Package and solver by the name that users give."""


def solver(name: str) -> Solver:
    """A planner by name.

    Raises
    ------
    ScenarioError
        If its package is not installed.
    """
    package, solve = OUTSIDE[name]
    if not installed(name):
        raise ScenarioError("planner", f"{name!r} needs {package}: pip install 'sidestep[bench]'")
    return solve


def installed(name: str) -> bool:
    """True if the package of a planner can be imported."""
    from importlib.util import find_spec  # noqa: PLC0415

    return find_spec(OUTSIDE[name][0]) is not None


def outside_way(name: str) -> Callable[[WaypointProblem, np.random.Generator], Plan | None]:
    """A planner of `OUTSIDE` in the ladder's place; what it cannot solve goes down the ladder."""
    solve = solver(name)

    def way(problem: WaypointProblem, rng: np.random.Generator) -> Plan | None:
        points, evaluations = solve(problem, rng)
        if points is None or not _may_be_flown(problem, points):
            return way_round(problem, rng)
        single = len(points) == 1 and problem.violation(np.array(points))[0] <= 0.0
        search = Search(
            start=problem.start,
            target=problem.target,
            centres=problem.centres,
            radii=problem.keep,
            planner=name,
            found=points[0] if single else None,
            cost=float(problem.cost(np.array(points))[0]) if single else math.nan,
            evaluations=evaluations,
            problem=problem,
        )
        return Plan(Rung.WAYPOINT if single else Rung.ROUTE, points, search)

    return way


def _may_be_flown(problem: WaypointProblem, points: Points) -> bool:
    corners = np.array([problem.start, *points, problem.target])
    return flyable(problem, corners) and problem.separation_shortfall(points) <= 0.0


def _population(problem: WaypointProblem, rng: np.random.Generator) -> Floats:
    """The swarm's seeds, filled up as the swarm fills them."""
    count = problem.parameters.swarm.particles
    if problem.parameters.rule_seeds:
        seeds = rule_seeds(problem, count).points
    else:
        seeds = sphere_seeds(problem, count, rng)
    missing = max(count - len(seeds), 0)
    scatter = seeds[np.arange(missing) % len(seeds)] + rng.normal(0.0, 200.0, (missing, 2))
    return np.concatenate([seeds[:count], scatter])


def _single(point: Floats, cost: float) -> Points | None:
    return ((float(point[0]), float(point[1])),) if cost < INFEASIBLE else None


@contextmanager
def _numpy_seeded(rng: np.random.Generator) -> Iterator[None]:
    """For libraries that draw from numpy's global generator: seeded inside, as it was outside."""
    before = np.random.get_state()  # noqa: NPY002
    np.random.seed(int(rng.integers(2**32)))  # noqa: NPY002
    try:
        yield
    finally:
        np.random.set_state(before)  # noqa: NPY002
