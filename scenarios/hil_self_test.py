"""The plant in the loop with a scripted autopilot on the other side: does it fly, how fast is the loop?"""

from __future__ import annotations

import contextlib
import math
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass

from offboard.errors import LinkError
from offboard.hil.pipes import SerialPipe, TcpServer, UdpPort
from offboard.hil.plant import Phase
from offboard.hil.px4_bridge import Px4Bridge
from offboard.hil.scripted import FLIGHT
from offboard.hil.scripted_ardupilot import ScriptedArduPilot
from offboard.hil.scripted_px4 import ScriptedPx4
from offboard.hil.timing import Punctuality, Timing
from scenarios.hil_priority import real_time, stolen_time
from scenarios.hil_record import HilRecorder
from scenarios.hil_setup import Rig

TARGETS = {"ardupilot": 3000.0, "px4": 2000.0}
"""Steps per second that the loop is to reach on one core, scripted autopilot included."""
TOLD = 0.05
"""Less processor time than this that the host withheld is not worth a word [s]."""
LATE_SHARE = 0.001
"""Of the steps in real time, so many may begin more than a period late."""
_BOOT = 60.0
SETTLED = 58.0
"""From here on the scripted flight is where it was told to be [s]."""


@dataclass(frozen=True, slots=True)
class Check:
    """One thing that must be so."""

    name: str
    passed: bool
    seen: str
    """In words, with the limit."""


@dataclass(frozen=True, slots=True)
class SelfTest:
    """What came of it."""

    checks: tuple[Check, ...]
    timing: Timing
    simulated: float
    """[s]"""
    wall: float
    """[s]"""
    processor: float
    """Processor time of this process: of both sides, unless the other has a process of its own [s]."""
    punctuality: Punctuality | None = None
    """In real time only."""
    stolen: float | None = None
    """Processor time that the machine's host withheld in real time [s]; None if it does not tell."""

    @property
    def passed(self) -> bool:
        """True if everything is as it must be."""
        return all(check.passed for check in self.checks)


def fly_ardupilot(rig: Rig, seconds: float, rate: int = 400) -> SelfTest:
    """Fly by ArduPilot's JSON protocol over UDP, both sides in turn in one thread."""
    recorder = HilRecorder(rig.faults)
    rig.simulation.watch = recorder
    port = UdpPort(0)
    bridge = rig.json_bridge(port)
    autopilot = ScriptedArduPilot(port.port, rig.airframe, rate=rate)
    timing = rig.simulation.timing
    begun = Stopwatch()
    try:
        while rig.simulation.truth.time < seconds:
            timing.start()
            autopilot.send()
            timing.lap("autopilot")
            if not bridge.poll(1.0):
                raise LinkError("a servo packet got lost on the way to this very process")
            timing.start()
            if autopilot.receive() is None:
                raise LinkError("an answer got lost on the way to this very process")
            timing.lap("autopilot")
    finally:
        autopilot.close()
        port.close()
    counts = bridge.counts
    exact = counts.steps == autopilot.answers and not (counts.garbage or counts.late or counts.duplicate)
    lockstep = Check("lockstep", exact, f"{counts.steps} packets, {autopilot.answers} answers")
    return _result(rig, recorder, seconds, begun, "ardupilot", lockstep)


def fly_px4(rig: Rig, seconds: float) -> SelfTest:
    """Fly by PX4's simulator API over TCP, both sides in turn in one thread."""
    recorder = HilRecorder(rig.faults)
    rig.simulation.watch = recorder
    server = TcpServer(0)
    bridge = rig.px4_bridge(0.0)
    autopilot = ScriptedPx4(rig.airframe, declination=rig.declination)
    autopilot.connect(server.port)
    steps, timing = bridge.serve(server), rig.simulation.timing
    begun = Stopwatch()
    try:
        while rig.simulation.truth.time < seconds:
            next(steps)
            timing.start()
            autopilot.poll()
            timing.lap("autopilot")
    finally:
        autopilot.close()
        server.close()
    return _result(rig, recorder, seconds, begun, "px4", _px4_lockstep(bridge, autopilot.boot))


def _px4_lockstep(bridge: Px4Bridge, boot: int) -> Check:
    counts = bridge.counts
    missing = counts.steps - counts.answers
    good = missing <= boot + 3 and bridge.link.skipped == 0 and bridge.link.broken == 0
    words = f"{counts.steps} HIL_SENSOR, {counts.answers} answers; the first {boot} run free"
    return Check("lockstep", good, words)


def fly_real_time(rig: Rig, seconds: float) -> SelfTest:
    """Fly in real time over a serial line, with the scripted board in a process of its own.

    Raises
    ------
    LinkError
        If this system has no pseudo-terminals, or the board's process ends.
    """
    recorder = HilRecorder(rig.faults)
    rig.simulation.watch = recorder
    bridge = rig.px4_bridge(1.0)
    begun, stolen = Stopwatch(), stolen_time()
    with _board(rig) as pipe, real_time() as urgent:
        steps = bridge.drive(pipe)
        while rig.simulation.truth.time < seconds:
            next(steps)
    kept = bridge.metronome.punctuality
    if stolen is not None:
        stolen = (stolen_time() or stolen) - stolen
    late = Check(
        "real time",
        kept.late_share <= LATE_SHARE,
        f"{kept.late} of {kept.steps} steps more than {kept.period * 1e3:g} ms late "
        f"({100 * kept.late_share:.3f} %, at most {100 * LATE_SHARE:g} %), worst {1e3 * kept.worst:.1f} ms; "
        f"{urgent}{_withheld(stolen)}",
    )
    enough = bridge.counts.answers > 0.8 * kept.steps - 250
    heard = Check("board", enough, f"{bridge.counts.answers} commands for {kept.steps} steps")
    checks = (heard, late, *_flight_checks(rig, recorder, seconds))
    return SelfTest(checks, rig.simulation.timing, rig.simulation.truth.time, *begun.read(), kept, stolen)


def _withheld(stolen: float | None) -> str:
    """What the machine's host did to the run, in words."""
    if stolen is None or stolen < TOLD:
        return ""
    return f"; not an idle machine: its host withheld {stolen:.1f} s of processor time"


class Stopwatch:
    """Wall and processor time since it was made."""

    def __init__(self) -> None:
        self._begun = (time.perf_counter(), time.process_time())

    def read(self) -> tuple[float, float]:
        """Both [s]."""
        return time.perf_counter() - self._begun[0], time.process_time() - self._begun[1]


def _result(
    rig: Rig, recorder: HilRecorder, seconds: float, begun: Stopwatch, autopilot: str, lockstep: Check
) -> SelfTest:
    wall, processor = begun.read()
    timing = rig.simulation.timing
    rate, target = timing.steps / processor, TARGETS[autopilot]
    words = f"{rate:,.0f} steps per second of one core, both sides and the FMU (at least {target:,.0f})"
    checks = (lockstep, Check("throughput", rate >= target, words), *_flight_checks(rig, recorder, seconds))
    return SelfTest(checks, timing, rig.simulation.truth.time, wall, processor)


def _flight_checks(rig: Rig, recorder: HilRecorder, seconds: float) -> Iterator[Check]:
    """Did the scripted flight go where it was told to go?"""
    truth, phase = rig.simulation.truth, rig.simulation.phase
    finite = all(map(math.isfinite, truth))
    yield Check("plant", finite, f"t = {truth.time:.1f} s, every value is a number")
    if seconds < SETTLED:
        return
    task, row = FLIGHT[-1], recorder.rows[-1]
    altitude, airspeed, heading = float(row[4]), float(row[8]), float(row[11])
    off = math.degrees(math.remainder(math.radians(heading) - task.heading, math.tau))
    bank = math.degrees(recorder.steepest)
    yield Check("flight", phase is Phase.FLYING, f"{phase.name.lower()} at the end")
    yield Check("altitude", abs(altitude - task.altitude) < 3.0, f"{altitude:.1f} m ({task.altitude:g} ± 3)")
    yield Check("heading", abs(off) < 5.0, f"{heading:.1f}° ({math.degrees(task.heading):g} ± 5)")
    words = f"{airspeed:.1f} m/s ({task.airspeed:g} ± 1)"
    yield Check("airspeed", abs(airspeed - task.airspeed) < 1.0, words)
    yield Check("bank", bank < 36.0, f"at most {bank:.1f}° (36)")


@contextlib.contextmanager
def _board(rig: Rig) -> Iterator[SerialPipe]:
    """A pseudo-terminal with the scripted board at its other end."""
    if not hasattr(os, "openpty"):
        raise LinkError("this system has no pseudo-terminals: --real-time needs Linux or macOS")
    outer, inner = os.openpty()
    pipe = SerialPipe(f"{os.ttyname(inner)}:921600")
    module = [sys.executable, "-m", "offboard.hil.scripted_board", str(outer), rig.airframe.name]
    board = subprocess.Popen([*module, str(rig.declination)], pass_fds=(outer,))
    try:
        if not pipe.read(_BOOT):
            raise LinkError(f"the scripted board has not spoken within {_BOOT:g} s")
        yield pipe
    finally:
        board.terminate()
        board.wait()
        pipe.close()
        os.close(outer)
        os.close(inner)
