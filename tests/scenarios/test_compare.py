"""Planners side by side: the same worlds, resumable, the same figures whatever the jobs."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from avoidance.parameters import DEFAULT
from scenarios.cli import app
from scenarios.compare import Row, jobs_of, rows
from scenarios.compare_maps import course_map
from scenarios.compare_store import Store, digest, fly_all
from scenarios.load import load


def quick(name="single"):
    chosen = load(name)
    return replace(chosen, vehicle=replace(chosen.vehicle, fidelity="kinematic"))


def plain(record):
    """A record without its wall times."""
    slow = {"wall_s", "real_time_factor", "decision_ms"}
    summary = {key: value for key, value in record["summary"].items() if key not in slow}
    return {k: v for k, v in record.items() if k not in {"algorithm_s", "decision_ms"}} | {"summary": summary}


def test_every_planner_flies_the_same_worlds():
    jobs = jobs_of(load("random"), DEFAULT, ["pso", "ga"], 2)
    assert [job.name for job in jobs] == ["random-0-pso", "random-0-ga", "random-1-pso", "random-1-ga"]
    assert jobs[0].scenario.obstacles == jobs[1].scenario.obstacles != jobs[2].scenario.obstacles
    assert [job.parameters.optimiser for job in jobs[:2]] == ["pso", "ga"]
    assert jobs[3].scenario.seed == 1


def test_records_are_kept_and_the_jobs_change_nothing(tmp_path):
    jobs = jobs_of(quick(), DEFAULT, ["pso", "exact"], 1)
    store = Store(tmp_path)
    first = fly_all(jobs, processes=1, store=store)
    again = fly_all(jobs, processes=1, store=store)
    assert again == json.loads(json.dumps(first))  # wall times and all: nothing was flown again
    other = fly_all(jobs, processes=2)
    assert {name: plain(r) for name, r in other.items()} == {name: plain(r) for name, r in first.items()}
    assert sorted(path.name for path in tmp_path.iterdir()) == ["single-0-exact.json", "single-0-pso.json"]


def test_a_killed_campaign_continues_where_it_stopped(tmp_path):
    """One record is there, one half written, one of another world: only the first is not flown again."""
    jobs = jobs_of(quick(), DEFAULT, ["pso", "ga", "sa"], 1)
    store = Store(tmp_path)
    store.write(jobs[0], {"planner": "pso", "safe": True, "kept": True})
    store.path(jobs[1]).write_text('{"digest": "')
    store.write(replace(jobs[2], scenario=replace(jobs[2].scenario, seed=9)), {"kept": True})
    assert [store.read(job) is not None for job in jobs] == [True, False, False]
    found = fly_all(jobs, processes=1, store=store)
    assert [bool(record.get("kept")) for record in found.values()] == [True, False, False]


def test_a_digest_holds_world_preset_planner_and_avoidance():
    (job,) = jobs_of(quick(), DEFAULT, ["pso"], 1)
    others = [
        replace(job, scenario=replace(job.scenario, seed=1)),
        replace(job, parameters=replace(DEFAULT, margin=51.0)),
        replace(job, avoidance=False),
    ]
    assert len({digest(one) for one in (job, *others)}) == 4
    assert digest(replace(job)) == digest(job)


def record(planner, *, safe=True, plan=1000.0, flown=1010.0, margin=50.0, gap=None):
    summary = {
        "plan_length_m": plan,
        "path_length_m": flown,
        "optimum_length_m": 1000.0,
        "min_margin_m": margin,
        "replans": 1,
        "violations": int(not safe),
    }
    search = {"first_feasible": 2, "evaluations": 30, "gap": gap}
    return {
        "planner": planner,
        "safe": safe,
        "summary": summary,
        "searches": [search],
        "decision_ms": [3.0, 5.0],
    }


def test_lengths_count_only_where_the_flight_was_safe():
    records = {
        "a": record("pso", gap=0.5),
        "b": record("pso", safe=False, plan=1.0, margin=-3.0),
        "c": record("ga"),
    }
    pso, ga = rows(records, ["pso", "ga"])
    figures = pso.as_json()
    assert (figures["runs"], figures["safe"], figures["violations"]) == (2, 1, 1)
    assert (figures["plan_length_m"], figures["length_ratio"], figures["min_margin_m"]) == (
        1000.0,
        1.01,
        -3.0,
    )
    assert (figures["first_feasible"], figures["search_gap"], figures["decision_ms"]) == (2.0, 0.5, 4.0)
    assert ga.as_json()["search_gap"] is None
    assert Row("sa", (record("sa", safe=False),)).length_ratio is None


def test_a_map_has_the_paper_s_axes_and_a_line_for_each_planner():
    (job,) = jobs_of(quick(), DEFAULT, ["pso"], 1)
    (flown,) = fly_all([job], processes=1).values()
    figure = course_map({"one": flown, "other": flown}, window=(15e3, 25e3, -3e3, 3e3))
    lines = [trace for trace in figure["data"] if trace["meta"]["role"] == "flown"]
    assert [line["name"] for line in lines] == ["one", "other"]
    assert lines[0]["x"][-1] == pytest.approx(40.0, abs=0.2)
    assert figure["layout"]["xaxis"]["range"] == [15.0, 25.0]
    assert "north" in figure["layout"]["xaxis"]["title"]["text"]


def test_the_command_prints_a_table_json_and_a_page(tmp_path):
    page = tmp_path / "page.html"
    options = ["--planners", "pso,sa", "--fidelity", "kinematic", "--jobs", "1", "-o", str(page)]
    done = CliRunner().invoke(app, ["compare", "single", *options])
    assert done.exit_code == 0
    assert "flown ÷ shortest" in done.stdout
    text = page.read_text(encoding="utf-8")
    assert "Planners compared: single" in text
    assert "http" not in text[: text.index("<script>")]
    done = CliRunner().invoke(app, ["compare", "single", *options[:-2], "--json"])
    assert [row["planner"] for row in json.loads(done.stdout)] == ["pso", "sa"]


def test_mistakes_are_told():
    for options, words in (
        (["single", "--planners", "pso,pos"], "'pos' is unknown; known: pso"),
        (["single", "--obstacles", "4"], "has no [random] table"),
        (["single", "--fidelity", "7dof"], "known: 6dof, kinematic"),
    ):
        done = CliRunner().invoke(app, ["compare", *options])
        assert done.exit_code == 2
        assert words in done.output
