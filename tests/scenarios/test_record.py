"""The files of a run: their columns and keys, whole or not at all, and the way back."""

from __future__ import annotations

import csv
import json
import math
import shutil

import numpy as np
import pytest

from offboard.plan_files import read_plan
from scenarios.errors import RunDirectoryError
from scenarios.load import load
from scenarios.record import write_run
from scenarios.recorded import differences, read_run
from scenarios.replay import timeline
from tests.scenarios.flights import encounter

SUMMARY_KEYS = [
    *("completed", "violations", "min_separation_m", "min_margin_m", "closest_obstacle"),
    *("violation_radius_m", "path_length_m", "plan_length_m", "optimum_length_m", "flight_time_s"),
    *(
        "waypoints_replaced",
        "replans",
        "state_of_charge",
        "reserve_used",
        "decision_ms",
        "wall_s",
        "real_time_factor",
    ),
    *("seed", "preset", "version"),
]


@pytest.fixture(scope="module")
def run_directory(tmp_path_factory):
    directory = tmp_path_factory.mktemp("runs") / "one"
    write_run(directory, *encounter())
    return directory


def rows(file):
    with file.open(newline="") as stream:
        return list(csv.DictReader(stream))


def test_files_have_the_promised_columns(run_directory):
    headers = {
        "track.csv": "vehicle,t_s,north_m,east_m,altitude_m,airspeed_m_s,heading_deg,bank_deg",
        "obstacles.csv": "id,kind,north_m,east_m,altitude_m,radius_m,appears_at_s",
        "traffic.csv": "t_s,id,north_m,east_m,altitude_m",
    }
    for name, header in headers.items():
        assert (run_directory / name).read_text().splitlines()[0] == header


def test_summary_has_every_key_in_order_and_no_nan(run_directory):
    text = (run_directory / "summary.json").read_text()
    assert list(json.loads(text)) == SUMMARY_KEYS
    assert "NaN" not in text


def test_a_stranger_can_recompute_the_separation(run_directory):
    """From the CSV files alone, by plain dense sampling of the recorded track."""
    track = np.array(
        [
            [float(r[k]) for k in ("north_m", "east_m", "altitude_m")]
            for r in rows(run_directory / "track.csv")
        ]
    )
    (obstacle,) = [r for r in rows(run_directory / "obstacles.csv") if r["id"] == "1"]
    centre = np.array([float(obstacle[k]) for k in ("north_m", "east_m", "altitude_m")])
    summary = json.loads((run_directory / "summary.json").read_text())
    assert summary["closest_obstacle"] == 1
    assert np.linalg.norm(track - centre, axis=1).min() == pytest.approx(
        summary["min_separation_m"], abs=0.01
    )


def test_track_has_10_hz_near_the_obstacle(run_directory):
    track = rows(run_directory / "track.csv")
    near = [
        float(r["t_s"])
        for r in track
        if math.hypot(float(r["north_m"]) - 6000, float(r["east_m"]) - 200) < 3000
    ]
    assert np.diff(near).max() == pytest.approx(0.1, abs=0.001)


def test_traffic_is_written_while_it_exists(run_directory):
    traffic = rows(run_directory / "traffic.csv")
    assert {r["id"] for r in traffic} == {"9"}
    assert float(traffic[0]["t_s"]) == 50.0
    assert len(traffic) < len(rows(run_directory / "track.csv"))


def test_decisions_hold_what_is_documented(run_directory):
    lines = (run_directory / "decisions.jsonl").read_text().splitlines()
    first = json.loads(lines[0])
    assert first["decision"] == "detour"
    assert first["threat"]["ids"] == [1]
    assert first["waypoint"] == first["waypoints"][0]
    assert first["search_gap"] is None or first["search_gap"] >= 0.0
    assert first["length_to_optimum"] >= 1.0 - 1e-9
    assert first["decision_ms"] > 0.0
    assert [w["item"] for w in first["route"]][-1] == 1


def test_documentation_names_every_key_and_column(run_directory, request):
    text = (request.config.rootpath / "docs" / "run-directory.md").read_text()
    decision = json.loads((run_directory / "decisions.jsonl").read_text().splitlines()[0])
    names = [
        *SUMMARY_KEYS,
        *decision,
        *decision["threat"],
        *json.loads((run_directory / "run.json").read_text()),
    ]
    for name in ("track.csv", "obstacles.csv", "traffic.csv", "waypoints.csv"):
        names += [name, *(run_directory / name).read_text().splitlines()[0].split(",")]
    assert [name for name in names if f"`{name}`" not in text] == []


def test_plan_is_the_mission_as_finally_flown(run_directory):
    plan = read_plan(run_directory / "mission.plan")
    assert len(plan.plan.mission_items) == 2 + 1
    assert (plan.home_latitude_deg, plan.home_altitude_m) == (14.39, 600.0)


def test_scenario_file_loads_again(run_directory):
    assert load(run_directory / "scenario.toml") == encounter()[0].scenario


def test_figures_follow_from_the_files(run_directory):
    assert differences(read_run(run_directory)) == []


def test_tampering_shows(run_directory, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(run_directory, copy)
    lines = (copy / "track.csv").read_text().splitlines()
    middle = len(lines) // 2
    lines[middle] = lines[middle].replace(",200.", ",900.")
    (copy / "track.csv").write_text("\n".join(lines) + "\n")
    (copy / "summary.json").write_text(
        (copy / "summary.json").read_text().replace('"violations": 0', '"violations": 3')
    )
    assert [line.split(":")[0] for line in differences(read_run(copy))] == ["violations"]
    (copy / "obstacles.csv").write_text((copy / "obstacles.csv").read_text().replace("6000.000", "6100.000"))
    assert any(line.startswith("min_separation_m") for line in differences(read_run(copy)))


@pytest.mark.parametrize(
    "name", ["track.csv", "summary.json", "scenario.toml", "decisions.jsonl", "mission.plan"]
)
def test_damaged_or_missing_files_are_named(run_directory, tmp_path, name):
    copy = tmp_path / "copy"
    shutil.copytree(run_directory, copy)
    (copy / name).write_text("{ nonsense\n[")
    with pytest.raises(RunDirectoryError, match="copy"):
        read_run(copy)
    (copy / name).unlink()
    with pytest.raises(RunDirectoryError, match=name.replace(".", r"\.")):
        read_run(copy)
    with pytest.raises(RunDirectoryError, match="no such directory"):
        read_run(tmp_path / "nowhere")


def test_replay_tells_the_flight_in_order(run_directory):
    events = timeline(read_run(run_directory))
    texts = [event.text for event in events]
    assert [event.time for event in events] == sorted(event.time for event in events)
    assert texts[0].endswith("the flight begins")
    assert texts[-1] == "the mission is completed"
    assert any(text.startswith("detour: ") for text in texts)
    assert any(text.startswith("closest to obstacle 1") for text in texts)


def test_a_failure_leaves_nothing_behind(tmp_path):
    def fail(directory):
        assert (directory / "track.csv").is_file()
        raise RunDirectoryError(directory, "the report failed")

    with pytest.raises(RunDirectoryError, match="the report failed"):
        write_run(tmp_path / "deep" / "run", *encounter(), fail)
    assert list((tmp_path / "deep").iterdir()) == []
