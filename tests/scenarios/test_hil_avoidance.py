"""Plant and avoidance together: what is started, where the plant begins, what the plant's own track says."""

from __future__ import annotations

import contextlib
import itertools
import math
import subprocess
import sys
from pathlib import Path

import pytest
import typer

from fmu.errors import PlantError
from offboard.hil.pipes import UdpPort
from offboard.hil.plant import NEUTRAL, Phase
from scenarios.errors import RunDirectoryError, ScenarioError
from scenarios.hil_avoidance import PREFIX, Together, end
from scenarios.hil_record import HilRecorder
from scenarios.hil_run import Course, _serve
from scenarios.hil_setup import HilOptions, Rig
from scenarios.target import FILES_OF_A_RUN
from tests.offboard.hil.fakes import AT_REST

SHORT = Path(__file__).parents[1] / "real" / "short.toml"


def together(tmp_path, name=SHORT, **options):
    choices = {"arm": False, "as_json": False} | options
    return Together.of(str(name), "udpin://127.0.0.1:14999", tmp_path / "run", **choices)


def test_the_other_process_is_sidestep_offboard(tmp_path):
    command = together(tmp_path, arm=True, as_json=True).command
    assert command[3] == "offboard"
    for option, value in (("--connect", "udpin://127.0.0.1:14999"), ("--mission", str(SHORT))):
        assert command[command.index(option) + 1] == value
    assert {"--arm", "--json"} <= set(command)
    assert "--arm" not in together(tmp_path).command


def test_the_plant_stands_where_and_when_the_scenario_begins(tmp_path):
    flown = together(tmp_path, "from-left")
    options = flown.options(HilOptions())
    assert options.home.latitude_deg == flown.scenario.home.latitude_deg
    assert options.start == flown.scenario.start_time_utc
    with Rig(options) as rig:
        truth, first = rig.simulation.truth, flown.scenario.mission[0]
        assert rig.simulation.phase is Phase.STANDING
        assert (truth.north, truth.east) == (first.north, first.east)


def test_the_plants_own_track_is_judged(tmp_path):
    """Past an obstacle of 200 m, 2,500 m ahead and 50 m to the right, 100 m and then 400 m off."""
    recorder = HilRecorder()
    for east, begin in ((150.0, 0.0), (-350.0, 1000.0)):
        for step in range(400):
            north = 10.0 * step
            truth = AT_REST._replace(time=begin + step, north=north, east=east, altitude=60.0)
            recorder(truth, Phase.FLYING, NEUTRAL)
    found = together(tmp_path).truth(recorder.rows[400:])
    clear = {"min_separation_m": 400.0, "min_margin_m": 200.0, "violations": 0}
    assert found == clear | {"judged": "all", "clock_fit_m": None}
    found = together(tmp_path).truth(recorder.rows[:400])
    cut = {"min_separation_m": 100.0, "min_margin_m": -100.0, "violations": 1}
    assert found == cut | {"judged": "all", "clock_fit_m": None}


def test_without_a_track_nothing_is_claimed(tmp_path):
    found = together(tmp_path).truth([])
    assert found.pop("judged") == "nothing"
    assert set(found.values()) == {None}


def test_the_plants_files_are_files_of_a_run(tmp_path):
    recorder = HilRecorder()
    recorder(AT_REST, Phase.STANDING, NEUTRAL)
    recorder.write(tmp_path, {}, PREFIX)
    assert {path.name for path in tmp_path.iterdir()} == {
        "plant-track.csv", "plant-events.jsonl", "plant-summary.json",
    }  # fmt: skip
    assert {path.name for path in tmp_path.iterdir()} <= FILES_OF_A_RUN


PATIENT = """
import signal

signal.signal(signal.SIGINT, signal.SIG_IGN)  # as in the background of a script
signal.signal(signal.SIGTERM, signal.default_int_handler)
try:
    print("up", flush=True)
    input()
except KeyboardInterrupt:
    raise SystemExit(7)
"""


def test_the_other_process_is_asked_to_write_its_run():
    child = subprocess.Popen([sys.executable, "-c", PATIENT], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    with child:
        assert child.stdout.readline().strip() == b"up"
        assert end(child) == 7
    assert end(child) == 7


def test_what_cannot_be_flown_or_written_is_refused_before(tmp_path):
    with pytest.raises(ScenarioError):
        together(tmp_path, "no-such-scenario")
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "mine.txt").write_text("mine")
    with pytest.raises(RunDirectoryError):
        together(tmp_path)


def test_the_heading_is_that_of_the_first_leg(tmp_path):
    flown = together(tmp_path, "from-left")
    first, then = flown.scenario.mission[:2]
    expected = math.atan2(then.east - first.east, then.north - first.north)
    assert flown.options(HilOptions()).heading == pytest.approx(expected)


class Other:
    """A process beside the bridge, and what the plant's track is said to show."""

    scenario = None

    def __init__(self, directory, code, violations=0):
        self.directory = directory
        self._code = code
        self._violations = violations
        self.process = None

    def begin(self):
        self.process = subprocess.Popen([sys.executable, "-c", self._code])
        return self.process

    def truth(self, rows):
        found = {"min_separation_m": 1.0, "min_margin_m": -1.0, "violations": self._violations}
        return found | {"judged": "all", "clock_fit_m": None}


def test_nobody_is_left_behind_when_the_model_fails(tmp_path):
    def steps():
        yield False
        raise PlantError("gone", 1.0, "error")

    other = Other(tmp_path, "import time; time.sleep(60)")
    with Rig(HilOptions()) as rig, contextlib.closing(UdpPort(0)) as port, pytest.raises(PlantError):
        _serve(rig, rig.json_bridge(port), steps(), Course(together=other))
    assert other.process.returncode is not None


@pytest.mark.parametrize(
    ("code", "expected"), [("raise SystemExit(3)", 3), ("import os; os.kill(os.getpid(), 9)", 3)]
)
def test_an_earlier_run_is_not_taken_for_one_that_was_not_written(tmp_path, capsys, code, expected):
    """The other process has failed, or was killed: what lies there is of the time before."""
    other = Other(tmp_path, code, violations=1)
    with (
        Rig(HilOptions()) as rig,
        contextlib.closing(UdpPort(0)) as port,
        pytest.raises(typer.Exit) as ended,
    ):
        _serve(rig, rig.json_bridge(port), itertools.repeat(False), Course(together=other))
    assert ended.value.exit_code == expected
    assert not list(tmp_path.iterdir())
    assert "has written no run" in capsys.readouterr().out


@pytest.mark.parametrize(("violations", "code"), [(0, 0), (1, 1)])
def test_a_sphere_entered_by_the_plants_own_track_is_no_safe_flight(tmp_path, violations, code):
    other = Other(tmp_path / "run", f"import os; os.mkdir({str(tmp_path / 'run')!r})", violations)
    with (
        Rig(HilOptions()) as rig,
        contextlib.closing(UdpPort(0)) as port,
        pytest.raises(typer.Exit) as ended,
    ):
        _serve(rig, rig.json_bridge(port), itertools.repeat(False), Course(together=other))
    assert ended.value.exit_code == code
