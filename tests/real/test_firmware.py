"""A real ArduPlane or PX4 on our plant: boot, arm, take off, mission, and a detour round an obstacle.

Needs a binary: on the PATH, or named by SIDESTEP_ARDUPLANE or SIDESTEP_PX4 (the latter may be PX4's build
directory). Each flight takes some minutes.
"""

from __future__ import annotations

import importlib.util
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

SCENARIO = Path(__file__).parent / "short.toml"
ROOT = Path(__file__).parents[2]
HOME = "47.397742,8.545594,1"
INSTANCE = 3
"""Not the first one, for that may be running on a developer's machine."""
TIME_LIMIT = 1500.0
"""Of a whole flight [s of real time]."""
ARDUPLANE_PARAMETERS = """
AIRSPEED_CRUISE 15
AIRSPEED_MIN 12
AIRSPEED_MAX 22
ROLL_LIMIT_DEG 35
ARSPD_USE 1
WP_RADIUS 50
SERVO1_MIN 1000
SERVO1_MAX 2000
SERVO2_MIN 1000
SERVO2_MAX 2000
SERVO3_MIN 1000
SERVO3_MAX 2000
SERVO4_MIN 1000
SERVO4_MAX 2000
AVD_ENABLE 0
ARMING_CHECK 0
"""
PX4_PARAMETERS = {
    **{f"SENS_EN_{sensor}SIM": 0 for sensor in ("GPS", "BARO", "MAG", "ARSPD")},
    **{"FW_AIRSPD_TRIM": 15, "FW_AIRSPD_MIN": 12, "FW_AIRSPD_MAX": 22, "EKF2_GPS_DELAY": 100},
    **{"MIS_TKO_LAND_REQ": 0, "NAV_TRAFF_AVOID": 0, "COM_RC_IN_MODE": 4, "NAV_DLL_ACT": 0},
}


def binary(variable, name):
    """The firmware's executable; the test is skipped if there is none."""
    named = os.environ.get(variable)
    found = named or shutil.which(name)
    if found is None:
        pytest.skip(f"no {name} on the PATH, and {variable} names none")
    path = Path(found).expanduser().resolve()
    path = path / "bin" / name if path.is_dir() else path
    if not path.is_file():
        pytest.fail(f"{variable}={named}: there is no {name}")
    if importlib.util.find_spec("mavsdk") is None:
        pytest.skip("mavsdk is not installed")
    return path


def fly(firmware, plant, folder, **options):
    """Plant and avoidance in one process, firmware in another; the run's and the plant's summaries."""
    run = folder / "run"
    command = [sys.executable, "-m", "scenarios.cli", "hil", *plant, "--with-avoidance", str(SCENARIO)]
    with (folder / "firmware.log").open("w") as log:
        flown = subprocess.Popen([*command, "--arm", "-o", str(run)], cwd=ROOT)
        autopilot = subprocess.Popen(firmware, cwd=folder, stdout=log, stderr=log, **options)
        try:
            code = flown.wait(TIME_LIMIT)
        finally:
            autopilot.kill()
            flown.kill()
    said = (folder / "firmware.log").read_text(errors="replace")[-2000:]
    assert code == 0, said
    return (json.loads((run / name).read_text()) for name in ("summary.json", "plant-summary.json"))


def check(run, plant):
    """The mission was flown to its end, round the obstacle, by telemetry and in truth."""
    assert run["completed"]
    assert run["violations"] == plant["violations"] == 0
    assert run["replans"] >= 1
    assert 200.0 < plant["min_separation_m"] < 1500.0
    assert plant["highest_m"] > 40.0


def test_arduplane(tmp_path):
    path = binary("SIDESTEP_ARDUPLANE", "arduplane")
    (tmp_path / "plane.parm").write_text(ARDUPLANE_PARAMETERS)
    firmware = [
        *(str(path), "-w", "--model", "JSON:127.0.0.1", "--home", f"{HOME},0", "--speedup", "5"),
        *("--defaults", "plane.parm", "--instance", str(INSTANCE)),
        *("--serial0", "udpclient:127.0.0.1:14573"),
    ]
    plant = ["ardupilot", "--udp", str(9002 + 10 * INSTANCE), "--connect", "udpin://127.0.0.1:14573"]
    check(*fly(firmware, plant, tmp_path))


def test_px4(tmp_path):
    path = binary("SIDESTEP_PX4", "px4")
    parameters = {f"PX4_PARAM_{name}": str(value) for name, value in PX4_PARAMETERS.items()}
    environment = {"PX4_SYS_AUTOSTART": "10041", "PX4_SIMULATOR": "mavlink", "PX4_SIM_SPEED_FACTOR": "5"}
    firmware = [str(path), "-d", "-i", str(INSTANCE), str(path.parents[1] / "etc")]
    plant = ["px4", "--tcp", str(4560 + INSTANCE), "--speed", "5"]
    plant += ["--connect", f"udpin://127.0.0.1:{14540 + INSTANCE}"]
    check(*fly(firmware, plant, tmp_path, env=os.environ | environment | parameters))
