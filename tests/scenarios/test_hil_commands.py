"""`sidestep hil`: self-tests, runs with a scripted autopilot outside, records, mistakes and exit codes."""

from __future__ import annotations

import csv
import json
import math
import threading

import pytest
from typer.testing import CliRunner

from offboard.hil.channels import load_airframe
from offboard.hil.pipes import UdpPort
from offboard.hil.scripted import ScriptedPilot, Task
from offboard.hil.scripted_ardupilot import ScriptedArduPilot
from scenarios.cli import app
from scenarios.hil_self_test import fly_ardupilot
from scenarios.hil_setup import HilOptions, Rig

UP = (Task(until=math.inf, altitude=30.0),)


def run(*arguments):
    return CliRunner().invoke(app, ["hil", *map(str, arguments)])


def free_port():
    port = UdpPort(0)
    port.close()
    return port.port


@pytest.mark.parametrize(
    ("autopilot", "airframe", "launch"),
    [("ardupilot", "ardupilot-x8", "catapult"), ("px4", "px4-1030", "runway")],
)
def test_the_self_test_says_where_the_time_goes(autopilot, airframe, launch):
    done = run(autopilot, "--self-test", "--seconds", 3, "--airframe", airframe, "--launch", launch)
    assert "FMU (write, step, read)" in done.stdout
    assert "steps per second of one core" in done.stdout
    findings = [line.split()[:2] for line in done.stdout.splitlines() if "passed" in line or "FAILED" in line]
    assert ["lockstep", "passed"] in findings
    assert ["plant", "passed"] in findings
    slow = ["throughput", "FAILED"] in findings  # a machine that does other things is no fault of ours
    assert done.exit_code == (1 if slow else 0)


def test_a_whole_flight_arrives_where_it_should():
    with Rig(HilOptions(autopilot="ardupilot", wind=(2.0, -1.0))) as rig:
        found = fly_ardupilot(rig, 60.0, rate=60)
    names = [each.name for each in found.checks]
    assert names == ["lockstep", "throughput", "plant", "flight", "altitude", "heading", "airspeed", "bank"]
    assert [each for each in found.checks if not each.passed and each.name != "throughput"] == []


def test_px4_takes_off_by_its_sensors_alone():
    done = run("px4", "--self-test", "--seconds", 15, "--json", "--faults", "gyro-bias@5:0,0.002,0")
    found = json.loads(done.stdout)
    assert [each for each in found["checks"] if not each["passed"] and each["name"] != "throughput"] == []
    assert found["steps"] == 3750
    assert sum(found["us_per_step"].values()) > found["us_per_step"]["plant"] > 0.0


def fly_outside(port, seconds, record):
    """A scripted ArduPilot in a thread, as a firmware in its own process would be."""
    autopilot = ScriptedArduPilot(port, load_airframe("ardupilot-plane"), ScriptedPilot(UP), rate=100)
    try:
        for _ in range(400):
            autopilot.send()
            if autopilot.receive(0.1) is not None:
                record.append(autopilot.felt["timestamp"][0])
            elif record:
                return  # nobody listens any more
            if record and record[-1] >= seconds:
                return
    finally:
        autopilot.close()


def test_a_run_is_recorded(tmp_path):
    port, heard = free_port(), []
    thread = threading.Thread(target=fly_outside, args=(port, 3.0, heard))
    thread.start()
    directory = tmp_path / "run"
    done = run("ardupilot", "--udp", port, "--until", 2, "--launch", "catapult", "--timeout", 20,
               "--faults", "accel-bias@1:0,0,0.1", "-o", directory)  # fmt: skip
    thread.join()
    assert done.exit_code == 0, done.output
    assert heard[-1] >= 2.0
    summary = json.loads((directory / "summary.json").read_text())
    assert summary["phase"] == "flying"
    assert summary["link"]["steps"] == pytest.approx(200, abs=1)
    events = [json.loads(line) for line in (directory / "events.jsonl").read_text().splitlines()]
    assert [each["event"] for each in events][:3] == ["standing", "launching", "flying"]
    assert {"t_s": 1.0, "event": "accel-bias begins"} in events
    with (directory / "track.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == pytest.approx(20, abs=1)
    assert float(rows[-1]["altitude_m"]) > 1.0
    again = run("ardupilot", "--udp", port, "-o", directory)
    assert again.exit_code == 2
    assert "is not empty" in again.stderr


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_an_autopilot_that_never_comes_is_a_failed_link(autopilot):
    port = ("--tcp", free_port()) if autopilot == "px4" else ("--udp", free_port())
    done = run(autopilot, *port, "--timeout", 0.05, "--json")
    assert done.exit_code == 3
    assert "silent for 0.05 s" in done.stderr
    assert json.loads(done.stdout)["link"]["steps"] == 0


def test_a_port_that_is_taken_is_a_failed_link():
    port = UdpPort(0)
    done = run("ardupilot", "--udp", port.port)
    port.close()
    assert done.exit_code == 3
    assert f"UDP port {port.port}" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("px4", "--airframe", "px4-99"), ["'px4-99' is unknown", "px4-10041"]),
        (("px4", "--airframe", "ardupilot-x8"), ["--airframe", "is for ardupilot"]),
        (("px4", "--aircraft", "concorde"), ["concorde"]),
        (("px4", "--aircraft", "missing.toml"), ["missing.toml"]),
        (("px4", "--launch", "slingshot"), ["launch='slingshot'", "runway, catapult, air"]),
        (("px4", "--wind", "3"), ["--wind", "'3'", "N,E"]),
        (("px4", "--home", "91,0,0"), ["--home", "latitude_deg = 91"]),
        (("px4", "--home", "1,2"), ["--home", "LAT,LON,ALT"]),
        (("px4", "--start", "noon"), ["--start", "'noon'"]),
        (("px4", "--faults", "gps-los@1"), ["--faults", "'gps-los' is unknown"]),
        (("ardupilot", "--faults", "gps-lost@1"), ["'gps-lost' is unknown here"]),
        (("px4", "--set", "launch.speed"), ["--set", "NAME=VALUE"]),
        (("px4", "--set", "launch.sped=3"), ["launch.sped"]),
        (("px4", "--set", "launch.speed=-3"), ["launch.speed", "[1, 100]"]),
        (("px4", "--serial", "/dev/nothing"), ["--serial", "DEVICE:BAUD"]),
        (("px4", "--serial", "x:1", "--mission-link", "tcp"), ["--mission-link", "'tcp'"]),
        (("px4", "--mission-link", "udp://127.0.0.1:14550"), ["--mission-link", "only with --serial"]),
        (("px4", "--real-time"), ["--real-time", "only with --self-test"]),
        (("px4", "--serial", "x:1", "--speed", "2"), ["--speed", "not with --serial"]),
        (("ardupilot", "--arm"), ["--arm", "only with --with-avoidance"]),
        (("ardupilot", "--self-test", "-o", "out"), ["--output", "not with --self-test"]),
        (("px4", "--self-test", "--with-avoidance", "single"), ["--with-avoidance", "not with --self-test"]),
    ],
)
def test_bad_input_is_one_message_and_exit_code_2(arguments, words):
    done = run(*arguments)
    assert done.exit_code == 2, done.output
    assert done.stderr.count("\n") == 1
    for word in words:
        assert word in done.stderr


def test_a_board_that_is_not_there_is_a_failed_link():
    done = run("px4", "--serial", "/dev/no-such-board:57600")
    assert done.exit_code == 3
    assert "/dev/no-such-board" in done.stderr


def test_airframes_are_listed():
    done = run("airframes")
    assert done.exit_code == 0
    assert [line.split()[0] for line in done.stdout.splitlines()] == [
        "ardupilot-plane", "ardupilot-x8", "px4-10041", "px4-1030", "px4-1033", "px4-x8",
    ]  # fmt: skip
