"""Runs in the loop with whoever is on the other side, until the end of time or Ctrl-C."""

from __future__ import annotations

import contextlib
import json
import signal
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType
from typing import Any

import typer

from offboard.errors import LinkError
from offboard.hil.errors import LinkLost
from offboard.hil.json_bridge import JsonBridge
from offboard.hil.pipes import SerialPipe, TcpServer, UdpLinks, UdpPort, parse_links
from offboard.hil.px4_bridge import Px4Bridge
from scenarios.command_errors import INTERRUPTED, OK
from scenarios.hil_priority import real_time
from scenarios.hil_record import HilRecorder, check_directory
from scenarios.hil_setup import HilOptions, Rig
from scenarios.hil_show import Status, punctuality_json

_EVERY = 64
"""Steps from one look at the clock to the next."""


def run_ardupilot(
    options: HilOptions,
    address: tuple[str, int],
    output: Path | None,
    until: float | None,
    timeout: float,
    *,
    as_json: bool,
) -> None:
    """Serve ArduPilot's JSON protocol; always ends with `typer.Exit`."""
    _prepare(output)
    with Rig(options) as rig:
        port = UdpPort(address[1], address[0])
        bridge = rig.json_bridge(port)
        _say(f"waiting for ArduPilot on UDP {address[0]}:{port.port} (--model JSON:{address[0]})", as_json)
        with contextlib.closing(port):
            _serve(rig, bridge, bridge.serve(), output, until, timeout, as_json=as_json)


def run_px4_tcp(
    options: HilOptions,
    address: tuple[str, int],
    speed: float,
    output: Path | None,
    until: float | None,
    timeout: float,
    *,
    as_json: bool,
) -> None:
    """Serve PX4's simulator API over TCP; always ends with `typer.Exit`."""
    _prepare(output)
    with Rig(options) as rig:
        server = TcpServer(address[1], address[0])
        bridge = rig.px4_bridge(speed)
        _say(f"waiting for PX4 on TCP {address[0]}:{server.port}", as_json)
        with contextlib.closing(server):
            _serve(rig, bridge, bridge.serve(server), output, until, timeout, as_json=as_json)


def run_px4_serial(
    options: HilOptions,
    serial: str,
    mission_link: str,
    output: Path | None,
    until: float | None,
    *,
    as_json: bool,
) -> None:
    """Fly a board in real time over a serial port; always ends with `typer.Exit`."""
    addresses = parse_links(mission_link)
    _prepare(output)
    with Rig(options) as rig, UdpLinks(addresses) as links:
        bridge = rig.px4_bridge(1.0)
        pipe = SerialPipe(serial)
        where = ", ".join(f"{host}:{port}" for host, port in addresses)
        with contextlib.closing(pipe), real_time() as urgent:
            _say(f"flying the board on {serial} in real time ({urgent}); MAVLink goes on to {where}", as_json)
            _serve(rig, bridge, bridge.drive(pipe, links), output, until, 0.0, as_json=as_json)


def _prepare(output: Path | None) -> None:
    if output is not None:
        check_directory(output)


def _serve(
    rig: Rig,
    bridge: JsonBridge | Px4Bridge,
    steps: Iterator[bool],
    output: Path | None,
    until: float | None,
    timeout: float,
    *,
    as_json: bool,
) -> None:
    """Step until it is over, show how it goes, write and print what came of it."""
    recorder = HilRecorder(rig.faults)
    rig.simulation.watch = recorder
    status = Status(rig.simulation, quiet=as_json)
    lost = ""
    with stop_on_interrupt() as stop:
        try:
            _loop(rig, bridge, steps, until, timeout, stop, status)
        except LinkLost as error:
            lost = str(error)
    status.close()
    summary = recorder.summary(bridge.counts) | {"ending": lost or ("interrupted" if stop else "time is up")}
    if isinstance(bridge, Px4Bridge) and bridge.metronome.punctuality.steps:
        summary["real_time"] = punctuality_json(bridge.metronome.punctuality)
    if output is not None:
        recorder.write(output, summary)
    _tell(summary, output, as_json=as_json)
    if lost:
        raise LinkError(lost)
    raise typer.Exit(INTERRUPTED if stop else OK)


def _loop(
    rig: Rig,
    bridge: JsonBridge | Px4Bridge,
    steps: Iterator[bool],
    until: float | None,
    timeout: float,
    stop: list[int],
    status: Status,
) -> None:
    heard, count = time.monotonic(), 0
    while not stop and (until is None or rig.simulation.truth.time < until):
        moved = next(steps)
        count += 1
        if moved and count % _EVERY:
            continue
        now = time.monotonic()
        heard = now if moved else heard
        if timeout and now - heard > timeout:
            raise LinkLost(f"the autopilot has been silent for {timeout:g} s")
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


def _say(text: str, quiet: bool) -> None:
    if not quiet:
        typer.echo(text, err=True)


def _tell(summary: dict[str, Any], output: Path | None, *, as_json: bool) -> None:
    if as_json:
        sys.stdout.write(json.dumps(summary, indent=2) + "\n")
        return
    link = ", ".join(f"{name} {value}" for name, value in summary["link"].items() if value)
    typer.echo(f"{summary['flight_time_s']:.1f} s flown, {summary['phase']}; {link}; {summary['ending']}")
    if (kept := summary.get("real_time")) is not None:
        typer.echo(
            f"real time: {kept['late']} of {kept['steps']} steps more than a period late "
            f"({100 * kept['late_share']:.3f} %), worst {kept['worst_ms']:.1f} ms"
        )
    if output is not None:
        typer.echo(f"written to {output}")


@contextlib.contextmanager
def stop_on_interrupt() -> Iterator[list[int]]:
    """The first Ctrl-C (or SIGTERM) only notes that it came: the list is then not empty; the second stops."""
    stop: list[int] = []
    before: dict[int, Callable[[int, FrameType | None], Any] | int | None] = {}

    def note(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
        stop.append(number)
        signal.signal(signal.SIGINT, signal.default_int_handler)

    for each in (signal.SIGINT, signal.SIGTERM):
        before[each] = signal.signal(each, note)
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
