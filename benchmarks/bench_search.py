"""How good and how fast the waypoint search is, on random problems: Markdown tables.

Run from the repository's root: `python benchmarks/bench_search.py [--problems 1000] [--rivals 40]`.

Problems: a leg of 8 to 40 km that obstacles block, 1 to 20 of them of 1 km, spread evenly about it or
drawn in clusters. `search_gap` compares with a refined grid under the same constraints; problems whose best
detour costs under the floor of `avoidance.yardsticks` are counted apart.

Rivals: pyswarms and scipy's differential_evolution (vectorised), given the same cost, constraints and
box, and what they need to come within a search_gap of 0.01 in one run.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable

import numpy as np

from avoidance import Performance
from avoidance.clusters import cluster_of
from avoidance.parameters import DEFAULT
from avoidance.prediction import Intruders
from avoidance.problem import WaypointProblem, search_box, straight_cost
from avoidance.pso import Pso
from avoidance.search import search_waypoint
from avoidance.seeds import rule_seeds
from avoidance.types import Floats
from avoidance.yardsticks import FLOOR, best_waypoint

RADIUS = 1000.0
GAP = 0.01
MOST_EVALUATIONS = 20_000
PERFORMANCE = Performance(
    airspeed=15.0, max_bank=0.5236, roll_time=1.3, acceptance_radius=100.0, tracking_error=5.0
)


def random_problem(rng: np.random.Generator, *, clustered: bool) -> WaypointProblem:
    """A blocked leg among 1 to 20 obstacles."""
    keep = RADIUS + DEFAULT.margin
    while True:
        length = float(rng.uniform(8_000.0, 40_000.0))
        count = int(rng.integers(1, 21))
        if clustered:
            hubs = rng.uniform(
                (3000.0, -2500.0), (min(length, 12_000.0), 2500.0), (int(rng.integers(1, 4)), 2)
            )
            centres = hubs[rng.integers(0, len(hubs), count)] + rng.normal(0.0, 900.0, (count, 2))
        else:
            centres = rng.uniform((0.0, -6000.0), (min(length, 12_000.0), 6000.0), (count, 2))
        along = np.clip(centres[:, 0], 0.0, length)
        gap = np.hypot(centres[:, 0] - along, centres[:, 1])
        ends = np.minimum(np.hypot(*centres.T), np.hypot(centres[:, 0] - length, centres[:, 1]))
        if gap.min() < keep and ends.min() > keep + 2.0 * PERFORMANCE.turn_radius:
            break
    first = int(np.argmin(np.where(gap < keep, centres[:, 0], math.inf)))
    links = centres, np.full(count, keep), DEFAULT.link_distance, DEFAULT.all_obstacles
    return WaypointProblem(
        start=(0.0, 0.0),
        target=(length, 0.0),
        course=0.0,
        before=None,
        centres=centres,
        keep=np.full(count, keep),
        keep_waypoint=np.full(count, RADIUS + DEFAULT.tolerance),
        avoided=cluster_of(first, *links),
        intruders=Intruders(),
        delay=0.0,
        performance=PERFORMANCE,
        parameters=DEFAULT,
    )


def quality(problems: list[WaypointProblem]) -> dict[str, float]:
    """Gap and time of the search on each problem against the refined grid."""
    gaps, times, missed, none, tiny = [], [], 0, 0, 0
    for number, problem in enumerate(problems):
        begun = time.perf_counter()
        search = search_waypoint(problem, np.random.default_rng(number))
        times.append(1000.0 * (time.perf_counter() - begun))
        best = best_waypoint(problem)
        if best is None:
            none += search.found is None
            continue
        if search.found is None:
            missed += 1
            continue
        lowest = min(best[1], search.cost)
        detour = lowest - straight_cost(problem)
        if detour < FLOOR:
            tiny += 1
            continue
        gaps.append((search.cost - lowest) / detour)
    return {
        "problems": len(problems),
        "no way": none,
        "missed": missed,
        "under the floor": tiny,
        "gap median": float(np.median(gaps)),
        "gap p95": float(np.percentile(gaps, 95)),
        "search [ms]": float(np.median(times)),
    }


class Reached(Exception):  # noqa: N818 - ends a rival's run; not an error
    """The target cost has been reached."""


def timed_cost(problem: WaypointProblem, goal: float) -> Callable[[Floats], Floats]:
    """The rank of points of shape (n, 2), which stops the run once a cost of `goal` has been seen."""
    spent = 0

    def rank(points: Floats) -> Floats:
        nonlocal spent
        costs = problem.rank(points)
        spent += len(points)
        if costs.min() <= goal or spent > MOST_EVALUATIONS:
            raise Reached(bool(costs.min() <= goal))
        return costs

    return rank


def by_sidestep(problem: WaypointProblem, goal: float, seed: int) -> None:
    """Our search: seeds, then the swarm, by the stop rule of the settings."""
    settings = problem.parameters.swarm
    seeds = rule_seeds(problem, settings.particles).points
    swarm = Pso(seeds, search_box(problem), settings, np.random.default_rng(seed))
    rank = timed_cost(problem, goal)
    while not swarm.finished:
        swarm.tell(rank(swarm.ask()))


def by_evolution(problem: WaypointProblem, goal: float, seed: int) -> None:
    """scipy's differential_evolution, vectorised."""
    from scipy.optimize import differential_evolution  # noqa: PLC0415

    rank = timed_cost(problem, goal)
    low, high = search_box(problem)
    differential_evolution(
        lambda x: rank(np.atleast_2d(x.T)),
        list(zip(low, high, strict=True)),
        vectorized=True,
        updating="deferred",
        rng=np.random.default_rng(seed),
        polish=False,
        maxiter=10_000,
        tol=0.0,
    )


def by_pyswarms(problem: WaypointProblem, goal: float, seed: int) -> None:
    """pyswarms' global-best swarm with its documented coefficients."""
    import logging  # noqa: PLC0415

    import pyswarms  # noqa: PLC0415

    logging.disable(logging.CRITICAL)
    rank = timed_cost(problem, goal)
    low, high = search_box(problem)
    state = np.random.get_state()  # noqa: NPY002 - pyswarms draws from the global generator
    np.random.seed(seed)  # noqa: NPY002
    try:
        swarm = pyswarms.single.GlobalBestPSO(
            n_particles=30, dimensions=2, options={"c1": 0.5, "c2": 0.3, "w": 0.9}, bounds=(low, high)
        )
        swarm.optimize(rank, iters=10_000, verbose=False)
    finally:
        np.random.set_state(state)  # noqa: NPY002
        logging.disable(logging.NOTSET)


Run = Callable[[WaypointProblem, float, int], None]
RIVALS: dict[str, Run] = {"pyswarms": by_pyswarms, "differential_evolution": by_evolution}


def race(problems: list[WaypointProblem]) -> dict[str, tuple[float, int, int]]:
    """Median time to the gap of each planner [ms], runs that reached it, and runs."""
    goals, ours = [], []
    kept = []
    for number, problem in enumerate(problems):
        best = best_waypoint(problem)
        if best is None or best[1] - straight_cost(problem) < FLOOR:
            continue
        goal = best[1] + GAP * (best[1] - straight_cost(problem))
        ours.append(_timed(by_sidestep, problem, goal, number))
        kept.append(problem)
        goals.append(goal)
    table = {"sidestep": _summary(ours)}
    for name, run in RIVALS.items():
        pairs = enumerate(zip(kept, goals, strict=True))
        table[name] = _summary([_timed(run, problem, goal, number) for number, (problem, goal) in pairs])
    return table


def _timed(run: Run, problem: WaypointProblem, goal: float, seed: int) -> tuple[float, bool]:
    """Time until the goal is seen [ms], and whether it was."""
    begun = time.perf_counter()
    reached = False
    try:
        run(problem, goal, seed)
    except Reached as end:
        reached = bool(end.args[0])
    return 1000.0 * (time.perf_counter() - begun), reached


def _summary(runs: list[tuple[float, bool]]) -> tuple[float, int, int]:
    return float(np.median([ms for ms, _ in runs])), sum(reached for _, reached in runs), len(runs)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--problems", type=int, default=200, help="of each kind")
    parser.add_argument("--rivals", type=int, default=20, help="of each kind that rivals are timed on")
    chosen = parser.parse_args()
    search_waypoint(random_problem(np.random.default_rng(0), clustered=True), np.random.default_rng(0))
    sets = {}
    for kind in ("uniform", "clustered"):
        rng = np.random.default_rng(1)
        sets[kind] = [random_problem(rng, clustered=kind == "clustered") for _ in range(chosen.problems)]
    rows = {kind: quality(problems) for kind, problems in sets.items()}
    names = list(rows["uniform"])
    print(f"| kind | {' | '.join(names)} |")
    print("|" + "---|" * (len(names) + 1))
    for kind, row in rows.items():
        print(f"| {kind} | {' | '.join(f'{row[name]:.5g}' for name in names)} |")
    raced = race([p for problems in sets.values() for p in problems[: chosen.rivals]])
    reference = raced["sidestep"][0]
    print(f"\n| planner | time to a gap of {GAP} [ms], median | ratio | reached |\n|---|---|---|---|")
    for name, (median, reached, runs) in raced.items():
        print(f"| {name} | {median:.1f} | {median / reference:.1f} | {reached} of {runs} |")


if __name__ == "__main__":
    main()
