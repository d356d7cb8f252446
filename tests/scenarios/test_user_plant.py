"""A user's own FMU flies scenarios; what is wrong with it is one message."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from fmu.errors import PlantError
from scenarios.cli import app
from scenarios.errors import ScenarioError
from scenarios.hangar import Hangar
from scenarios.load import load, parse
from scenarios.run import preset
from scenarios.toml_text import to_toml
from tests.fmu.users import make_users_fmu

SCENARIO = """
obstacles = [{north_m = 3000.0, east_m = 100.0, safety_radius_m = 500.0}]
vehicle = {plant = "mapping.toml", airspeed_m_s = 25.0}
wind = {north_m_s = 2.0, east_m_s = 1.0}
mission = [{north_m = 500.0, east_m = 0.0}, {north_m = 6000.0, east_m = 0.0}]
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("users")
    make_users_fmu(folder)
    (folder / "scenario.toml").write_text(SCENARIO)
    return folder


def fly(*arguments):
    return CliRunner().invoke(app, ["fly", *map(str, arguments)])


def test_a_users_fmu_avoids_an_obstacle(folder, tmp_path):
    done = fly(folder / "scenario.toml", "--json", "-o", tmp_path / "run")
    assert done.exit_code == 0, done.output
    summary = json.loads(done.stdout)
    assert (summary["violations"], summary["completed"]) == (0, True)
    assert (
        540.0 < summary["min_separation_m"] < 600.0
    )  # the margin of its wide turns, and what they overshoot
    assert summary["flight_time_s"] == pytest.approx(5500.0 / 27.0, rel=0.05)
    assert summary["state_of_charge"] is None
    assert load(tmp_path / "run" / "scenario.toml").vehicle.plant == folder / "mapping.toml"
    assert "mapping.toml" in (tmp_path / "run" / "report.html").read_text(encoding="utf-8")


def test_the_command_line_names_a_plant(folder, tmp_path):
    plain = tmp_path / "plain.toml"
    plain.write_text(SCENARIO.replace('plant = "mapping.toml", airspeed_m_s = 25.0', ""))
    done = fly(plain, "--plant", folder / "mapping.toml", "--no-avoidance", "--json", "-o", tmp_path / "run")
    assert done.exit_code == 1, done.output
    assert json.loads(done.stdout)["violations"] == 1


def test_a_scenario_with_a_plant_survives_writing(folder):
    scenario = load(folder / "scenario.toml")
    assert parse(to_toml(scenario)) == scenario


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("25.0", "50.0", "flown at 50 m/s; [limits] of the plant allow 8 to 40"),
        ("{north_m_s = 2.0,", '{turbulence = "light", north_m_s = 2.0,', "turbulence cannot be given"),
        ("mapping.toml", "none.toml", "none.toml"),
    ],
)
def test_a_scenario_that_the_plant_cannot_fly_is_refused(folder, old, new, words):
    file = folder / "bad.toml"
    file.write_text(SCENARIO.replace(old, new))
    with pytest.raises(ScenarioError, match=r"vehicle\.plant") as caught:
        load(file)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            "max_bank_deg = 20",
            "max_bank_deg = 90",
            "max_bank_deg = 90 must be at least 1 and at most 80",
        ),
        ("max_bank_deg = 20\n", "", "limits.max_bank_deg is missing"),
        ("min_airspeed_m_s = 8", "min_airspeed_m_s = 41", "above max_airspeed_m_s"),
        ("roll_time_s = 1", "roll_time = 1", "limits.roll_time is unknown"),
        ('north = "x_0"', 'north = "x"', "initial.north.variable = 'x' cannot be set before the start"),
        ('"wind.north" = "wind_x"\n', "", "command.wind.north and command.wind.east are not mapped"),
        ('fmu = "UserAircraft.fmu"', 'fmu = "Other.fmu"', "no FMU at"),
    ],
)
def test_mistakes_of_the_mapping_are_exit_code_2(folder, tmp_path, old, new, words):
    mapping = folder / "changed.toml"
    mapping.write_text((folder / "mapping.toml").read_text().replace(old, new, 1))
    done = fly(folder / "scenario.toml", "--plant", mapping, "-o", tmp_path / "run")
    assert done.exit_code == 2
    assert words in done.stderr
    assert not (tmp_path / "run").exists()


def test_a_mapping_without_limits_or_a_start_elsewhere_is_refused(folder, tmp_path):
    whole = (folder / "mapping.toml").read_text()
    mapping = folder / "changed.toml"
    mapping.write_text(whole[: whole.index("[limits]")])
    assert "has no [limits]" in fly("single", "--plant", mapping, "-o", tmp_path / "run").stderr
    mapping.write_text(whole[: whole.index("[initial]")] + whole[whole.index("[limits]") :])
    done = fly(folder / "scenario.toml", "--plant", mapping, "-o", tmp_path / "run")
    assert (done.exit_code, "the FMU begins at (0, 0) m, 83 m up" in done.stderr) == (2, True)


def test_a_plant_that_tells_no_number_ends_the_flight(folder):
    scenario = load(folder / "scenario.toml")
    with Hangar(scenario, preset("default")) as hangar:
        vehicle = hangar.own_vehicle()
        vehicle.plant._unit.write({"wind_x": float("nan")})
        with pytest.raises(PlantError, match="not finite"):
            vehicle.advance(1.0)
        assert hangar.energy() is None
        with pytest.raises(ScenarioError, match="cannot stand behind an autopilot"):
            hangar.own_plant()
