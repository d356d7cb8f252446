"""The worlds, the sections made of records, the page, the command."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from avoidance.parameters import DEFAULT, PAPER
from scenarios.cli import app
from scenarios.compare_store import fly_all
from scenarios.errors import ScenarioError
from scenarios.load import load
from scenarios.paper import convergence, searches, table3, table4, table6
from scenarios.paper.experiment import TARGETS, jobs_of, sections_of, wanted
from scenarios.paper.page import page
from scenarios.paper.section import text_of
from scenarios.paper.worlds import Options, field_job, scene_job, table4_job
from scenarios.run import prepare

QUICK = Options(fidelity="kinematic", runs=2)


def test_a_field_is_the_world_that_the_command_line_flies():
    job = field_job(Options(), "40", 3, "ga")
    assert job.scenario.obstacles == prepare(load("random"), 3, obstacles=40).obstacles
    assert (job.scenario.seed, job.scenario.planner, job.parameters.optimiser) == (3, "ga", "ga")
    assert job.name == "field-40-3-ga-default-6dof"


def test_hill_and_traffic_are_added_to_the_same_field():
    plain, hill, moving = (field_job(Options(), row, 0, "pso") for row in ("40", "40+hill", "40+moving"))
    assert hill.scenario.obstacles[-40:] == tuple(
        replace(o, id=o.id) for o in hill.scenario.obstacles if o.kind == "random"
    )
    places = [(o.north, o.east) for o in plain.scenario.obstacles]
    assert [(o.north, o.east) for o in hill.scenario.obstacles if o.kind == "random"] == places
    assert len(hill.scenario.obstacles) == 51
    assert len(moving.scenario.traffic) == 2


def test_tables_share_their_flights():
    options = Options()
    names = {job.name for job in jobs_of(["table3", "table5", "table6", "fig26"], options)}
    assert len(names) == 131 + 3 * 4 * 10  # PSO's rows of Table 6 are those of Table 3
    assert len(jobs_of(wanted("all"), options)) == len({job.name for job in jobs_of(TARGETS, options)})
    assert not {job.name for job in jobs_of(TARGETS, Options(preset="paper"))} & names


def test_another_planner_takes_part():
    options = Options(planner="gcpso")
    assert options.planners == ("pso", "theta-mafoa", "ga", "sa", "gcpso")
    assert {job.parameters.optimiser for job in table3.jobs(options)} == {"gcpso"}


def test_an_unknown_target_is_refused():
    assert wanted("all") == list(TARGETS)
    with pytest.raises(ScenarioError, match="'table8' is neither a table nor a figure"):
        wanted("table8")


@pytest.fixture(scope="module")
def flown():
    """Figs. 20 and 23, and Table 4's PSO, flown once."""
    jobs = [scene_job(QUICK, "fig20"), scene_job(QUICK, "fig23"), table4_job(QUICK, "pso")]
    return fly_all(jobs, processes=1)


def test_table_4_keeps_every_constraint_below_the_limit(flown):
    """ "How good": PSO's plan is at most 431,700 m with every constraint met."""
    row = table4._ours("pso", flown["table4-pso-default-kinematic"])
    assert row["constraints_broken"] == []
    assert 431_644.0 < row["plan_length_m"] <= 431_700.0
    assert row["flown_safely"]
    assert row["flown_margin_m"] >= 0.0


def test_the_bound_with_everything_known():
    assert searches.full_knowledge_bound(DEFAULT) == pytest.approx(431_645.5, abs=0.3)


def test_figures_become_sections_and_a_page_without_network(flown):
    sections = sections_of(["fig20", "fig23"], QUICK, flown)
    assert sections[0].data["violations"] == 0
    text = page(sections, QUICK)
    head = text[: text.index("<script>")]
    assert "Fig. 20: one obstacle, the shorter side" in head
    assert not re.search(r'(?:src|href)="https?:', head)
    assert '<a href="#E36">' in page(sections_of(["fig24"], QUICK, {}), QUICK) or 'id="E36"' in text
    plots = json.loads(re.search(r'id="plots">(.*?)</script>', text, re.S)[1])
    assert {plot.name for s in sections for plot in s.plots} == set(plots)


def record(*, safe=True, plan=432_000.0, flown=432_100.0, margin=50.0):
    summary = {
        "plan_length_m": plan,
        "path_length_m": flown,
        "optimum_length_m": 431_700.0,
        "min_margin_m": margin,
        "flight_time_s": 28_800.0,
        "replans": 3,
        "waypoints_replaced": 1,
    }
    return {
        "summary": summary,
        "safe": safe,
        "feasible": True,
        "algorithm_s": 0.5,
        "searches": [{"first_feasible": 1}, {"first_feasible": None}],
        "changes": [{"rung": "waypoint", "decision": "detour"}, {"rung": "free", "decision": "replace"}],
    }


def made(target, options):
    return {job.name: record() for job in TARGETS[target].jobs(options)}


def test_every_row_of_table_3_has_figures_of_ours():
    records = made("table3", QUICK)
    records["field-40-0-pso-default-kinematic"] = record(safe=False, plan=1.0, margin=-4.0)
    section = table3.section(QUICK, records)
    assert [text_of(line[0]) for line in section.grids[0].lines][-2:] == ["40 and a hill", "40 and 2 moving"]
    assert all(row["ours"]["plan_length_m"] == 432_000.0 for row in section.data)  # of the safe runs
    (row,) = (row for row in section.data if row["obstacles"] == "40")
    assert (row["ours"]["successes"], row["ours"]["feasible"], row["ours"]["min_margin_m"]) == (1, 2, -4.0)


def test_table_6_and_5_of_records():
    records = made("table6", QUICK)
    for name in records:
        if name.startswith("field-80-") and "-sa-" in name:
            records[name] = record(safe=False)
    rows = {(r["obstacles"], r["planner"]): r["ours"] for r in table6.table6(QUICK, records).data}
    assert rows[80, "sa"]["successes"] == 0
    assert rows[80, "sa"]["plr"] is None
    assert rows[40, "ga"]["plr"] == pytest.approx(432_000.0 / 270_204.0, abs=1e-5)
    assert rows[40, "ga"]["cs"] == 1.0
    assert rows[40, "ga"]["rungs"] == {"waypoint": 2}
    verdicts = table6.table5(QUICK, records).data
    assert len(verdicts) == 4 * 12
    assert {v["verdict"] for v in verdicts if v["obstacles"] == 40} == {"equivalent"}


def test_convergence_shows_both_presets_and_the_optimum_as_a_line():
    section = convergence.fig25(QUICK)
    assert [plot.caption for plot in section.plots] == [
        f"({a}) {n} iterations" for a, n in zip("abc", (10, 20, 30), strict=True)
    ]
    roles = [trace["meta"]["role"] for trace in section.plots[2].figure["data"]]
    assert roles.count("optimum") == 1
    names = {trace["name"] for trace in section.plots[2].figure["data"]}
    assert {"paper parameters", "default parameters"} <= names
    for row in section.data:
        assert row["never_worse"]
        assert all(best >= row["optimum"] - 1.0 for best in row["final"] if best is not None)


def test_the_condition_of_equation_31():
    assert convergence.progress_condition([500.0, 300.0, 150.0, 90.0], 0.0) == pytest.approx(
        2.0 / 3.0 + 1.0 / 3.0
    )
    assert convergence.progress_condition([500.0, 450.0, 450.0], 0.0) == 0.0


@pytest.mark.parametrize("parameters", [DEFAULT, PAPER], ids=["default", "paper"])
@pytest.mark.parametrize("case", searches.CASES)
def test_the_readings_of_the_fitness(case, parameters):
    """As printed about 7,500 and 7,000; as a length from the leg's start what the paper prints."""
    low = searches.optimum(searches.problem(case, "as printed", parameters))
    high = searches.optimum(searches.problem(case, "W_t = 1", parameters))
    assert low == pytest.approx({"obstacle 2": 7509.0, "obstacles 3-5": 7006.0}[case], abs=1.5)
    assert high == pytest.approx({"obstacle 2": 100_090.0, "obstacles 3-5": 150_088.0}[case], abs=2.0)
    *_, last = searches.iterations(searches.problem(case, "W_t = 1", parameters), np.random.default_rng(0))
    assert high - 0.01 <= last.best < high + 60.0


def test_the_command(tmp_path):
    options = ["--fidelity", "kinematic", "--jobs", "1", "-o", str(tmp_path)]
    done = CliRunner().invoke(app, ["paper", "fig20", *options])
    assert done.exit_code == 0
    assert "Fig. 20: one obstacle, the shorter side" in done.stdout
    assert (tmp_path / "fig20.html").is_file()
    kept = (tmp_path / "flights" / "fig20-pso-default-kinematic.json").stat().st_mtime_ns
    done = CliRunner().invoke(app, ["paper", "fig20", *options, "--json"])
    assert json.loads(done.stdout)["replans"] == 1
    assert (tmp_path / "flights" / "fig20-pso-default-kinematic.json").stat().st_mtime_ns == kept


def test_table_7_by_the_command(tmp_path):
    done = CliRunner().invoke(app, ["paper", "table7", "--runs", "2", "-o", str(tmp_path), "--json"])
    rows = json.loads(done.stdout)
    assert len(rows) == 2 * 2 * 3
    assert {row["reading"] for row in rows} == {"as printed", "W_t = 1"}
    assert all(row[name]["feasible"] == 2 for row in rows for name in ("default", "paper"))
    assert all(row["default"]["mean"] <= row["default"]["optimum"] + 0.5 for row in rows)


def test_errata_as_a_table():
    done = CliRunner().invoke(app, ["paper", "errata"])
    assert done.stdout.count("\n") == 39


def test_mistakes_of_the_command(tmp_path):
    for options, words in (
        (["table9"], "neither a table nor a figure"),
        (["fig20", "--planner", "pos"], "'pos' is unknown"),
        (["fig20", "--preset", "best"], "known: default, paper"),
        (["fig20", "--fidelity", "7dof"], "known: 6dof, kinematic"),
    ):
        done = CliRunner().invoke(app, ["paper", *options, "-o", str(tmp_path)])
        assert done.exit_code == 2
        assert words in done.output


def test_a_blocked_leg_behind_the_target_is_no_passage():
    """Ten obstacles, one beside a waypoint at which the course reverses: the way to it may be flown."""
    (record,) = fly_all([field_job(QUICK, "10", 3, "pso")], processes=1).values()
    assert record["safe"]
    assert "hold" not in [change["decision"] for change in record["changes"]]
