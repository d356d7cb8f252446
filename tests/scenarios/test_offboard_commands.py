"""`sidestep offboard`: bad input, and what is never done to a vehicle without being asked."""

from __future__ import annotations

import contextlib
import socket

import pytest
from typer.testing import CliRunner

from avoidance.parameters import DEFAULT
from offboard.errors import LinkError
from offboard.frames import MapFrame
from offboard.live.lockstep import connect_in_step
from offboard.live.messages import Message
from offboard.live.starting import open_vehicle, with_take_off
from offboard.raw_mission import RawItem, RawMission
from offboard.sitl.autopilot import FLAVOURS
from scenarios.cli import app
from scenarios.errors import ScenarioError
from scenarios.live_mission import mission_of, source_of
from scenarios.offboard_commands import fly
from scenarios.plan_convert import convert
from scenarios.sitl_world import SitlWorld
from tests.offboard.live.kit import SMALL, STEP, Simulation


@contextlib.contextmanager
def waiting(*, simulated=False):
    """A vehicle that waits with a mission of its own, and has not said that it is a simulation."""
    with SitlWorld(SMALL, DEFAULT, FLAVOURS["px4"], SMALL.fleet) as world:
        simulation = Simulation(world)
        with contextlib.closing(connect_in_step(simulation, STEP)) as session:
            vehicle = open_vehicle(session)
            vehicle.aboard.simulated = simulated
            yield simulation, vehicle


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--mission", "no-such"], "no-such: unknown scenario"),
        (["--mission", "none.plan"], "none.plan: cannot be read"),
        (["--obstacles", "udp:70000"], "--obstacles: 'udp:70000'"),
        (["--preset", "bold"], "'bold' is unknown"),
        (["--connect", "fax://1"], "fax://1 cannot be opened"),
    ],
)
def test_bad_input_is_one_message(arguments, words, tmp_path):
    result = CliRunner().invoke(
        app, ["offboard", *arguments, "--timeout", "0.1", "-o", str(tmp_path / "run")]
    )
    assert result.exit_code == 2
    assert words in result.output
    assert "Traceback" not in result.output


@pytest.mark.parametrize(
    ("content", "url", "words"),
    [
        (None, "udpin://127.0.0.1:14540", "key.txt: the signing key cannot be read"),
        ("\n", "udpin://127.0.0.1:14540", "key.txt: the signing key is empty; put 64 hexadecimal digits"),
        ("secret", "tcpin://127.0.0.1:5760", "tcpin://127.0.0.1:5760 cannot be opened with a signing key"),
    ],
    ids=["no file", "empty", "url"],
)
def test_a_signing_key_or_a_url_that_cannot_be_used_is_one_line(content, url, words, tmp_path):
    file = tmp_path / "key.txt"
    if content is not None:
        file.write_text(content)
    arguments = [
        "--connect",
        url,
        "--signing-key",
        str(file),
        "--timeout",
        "0.1",
        "-o",
        str(tmp_path / "run"),
    ]
    result = CliRunner().invoke(app, ["offboard", *arguments])
    assert result.exit_code == 2
    said = [line for line in result.stderr.splitlines() if not line.startswith("Waiting for a vehicle")]
    assert len(said) == 1
    assert said[0].startswith("sidestep: ")
    assert words in said[0]
    assert result.stdout == ""
    assert not (tmp_path / "run").exists()


@pytest.fixture
def plan(tmp_path):
    """A scenario with wind and obstacles as a plan file, which has neither."""
    lines = (
        'preset = "paper"',
        "home = {latitude_deg = 14.39, longitude_deg = 76.6, altitude_m = 600.0}",
        "mission = [{north_m = 0, east_m = 0, altitude_m = 90}, {north_m = 9e3, east_m = 0, altitude_m = 9}]",
        "wind = {north_m_s = 3.0, east_m_s = -4.0}",
        "obstacles = [{north_m = 5000, east_m = 0, altitude_m = 150}]",
    )
    (tmp_path / "windy.toml").write_text("\n".join(lines))
    convert(str(tmp_path / "windy.toml"), tmp_path / "windy.plan")
    return tmp_path


def test_obstacles_come_from_the_vehicle_unless_the_mission_is_a_scenario_that_has_some(plan):
    assert source_of(None, mission_of(None)).kind == "mavlink"
    assert source_of(None, mission_of("clear")).kind == "mavlink"
    assert source_of(None, mission_of(str(plan / "windy.plan"))).kind == "mavlink"
    assert source_of(None, mission_of("head-on")).kind == "scenario"  # traffic alone
    own = source_of(None, mission_of("single"))
    assert (own.kind, own.scenario.name) == ("scenario", "single")
    given = source_of("mavlink", mission_of("single"))
    assert (given.kind, given.scenario.obstacles) == ("mavlink", ())


def test_wind_and_preset_are_the_scenario_s_and_else_3_m_s_and_default(plan):
    found = {name: mission_of(name and str(plan / name)) for name in (None, "windy.plan", "windy.toml")}
    assert {name: one.wind_bound for name, one in found.items()} == {
        None: 3.0, "windy.plan": 3.0, "windy.toml": 5.0
    }  # fmt: skip
    assert {name: one.preset for name, one in found.items()} == {
        None: "default", "windy.plan": "default", "windy.toml": "paper"
    }  # fmt: skip


def test_a_vehicle_that_may_be_real_is_left_alone_until_somebody_says_yes(tmp_path):
    wanted = mission_of("single")
    with waiting() as (simulation, vehicle):
        before = simulation.mission()
        with pytest.raises(ScenarioError, match="nothing was sent"):
            fly(vehicle, wanted, source_of(None, wanted), DEFAULT, tmp_path)
        assert simulation.mission() == before
        assert not simulation.autopilot.captain.armed


def test_a_vehicle_on_the_other_side_of_the_earth_is_not_the_mission_s():
    opposite = MapFrame(-14.39, 76.60 - 180.0, 600.0)
    with waiting() as (_, vehicle), pytest.raises(LinkError, match="is it the right one"):
        open_vehicle(vehicle.aboard.session, opposite)


def test_no_vehicle_is_armed_whose_obstacles_cannot_be_known(tmp_path):
    wanted = mission_of("single")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("0.0.0.0", 0))
        port = taken.getsockname()[1]
        with waiting(simulated=True) as (simulation, vehicle):
            with pytest.raises(LinkError, match=f"UDP port {port}"):
                fly(vehicle, wanted, source_of(f"udp:{port}", wanted), DEFAULT, tmp_path, arm=True)
            assert not simulation.autopilot.captain.armed


def test_a_take_off_ends_at_the_altitude_of_the_first_waypoint_in_its_own_frame():
    above_sea = RawItem(16, 5, (0.0, 0.0, 0.0, 0.0), 143900000, 766000000, 800.0)
    with waiting() as (_, vehicle):
        vehicle.aboard.telemetry.fixes.clear()
        place = {"time_boot_ms": 1000, "lat": 143900000, "lon": 766000000}
        on_ground = {**place, "relative_alt": 0, "alt": 600_000, "vx": 0, "vy": 0, "vz": 0, "hdg": 0}
        vehicle.aboard.telemetry.feed(Message("GLOBAL_POSITION_INT", on_ground))
        first = with_take_off(RawMission.of((above_sea, above_sea)), vehicle).items[0]
    assert (first.command, first.frame, first.z) == (22, 5, 800.0)
