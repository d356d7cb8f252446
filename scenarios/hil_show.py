"""What a run in the loop shows on the terminal: a status line, where the time goes, what was found."""

from __future__ import annotations

import math
import sys
import time
from typing import Any

from offboard.hil.attitude import euler
from offboard.hil.simulation import Simulation
from offboard.hil.timing import PARTS, Punctuality, Timing
from scenarios.hil_self_test import SelfTest

_REFRESH = 0.5
_NAMES = {
    "plant": "FMU (write, step, read)",
    "sensors": "sensors (noise, GPS, compass)",
    "protocol": "protocol (pack, parse)",
    "transport": "transport (sockets)",
    "autopilot": "autopilot (scripted, or waited for)",
}


class Status:
    """One line that tells how the flight goes; lines of its own where it is no terminal, once a minute."""

    def __init__(self, simulation: Simulation, *, quiet: bool = False) -> None:
        self._simulation = simulation
        self._quiet = quiet
        self._terminal = sys.stderr.isatty()
        self._period = _REFRESH if self._terminal else 60.0
        self._next = 0.0
        self._seen = (time.monotonic(), 0)

    def update(self, extra: str = "") -> None:
        """Show what is so now, if it is time to."""
        now = time.monotonic()
        if self._quiet or now < self._next:
            return
        self._next = now + self._period
        before, steps = self._seen
        self._seen = (now, self._simulation.timing.steps)
        rate = (self._simulation.timing.steps - steps) / (now - before) if now > before and steps else 0.0
        line = f"{status_text(self._simulation)}  {rate:,.0f} steps/s  {extra}"
        sys.stderr.write(f"\r\x1b[K{line}" if self._terminal else line + "\n")
        sys.stderr.flush()

    def close(self) -> None:
        """Leave the line as it is."""
        if self._terminal and not self._quiet:
            sys.stderr.write("\n")


def status_text(simulation: Simulation) -> str:
    """Time, phase and motion in words."""
    t = simulation.truth
    bank, pitch, heading = (math.degrees(angle) for angle in euler(t.qw, t.qx, t.qy, t.qz))
    return (
        f"t {t.time:7.1f} s  {simulation.phase.name.lower():<9}  {t.altitude:6.1f} m  {t.airspeed:4.1f} m/s  "
        f"hdg {heading % 360.0:3.0f}°  bank {bank:+4.0f}°  pitch {pitch:+4.0f}°  "
        f"throttle {100 * simulation.axes.throttle:3.0f} %"
    )


def self_test_table(found: SelfTest) -> None:
    """Print the timing and the findings."""
    from rich.table import Table  # noqa: PLC0415

    console = _console()
    table = Table(box=None, pad_edge=False)
    table.add_column("part of a step", no_wrap=True)
    table.add_column("µs", justify="right")
    table.add_column("share", justify="right")
    for name, microseconds, share in split(found.timing):
        table.add_row(name, f"{microseconds:.1f}", f"{100 * share:.0f} %")
    console.print(table, highlight=False)
    steps = found.timing.steps
    console.print(
        f"{found.simulated:g} s simulated, {steps:,} steps, in {found.wall:.1f} s "
        f"({steps / found.wall:,.0f} steps/s) and {found.processor:.1f} s of processor time",
        highlight=False,
    )
    console.print()
    table = Table(box=None, pad_edge=False, show_header=False)
    for check in found.checks:
        verdict = "[green]passed[/]" if check.passed else "[bold red]FAILED[/]"
        table.add_row(check.name, verdict, check.seen)
    console.print(table, highlight=False)


def split(timing: Timing) -> list[tuple[str, float, float]]:
    """Part, microseconds per step, share of the whole; parts that took no time are left out."""
    steps, total = max(timing.steps, 1), timing.total or 1.0
    rows = [(_NAMES[part], timing.seconds[part]) for part in PARTS]
    return [(name, 1e6 * seconds / steps, seconds / total) for name, seconds in rows if seconds > 0.0]


def self_test_json(found: SelfTest) -> dict[str, Any]:
    """The same for a program."""
    return {
        "passed": found.passed,
        "simulated_s": found.simulated,
        "wall_s": found.wall,
        "processor_s": found.processor,
        "steps": found.timing.steps,
        "steps_per_s": found.timing.steps / found.wall,
        "us_per_step": {part: 1e6 * s / found.timing.steps for part, s in found.timing.seconds.items()},
        "real_time": None if found.punctuality is None else punctuality_json(found.punctuality),
        "stolen_s": found.stolen,
        "checks": [{"name": c.name, "passed": c.passed, "seen": c.seen} for c in found.checks],
    }


def punctuality_json(kept: Punctuality) -> dict[str, Any]:
    """How real time was kept."""
    return {
        "steps": kept.steps,
        "late": kept.late,
        "late_share": kept.late_share,
        "worst_ms": 1e3 * kept.worst,
        "resynchronised": kept.resynchronised,
    }


def _console() -> Any:  # noqa: ANN401  (rich is imported late)
    from rich.console import Console  # noqa: PLC0415

    console = Console()
    if not console.is_terminal:
        console.width = 140  # a file or a pipe has no width of its own
    return console
