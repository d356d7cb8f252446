"""Algorithm 10 and Eqs. (28)-(30)."""

from __future__ import annotations

import numpy as np
import pytest

from avoidance.parameters import PAPER, SwarmSettings
from avoidance.pso import Pso

BOX = np.array([[-2000.0, -2000.0], [2000.0, 2000.0]])


def run(swarm: Pso, centre: tuple[float, float] = (0.0, 0.0)) -> Pso:
    while not swarm.finished:
        swarm.tell(((swarm.ask() - np.array(centre)) ** 2).sum(axis=1))
    return swarm


def test_the_swarm_finds_the_bottom_of_a_bowl() -> None:
    settings = SwarmSettings(iterations=80, stop_change=0.0, stop_iterations=80)
    swarm = run(Pso(np.array([[900.0, 700.0], [-300.0, 800.0]]), BOX, settings, np.random.default_rng(3)))
    assert float(np.hypot(*swarm.best)) < 5.0


def test_the_first_points_are_the_seeds() -> None:
    seeds = np.arange(12.0).reshape(6, 2)
    swarm = Pso(seeds, BOX, SwarmSettings(particles=4), np.random.default_rng(0))
    assert swarm.ask().tolist() == seeds[:4].tolist()


def test_no_step_is_longer_than_the_velocity_bound() -> None:
    swarm = Pso(np.array([[5000.0, 0.0]]), BOX, SwarmSettings(largest_step=50.0), np.random.default_rng(1))
    before = swarm.ask()
    swarm.tell((before**2).sum(axis=1))
    swarm.tell((swarm.ask() ** 2).sum(axis=1))
    assert np.abs(swarm.ask() - before).max() <= 100.0 + 1e-9


def test_the_printed_stop_rule_fires_after_five_small_changes() -> None:
    swarm = run(Pso(np.array([[10.0, 0.0]]), BOX, PAPER.swarm, np.random.default_rng(2)))
    assert swarm.iteration in (6, 7)  # erratum E30: at iteration 5-6 after the first evaluation


def test_the_same_seed_gives_the_same_swarm() -> None:
    bests = [
        run(Pso(np.array([[900.0, 700.0]]), BOX, SwarmSettings(), np.random.default_rng(5))).best
        for _ in "ab"
    ]
    assert bests[0].tolist() == bests[1].tolist()


def test_no_seeds_is_a_wrong_call() -> None:
    with pytest.raises(ValueError, match="seeds"):
        Pso(np.empty((0, 2)), BOX, SwarmSettings(), np.random.default_rng(0))
