"""The command line: exit codes, messages, and what goes to which stream."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fmu.errors import PlantError
from scenarios import __version__
from scenarios.cli import app
from scenarios.hangar import Hangar
from scenarios.recorded import differences, read_run
from scenarios.scenario import Wind
from tests.scenarios.flights import ENCOUNTER

ROOT = Path(__file__).parents[2]
COMMAND = [sys.executable, "-m", "scenarios.cli"]


def run(*arguments: object):
    return CliRunner().invoke(app, [str(a) for a in arguments])


@pytest.fixture
def scenario(tmp_path) -> Path:
    file = tmp_path / "encounter.toml"
    file.write_text(ENCOUNTER)
    return file


def test_version_and_list():
    assert run("--version").stdout == f"sidestep {__version__}\n"
    listed = run("list")
    assert listed.exit_code == 0
    assert "table4" in listed.stdout.splitlines()[1]


def test_json_is_all_that_goes_to_stdout_and_stderr_stays_empty(scenario, tmp_path):
    done = subprocess.run(
        [*COMMAND, "fly", str(scenario), "--json", "-o", str(tmp_path / "out")],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout) == json.loads((tmp_path / "out" / "summary.json").read_text())
    assert (tmp_path / "out" / "report.html").is_file()


def test_fly_tells_a_stranger_and_replay_agrees(scenario, tmp_path):
    done = run("fly", scenario, "-o", tmp_path / "out")
    assert done.exit_code == 0
    assert "Flown safely" in done.stdout
    assert "closest approach" in done.stdout
    again = run("replay", tmp_path / "out")
    assert again.exit_code == 0
    assert "detour: " in again.stdout
    assert run("report", tmp_path / "out").exit_code == 0
    summary = tmp_path / "out" / "summary.json"
    summary.write_text(summary.read_text().replace('"violations": 0', '"violations": 1'))
    wrong = run("replay", tmp_path / "out")
    assert wrong.exit_code == 1
    assert "violations: summary.json says 1, the files give 0" in wrong.stdout


def test_a_collision_is_exit_code_1(scenario, tmp_path):
    done = run("fly", scenario, "--no-avoidance", "-o", tmp_path / "out")
    assert done.exit_code == 1
    assert "A safety sphere was entered once." in done.stdout


def test_options_reach_the_flight(scenario, tmp_path):
    options = ("--seed", 4, "--wind", "-3,4", "--turbulence", "light", "--fidelity", "kinematic")
    done = run("fly", scenario, *options, "--preset", "paper", "--json", "-o", tmp_path / "out")
    assert done.exit_code == 0
    summary = json.loads(done.stdout)
    assert (summary["seed"], summary["preset"]) == (4, "paper")
    flown = read_run(tmp_path / "out").scenario
    assert flown.wind == Wind(-3.0, 4.0, "light")


def test_a_mission_within_the_acceptance_radius_is_over_at_once(tmp_path):
    short = tmp_path / "short.toml"
    short.write_text("mission = [{north_m = 0, east_m = 0}, {north_m = 90, east_m = 0}]\n")
    done = run("fly", short, "--json", "-o", tmp_path / "out")
    assert done.exit_code == 0
    summary = json.loads(done.stdout)
    assert (summary["completed"], summary["flight_time_s"], summary["path_length_m"]) == (True, 0.0, 0.0)
    assert run("replay", tmp_path / "out").exit_code == 0
    shown = run("fly", short, "-o", tmp_path / "out")
    assert (shown.exit_code, "Flown safely" in shown.stdout) == (0, True)


def test_the_default_directory_is_numbered(scenario, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for number in (1, 2):
        assert run("fly", scenario).exit_code == 0
        assert (tmp_path / "sidestep-runs" / f"encounter-0-{number}" / "summary.json").is_file()


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["tabel4"], "did you mean 'table4'?"),
        (["missing.toml"], "missing.toml: no such file"),
        (["--wind", "3"], "must be two numbers with a comma"),
        (["--wind", "nan,0"], "must be two finite numbers"),
        (["--wind", "20,20"], "at most 12 m/s"),
        (["--preset", "best"], "known: default, paper"),
        (["--fidelity", "good"], "known: 6dof, kinematic"),
        (["--turbulence", "strong"], "known: none, light, moderate, severe"),
        (["single", "--obstacles", "4"], "has no [random] table"),
        (["--seed", "-1"], "--seed"),
        (["--obstacles", "-1"], "--obstacles"),
    ],
)
def test_bad_input_is_exit_code_2_with_one_message(arguments, expected, tmp_path):
    done = run("fly", *arguments, "-o", tmp_path / "out")
    assert done.exit_code == 2
    assert expected in done.stderr
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_directory_with_other_things_is_refused_before_the_flight(scenario, tmp_path):
    done = run("fly", scenario, "-o", tmp_path)
    assert done.exit_code == 2
    assert "holds no previous run" in done.stderr


@pytest.mark.parametrize("command", ["report", "replay"])
def test_what_is_no_run_is_refused(command, tmp_path):
    for directory in (tmp_path, tmp_path / "nowhere"):
        done = run(command, directory)
        assert done.exit_code == 2
        assert str(directory) in done.stderr


def test_a_failing_plant_is_exit_code_3(scenario, tmp_path, monkeypatch):
    def fail(self, *arguments):
        raise PlantError("load", 0.0, "the FMU is missing")

    monkeypatch.setattr(Hangar, "__init__", fail)
    done = run("fly", scenario, "-o", tmp_path / "out")
    assert done.exit_code == 3
    assert "the FMU is missing" in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.skipif(os.name == "nt", reason="Windows sends no SIGINT to a single process")
def test_ctrl_c_writes_what_was_flown(tmp_path):
    long = tmp_path / "long.toml"
    far = ENCOUNTER.replace("north_m = 12000.0\neast_m = 0.0", "north_m = 900000.0\neast_m = 0.0")
    long.write_text(far.replace("kinematic", "6dof"))
    ready = "import sys, scenarios.show as s; s.Progress.update = lambda *a: print('flying', flush=True)"
    program = f"{ready}; sys.argv = ['sidestep', 'fly', {str(long)!r}, '-o', {str(tmp_path / 'out')!r}]; "
    process = subprocess.Popen(
        [sys.executable, "-c", program + "from scenarios.cli import main; main()"],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    for _ in range(30):
        assert process.stdout.readline() == "flying\n"
    process.send_signal(signal.SIGINT)
    output, _ = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Interrupted" in output
    recorded = read_run(tmp_path / "out")
    assert recorded.summary["completed"] is False
    assert differences(recorded) == []


def test_help_needs_no_heavy_package():
    program = (
        "import sys, scenarios.cli; print([m for m in sys.modules if m in {'numpy', 'pydantic', 'plotly'}])"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, check=True, capture_output=True, text=True
    )
    assert done.stdout == "[]\n"
