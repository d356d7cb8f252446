"""Campaigns: the same worlds whatever the jobs, the figures, the files, the command."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from avoidance.parameters import DEFAULT, PAPER
from scenarios.cases import KINDS, Case, scenario_of
from scenarios.cli import app
from scenarios.errors import ScenarioError
from scenarios.load import load, parse
from scenarios.stress import Campaign, Row, rows, run, write_case
from scenarios.stress_options import campaign_of
from scenarios.toml_text import to_toml
from scenarios.trial import Events, Outcome, attempt

KEYS = [
    *("kind", "obstacles", "runs", "feasible", "successes", "violations", "min_separation_m"),
    *("length_ratio_median", "length_ratio_p95", "added_path_pct", "risk_ratio", "rungs"),
    *("replans_median", "decision_ms", "seed"),
]


def campaign(kind="moving", counts=(1,), runs=2, seed=5) -> Campaign:
    return Campaign(kind, counts, runs, seed, "kinematic", DEFAULT)


def without_wall_time(outcomes):
    return sorted((replace(o, decision_ms=()) for o in outcomes), key=lambda o: o.case.index)


@pytest.mark.parametrize("kind", KINDS)
def test_a_world_is_a_function_of_its_case_and_survives_its_file(kind):
    count = KINDS[kind].counts[0]
    world = scenario_of(Case(kind, count, 7, 3), "kinematic", DEFAULT)
    assert parse(to_toml(world)) == world
    assert scenario_of(Case(kind, count, 7, 3), "kinematic", DEFAULT) == world
    for other in (Case(kind, count, 7, 4), Case(kind, count, 8, 3), Case(kind, count + 1, 7, 3)):
        there = scenario_of(other, "kinematic", DEFAULT)
        assert (there.obstacles, there.traffic) != (world.obstacles, world.traffic)
        assert there.seed != world.seed


def test_worlds_stay_what_they_were():
    """A change here makes every published campaign irreproducible."""
    field = scenario_of(Case("static", 10, 0, 0), "kinematic", DEFAULT)
    (flight,) = scenario_of(Case("moving", 1, 0, 0), "kinematic", DEFAULT).traffic
    assert (field.obstacles[0].north, field.obstacles[0].east) == (5349.53, 2854.285)
    assert (flight.waypoints[0].north, flight.waypoints[0].east) == (23369.754, -24003.742)


def test_mixed_fields_have_all_sizes_wind_and_a_free_start():
    world = scenario_of(Case("mixed", 100, 0, 0), "kinematic", DEFAULT)
    radii = [o.safety_radius for o in world.obstacles]
    assert 300.0 <= min(radii) < 500.0
    assert 1500.0 < max(radii) <= 2000.0
    assert world.wind.speed == pytest.approx(8.0, abs=0.01)
    assert world.wind.turbulence == "moderate"
    assert all(o.north**2 + o.east**2 >= (o.safety_radius + 500.0) ** 2 for o in world.obstacles)


def test_the_paper_keeps_its_own_reach():
    assert scenario_of(Case("static", 10, 0, 0), "6dof", PAPER).vehicle.acceptance_radius is None
    assert scenario_of(Case("static", 10, 0, 0), "6dof", DEFAULT).vehicle.acceptance_radius == 20.0


def test_the_number_of_jobs_changes_nothing():
    one = without_wall_time(run(campaign(), jobs=1))
    two = without_wall_time(run(campaign(), jobs=2))
    assert one == two
    assert [o.case.index for o in one] == [0, 1]
    assert all(o.unmitigated.loss and o.error is None for o in one)


def test_an_error_of_the_software_is_a_finding(monkeypatch):
    monkeypatch.setattr("scenarios.trial.score", lambda flown: 1 / 0)
    outcome = attempt(Case("moving", 1, 0, 0), "kinematic", DEFAULT)
    assert outcome.failing
    assert outcome.why == "the software failed: ZeroDivisionError: division by zero"


def outcome(index, obstacles=1, **fields) -> Outcome:
    return Outcome(Case("moving", obstacles, 0, index), **fields)


def test_rows_gather_whoever_finished_first():
    found = rows([outcome(1), outcome(0, 4), outcome(0)])
    assert [(row.obstacles, [o.case.index for o in row.outcomes]) for row in found] == [(1, [0, 1]), (4, [0])]


def test_figures_of_a_row():
    hit, kept = Events(loss=True), Events()
    row = Row(
        (
            outcome(0, success=True, added_path=1.0, events=kept, unmitigated=hit, rungs={"waypoint": 3}),
            outcome(1, violations=2, added_path=50.0, events=hit, unmitigated=hit, rungs={"route": 1}),
            outcome(2, feasible=False, decision_ms=(4.0, 6.0), unmitigated=hit),
        )
    )
    figures = row.as_json()
    assert list(figures) == KEYS
    assert (figures["runs"], figures["feasible"], figures["successes"], figures["violations"]) == (3, 2, 1, 2)
    assert figures["added_path_pct"] == {"median": 1.0, "p95": 1.0}
    assert figures["risk_ratio"]["loss"]["value"] == pytest.approx(1 / 3)
    assert figures["risk_ratio"]["nmac"] == {"value": None, "low": None, "high": None}
    assert (figures["rungs"]["waypoint"], figures["rungs"]["route"]) == (0.75, 0.25)
    assert figures["decision_ms"]["median"] == 5.0
    assert [o.failing for o in row.outcomes] == [False, True, False]


def test_a_failing_world_is_a_scenario_that_flies(tmp_path):
    bad = outcome(2, violations=1, min_margin=-3.25)
    path = write_case(bad, campaign(seed=0), tmp_path / "bad")
    assert path.read_text().startswith("# 1 entries into a sphere, 3.2 m deep\n")
    assert load(path) == scenario_of(bad.case, "kinematic", DEFAULT)
    assert [p.name for p in path.parent.iterdir()] == ["moving-1-seed0-run2.toml"]


def test_the_command_prints_rows_and_the_failures_replay(tmp_path):
    options = ["--kind", "moving", "--runs", "1", "--seed", "3", "--jobs", "1", "-o", str(tmp_path)]
    done = CliRunner().invoke(app, ["stress", *options, "--json"])
    (row,) = json.loads(done.stdout)
    assert list(row) == KEYS
    assert done.exit_code == (0 if row["successes"] == 1 else 1)
    bad = Outcome(Case("moving", 1, 3, 0), violations=1)
    file = write_case(bad, campaign(seed=3), tmp_path)
    flown = CliRunner().invoke(app, ["fly", str(file), "--json", "-o", str(tmp_path / "run")])
    assert json.loads(flown.stdout)["min_separation_m"] == row["min_separation_m"]


def test_the_table_is_for_a_stranger():
    done = CliRunner().invoke(app, ["stress", "--kind", "moving", "--runs", "1", "--jobs", "1"])
    assert "intruders at constant velocity, each would pass within 1 km" in done.stdout
    assert "well clear" in done.stdout
    assert "1 intruder" in done.stdout


def test_options_are_checked_together():
    with pytest.raises(ScenarioError) as caught:
        campaign_of("statik", "1,x", 1, 0, "7dof", "default", None, 2, "tcp://there:1")
    assert [p.key for p in caught.value.problems] == ["--kind", "--vehicle", "--obstacles", "--jobs"]
    with pytest.raises(ScenarioError, match="from 1"):
        campaign_of("moving", "0", 1, 0, "6dof", "default", None, None, None)
    assert campaign_of("static", "40,10,40", 1, 0, "6dof", "paper", "ga", None, None).counts == (10, 40)
