"""One waypoint search: problem, seeds, planner and yardsticks together."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from avoidance.geofence import Walls
from avoidance.parameters import DEFAULT, PAPER, Parameters
from avoidance.problem import INFEASIBLE
from avoidance.search import search_waypoint
from avoidance.seeds import rule_seeds, sphere_seeds
from avoidance.yardsticks import best_waypoint, length_to_optimum, search_gap
from tests.avoidance.worlds import intruders, problem

SINGLE = [(9000.0, 400.0)]
HILL = [(9000.0, 400.0), (9300.0, 300.0), (9600.0, 500.0)]


@pytest.mark.parametrize("parameters", [DEFAULT, PAPER], ids=["default", "paper"])
@pytest.mark.parametrize("centres", [SINGLE, HILL], ids=["single", "hill"])
def test_the_waypoint_meets_every_constraint(
    parameters: Parameters, centres: list[tuple[float, float]]
) -> None:
    question = problem(centres, parameters=parameters)
    search = search_waypoint(question, np.random.default_rng(1))
    assert search.found is not None
    broken = question.constraints(np.array([search.found]))
    assert {name: float(value[0]) for name, value in broken.items()} == dict.fromkeys(broken, 0.0)


@pytest.mark.parametrize("seed", range(4))
def test_the_default_planner_is_within_a_thousandth_of_the_best(seed: int) -> None:
    search = search_waypoint(problem(HILL), np.random.default_rng(seed))
    gap = search_gap(search)
    assert gap is not None
    assert 0.0 <= gap <= 0.001


def test_a_swarm_that_does_not_improve_on_the_rules_stops_at_once() -> None:
    """The seeds and one iteration; from seeds about the sphere it goes on for as long as it improves."""
    rng = np.random.default_rng(0)
    assert search_waypoint(problem(SINGLE), rng).iterations == 2
    assert search_waypoint(problem(SINGLE, parameters=replace(DEFAULT, rule_seeds=False)), rng).iterations > 3


def test_in_traffic_it_goes_on_for_the_rules_are_not_the_best_there() -> None:
    moving = intruders((-6400.4, -1682.0, 39.1, 4.9), (8265.5, 4835.2, 5.1, -5.2))
    question = problem([], target=(20_000.0, 0.0), intruders=moving)
    search = search_waypoint(question, np.random.default_rng(25))
    assert search.iterations > 3
    assert search.cost < 2040.0  # the rules' best has 2050.9


def test_the_shorter_side_is_taken() -> None:
    search = search_waypoint(problem([(9000.0, 400.0)]), np.random.default_rng(0))
    assert search.found is not None
    assert search.found[1] < 0.0  # the obstacle is to the right of the leg, so pass left (Sec. 5.4, case i)


def test_the_other_side_is_taken_when_the_short_one_is_blocked() -> None:
    blocked = [(9000.0, 400.0), (9000.0, -1500.0), (9000.0, -3200.0)]
    search = search_waypoint(problem(blocked), np.random.default_rng(0))
    assert search.found is not None
    assert search.found[1] > 0.0  # Sec. 5.4, case ii


def test_nothing_is_found_where_the_target_is_walled_in() -> None:
    ring = [(20_000 + 2500 * math.cos(a), 2500 * math.sin(a)) for a in np.linspace(0, 2 * math.pi, 12)]
    question = problem(ring, target=(20_000.0, 0.0))
    assert search_waypoint(question, np.random.default_rng(0)).found is None
    assert best_waypoint(question) is None


def test_infeasible_candidates_rank_after_feasible_ones() -> None:
    question = problem(SINGLE)
    ranks = question.rank(np.array([[9000.0, 400.0], [9000.0, -1700.0], [9000.0, 100.0]]))
    assert ranks[1] < INFEASIBLE < ranks[2]
    assert ranks[2] < ranks[0] + 1e6


def test_a_waypoint_is_kept_clear_of_an_intruder() -> None:
    """Head-on at the same speed: the detour keeps d + h all along."""
    question = problem([], target=(30_000.0, 0.0), intruders=intruders((9000.0, 0.0, -15.0, 0.0)))
    search = search_waypoint(question, np.random.default_rng(0))
    assert search.found is not None
    assert question.constraints(np.array([search.found]))["g5"][0] == 0.0


def test_the_printed_seeds_lie_outside_on_both_sides() -> None:
    """Erratum E26: on the sphere of RS every seed would break g1."""
    question = problem(SINGLE, parameters=PAPER)
    seeds = sphere_seeds(question, 10, np.random.default_rng(0))
    distance = np.hypot(seeds[:, 0] - 9000.0, seeds[:, 1] - 400.0)
    assert (distance >= 2000.0).all()
    assert (seeds[:, 1] > 400.0).sum() == 5


def test_rule_seeds_begin_with_a_feasible_point() -> None:
    question = problem(HILL)
    seeds, _, evaluated = rule_seeds(question, 20)
    assert question.rank(seeds[:1])[0] < INFEASIBLE
    assert evaluated > 0


def test_a_wall_alone_is_flown_round() -> None:
    wall = Walls(np.array([[[9000.0, -3000.0], [9000.0, 2000.0]]]), room=17.0)
    fenced = replace(problem([], target=(20_000.0, 0.0)), relaxed=frozenset({"g2"}), walls=wall)
    search = search_waypoint(fenced, np.random.default_rng(0))
    assert search.found is not None
    assert search.found[1] > 2000.0


def test_what_touches_a_long_leg_far_from_the_hill_bounds_the_search_too() -> None:
    hill = [(814.0, 1772.0), (798.0, 845.0), (469.0, 3248.0)]
    others = [(11_453.0, 2166.0), (7402.0, 5319.0), (6032.0, -5965.0), (3832.0, -4405.0)]
    between = [(2358.0, -977.0), (4236.0, -2741.0)]
    question = replace(problem([*hill, *others, *between], target=(28_484.0, 0.0)), avoided=np.arange(3))
    assert best_waypoint(question) is not None
    assert search_waypoint(question, np.random.default_rng(0)).found is not None


def test_length_to_optimum_compares_with_the_shortest_path() -> None:
    search = search_waypoint(problem(SINGLE), np.random.default_rng(0))
    ratio = length_to_optimum(search)
    assert ratio is not None
    assert 1.0 <= ratio < 1.001


def test_the_gap_has_no_meaning_without_a_detour() -> None:
    search = search_waypoint(problem([(9000.0, 3000.0)]), np.random.default_rng(0))
    assert search_gap(search) is None


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("spread", [700.0, 3000.0], ids=["clustered", "spread"])
def test_a_waypoint_is_found_wherever_a_grid_finds_one(spread: float, seed: int) -> None:
    """Dense fields, where the best waypoint touches the search limit, several circles or the first turn."""
    rng = np.random.default_rng([seed, int(spread)])
    centres = rng.normal((7000.0, 0.0), (spread, spread), (14, 2))
    ends = np.minimum(np.hypot(*centres.T), np.hypot(*(centres - [20_000.0, 0.0]).T))
    question = problem([(c[0], c[1]) for c in centres[ends > 1200.0]], target=(20_000.0, 0.0))
    search = search_waypoint(question, rng)
    if best_waypoint(question) is None:
        assert search.found is None
        return
    assert search.found is not None
    gap = search_gap(search)
    assert gap is None or gap < 0.01
