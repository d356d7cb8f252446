"""One waypoint search: problem, seeds, planner and yardsticks together."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from avoidance import seeds
from avoidance.cost import path_length
from avoidance.geofence import Walls
from avoidance.parameters import DEFAULT, PAPER, Parameters
from avoidance.problem import INFEASIBLE, WaypointProblem
from avoidance.search import search_waypoint
from avoidance.seeds import rule_seeds, sphere_seeds
from avoidance.types import Floats
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


def test_a_swarm_that_is_given_the_best_only_looks_at_its_seeds() -> None:
    """From seeds about the sphere it goes on for as long as it improves."""
    rng = np.random.default_rng(0)
    assert rule_seeds(problem(SINGLE), 20).proven
    assert search_waypoint(problem(SINGLE), rng).iterations == 1
    assert search_waypoint(problem(SINGLE, parameters=replace(DEFAULT, rule_seeds=False)), rng).iterations > 3


def test_the_best_is_proven_only_where_the_curves_of_all_obstacles_are_known() -> None:
    beside = [(3000.0 + 400.0 * k, 9000.0) for k in range(45)]
    for count in (10, 45):
        question = replace(problem([*SINGLE, *beside[:count]]), avoided=np.arange(1))
        assert rule_seeds(question, 20).proven is (count == 10)


def test_the_best_is_not_proven_where_risk_is_a_large_part_of_what_the_detour_costs() -> None:
    """A leg that hardly cuts the sphere: ever less way is added, the risk near it stays."""
    deep, grazing = ([(9000.0, 400.0)], [(9000.0, 1005.0)])
    assert rule_seeds(problem(deep, target=(20_000.0, 0.0)), 20).proven
    assert not rule_seeds(problem(grazing, target=(20_000.0, 0.0)), 20).proven


def test_a_dear_point_that_can_be_flown_does_not_hide_a_cheaper_one_behind_some_that_cannot(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The shortest way is dear, the next ten cannot be flown."""
    question = problem(SINGLE, target=(20_000.0, 0.0), relaxed=frozenset({"g1"}))
    points = rule_seeds(question, 300).points
    allowed = points[(question.waypoint_violation(points) <= 0.0) & (question.leg_violation(points) <= 0.0)]
    lengths = np.sort(path_length(allowed, question.start, question.target))

    def cost(_: WaypointProblem, points: Floats) -> Floats:
        length = path_length(points, question.start, question.target)
        return np.asarray(0.1 * length + 1000.0 * (length < lengths[0] + 1e-6))

    def rank(_: WaypointProblem, points: Floats, cost: Floats) -> Floats:
        length = path_length(points, question.start, question.target)
        barred = (length > lengths[0] + 1e-6) & (length < lengths[10] + 1e-6)
        return np.where(barred, INFEASIBLE + 1.0, cost)

    monkeypatch.setattr(WaypointProblem, "cost", cost)
    monkeypatch.setattr(WaypointProblem, "rank_placed", rank)
    shortest_ones = int((path_length(points, question.start, question.target) <= lengths[0] + 1e-6).sum())
    monkeypatch.setattr(seeds, "BATCH_ALONE", shortest_ones)
    found = rule_seeds(question, 20)
    best = lengths[lengths > lengths[10] + 1e-6][0]
    assert found.ranks[0] <= 0.1 * best + 0.01


def test_what_was_worked_out_about_tangents_serves_the_same_places_only() -> None:
    question = problem(SINGLE)
    rule_seeds(question, 20)
    assert len(question.rays) == 1
    close = question.relaxing(frozenset({"g1"}), longest=50_000.0)
    assert close.rays is question.rays
    assert close.relaxed == {"g1"}
    assert close.longest == 50_000.0
    assert not replace(question, centres=question.centres + 500.0).rays


def test_where_turns_move_the_best_waypoint_off_the_rules_points_the_swarm_searches() -> None:
    """A waypoint close to the sphere: the turn there needs room that the tangents do not leave."""
    close = problem([(9000.0, 0.0)], target=(40_000.0, 0.0), relaxed=frozenset({"g1", "g2", "g4"}))
    assert not rule_seeds(close, 20).proven
    search = search_waypoint(close, np.random.default_rng(0))
    assert search.iterations > 1
    gap = search_gap(search)
    assert gap is not None
    assert gap <= 0.01


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
    points = sphere_seeds(question, 10, np.random.default_rng(0))
    distance = np.hypot(points[:, 0] - 9000.0, points[:, 1] - 400.0)
    assert (distance >= 2000.0).all()
    assert (points[:, 1] > 400.0).sum() == 5


def test_rule_seeds_begin_with_a_feasible_point() -> None:
    question = problem(HILL)
    found = rule_seeds(question, 20)
    assert found.feasible
    assert question.rank(found.points[:1])[0] == found.ranks[0] < INFEASIBLE
    assert found.tested > 0


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


def test_the_best_waypoint_on_a_leg_that_touches_something_far_from_the_hill_is_found() -> None:
    """The best of the points about the hill alone is 3.4 km further."""
    hill = [(1093.0, -1947.0), (1294.0, -794.0)]
    others = [(9244.0, 3337.0), (10_262.0, 2855.0), (11_419.0, 4095.0), (7824.0, 400.0), (11_543.0, -5443.0)]
    question = replace(problem([*hill, *others], target=(34_979.0, 0.0)), avoided=np.arange(2))
    gap = search_gap(search_waypoint(question, np.random.default_rng(0)))
    assert gap is not None
    assert gap <= 0.001


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
