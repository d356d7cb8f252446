"""Separation by the plant's own track: also from traffic, whose clock is another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from scenarios.cli import app
from scenarios.hil_truth import ClockFit, truth
from scenarios.recorded import read_run
from scenarios.scenario import Obstacle
from scenarios.track import Track

AHEAD = 37.25
"""The plant's clock is ahead of the run's by this much [s]."""


def flown(directory, *options):
    done = CliRunner().invoke(
        app, ["fly", "head-on", "--fidelity", "kinematic", "-o", str(directory), *options]
    )
    assert done.exit_code == len(options), done.output
    return read_run(directory)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return flown(tmp_path_factory.mktemp("hil") / "run")


@pytest.fixture(scope="module")
def blind(tmp_path_factory):
    """The same without avoidance: it ends with code 1."""
    return flown(tmp_path_factory.mktemp("hil") / "blind", "--no-avoidance")


def rows_of(track, ahead=AHEAD):
    """The same flight as the plant records it: at 10 Hz, on its own clock, after a minute on the ground."""
    times = np.arange(track.times[0], track.times[-1], 0.1)
    columns = [np.interp(times, track.times, column) for column in track.positions.T]
    flown = [(t + ahead, "flying", *point) for t, *point in zip(times, *columns, strict=True)]
    before = [(t, "standing", *track.positions[0]) for t in np.arange(-30.0, ahead, 0.1)]
    return before + flown


def test_the_clocks_are_told_by_the_two_tracks(run):
    rows = np.array([[row[0], *row[2:]] for row in rows_of(run.track)])
    blank = np.zeros(len(rows))
    fit = ClockFit.of(Track("plant", rows[:, 0], rows[:, 1:], blank, blank, blank), run.track)
    assert fit.offset == pytest.approx(AHEAD, abs=0.02)
    assert fit.apart < 1.0


def test_traffic_counts_where_it_was_at_the_time(run):
    found = truth(run.scenario, rows_of(run.track), run.directory)
    assert found["judged"] == "all"
    assert found["violations"] == 0
    assert found["min_separation_m"] == pytest.approx(run.summary["min_separation_m"], abs=1.0)


def test_an_intruder_met_too_near_is_a_violation(blind):
    found = truth(blind.scenario, rows_of(blind.track), blind.directory)
    assert found["judged"] == "all"
    assert found["violations"] == blind.summary["violations"] == 1
    assert found["min_separation_m"] == pytest.approx(blind.summary["min_separation_m"], abs=10.0)


def test_tracks_that_do_not_match_are_not_compared(run):
    elsewhere = replace(run.track, positions=run.track.positions + np.array([0.0, 5000.0, 0.0]))
    found = truth(run.scenario, rows_of(elsewhere), run.directory)
    assert found["judged"] == "standing"
    assert found["clock_fit_m"] > 1000.0


def test_without_the_other_run_only_what_stands_still_is_judged(run, tmp_path):
    found = truth(run.scenario, rows_of(run.track), tmp_path / "nothing")
    assert found["judged"] == "standing"
    assert found["clock_fit_m"] is None


@pytest.mark.parametrize(("appears_at", "violations"), [(0.0, 1), (1.0, 0)], ids=["always", "pop-up"])
def test_what_stands_from_the_beginning_counts_before_the_run_begins(run, appears_at, violations):
    """The plant takes off inside a sphere, and is out of it when the other process begins to record."""
    inside = [(t, "flying", -9000.0, 0.0, 200.0) for t in np.arange(0.0, 5.0, 0.1)]
    after = [row for row in rows_of(run.track) if row[0] > 5.0]
    scenario = replace(run.scenario, obstacles=(Obstacle(1, -9000.0, 0.0, 200.0, 500.0, appears_at),))
    found = truth(scenario, inside + after, run.directory)
    assert found["judged"] == "all"
    assert found["violations"] == violations


def test_what_appears_by_a_clock_that_is_not_known_is_not_judged(run, tmp_path):
    """By the plant's clock it would stand in the way already; by the autopilot's it appeared later."""
    where = run.track.positions[len(run.track.times) // 2]
    scenario = replace(run.scenario, traffic=(), obstacles=(Obstacle(1, *where, 500.0, appears_at=1.0),))
    found = truth(scenario, rows_of(run.track), tmp_path / "nothing")
    assert (found["judged"], found["violations"], found["min_margin_m"]) == ("standing", 0, None)


def test_what_was_before_a_restart_does_not_count(run):
    """The first attempt flies 100 km off, then the plant is back at its start: no leap through the field."""
    first = [(t, "flying", 1e5, 1e5, 200.0) for t in np.arange(0.0, 500.0, 1.0)]
    whole = truth(run.scenario, first + rows_of(run.track), run.directory)
    assert whole == truth(run.scenario, rows_of(run.track), run.directory)
