"""What the terminal shows while a live vehicle is flown."""

from __future__ import annotations

import math
import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING, Self

from rich.console import Console
from rich.live import Live
from rich.table import Table

from avoidance import Ownship, RadarScan
from offboard.pilot import Frame
from scenarios.show import clock

if TYPE_CHECKING:
    from offboard.live.vehicle import LiveVehicle
    from scenarios.live_flight import LiveFlight

REFRESH = 0.25
"""Wall time between two updates [s]."""
STYLES = {"info": "", "warning": "yellow", "alarm": "bold red"}

_console = Console(stderr=True, highlight=False)


def say(text: str, severity: str = "info") -> None:
    """Print a line on stderr, above the status."""
    prefix = "ALARM: " if severity == "alarm" else ""
    _console.print(prefix + text, style=STYLES[severity], markup=False, soft_wrap=True)


def ending_words(ending: str) -> str | None:
    """Why a flight ended before its mission did; None if it did not."""
    return {
        "link lost": "The link was lost for good; the vehicle flies on along the mission that it has.",
        "disarmed": "The vehicle was disarmed before the end of its mission.",
        "interrupted": "The watch has ended; the vehicle flies on along the mission that it has.",
    }.get(ending)


class LiveStatus:
    """Mode, leg, speed, obstacles, nearest threat, last decision and link, a few times a second.

    Silent where stderr is not a terminal; events are printed by `say` all the same.
    """

    def __init__(self, vehicle: LiveVehicle, flight: LiveFlight, source: str) -> None:
        self._vehicle = vehicle
        self._flight = flight
        self._source = source
        self._next = 0.0
        self._live = Live(console=_console, auto_refresh=False, transient=True)
        self._shown = sys.stderr.isatty()

    def __enter__(self) -> Self:
        say(f"Flying. Obstacles: {self._source}.")
        if self._shown:
            self._live.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._shown:
            self._live.stop()

    def update(self, frame: object) -> None:
        """Show one frame."""
        now = time.monotonic()
        if not self._shown or now < self._next or not isinstance(frame, Frame):
            return
        self._next = now + REFRESH
        self._live.update(self.table(frame), refresh=True)

    def table(self, frame: Frame) -> Table:
        """The status as a table."""
        vehicle, step = self._vehicle, frame.steps[0]
        own = step.state.ownship
        table = Table(box=None, pad_edge=False, show_header=False)
        table.add_column(style="dim")
        table.add_column()
        table.add_row("time", f"{clock(frame.time)}   {vehicle.aboard.clock.rate:.1f} times real time")
        table.add_row(
            "vehicle", f"{vehicle.aboard.mode_name}, {_control(vehicle)}; edit {step.state.edit.value}"
        )
        table.add_row("leg", _leg(vehicle, own))
        table.add_row(
            "motion",
            f"{own.ground_speed:.1f} m/s over ground, {own.altitude:.0f} m, course "
            f"{math.degrees(own.course) % 360.0:.0f} deg, bank {math.degrees(own.bank):.0f} deg",
        )
        table.add_row("obstacles", _nearest(step.scan, own))
        last = self._flight.last_decision
        if last is not None:
            table.add_row(
                "last decision", f"{clock(last.state.time)} {last.decision.name}: {last.decision.why}"
            )
            threat = last.decision.threat
            if threat is not None and last.state.time > own.time - 5.0:
                table.add_row("threat", f"{threat.distance / 1e3:.1f} km ahead, in {threat.time:.0f} s")
        table.add_row("link", _link(vehicle))
        return table


def _control(vehicle: LiveVehicle) -> str:
    """Who flies."""
    if vehicle.watch.lost:
        return "link lost"
    if vehicle.watch.disarmed:
        return "disarmed"
    if vehicle.watch.human:
        return "someone else flies"
    return "on watch" if vehicle.touch else "dry run"


def _leg(vehicle: LiveVehicle, own: Ownship) -> str:
    route, mission = vehicle.route(), vehicle.mission
    if not route.waypoints or mission is None:
        return "none"
    end = route.waypoints[0]
    away = math.hypot(end.north - own.north, end.east - own.east)
    name = "detour" if end.item is None else f"waypoint {end.item + 1} of {len(mission.uploaded)}"
    return f"{name}, {away / 1e3:.1f} km to go; {len(route.waypoints)} ahead"


def _nearest(scan: RadarScan, own: Ownship) -> str:
    if not len(scan.ids):
        return "none in sight"
    away = [math.dist(place, (own.north, own.east, own.altitude)) for place in scan.positions.tolist()]
    nearest = min(range(len(away)), key=away.__getitem__)
    return f"{len(away)} in sight, nearest {int(scan.ids[nearest])} at {away[nearest] / 1e3:.2f} km"


def _link(vehicle: LiveVehicle) -> str:
    records = vehicle.editor.records
    edits = f"{len(records)} edits, {vehicle.editor.fallbacks} fall-backs"
    if dropped := vehicle.aboard.session.dropped:
        edits += f"; {dropped} unsigned or old frames dropped"
    return f"heard {vehicle.silent:.1f} s ago, lost {vehicle.link_losses} times; {edits}"
