"""What is particular to each rival of the swarm."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from avoidance.agent import Agent
from avoidance.exact import exact_way
from avoidance.parameters import DEFAULT, SwarmSettings
from avoidance.rivals.ga import LEVELS, Ga
from avoidance.rivals.gcpso import FIRST_RADIUS, Gcpso
from avoidance.rivals.mpso import PATIENCE, Mpso
from avoidance.rivals.sa import Sa
from avoidance.rivals.theta_mafoa import ThetaMafoa
from avoidance.types import Rung
from avoidance.yardsticks import length_to_optimum
from tests.avoidance.worlds import PERFORMANCE, ownship, problem, route, scan

BOX = np.array([[-2000.0, -2000.0], [2000.0, 2000.0]])
SEED = np.array([[900.0, 700.0]])
SETTINGS = SwarmSettings(particles=6, iterations=40, stop_change=0.0, stop_iterations=1000)


def rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def test_the_leader_of_gcpso_searches_about_the_best_point_while_a_plain_swarm_stands_still() -> None:
    """All particles on one spot: Eq. (28) gives no velocity at all, the leader's rule does."""
    swarm = Gcpso(np.repeat(SEED, 6, axis=0), BOX, SETTINGS, rng())
    swarm.tell(np.zeros(6))
    moved = np.abs(swarm.ask() - SEED)
    assert (moved[1:] == 0.0).all()
    assert 0.0 < moved[0].max() <= FIRST_RADIUS


def test_gcpso_narrows_after_failures_and_widens_after_successes() -> None:
    swarm = Gcpso(SEED, BOX, SETTINGS, rng())
    swarm.tell(np.full(6, 10.0))
    for _ in range(6):
        swarm.tell(np.full(6, 11.0))
    assert swarm._radius == 0.5 * FIRST_RADIUS
    for better in range(16):
        swarm.tell(np.full(6, 9.0 - 0.1 * better))
    assert swarm._radius == FIRST_RADIUS


def test_mpso_starts_again_where_it_stands_and_keeps_its_best() -> None:
    swarm = Mpso(SEED, BOX, SETTINGS, rng())
    swarm.tell(np.full(6, 5.0))
    best = swarm.best.tolist()
    for _ in range(PATIENCE):
        swarm.tell(np.full(6, 5.0))
    assert swarm.restarts == 1
    assert (np.abs(swarm.ask()) <= 2000.0).all()
    assert np.ptp(swarm.ask(), axis=0).min() > 500.0
    assert swarm.best.tolist() == best


def test_children_lie_on_the_grid_and_the_best_is_handed_on() -> None:
    planner = Ga(np.array([[0.123, 0.456], [500.0, 600.0]]), BOX, SETTINGS, rng(1))
    planner.tell(np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]))
    children = planner.ask()
    assert children[0].tolist() == [0.123, 0.456]
    steps = (children[1:] + 2000.0) / 4000.0 * LEVELS
    assert np.allclose(steps, np.rint(steps), atol=1e-6)


def test_crossover_swaps_tails_and_loses_no_bit() -> None:
    planner = Ga(SEED, BOX, SETTINGS, rng(2))
    parents = np.array([0, (1 << 32) - 1] * 50, dtype=np.int64)
    children = planner._cross(parents)
    assert ((children[::2] ^ children[1::2]) == (1 << 32) - 1).all()
    assert (children != parents).sum() > 20


def test_the_walk_takes_steps_of_one_temperature_and_stays_in_the_box() -> None:
    planner = Sa(SEED, BOX, SETTINGS, rng())
    planner.tell(np.hypot(*planner.ask().T))
    start = planner.best
    assert np.isclose(np.hypot(*(planner.ask()[0] - start)), 100.0)
    corner = Sa(np.array([[2000.0, 2000.0]]), BOX, replace(SETTINGS, particles=1), rng())
    while not corner.finished:
        corner.tell(np.zeros(1))
        assert (np.abs(corner.ask()) <= 2000.0).all()


def test_all_steps_of_annealing_together_reach_a_kilometre_and_a_half() -> None:
    """Erratum E34: 100 m · (0.95 + 0.95² + … ) in 30 iterations."""
    assert round(sum(100.0 * 0.95**k for k in range(1, 31))) == 1492


def test_phase_angles_keep_the_flies_in_the_box() -> None:
    planner = ThetaMafoa(np.array([[5000.0, -9000.0]]), BOX, SETTINGS, rng())
    planner.tell(np.arange(6.0))
    while not planner.finished:
        assert (np.abs(planner.ask()) <= 2000.0 + 1e-9).all()
        planner.tell(np.hypot(*planner.ask().T))
    assert planner.best_cost < 200.0


def test_the_exact_planner_gives_the_shortest_route_at_once() -> None:
    question = problem([(9000.0, 400.0), (14_000.0, -900.0)])
    plan = exact_way(question, rng())
    assert plan is not None
    assert plan.rung is Rung.ROUTE
    assert len(plan.waypoints) >= 2
    assert length_to_optimum(plan.search) is None  # it is no single waypoint


def test_an_agent_flies_by_whatever_finds_the_way() -> None:
    agent = Agent(PERFORMANCE, DEFAULT, rng(), exact_way)
    ahead, seen = route((60_000.0, 0.0)), [(8000.0, 400.0), (9500.0, -900.0)]
    agent.decide(ownship(), ahead, scan(seen))
    decision = agent.decide(ownship(north=15.0, time=1.0), ahead, scan(seen, time=1.0))
    assert decision.rung is Rung.ROUTE
    assert "no single waypoint" not in decision.why
