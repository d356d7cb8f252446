"""Planners by name: flown by, written down, refused."""

from __future__ import annotations

import itertools
import json
import typing

import numpy as np
import pytest
from typer.testing import CliRunner

from avoidance.exact import exact_way
from avoidance.ladder import way_round
from avoidance.parameters import DEFAULT
from avoidance.search import OPTIMISERS
from avoidance.types import Rung
from scenarios.cli import app
from scenarios.errors import ScenarioError
from scenarios.load import load
from scenarios.outside import OUTSIDE, installed, outside_way
from scenarios.planners import PLANNERS, planned_by, way_of
from scenarios.schema import PlannerName
from tests.avoidance.worlds import problem

HILL = [(9000.0, 400.0), (9300.0, 300.0), (9600.0, 500.0)]


def needs(name):
    return pytest.param(
        name, marks=pytest.mark.skipif(not installed(name), reason=f"{OUTSIDE[name][0]} is not installed")
    )


def test_every_planner_has_a_title_and_may_stand_in_a_file():
    assert set(PLANNERS) == {*OPTIMISERS, "exact", *OUTSIDE} == set(typing.get_args(PlannerName))


def test_single_waypoint_planners_go_through_the_ladder():
    parameters, way = way_of(planned_by(DEFAULT, "ga"))
    assert (parameters.optimiser, way) == ("ga", way_round)
    parameters, way = way_of(planned_by(DEFAULT, "exact"))
    assert (parameters.optimiser, way) == ("pso", exact_way)


def test_an_unknown_planner_is_refused_with_the_known_ones():
    with pytest.raises(ScenarioError, match=r"'pos' is unknown; known: pso, .*ompl-bitstar"):
        planned_by(DEFAULT, "pos")


@pytest.mark.parametrize("name", [needs("pyswarms"), needs("scipy-de")])
def test_outside_swarms_find_what_ours_finds(name):
    question = problem(HILL)
    plans = [outside_way(name)(question, np.random.default_rng(3)) for _ in "ab"]
    assert plans[0].waypoints == plans[1].waypoints  # a function of the generator
    assert plans[0].rung is Rung.WAYPOINT
    assert question.violation(np.array(plans[0].waypoints))[0] == 0.0
    ours = way_round(question, np.random.default_rng(3))
    assert plans[0].search.cost == pytest.approx(ours.search.cost, rel=1e-3)


@pytest.mark.parametrize("name", [needs("ompl-rrtstar"), needs("ompl-bitstar")])
def test_outside_routes_keep_clear_of_every_disc(name):
    question = problem(HILL)
    plans = [outside_way(name)(question, np.random.default_rng(3)) for _ in "ab"]
    assert plans[0].waypoints == plans[1].waypoints
    corners = np.array([question.start, *plans[0].waypoints, question.target])
    samples = np.concatenate([np.linspace(a, b, 2000) for a, b in itertools.pairwise(corners)])
    away = np.hypot(*(samples[:, None] - question.centres[None]).transpose(2, 0, 1))
    assert (away >= question.keep).all()


def test_numpy_s_own_generator_is_left_as_it_was():
    if not installed("pyswarms"):
        pytest.skip("pyswarms is not installed")
    np.random.seed(7)  # noqa: NPY002
    expected = np.random.random()  # noqa: NPY002
    np.random.seed(7)  # noqa: NPY002
    outside_way("pyswarms")(problem(HILL), np.random.default_rng(0))
    assert np.random.random() == expected  # noqa: NPY002


@pytest.mark.parametrize("name", ["exact", "sa"])
def test_a_flight_is_flown_by_the_planner_named_and_its_file_says_so(name, tmp_path):
    place = tmp_path / "run"
    options = ["single", "--planner", name, "--fidelity", "kinematic", "-o", str(place), "--json"]
    done = CliRunner().invoke(app, ["fly", *options])
    assert done.exit_code == 0
    assert json.loads((place / "run.json").read_text())["planner"] == name
    assert load(place / "scenario.toml").planner == name
    rows = [json.loads(line) for line in (place / "decisions.jsonl").read_text().splitlines()]
    assert {row["planner"] for row in rows if row["planner"]} == {name}


def test_a_planner_that_is_unknown_is_bad_input(tmp_path):
    for command in (["fly", "single"], ["stress", "--runs", "1"]):
        done = CliRunner().invoke(app, [*command, "--planner", "pos", "-o", str(tmp_path)])
        assert done.exit_code == 2
        assert "known: pso" in done.output
