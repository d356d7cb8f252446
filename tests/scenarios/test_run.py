"""Real flights, from scan to score."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from scenarios.errors import ScenarioError
from scenarios.load import load, parse
from scenarios.run import prepare, preset
from scenarios.scenario import Point
from tests.scenarios.flights import ENCOUNTER, encounter, flown


@pytest.mark.parametrize("fidelity", ["kinematic", "6dof"])
def test_an_obstacle_on_the_leg_is_avoided(fidelity: str):
    result, score = encounter(fidelity)
    summary = score.summary
    assert score.safe
    assert summary["closest_obstacle"] == 1
    assert summary["min_margin_m"] == pytest.approx(summary["min_separation_m"] - 800.0, abs=0.002)
    assert summary["replans"] >= 1
    assert summary["path_length_m"] + 100.0 >= summary["optimum_length_m"] > 12_000.0
    assert result.ending == "finished"
    assert len(result.traffic[0].positions) == len(result.track.times)


def test_without_avoidance_the_same_world_is_hit():
    _, score = encounter("kinematic", avoidance=False)
    assert score.summary["completed"]
    assert score.summary["violations"] == 1
    assert score.summary["min_separation_m"] == pytest.approx(200.0, abs=2.0)
    assert score.summary["decision_ms"] == {"median": None, "p99": None}
    assert not score.safe


def test_an_empty_sky_has_no_separation():
    scenario = replace(parse(ENCOUNTER), obstacles=(), traffic=())
    _, score = flown(scenario)
    assert score.safe
    for key in ("min_separation_m", "min_margin_m", "closest_obstacle", "violation_radius_m"):
        assert score.summary[key] is None
    assert score.summary["plan_length_m"] == pytest.approx(12_000.0, abs=0.001)
    assert score.summary["optimum_length_m"] == pytest.approx(12_000.0)


def test_a_waypoint_inside_a_sphere_is_replaced_and_the_mission_completed():
    points = (Point(0.0, 0.0, 200.0), Point(6000.0, 0.0, 200.0), Point(12_000.0, 0.0, 200.0))
    _, score = flown(replace(parse(ENCOUNTER), mission=points))
    assert score.safe
    assert score.summary["waypoints_replaced"] == 1
    assert score.fates[1].goal.replaced
    assert score.fates[1].missed_by < 101.0


def test_the_time_limit_ends_a_flight():
    result, score = flown(replace(parse(ENCOUNTER), time_limit=100.0))
    assert result.ending == "time limit"
    assert result.track.times[-1] == 100.0
    assert not score.summary["completed"]


def test_a_flight_broken_off_keeps_what_was_flown():
    result, score = flown(parse(ENCOUNTER), frames=60)
    assert result.ending == "interrupted"
    assert score.summary["flight_time_s"] == 59.0
    assert not score.summary["completed"]


def test_wind_changes_ground_speed_and_not_the_safety():
    scenario = parse("wind = {north_m_s = 3.0, east_m_s = -4.0}\n" + ENCOUNTER)
    result, score = flown(scenario)
    assert score.safe
    assert score.summary["flight_time_s"] < encounter()[1].summary["flight_time_s"] - 100.0
    assert np.abs(result.track.airspeeds - 15.0).max() < 1.0


def test_aircraft_may_be_traffic():
    scenario = parse(ENCOUNTER.replace('"point"', '"6dof"').replace("speed_m_s = 30.0", "speed_m_s = 14.0"))
    result, _ = flown(scenario, frames=120)
    moving = result.traffic[0].positions
    begin = np.flatnonzero(np.isfinite(moving[:, 0]))[0]
    assert result.track.times[begin] == 50.0
    covered = np.hypot(*(moving[-1, :2] - moving[begin, :2]))
    assert covered == pytest.approx(14.0 * (result.track.times[-1] - 50.0), rel=0.02)


def test_a_random_world_must_be_drawn_first():
    with pytest.raises(ScenarioError, match=r"has no \[random\] table"):
        prepare(load("single"), 0, obstacles=5)
    assert len(prepare(load("random"), 0, obstacles=5).obstacles) == 5
    with pytest.raises(ScenarioError, match="known: default, paper"):
        preset("best")


def test_the_paper_s_preset_flies_as_well():
    result, score = flown(parse(ENCOUNTER), preset_name="paper")
    assert score.safe
    assert score.summary["preset"] == "paper"
    assert result.performance.acceptance_radius == 1000.0


DIGEST = """
import hashlib, json
from scenarios.load import parse
from scenarios.record import decision_row, track_text
from tests.scenarios.flights import ENCOUNTER, flown
text = "radar = {detection_probability = 0.8}\\n" + ENCOUNTER
result, _ = flown(parse(text), seed=5)
rows = [decision_row(entry) for entry in result.decisions]
for row in rows:
    row.pop("decision_ms")
print(hashlib.sha256((track_text([result.track]) + json.dumps(rows)).encode()).hexdigest())
"""


def test_the_same_seed_gives_the_same_bytes_in_two_processes(request):
    root = request.config.rootpath
    digests = {
        subprocess.run(
            [sys.executable, "-c", DIGEST], cwd=root, check=True, capture_output=True, text=True
        ).stdout
        for _ in range(2)
    }
    assert len(digests) == 1


CATALOGUE_TRAFFIC = ("head-on", "from-left", "from-right", "overtaking", "same-course", "pop-up")


@pytest.mark.parametrize("name", CATALOGUE_TRAFFIC)
def test_what_the_catalogue_puts_in_the_way_is_hit_without_avoidance(name):
    scenario = load(name)
    slow = replace(scenario.vehicle, fidelity="kinematic")
    points = tuple(replace(flight, motion="point") for flight in scenario.traffic)
    _, judged = flown(replace(scenario, vehicle=slow, traffic=points), avoidance=False)
    assert judged.summary["violations"] > 0
