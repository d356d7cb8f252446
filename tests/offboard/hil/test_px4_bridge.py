"""The bridge to PX4 over real sockets: free run, lockstep, reconnection; a board's real time over a pipe."""

from __future__ import annotations

import contextlib
import math
import socket
from datetime import UTC, datetime

import numpy as np
import pytest
from pymavlink.dialects.v20 import common

from offboard.errors import LinkError
from offboard.frames import MapFrame
from offboard.hil.channels import load_airframe
from offboard.hil.errors import LinkLost, OptionError
from offboard.hil.framing import Framer
from offboard.hil.geodesy import Geodesy
from offboard.hil.magnetic import MagneticField
from offboard.hil.pipes import TcpServer, UdpLinks, parse_links
from offboard.hil.plant import Axes, Phase
from offboard.hil.px4_bridge import Px4Bridge
from offboard.hil.px4_protocol import Px4Link
from offboard.hil.scripted import ScriptedPilot, Task
from offboard.hil.scripted_px4 import HIL_SENSOR, ScriptedPx4
from offboard.hil.sensors import Sensors
from offboard.hil.simulation import LaunchRule, Simulation
from tests.offboard.hil.fakes import FakePlant

HOME = MapFrame(47.397742, 8.545594, 488.0)
AIRFRAME = load_airframe("px4-10041")
FIELD = MagneticField(datetime(2025, 7, 1, tzinfo=UTC))


def make_bridge(speed=0.0, rate=250.0):
    simulation = Simulation(FakePlant(), LaunchRule(delay=0.0))
    sensors = Sensors(Geodesy(HOME), FIELD, np.random.default_rng(1))
    return Px4Bridge(simulation, sensors, AIRFRAME, Px4Link(), speed=speed, rate=rate)


def make_autopilot(**options):
    return ScriptedPx4(AIRFRAME, ScriptedPilot((Task(until=math.inf),)), boot=3, **options)


@pytest.fixture
def rig():
    """A bridge that serves, and a scripted PX4 that is connected to it."""
    server, bridge, autopilot = TcpServer(0), make_bridge(), make_autopilot()
    autopilot.connect(server.port)
    yield bridge, bridge.serve(server), autopilot, server
    autopilot.close()
    server.close()


def run(steps, autopilot, count):
    """Turn by turn, until the autopilot has had so many sensor messages."""
    for _ in range(20 * count):
        next(steps)
        autopilot.poll()
        if autopilot.sensors >= count:
            return
    raise AssertionError(f"only {autopilot.sensors} of {count} HIL_SENSOR")


def test_free_until_the_first_answer_then_one_for_one(rig):
    bridge, steps, autopilot, _ = rig
    run(steps, autopilot, 200)
    assert bridge.counts.steps == autopilot.sensors == 200
    assert bridge.counts.answers == pytest.approx(200 - 3, abs=3)
    assert (bridge.armed, bridge.connected) == (True, True)
    assert bridge.simulation.phase is Phase.LAUNCHING


def test_without_an_answer_the_plant_stands_still(rig):
    bridge, steps, autopilot, _ = rig
    run(steps, autopilot, 50)
    bridge.counts.stale = 0
    next(steps)  # takes the answer of before
    next(steps)  # sends, and hears nothing
    before = bridge.counts.steps
    autopilot._socket.sendall(autopilot.controls(4000))  # late: the answer to the first step
    assert [next(steps) for _ in range(2)] == [False, False]
    assert (bridge.counts.steps, bridge.counts.stale) == (before, 1)
    autopilot._socket.sendall(b"garbage" + autopilot.controls(4000 * before) * 2)  # and twice
    assert next(steps) is True
    assert bridge.counts.stale == 2
    assert bridge.link.skipped == len("garbage")


def test_a_firmware_that_starts_again_finds_the_plant_at_its_start(rig):
    bridge, steps, autopilot, server = rig
    run(steps, autopilot, 300)
    assert bridge.simulation.truth.north > 0.0
    autopilot.close()
    while bridge.connected:
        next(steps)
    autopilot.boot_up()
    autopilot.connect(server.port)
    run(steps, autopilot, 2)
    assert bridge.simulation.truth.time < 0.05
    assert (bridge.counts.connections, bridge.simulation.restarts) == (2, 1)


class Line:
    """A serial line in memory; the board at its other end answers at once."""

    def __init__(self, board, extra=b""):
        self.board, self.pending, self.written = board, [extra], []
        self.broken = False

    def read(self, timeout):
        if self.broken:
            raise LinkLost("unplugged")
        return self.pending.pop(0) if self.pending else b""

    def write(self, data):
        self.written.append(data)
        if answer := self.board.feed(data):
            self.pending.append(answer)

    def close(self):
        pass


class Links:
    """Ground stations in memory."""

    def __init__(self, said=b""):
        self.heard, self.said = [], said

    def send(self, data):
        self.heard.append(data)

    def receive(self):
        said, self.said = self.said, b""
        return said


def test_hardware_keeps_its_own_time_and_mavlink_is_bridged():
    board = make_autopilot(hardware=True)
    mav = common.MAVLink(None, srcSystem=1, srcComponent=1)
    attitude = bytes(common.MAVLink_attitude_message(1, 0.1, 0, 0, 0, 0, 0).pack(mav))
    request = bytes(common.MAVLink_param_request_list_message(1, 1).pack(mav))
    line, links, bridge = Line(board, attitude), Links(request), make_bridge(speed=1.0, rate=5000.0)
    steps = bridge.drive(line, links)
    assert all(next(steps) for _ in range(30))
    assert links.heard == [attitude]
    assert request in line.written
    assert board.sensors == 30
    assert bridge.armed
    assert bridge.metronome.punctuality.steps == 30
    ids = [frame.message for data in line.written for frame in Framer().feed(data)]
    assert ids.count(0) == 1
    assert ids.count(HIL_SENSOR) == 30


def test_an_unplugged_board_ends_the_drive():
    line, bridge = Line(make_autopilot(hardware=True)), make_bridge(rate=5000.0)
    steps = bridge.drive(line)
    next(steps)
    line.broken = True
    with pytest.raises(LinkLost, match="unplugged"):
        next(steps)


def test_the_scripted_px4_says_what_the_real_one_said_first():
    assert [frame.message for frame in Framer().feed(make_autopilot().hello())] == [76, 0]


def test_disarmed_outputs_are_zero():
    board = ScriptedPx4(AIRFRAME, ScriptedPilot((Task(until=math.inf, armed=False),)), boot=0)
    (heard,) = Px4Link().hear(board.controls(1, Axes(1.0, 1.0, 1.0, 1.0))).actuators
    assert (heard.armed, set(heard.controls)) == (False, {0.0})


def test_a_port_that_is_taken_is_said():
    server = TcpServer(0)
    with pytest.raises(LinkError, match=f"TCP port {server.port}"):
        TcpServer(server.port)
    server.close()


def test_a_flood_does_not_hold_up_the_steps():
    with contextlib.closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as peer, UdpLinks([]) as links:
        port = links._socket.getsockname()[1]
        for _ in range(100):
            peer.sendto(b"x", ("127.0.0.1", port))
        read = [len(links.receive()) for _ in range(3)]
    assert read == [64, 36, 0]


def test_mission_links():
    assert parse_links("udp://127.0.0.1:14550, udpout://10.0.0.1:14540") == [
        ("127.0.0.1", 14550),
        ("10.0.0.1", 14540),
    ]
    for text in ("14550", "tcp://127.0.0.1:1", "udp://127.0.0.1:99999", ""):
        with pytest.raises(OptionError, match="mission-link"):
            parse_links(text)
