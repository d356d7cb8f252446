"""Standing until thrust is asked for; restarts; timing; keeping time."""

from __future__ import annotations

import pytest

from offboard.hil.plant import NEUTRAL, Axes, Phase
from offboard.hil.simulation import LaunchRule, Simulation
from offboard.hil.timing import Punctuality, Timing
from tests.offboard.hil.fakes import FakePlant

FULL = Axes(0.0, 0.0, 0.0, 1.0)


def test_no_launch_without_thrust_for_a_while():
    simulation = Simulation(FakePlant(), LaunchRule(throttle=0.3, delay=0.5))
    for axes in (NEUTRAL, FULL, FULL._replace(throttle=0.2), FULL):
        simulation.step(axes, 0.4)
        assert simulation.phase is Phase.STANDING
    simulation.step(FULL, 0.1)
    assert simulation.phase is Phase.LAUNCHING


def test_a_restart_puts_everything_back():
    simulation = Simulation(FakePlant(), LaunchRule(delay=0.0))
    for _ in range(3):
        simulation.step(FULL, 0.5)
    assert simulation.truth.north > 0
    simulation.restart()
    assert (simulation.truth.time, simulation.truth.north, simulation.phase) == (0.0, 0.0, Phase.STANDING)
    assert (simulation.axes, simulation.restarts) == (NEUTRAL, 1)


def test_every_step_is_seen_by_the_watcher():
    seen = []
    simulation = Simulation(FakePlant(), watch=lambda truth, phase, axes: seen.append((truth.time, axes)))
    simulation.step(FULL, 0.5)
    simulation.step(NEUTRAL, 0.5)
    assert seen == [(0.5, FULL), (1.0, NEUTRAL)]
    assert simulation.timing.steps == 2


def test_time_goes_to_the_part_that_is_named():
    timing = Timing(steps=10)
    timing.start()
    timing.lap("plant")
    timing.seconds["transport"] += 3.0
    assert timing.total == pytest.approx(3.0, abs=0.1)
    assert timing.rate == pytest.approx(10 / 3.0, rel=0.05)


def test_a_step_late_by_more_than_a_period_is_counted():
    seen = Punctuality(0.004)
    for lateness in (0.0, 0.003, 0.0041, 0.2):
        seen.note(lateness)
    assert (seen.steps, seen.late, seen.worst, seen.late_share) == (4, 2, 0.2, 0.5)
