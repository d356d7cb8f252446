"""Runs in the loop with whoever is on the other side, until the end of time or Ctrl-C."""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer

from offboard.errors import LinkError
from offboard.hil.errors import LinkLost
from offboard.hil.json_bridge import JsonBridge
from offboard.hil.pipes import SerialPipe, TcpServer, UdpLinks, UdpPort, parse_links
from offboard.hil.px4_bridge import Px4Bridge
from scenarios.command_errors import FAILED, INTERRUPTED, OK, UNSAFE
from scenarios.hil_avoidance import PREFIX, Together, end
from scenarios.hil_priority import real_time
from scenarios.hil_record import HilRecorder, check_directory
from scenarios.hil_setup import HilOptions, Rig
from scenarios.hil_show import Status, punctuality_json
from scenarios.interrupts import stop_on_interrupt

_EVERY = 64
"""Steps from one look at the clock to the next."""


@dataclass(frozen=True, slots=True)
class Course:
    """How a run is conducted: how long, what is written, who else takes part."""

    output: Path | None = None
    """Where it is written."""
    until: float | None = None
    """Simulated time at which it ends [s]; None: at Ctrl-C."""
    timeout: float = 0.0
    """An autopilot that is silent for so long is given up [s]; 0: never."""
    as_json: bool = False
    """Print the summary as JSON and nothing else."""
    together: Together | None = None
    """A scenario that is flown with sense and avoid beside it."""

    def check(self) -> None:
        """Find out before the flight whether it can be written; `RunDirectoryError` if not."""
        if self.output is not None and self.together is None:
            check_directory(self.output)

    def say(self, text: str) -> None:
        """Tell the user, unless a program is listening."""
        if not self.as_json:
            typer.echo(text, err=True)


def run_ardupilot(options: HilOptions, address: tuple[str, int], course: Course) -> None:
    """Serve ArduPilot's JSON protocol; always ends with `typer.Exit`."""
    course.check()
    with Rig(options) as rig:
        port = UdpPort(address[1], address[0])
        bridge = rig.json_bridge(port)
        course.say(f"waiting for ArduPilot on UDP {address[0]}:{port.port} (--model JSON:{address[0]})")
        with contextlib.closing(port):
            _serve(rig, bridge, bridge.serve(), course)


def run_px4_tcp(options: HilOptions, address: tuple[str, int], speed: float, course: Course) -> None:
    """Serve PX4's simulator API over TCP; always ends with `typer.Exit`."""
    course.check()
    with Rig(options) as rig:
        server = TcpServer(address[1], address[0])
        bridge = rig.px4_bridge(speed)
        course.say(f"waiting for PX4 on TCP {address[0]}:{server.port}")
        with contextlib.closing(server):
            _serve(rig, bridge, bridge.serve(server), course)


def run_px4_serial(options: HilOptions, serial: str, mission_link: str, course: Course) -> None:
    """Fly a board in real time over a serial port; always ends with `typer.Exit`."""
    addresses = parse_links(mission_link)
    course.check()
    with Rig(options) as rig, UdpLinks(addresses) as links:
        bridge = rig.px4_bridge(1.0)
        pipe = SerialPipe(serial)
        where = ", ".join(f"{host}:{port}" for host, port in addresses)
        with contextlib.closing(pipe), real_time() as urgent:
            course.say(f"flying the board on {serial} in real time ({urgent}); MAVLink goes on to {where}")
            _serve(rig, bridge, bridge.drive(pipe, links), course)


def _serve(rig: Rig, bridge: JsonBridge | Px4Bridge, steps: Iterator[bool], course: Course) -> None:
    """Step until it is over, show how it goes, write and print what came of it."""
    recorder = HilRecorder(rig.faults)
    rig.simulation.watch = recorder
    together = course.together
    status = Status(rig.simulation, quiet=course.as_json or together is not None)
    lost = ""
    before = None if together is None else _state(together.directory)
    companion = None if together is None else together.begin()
    with stop_on_interrupt() as stop:
        try:
            _loop(rig, bridge, steps, course, stop, status, companion)
        except LinkLost as error:
            lost = str(error)
        finally:  # also when the model fails: nobody is left behind
            code = OK if companion is None else end(companion)
    status.close()
    ending = lost or ("interrupted" if stop else "time is up" if companion is None else "the mission is over")
    summary = recorder.summary(bridge.counts) | {"ending": ending}
    if isinstance(bridge, Px4Bridge) and bridge.metronome.punctuality.steps:
        summary["real_time"] = punctuality_json(bridge.metronome.punctuality)
    where = course.output
    if together is not None and (where := _written(together.directory, before)) is not None:
        summary |= together.truth(recorder.rows)
        recorder.write(where, summary, PREFIX)
    elif where is not None:
        recorder.write(where, summary)
    _tell(summary, course, where)
    if lost:
        raise LinkError(lost)
    if code == OK and summary.get("violations"):
        code = UNSAFE  # by the plant's own track
    raise typer.Exit(INTERRUPTED if stop else code if code >= 0 else FAILED)  # below 0: killed


def _state(directory: Path) -> tuple[int, int] | None:
    """Which directory it is; None if it is none."""
    if not directory.is_dir():
        return None
    found = directory.stat()
    return found.st_ino, found.st_mtime_ns


def _written(directory: Path, before: tuple[int, int] | None) -> Path | None:
    """Where the other process has written its run; None if it has not, though an earlier one may be there."""
    return None if _state(directory) in (None, before) else directory


def _loop(
    rig: Rig,
    bridge: JsonBridge | Px4Bridge,
    steps: Iterator[bool],
    course: Course,
    stop: list[int],
    status: Status,
    companion: subprocess.Popen[bytes] | None,
) -> None:
    heard, count, until = time.monotonic(), 0, course.until
    while not stop and (until is None or rig.simulation.truth.time < until):
        moved = next(steps)
        count += 1
        if moved and count % _EVERY:
            continue
        now = time.monotonic()
        heard = now if moved else heard
        if course.timeout and now - heard > course.timeout:
            raise LinkLost(f"the autopilot has been silent for {course.timeout:g} s")
        if companion is not None and companion.poll() is not None:
            return
        if bridge.connected:
            status.update(_extra(bridge))


def _extra(bridge: JsonBridge | Px4Bridge) -> str:
    """What there is to say of the link."""
    if isinstance(bridge, JsonBridge):
        counts = bridge.counts
        odd = counts.duplicate + counts.repeated + counts.late + counts.garbage + counts.missed
        return f"{odd} odd packets" if odd else ""
    words = ["armed" if bridge.armed else "disarmed"]
    if late := bridge.metronome.punctuality.late:
        words.append(f"{late} late steps")
    if bridge.counts.stalls:
        words.append(f"{bridge.counts.stalls} stalls")
    return ", ".join(words)


def _tell(summary: dict[str, Any], course: Course, where: Path | None) -> None:
    if course.as_json:
        if course.together is None:  # else the other process has printed the run's own summary
            sys.stdout.write(json.dumps(summary, indent=2) + "\n")
        return
    link = ", ".join(f"{name} {value}" for name, value in summary["link"].items() if value)
    parts = [f"{summary['flight_time_s']:.1f} s flown", summary["phase"] or "", link, summary["ending"]]
    typer.echo("; ".join(part for part in parts if part))
    if (kept := summary.get("real_time")) is not None:
        typer.echo(
            f"real time: {kept['late']} of {kept['steps']} steps more than a period late "
            f"({100 * kept['late_share']:.3f} %), worst {kept['worst_ms']:.1f} ms"
        )
    if summary.get("min_separation_m") is not None:
        typer.echo(
            f"by the plant's own track: nearest {summary['min_separation_m']:.1f} m, least margin "
            f"{summary['min_margin_m']:.1f} m, spheres entered {summary['violations']}"
            + ("" if summary["judged"] == "all" else " (of what always stood there alone)")
        )
    if where is not None:
        typer.echo(f"written to {where}")
    elif course.together is not None:
        typer.echo("the other process has written no run, and nothing is kept of the plant's track")
