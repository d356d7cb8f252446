"""Several own vehicles in one world: each sees the others, each is judged, each has its page."""

from __future__ import annotations

import json
from functools import cache

import numpy as np
import pytest

from scenarios.errors import ScenarioError
from scenarios.load import parse
from scenarios.record import write_run
from scenarios.recorded import differences, read_fleet
from scenarios.report import write_report
from scenarios.toml_text import to_toml
from tests.scenarios.flights import flown

FLEET = """
[vehicle]
fidelity = "kinematic"
[[mission]]
north_m = 0.0
east_m = 0.0
[[mission]]
north_m = 12000.0
east_m = 0.0
[[obstacles]]
id = 5
north_m = 5000.0
east_m = 100.0
[[vehicles]]
name = "left"
[[vehicles]]
name = "right"
east_offset_m = 3000.0
[[vehicles]]
name = "back"
mission = [{north_m = 14000.0, east_m = 0.0}, {north_m = 2000.0, east_m = 500.0}]
"""


@cache
def fleet(avoidance=True):
    return flown(parse(FLEET), avoidance=avoidance)


def test_missions_are_moved_aside_or_their_own_and_ids_are_free_ones():
    scenario = parse(FLEET)
    assert [(m.id, m.name, m.mission[0].north, m.mission[0].east) for m in scenario.vehicles] == [
        (1, "left", 0.0, 0.0),
        (2, "right", 0.0, 3000.0),
        (3, "back", 14000.0, 0.0),
    ]
    assert parse(to_toml(scenario), "scenario") == scenario


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('name = "right"', 'name = "left"', "used twice"),
        ("east_offset_m = 3000.0", "east_offset_m = 900.0", "begins 900 m from another vehicle"),
        ('name = "back"', 'name = "back"\nid = 5', "ids must differ"),
        ("north_m = 2000.0, east_m = 500.0", "north_m = 14000.0, east_m = 0.0", "at least 1 m apart"),
    ],
)
def test_mistakes_are_told(old, new, message):
    with pytest.raises(ScenarioError, match=message):
        parse(FLEET.replace(old, new))


def test_each_avoids_the_field_and_the_others():
    result, judged = fleet()
    assert [v.name for v in judged.vehicles] == ["left", "right", "back"]
    assert judged.safe
    assert all(v.decisions for v in (result.vehicles[0], result.vehicles[2]))
    left, back = judged.vehicles[0], judged.vehicles[2]
    pair = [next(s for s in v.separations if s.id == i) for v, i in ((left, 3), (back, 1))]
    assert pair[0].distance == pytest.approx(pair[1].distance)
    assert pair[0].distance >= 1000.0


def test_an_approach_of_two_own_vehicles_counts_once():
    _, judged = fleet(avoidance=False)
    entries = {v.name: v.figures["violations"] for v in judged.vehicles}
    assert entries == {"left": 2, "right": 0, "back": 2}
    assert judged.summary["violations"] == 3


def test_a_vehicle_is_recorded_until_it_has_finished():
    result, judged = fleet()
    ends = [float(v.track.times[-1]) for v in result.vehicles]
    assert judged.summary["flight_time_s"] == max(ends)
    assert len(set(ends)) == 3
    assert all(np.isfinite(v.track.positions).all() for v in result.vehicles)


def test_the_directory_says_it_all(tmp_path):
    write_run(tmp_path / "run", *fleet(), write_report)
    runs = read_fleet(tmp_path / "run")
    assert [run.vehicle for run in runs] == ["left", "right", "back"]
    assert [text for run in runs for text in differences(run)] == []
    names = {path.name for path in (tmp_path / "run").iterdir()}
    assert {"mission.plan", "mission-right.plan", "report.html", "report-back.html"} <= names
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert list(summary["vehicles"]) == ["left", "right", "back"]
    page = (tmp_path / "run" / "report-back.html").read_text()
    assert 'href="report.html"' in page
    assert "vehicle left" in page
