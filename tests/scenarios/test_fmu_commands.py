"""`sidestep fmu`: what a simulation engineer does first with the FMUs."""

from __future__ import annotations

import csv
import subprocess
import sys

import pytest
from typer.testing import CliRunner

from fmu.check import packaged
from scenarios.cli import app


def run(*arguments):
    return CliRunner().invoke(app, ["fmu", *map(str, arguments)])


def table(path):
    with path.open(newline="") as stream:
        return list(csv.DictReader(stream))


def test_info_says_where_the_fmus_lie_and_what_is_in_them():
    done = run("info")
    assert done.exit_code == 0
    for path in packaged():
        assert str(path) in done.stdout
    for word in ("Co-Simulation", "platforms", "parameter", "skywalker_x8, techpod"):
        assert word in done.stdout


@pytest.mark.parametrize("file", packaged(), ids=lambda path: path.stem)
def test_an_fmu_flies_alone_from_a_table_of_inputs(file, tmp_path):
    inputs, output = tmp_path / "in.csv", tmp_path / "out.csv"
    inputs.write_text("time, command.altitude, command.mode\n0, 200, 1\n5, 200, 1\n6, 230, 1\n")
    done = run("simulate", file, "-i", inputs, "-o", output, "--stop", 30, "--step", 0.5)
    assert done.exit_code == 0, done.output
    assert done.stdout == f"61 rows written to {output}\n"
    rows = table(output)
    assert [float(row["time"]) for row in rows] == [0.5 * i for i in range(61)]
    assert float(rows[10]["state.altitude"]) == pytest.approx(200, abs=1e-2)
    assert float(rows[-1]["state.altitude"]) == pytest.approx(230, abs=0.5)


@pytest.mark.parametrize("file", packaged(), ids=lambda path: path.stem)
def test_fmpys_own_command_flies_it_from_the_same_table(file, tmp_path):
    inputs, ours, theirs = (tmp_path / name for name in ("in.csv", "ours.csv", "theirs.csv"))
    inputs.write_text("time,command.altitude\n0,200\n2,200\n2,240\n")
    assert run("simulate", file, "-i", inputs, "-o", ours, "--stop", 8, "--step", 0.5).exit_code == 0
    options = ("--stop-time", "8", "--output-interval", "0.5", "--output-variables", "state.altitude")
    files = ("--input-file", str(inputs), "--output-file", str(theirs))
    call = [sys.executable, "-m", "fmpy", "simulate", str(file), *files, *options]
    subprocess.run(call, check=True, capture_output=True)
    columns = [[float(row["state.altitude"]) for row in table(path)] for path in (ours, theirs)]
    assert columns[0] == columns[1]
    assert columns[0][-1] > 205


def test_an_aircraft_start_values_and_columns_can_be_chosen(tmp_path):
    output = tmp_path / "out.csv"
    options = ("--aircraft", "techpod", "--set", "initial.altitude=321", "--column", "state.altitude")
    done = run("simulate", "-o", output, "--stop", 1, *options, "--column", "aircraft.mass")
    assert done.exit_code == 0, done.output
    rows = table(output)
    assert rows[0] == {"time": "0.0", "state.altitude": "321.0", "aircraft.mass": "2.65"}


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        ("time,command.altitud\n0,1\n", (), ("in.csv", "command.altitud")),
        ("time,state.north\n0,1\n", (), ("in.csv", "state.north", "no input")),
        ("t,command.altitude\n0,1\n", (), ("in.csv", "time")),
        ("time,command.altitude\n0,high\n", (), ("line 2", "high")),
        ("time,command.altitude\n0,nan\n", (), ("line 2", "finite")),
        ("time,command.altitude\n1,200\n0,200\n", (), ("time", "back")),
        ("", (), ("in.csv",)),
        (None, (), ("in.csv",)),
        ("time,command.altitude\n0,200\n", ("--set", "mass"), ("--set mass", "NAME=VALUE")),
        ("time,command.altitude\n0,200\n", ("--set", "mass=3"), ("'mass'",)),
        ("time,command.altitude\n0,200\n", ("--set", "aircraft.mass=x"), ("'x'",)),
        ("time,command.altitude\n0,200\n", ("--aircraft", "concorde"), ("concorde",)),
        ("time,command.altitude\n0,200\n", ("--column", "mass"), ("--column mass",)),
    ],
)
def test_bad_input_is_named(text, options, words, tmp_path):
    inputs, output = tmp_path / "in.csv", tmp_path / "out.csv"
    if text is not None:
        inputs.write_text(text)
    done = run("simulate", "-i", inputs, "-o", output, *options)
    assert done.exit_code == 2
    for word in words:
        assert word in done.stderr
    assert not output.exists()


def test_what_the_model_refuses_is_told_in_its_words(tmp_path):
    output = tmp_path / "out.csv"
    done = run("simulate", "-o", output, "--set", "aircraft.mass=-1")
    assert done.exit_code == 3
    assert "aircraft.mass" in done.stderr
    assert not output.exists()


def test_a_missing_fmu_and_a_wrong_one_have_their_own_exit_codes(tmp_path):
    absent, text = tmp_path / "absent.fmu", tmp_path / "text.fmu"
    text.write_text("not a zip")
    for command in ("info", "check", "simulate"):
        done = run(command, absent)
        assert (done.exit_code, "absent.fmu" in done.stderr) == (2, True), command
        done = run(command, text)
        assert (done.exit_code, "text.fmu" in done.stderr) == (3, True), command
    assert run("check", "--nesc", tmp_path / "nowhere").exit_code == 2


def test_the_check_is_one_table_with_an_exit_code(tmp_path):
    done = run("check", packaged()[0], "--nesc", tmp_path)
    lines = done.stdout.splitlines()
    assert lines[0] == str(packaged()[0])
    assert lines[1].split()[:3] == ["FMU", "check", "result"]
    # an empty folder has none of NASA's trajectories: those cases must not pass for want of data
    assert done.exit_code == 1
    failed = [line for line in lines[2:-1] if "FAILED" in line]
    assert ["NASA case" in line for line in failed] == [True] * 4
    assert "4 FAILED" in lines[-1]
