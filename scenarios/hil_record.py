"""What a run in the loop leaves: the track, what happened, and a summary."""

from __future__ import annotations

import csv
import io
import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from offboard.hil.attitude import euler
from offboard.hil.faults import Fault
from offboard.hil.plant import Axes, Phase, Truth
from scenarios.errors import RunDirectoryError

PERIOD = 0.1
"""Between two lines of the track [s]."""
COLUMNS = (
    "t_s", "phase", "north_m", "east_m", "altitude_m", "velocity_north_m_s", "velocity_east_m_s", "climb_m_s",
    "airspeed_m_s", "bank_deg", "pitch_deg", "heading_deg", "roll", "pitch", "yaw", "throttle",
)  # fmt: skip


@dataclass(slots=True)
class HilRecorder:
    """Watches a simulation: the track at 10 Hz, and events."""

    faults: tuple[Fault, ...] = ()
    """Failures that were asked for."""
    rows: list[tuple[Any, ...]] = field(default_factory=list)
    """Lines of the track."""
    events: list[dict[str, Any]] = field(default_factory=list)
    """What happened, in order."""
    highest: float = 0.0
    """Above home [m]."""
    steepest: float = 0.0
    """Largest bank [rad]."""
    _phase: Phase | None = None
    _last: Truth | None = None
    _next: float = 0.0
    _active: frozenset[Fault] = frozenset()

    def __call__(self, truth: Truth, phase: Phase, axes: Axes) -> None:
        """One step of the plant."""
        if self._last is not None and truth.time < self._last.time:
            self._event(truth, "restart")
            self._next, self._phase = 0.0, None
        if phase is not self._phase:
            self._change(truth, phase)
        if self.faults:
            self._note_faults(truth)
        self._last = truth
        if truth.time >= self._next:
            self._next = truth.time + PERIOD - 1e-9
            self._sample(truth, phase, axes)

    def summary(self, counts: object) -> dict[str, Any]:
        """Figures of the run; `counts` is what came over the link."""
        touchdowns = [event for event in self.events if event["event"] == "landed"]
        return {
            "flight_time_s": round(self._last.time, 3) if self._last else 0.0,
            "phase": self._phase.name.lower() if self._phase is not None else None,
            "highest_m": round(self.highest, 3),
            "largest_bank_deg": round(math.degrees(self.steepest), 2),
            "contact_speed_m_s": touchdowns[-1].get("contact_speed_m_s") if touchdowns else None,
            "restarts": sum(event["event"] == "restart" for event in self.events),
            "link": {name: getattr(counts, name) for name in getattr(counts, "__slots__", ())},
        }

    def write(self, directory: Path, summary: dict[str, Any], prefix: str = "") -> None:
        """Write `track.csv`, `events.jsonl` and `summary.json`, with a prefix where they join another run's.

        Raises
        ------
        RunDirectoryError
            If they cannot be written; without a prefix also if the directory holds anything.
        """
        if not prefix:
            check_directory(directory)
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(self.rows)
        try:
            directory.mkdir(parents=True, exist_ok=True)
            (directory / f"{prefix}track.csv").write_text(text.getvalue(), encoding="utf-8")
            lines = "".join(json.dumps(event) + "\n" for event in self.events)
            (directory / f"{prefix}events.jsonl").write_text(lines, encoding="utf-8")
            (directory / f"{prefix}summary.json").write_text(
                json.dumps(summary, indent=2) + "\n", encoding="utf-8"
            )
        except OSError as error:
            raise RunDirectoryError(directory, f"cannot be written ({error})") from error

    def _change(self, truth: Truth, phase: Phase) -> None:
        details: dict[str, Any] = {}
        if phase is Phase.LANDED and self._last is not None:
            details["contact_speed_m_s"] = round(max(self._last.velocity_down, 0.0), 3)
        self._event(truth, phase.name.lower(), **details)
        self._phase = phase

    def _note_faults(self, truth: Truth) -> None:
        active = frozenset(fault for fault in self.faults if fault.active(truth.time))
        for fault in sorted(active ^ self._active, key=lambda each: each.name):
            self._event(truth, f"{fault.name} {'begins' if fault in active else 'ends'}")
        self._active = active

    def _sample(self, t: Truth, phase: Phase, axes: Axes) -> None:
        bank, pitch, heading = euler(t.qw, t.qx, t.qy, t.qz)
        self.highest = max(self.highest, t.altitude)
        self.steepest = max(self.steepest, abs(bank))
        angles = (math.degrees(bank), math.degrees(pitch), math.degrees(heading) % 360.0)
        numbers = (
            t.north, t.east, t.altitude, t.velocity_north, t.velocity_east, -t.velocity_down, t.airspeed,
            *angles, *axes,
        )  # fmt: skip
        self.rows.append((f"{t.time:.3f}", phase.name.lower(), *(f"{number:.3f}" for number in numbers)))

    def _event(self, truth: Truth, event: str, **details: Any) -> None:  # noqa: ANN401
        self.events.append({"t_s": round(truth.time, 3), "event": event} | details)


def check_directory(directory: Path) -> None:
    """Make sure, before the flight, that nothing would be overwritten.

    Raises
    ------
    RunDirectoryError
        If the directory exists and is not empty, or is a file.
    """
    if directory.is_file():
        raise RunDirectoryError(directory, "is a file")
    if directory.is_dir() and any(directory.iterdir()):
        raise RunDirectoryError(directory, "is not empty; it is left alone")
