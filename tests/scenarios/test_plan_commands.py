"""`sidestep plan convert`, both ways."""

from __future__ import annotations

import json
import math

import pytest
from typer.testing import CliRunner

from scenarios.cli import app
from scenarios.load import load

runner = CliRunner()


def convert(*arguments: object):
    return runner.invoke(app, ["plan", "convert", *map(str, arguments)])


def test_a_scenario_survives_plan_and_wpl(tmp_path):
    first, second, third = tmp_path / "a.plan", tmp_path / "b.waypoints", tmp_path / "c.toml"
    for pair in ((first, "fence"), (second, first), (third, second)):
        result = convert(pair[1], pair[0])
        assert result.exit_code == 0, result.output
    before, after = load("fence"), load(str(third))
    for a, b in zip(before.mission, after.mission, strict=True):
        assert math.hypot(a.north - b.north, a.east - b.east) < 0.01
        assert b.altitude == a.altitude
    assert after.home == before.home


def test_a_geofence_goes_into_a_plan_and_comes_back(tmp_path):
    convert("fence", tmp_path / "a.plan")
    assert json.loads((tmp_path / "a.plan").read_text())["geoFence"]["polygons"]
    convert(tmp_path / "a.plan", tmp_path / "b.toml")
    before, after = load("fence").geofence, load(str(tmp_path / "b.toml")).geofence
    assert [area.include for area in after] == [area.include for area in before]


def test_what_is_not_written_is_named(tmp_path):
    result = convert("single", tmp_path / "a.waypoints")
    assert "obstacles and traffic" in result.stderr


@pytest.mark.parametrize(
    ("source", "target", "problem"),
    [
        ("single", "a.kml", "must end in"),
        ("no-such.plan", "a.waypoints", "cannot be read"),
        ("no-such-scenario", "a.plan", "no-such-scenario"),
    ],
)
def test_bad_input_is_one_message_and_exit_code_2(tmp_path, source, target, problem):
    result = convert(source, tmp_path / target)
    assert result.exit_code == 2
    assert problem in result.stderr
