"""`sidestep sitl`: worlds with autopilots in them, and the command around them."""

from __future__ import annotations

import contextlib
import io
import math
import re
import socket
import threading
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from avoidance.parameters import PRESETS
from offboard.sitl.aircraft import Phase
from offboard.sitl.autopilot import FLAVOURS
from offboard.sitl.dialect import Codec, mavlink
from offboard.sitl.transports import Exchange, TcpServer, Udp
from scenarios.cli import app
from scenarios.errors import ScenarioError
from scenarios.load import load
from scenarios.scenario import Obstacle, Point, Traffic
from scenarios.sitl_run import connect, serve
from scenarios.sitl_show import status_of
from scenarios.sitl_world import SitlWorld, fleet_of
from tests.offboard.sitl.station import Station, autopilot

DOCUMENT = (Path(__file__).parents[2] / "docs" / "sitl.md").read_text(encoding="utf-8")


def small(name="single", **changes):
    scenario = load(name)
    vehicle = replace(scenario.vehicle, fidelity="kinematic")
    return replace(scenario, vehicle=vehicle, **changes)


def world_of(scenario, kind="px4", count=1, **others):
    on_ground = others.get("on_ground", False)
    members = fleet_of(scenario, count, on_ground=on_ground)
    return SitlWorld(scenario, PRESETS["default"], FLAVOURS[kind], members, **others)


def pilots(world):
    return list(world.autopilots.values())


def start(station, kind="px4"):
    assert station.start(kind) == (0, 0)


def fly(world, stations, seconds):
    for _ in range(round(seconds / 0.1)):
        world.advance(0.1)
        for station in stations:
            station.read()


def told(station, name):
    return [m for m in station.seen if m.get_type() == name]


@pytest.mark.parametrize("kind", ["px4", "ardupilot"])
def test_the_scenario_s_mission_is_in_the_memory_and_can_be_flown(kind):
    with world_of(small(), kind) as world:
        (pilot,) = pilots(world)
        ground = Station(pilot)
        fly(world, [ground], 1.0)
        assert not world.flying
        start(ground, kind)
        fly(world, [ground], 60.0)
        assert pilot.aircraft.state.north == pytest.approx(15.0 * 60.0, abs=20.0)
        assert world.world.now == pytest.approx(60.0, abs=0.2)


def test_what_stands_still_is_seen_within_the_range():
    near = Obstacle(id=3, north=6000.0, east=800.0, altitude=200.0, safety_radius=1000.0)
    far = replace(near, id=4, north=60_000.0)
    with world_of(small(obstacles=(near, far))) as world:
        (pilot,) = pilots(world)
        ground = Station(pilot)
        start(ground)
        fly(world, [ground], 10.0)
        returns = told(ground, "OBSTACLE_DISTANCE_3D")
    assert {m.obstacle_id for m in returns} == {3}
    assert len(returns) in (9, 10, 11)  # once a second
    assert returns[-1].x == pytest.approx(6000.0 - 15.0 * 10.0, abs=30.0)
    assert returns[-1].y == pytest.approx(800.0, abs=5.0)


def test_pop_ups_and_traffic_wait_for_the_launch():
    late = Obstacle(id=3, north=6000.0, east=800.0, altitude=200.0, safety_radius=1000.0, appears_at=5.0)
    points = (Point(5000.0, 0.0, 200.0), Point(-20_000.0, 0.0, 200.0))
    intruder = Traffic(id=9, waypoints=points, speed=25.0, motion="point")
    with world_of(small(obstacles=(late,), traffic=(intruder,))) as world:
        (pilot,) = pilots(world)
        ground = Station(pilot)
        fly(world, [ground], 20.0)
        assert told(ground, "OBSTACLE_DISTANCE_3D") == []
        start(ground)
        fly(world, [ground], 8.0)
        assert len(told(ground, "OBSTACLE_DISTANCE_3D")) in (2, 3, 4)
        report = ground.last("ADSB_VEHICLE")
    assert report.ICAO_address == 9
    assert (report.heading, report.hor_velocity) == (18_000, pytest.approx(2500, abs=2))
    assert {m.obstacle_id for m in told(ground, "OBSTACLE_DISTANCE_3D")} == {3}


def test_two_vehicles_see_one_another():
    with world_of(small(), count=2) as world:
        stations = [Station(pilot) for pilot in pilots(world)]
        stations[1].codec = Codec(246, 190)
        start(stations[0])
        fly(world, stations, 20.0)
        first, second = (told(station, "ADSB_VEHICLE")[-1] for station in stations)
        systems = {pilot.settings.system_id for pilot in pilots(world)}
    assert systems == {1, 2}
    assert (first.ICAO_address, second.ICAO_address) == (902, 901)
    assert (first.hor_velocity, second.hor_velocity) == (0, pytest.approx(1500, abs=5))


def test_a_fleet_is_the_scenario_s_or_side_by_side():
    circle = load("circle")
    assert fleet_of(circle, 3, on_ground=False) == circle.vehicles[:3]
    with pytest.raises(ScenarioError, match="9 vehicles, but circle has 8"):
        fleet_of(circle, 9, on_ground=False)
    easts = [member.mission[0].east for member in fleet_of(load("single"), 3, on_ground=False)]
    assert easts == [0.0, 3000.0, 6000.0]


def test_from_the_catapult_to_the_ground_on_the_fmu():
    with world_of(small("clear"), on_ground=True) as world:
        (pilot,) = pilots(world)
        ground = Station(pilot)
        frame = pilot.aircraft.frame
        items = []
        for seq, (north, altitude, command) in enumerate(
            ((300.0, 40.0, 22), (900.0, 40.0, 16), (0.0, 0.0, 21))
        ):
            latitude, longitude = frame.to_geodetic(north, 0.0)
            place = (round(latitude * 1e7), round(longitude * 1e7), altitude)
            items.append(
                mavlink.MAVLink_mission_item_int_message(1, 1, seq, 6, command, 0, 1, 0, 0, 0, 0, *place, 0)
            )
        assert ground.upload(items)[0] == 0
        start(ground)
        for _ in range(3000):
            fly(world, [ground], 0.1)
            if pilot.aircraft.phase is Phase.LANDED:
                break
        fly(world, [ground], 1.0)
        state = pilot.aircraft.state
        assert math.hypot(state.north, state.east) < 150.0
        assert not pilot.captain.armed
        assert world.over
        assert [m.seq for m in told(ground, "MISSION_ITEM_REACHED")][-1] == 2


# Against the clock on the wall, over UDP


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@contextlib.contextmanager
def served(world, port, speed):
    """The world served in a thread for as long as the context lasts."""
    exchange, _ = connect(pilots(world)[0], 0, port, "127.0.0.1")
    stop = threading.Event()
    shown = []
    thread = threading.Thread(
        target=serve, args=(world, [exchange], speed, lambda *state: shown.append(state), stop.is_set)
    )
    thread.start()
    try:
        yield shown
    finally:
        stop.set()
        thread.join()
        exchange.close()


def test_the_script_in_the_documentation_prints_what_it_shows():
    (code, output) = re.search(
        r"```python\n(from pymavlink.*?)```\n\n```text\n(.*?)```", DOCUMENT, re.S
    ).groups()
    port, printed = free_port(), io.StringIO()
    with world_of(small()) as world, served(world, port, 20.0), contextlib.redirect_stdout(printed):
        exec(compile(code.replace("14540", str(port)), "sitl.md", "exec"), {})
    assert printed.getvalue() == output


def test_the_example_without_transport_runs():
    code = re.search(r"```python\n(from offboard.sitl.aircraft.*?)```", DOCUMENT, re.S).group(1)
    pilot = autopilot()
    names = {
        "plant": pilot.aircraft.plant,
        "frame": pilot.aircraft.frame,
        "performance": pilot.aircraft.performance,
        "data": b"",
    }
    exec(compile(code, "sitl.md", "exec"), names)
    assert names["data"][0] == 0xFD


def test_a_simulation_that_is_too_slow_gives_time_up():
    with world_of(small()) as world:
        exchange = Exchange(pilots(world)[0], [Udp()])
        shown, calls = [], iter(range(1000))
        serve(world, [exchange], 1e6, lambda *state: shown.append(state), lambda: next(calls) == 300)
        exchange.close()
    assert pilots(world)[0].aircraft.clock == pytest.approx(30.0, abs=0.2)  # one step a turn


def test_a_client_that_goes_does_not_end_the_simulation(monkeypatch):
    server = TcpServer()
    clients = [socket.create_connection(("127.0.0.1", server.port))]
    turns, waits = iter(range(1000)), []

    def wait(sockets, *_):
        waits.append([each.fileno() for each in sockets])
        if len(waits) == 2:
            clients.pop().close()

    monkeypatch.setattr("scenarios.sitl_run.select.select", wait)
    with world_of(small()) as world:
        exchange = Exchange(pilots(world)[0], [server])
        serve(world, [exchange], 0.01, lambda *_: None, lambda: next(turns) == 10)
        exchange.close()
    assert [len(each) for each in waits[:2]] == [2, 2]
    assert len(waits[-1]) == 1
    assert min(min(each) for each in waits) >= 0


# The command


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--autopilot", "inav"], "'inav' is unknown; known: px4, ardupilot"),
        (["--set", "NAV_ACC_RAD"], "must be a name and a number"),
        (["--set", "NO_SUCH=1"], "NO_SUCH = 1"),
        (["--delay", "3,1"], "the lesser first"),
        (["--outage", "soon"], "two numbers with a comma"),
        (["no-such-scenario"], "no-such-scenario"),
        (["circle", "--vehicles", "9"], "circle has 8"),
        (["--port", "65535", "--vehicles", "2"], "need ports up to 65536"),
        (["--host", "no such host"], "'no such host' is no host"),
    ],
)
def test_bad_input_is_one_message(arguments, words):
    result = CliRunner().invoke(app, ["sitl", *arguments])
    assert result.exit_code == 2
    assert words in result.output
    assert "Traceback" not in result.output


def test_a_key_that_cannot_be_read_is_said_so(tmp_path):
    result = CliRunner().invoke(app, ["sitl", "--signing-key", str(tmp_path / "none")])
    assert result.exit_code == 2
    assert "signing key cannot be read" in result.output


def test_once_ends_when_the_missions_are_over(monkeypatch):
    monkeypatch.setattr(
        SitlWorld, "over", property(lambda world: next(iter(pilots(world))).aircraft.clock > 5.0)
    )
    result = CliRunner().invoke(
        app, ["sitl", "single", "--once", "--speed", "500", "--port", str(free_port())]
    )
    assert result.exit_code == 0
    assert "1 vehicle, px4 behaviour, in scenario single, 500 times real time" in result.output
    assert "udpin://127.0.0.1:" in result.output


def test_what_is_shown_of_a_vehicle():
    with world_of(small(), count=2) as world:
        ground = Station(pilots(world)[0])
        assert status_of(pilots(world)[0]) == "Hold disarmed, item 0 of 2, not launched"
        start(ground)
        fly(world, [ground], 5.0)
        assert status_of(pilots(world)[0]) == "Mission armed, item 1 of 2, 200 m 15.0 m/s"
