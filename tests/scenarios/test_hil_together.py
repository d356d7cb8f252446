"""The whole chain: avoidance, MAVSDK, a firmware by script, ArduPilot's JSON protocol, the FMU."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import pytest

from offboard.hil.pipes import UdpPort

ROOT = Path(__file__).parents[2]
SCENARIO = """
name = "near"
start_time_utc = 2025-06-21T08:00:00Z
[home]
latitude_deg = 47.397742
longitude_deg = 8.545594
altitude_m = 488.0
[[mission]]
north_m = 0.0
east_m = 0.0
altitude_m = 40.0
[[mission]]
north_m = 1300.0
east_m = 0.0
altitude_m = 40.0
[[obstacles]]
north_m = 850.0
east_m = 20.0
altitude_m = 40.0
safety_radius_m = 100.0
"""


@pytest.mark.skipif(importlib.util.find_spec("mavsdk") is None, reason="mavsdk is not installed")
def test_a_mission_is_flown_round_an_obstacle_from_the_ground_up(tmp_path):
    ports = [UdpPort(0), UdpPort(0)]
    plant, mavsdk = (port.port for port in ports)
    for port in ports:
        port.close()
    (tmp_path / "near.toml").write_text(SCENARIO)
    firmware = [sys.executable, "-m", "offboard.hil.scripted_firmware", str(plant), str(mavsdk)]
    flown = [sys.executable, "-m", "scenarios.cli", "hil", "ardupilot", "--udp", str(plant), "--arm"]
    flown += ["--timeout", "60"]
    flown += ["--with-avoidance", str(tmp_path / "near.toml"), "--connect", f"udpin://127.0.0.1:{mavsdk}"]
    flown += ["-o", str(tmp_path / "run")]
    autopilot = subprocess.Popen([*firmware, "47.397742,8.545594,488", "12"], cwd=ROOT)
    try:
        done = subprocess.run(flown, cwd=ROOT, timeout=300, capture_output=True, text=True, check=False)
    finally:
        autopilot.kill()
        autopilot.wait()
    assert done.returncode == 0, done.stdout + done.stderr
    run, truth = (json.loads((tmp_path / "run" / f"{n}summary.json").read_text()) for n in ("", "plant-"))
    assert run["completed"]
    assert run["replans"] >= 1
    assert run["violations"] == truth["violations"] == 0
    assert truth["judged"] == "all"
    assert truth["clock_fit_m"] < 10.0
    assert 100.0 < truth["min_separation_m"] < 400.0
    assert truth["min_separation_m"] == pytest.approx(run["min_separation_m"], abs=10.0)
    events = (tmp_path / "run" / "plant-events.jsonl").read_text().splitlines()
    assert [json.loads(line)["event"] for line in events] == ["standing", "launching", "flying"]
    assert (tmp_path / "run" / "report.html").is_file()
