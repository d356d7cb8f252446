"""The bridge to ArduPilot over real sockets: lockstep, late, doubled, restarted, garbage."""

from __future__ import annotations

import json
import math

import pytest

from offboard.frames import MapFrame
from offboard.hil.channels import load_airframe
from offboard.hil.faults import parse_faults
from offboard.hil.geodesy import Geodesy
from offboard.hil.json_bridge import KNOWN_FAULTS, JsonBridge
from offboard.hil.json_protocol import Servos, pack_servos
from offboard.hil.pipes import UdpPort
from offboard.hil.plant import Phase
from offboard.hil.scripted import ScriptedPilot, Task
from offboard.hil.scripted_ardupilot import ScriptedArduPilot, read_line
from offboard.hil.simulation import LaunchRule, Simulation
from tests.offboard.hil.fakes import FakePlant, recording

HOME = MapFrame(47.397742, 8.545594, 488.0)


@pytest.fixture
def rig():
    """A bridge before a fake plant, and a scripted ArduPilot that goes through full throttle at once."""
    opened = []

    def build(faults="", channels=16, plant=None):
        simulation = Simulation(plant or FakePlant(), LaunchRule(delay=0.0))
        port, airframe = UdpPort(0), load_airframe("ardupilot-plane")
        known = parse_faults(faults, KNOWN_FAULTS)
        bridge = JsonBridge(simulation, port, airframe, Geodesy(HOME), known)
        pilot = ScriptedPilot((Task(until=math.inf),))
        autopilot = ScriptedArduPilot(port.port, airframe, pilot, rate=100, channels=channels)
        opened.extend((port, autopilot))
        return bridge, autopilot

    yield build
    for each in opened:
        each.close()


def exchange(bridge, autopilot, count=1):
    """Packets and answers, one for one; the last answer's numbers."""
    for _ in range(count):
        autopilot.send()
        assert bridge.poll(1.0)
        assert autopilot.receive() is not None
    return autopilot.felt


@pytest.mark.parametrize("channels", [16, 32])
def test_a_step_for_each_packet(channels, rig):
    bridge, autopilot = rig(channels=channels)
    felt = exchange(bridge, autopilot, 100)
    assert felt["timestamp"][0] == pytest.approx(1.0)
    assert bridge.simulation.phase is Phase.LAUNCHING
    assert bridge.counts.steps == bridge.simulation.timing.steps == 100
    assert bridge.connected


def test_a_doubled_packet_is_flown_once_and_answered_once(rig):
    bridge, autopilot = rig()
    exchange(bridge, autopilot, 5)
    packet = autopilot.packet()
    for _ in range(3):
        autopilot.send(packet)
        assert bridge.poll(1.0)
    assert autopilot.receive() is not None
    assert autopilot.receive(timeout=0.0) is None
    assert (bridge.counts.steps, bridge.counts.duplicate) == (6, 2)


def test_garbage_and_overtaken_packets_change_nothing(rig):
    bridge, autopilot = rig()
    exchange(bridge, autopilot, 5)
    before = bridge.simulation.truth
    for data in (b"", b"\x1a\x48", b"x" * 40, pack_servos(Servos(100, 2, (2000,) * 16))):
        autopilot.send(data)
        assert bridge.poll(1.0)
    assert bridge.simulation.truth == before
    assert (bridge.counts.garbage, bridge.counts.late) == (3, 1)
    assert exchange(bridge, autopilot)["timestamp"][0] == pytest.approx(0.06)


def test_a_firmware_that_starts_again_finds_the_plant_at_its_start(rig):
    bridge, autopilot = rig()
    assert exchange(bridge, autopilot, 300)["position"][0] > 1.0
    autopilot.restart()
    felt = exchange(bridge, autopilot)
    assert (felt["timestamp"][0], felt["position"][0]) == (pytest.approx(0.01), 0.0)
    assert bridge.simulation.restarts == 1
    assert bridge.simulation.phase is Phase.STANDING


def test_nothing_comes_of_waiting_in_vain(rig):
    bridge, _ = rig()
    assert bridge.poll(0.0) is False
    assert bridge.punctuality is None


def test_an_autopilot_that_has_gone_is_no_error(rig):
    bridge, autopilot = rig()
    autopilot.send()
    autopilot.close()
    assert bridge.poll(1.0)
    bridge.poll(0.01)


def test_faults_that_this_protocol_can_tell(rig):
    bridge, autopilot = rig("accel-bias@0.5:1,2,3; gyro-bias@0.5-0.6:0.1,0.2,0.3")
    assert exchange(bridge, autopilot, 40)["accel_body"] == (0.0, 0.0, -9.81)
    felt = exchange(bridge, autopilot, 15)
    assert felt["accel_body"] == pytest.approx((1.0, 2.0, -6.81))
    assert felt["gyro"] == pytest.approx((0.1, 0.2, 0.3))
    assert exchange(bridge, autopilot, 10)["gyro"] == (0.0, 0.0, 0.0)


def test_a_blocked_pitot_tube_does_not_follow_the_airspeed(rig):
    class Diving(FakePlant):
        def step(self, duration):
            super().step(duration)
            speed = 15.0 + self._truth.time
            self._truth = self._truth._replace(airspeed=speed, differential_pressure=0.6 * speed**2)

    bridge, autopilot = rig("airspeed-blocked@1", plant=Diving())
    assert exchange(bridge, autopilot, 90)["airspeed"][0] == pytest.approx(15.9)
    assert exchange(bridge, autopilot, 300)["airspeed"][0] == pytest.approx(16.0, abs=0.02)


def test_recorded_packets_of_a_real_arduplane_drive_the_plant(rig):
    """Each is answered in its turn, and the plant's time is that of the recorded plant."""
    with recording("ardupilot_json.jsonl").open() as file:
        lines = [json.loads(line) for line in file]
    bridge, autopilot = rig()
    for line in lines[:230]:
        autopilot.send(bytes.fromhex(line["servo_hex"]))
        bridge.poll(1.0)
        autopilot.receive()
        theirs = read_line(line["reply"])
        assert autopilot.felt["timestamp"] == pytest.approx(theirs["timestamp"], abs=1e-6)
    assert bridge.counts.steps == 230
