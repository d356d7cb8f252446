"""The contract of every planner behind ask and tell."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from avoidance.parameters import DEFAULT, PAPER, SwarmSettings
from avoidance.problem import INFEASIBLE, search_box
from avoidance.search import OPTIMISERS, Optimiser, search_waypoint
from avoidance.yardsticks import search_gap
from tests.avoidance.worlds import problem

BOX = np.array([[-2000.0, -2000.0], [2000.0, 2000.0]])
SEEDS = np.array([[900.0, 700.0], [-300.0, 800.0], [400.0, -650.0]])
PATIENT = SwarmSettings(particles=10, iterations=60, stop_change=0.0, stop_iterations=1000)
HILL = [(9000.0, 400.0), (9300.0, 300.0), (9600.0, 500.0)]

every_planner = pytest.mark.parametrize("name", OPTIMISERS)


def bowl(points: np.ndarray) -> np.ndarray:
    return np.hypot(points[:, 0], points[:, 1])


def finish(planner: Optimiser) -> list[float]:
    """Run to the end; the best cost after each iteration."""
    bests = []
    while not planner.finished:
        planner.tell(bowl(planner.ask()))
        bests.append(planner.best_cost)
    return bests


@every_planner
def test_the_best_never_gets_worse_and_is_what_it_says(name: str) -> None:
    planner = OPTIMISERS[name](SEEDS, BOX, PATIENT, np.random.default_rng(4))
    bests = finish(planner)
    assert all(later <= earlier for earlier, later in itertools.pairwise(bests))
    assert planner.best_cost == bowl(planner.best[None])[0]
    assert planner.best_cost < 0.5 * bowl(SEEDS).min()  # the convergence condition: it gets nearer


@every_planner
def test_the_seeds_are_evaluated_first_and_as_they_are(name: str) -> None:
    planner = OPTIMISERS[name](SEEDS, BOX, PATIENT, np.random.default_rng(0))
    assert planner.ask()[:3].tolist() == SEEDS.tolist()


@every_planner
def test_the_iterations_are_the_budget(name: str) -> None:
    settings = replace(PATIENT, iterations=7)
    planner = OPTIMISERS[name](SEEDS, BOX, settings, np.random.default_rng(0))
    assert len(finish(planner)) == 8  # the seeds, then seven iterations


@every_planner
def test_the_same_generator_gives_the_same_answer(name: str) -> None:
    one, other = (OPTIMISERS[name](SEEDS, BOX, PATIENT, np.random.default_rng(9)) for _ in "ab")
    assert finish(one) == finish(other)
    assert one.best.tolist() == other.best.tolist()


@every_planner
def test_one_seed_is_enough_and_none_is_a_wrong_call(name: str) -> None:
    planner = OPTIMISERS[name](SEEDS[:1], BOX, PATIENT, np.random.default_rng(1))
    assert finish(planner)[-1] <= bowl(SEEDS[:1])[0]
    with pytest.raises(ValueError, match="seeds"):
        OPTIMISERS[name](np.empty((0, 2)), BOX, PATIENT, np.random.default_rng(0))


@every_planner
@pytest.mark.parametrize("parameters", [DEFAULT, PAPER], ids=["default", "paper"])
def test_a_waypoint_found_meets_every_constraint(name: str, parameters) -> None:
    question = problem(HILL, parameters=replace(parameters, optimiser=name))
    search = search_waypoint(question, np.random.default_rng(1))
    assert search.planner == name
    assert search.found is not None
    assert question.violation(np.array([search.found]))[0] == 0.0
    assert search.first_feasible is not None


@every_planner
def test_with_rule_seeds_every_planner_is_as_good_as_the_grid(name: str) -> None:
    """Seeds decide, not coefficients."""
    search = search_waypoint(
        problem(HILL, parameters=replace(DEFAULT, optimiser=name)), np.random.default_rng(2)
    )
    gap = search_gap(search)
    assert gap is not None
    assert 0.0 <= gap <= 0.002


@every_planner
def test_infeasible_points_are_left_for_feasible_ones(name: str) -> None:
    planner = OPTIMISERS[name](SEEDS, BOX, PATIENT, np.random.default_rng(3))
    while not planner.finished:
        points = planner.ask()
        planner.tell(np.where(points[:, 0] > 0.0, bowl(points), INFEASIBLE - points[:, 0]))
    assert planner.best[0] > 0.0
    assert planner.best_cost < INFEASIBLE


def test_the_box_is_what_the_search_limit_allows() -> None:
    low, high = search_box(problem(HILL))
    assert (low.tolist(), high.tolist()) == ([5000.0, -3700.0], [13600.0, 4500.0])
    low, high = search_box(problem(HILL, relaxed=frozenset({"g2"})))
    assert (low.tolist(), high.tolist()) == ([-8000.0, -8000.0], [78000.0, 8000.0])
