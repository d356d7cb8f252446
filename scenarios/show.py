"""What the terminal shows: scenarios, progress, results."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Iterable, Sequence
from itertools import pairwise
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Self

from rich.console import Console
from rich.table import Table

from avoidance import Ownship, Route
from offboard.pilot import Frame
from scenarios.scenario import Scenario

if TYPE_CHECKING:
    from scenarios.flown import Flown
    from scenarios.recorded import Recorded
    from scenarios.replay import Event
    from scenarios.run import Flight
    from scenarios.score import Score

REFRESH = 0.1
"""Wall time between two updates of the progress bar [s]."""


def scenario_table(scenarios: Sequence[Scenario]) -> None:
    """Print the catalogue."""
    table = Table(box=None, pad_edge=False)
    table.add_column("scenario", style="bold")
    table.add_column("obstacles", justify="right")
    table.add_column("legs", justify="right")
    table.add_column("what it is")
    for scenario in scenarios:
        count = len(scenario.obstacles) + len(scenario.traffic) + len(scenario.vehicles[1:])
        shown = str(count) if scenario.random is None else f"{count + scenario.random.count} drawn"
        table.add_row(scenario.name, shown, str(len(scenario.mission) - 1), scenario.description)
    Console().print(table)


class Progress:
    """A progress bar on stderr; silent where stderr is not a terminal."""

    def __init__(self, scenario: Scenario) -> None:
        from rich.progress import BarColumn, TextColumn, TimeRemainingColumn  # noqa: PLC0415
        from rich.progress import Progress as Bar  # noqa: PLC0415

        points = scenario.mission
        self._total = sum(math.dist((a.north, a.east), (b.north, b.east)) for a, b in pairwise(points))
        self._bar = Bar(
            TextColumn("{task.description}"),
            BarColumn(bar_width=20),
            TextColumn("{task.fields[flown]}"),
            TimeRemainingColumn(),
            TextColumn("{task.fields[last]}"),
            console=Console(stderr=True),
            transient=True,
            disable=not sys.stderr.isatty(),
        )
        self._task = self._bar.add_task(scenario.name, total=self._total, flown="", last="")
        self._next = 0.0

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    def update(self, frame: Frame, flight: Flight) -> None:
        """Show simulated time, distance and the last decision, ten times a second at most."""
        now = time.perf_counter()
        if self._bar.disable or now < self._next:
            return
        self._next = now + REFRESH
        done = max(self._total - _remaining(frame.steps[0].state.ownship, flight.vehicle.route()), 0.0)
        last = flight.last_decision
        self._bar.update(
            self._task,
            completed=done,
            flown=f"{clock(frame.time)}  {done / 1e3:6.1f} of {self._total / 1e3:.1f} km",
            last="" if last is None else f"{clock(last.state.time)} {last.decision.name}",
        )


def results(flown: Flown, score: Score, directory: Path) -> None:
    """Print the verdict and the figures of a flight, in words."""
    summary = score.summary
    console = Console()
    console.print(_verdict(flown, score), style="bold green" if score.safe else "bold red")
    table = Table(box=None, pad_edge=False, show_header=False)
    table.add_column()
    table.add_column(justify="right")
    table.add_column()
    for row in _rows(flown, score):
        table.add_row(*row)
    console.print(table)
    if len(score.vehicles) > 1:
        console.print(_fleet(score))
    wall = f"{summary['wall_s']:.1f} s of wall time, {summary['real_time_factor'] or 0:.0f} times real time"
    print(f"Simulated in {wall}. Everything about the flight: {directory}")
    if (directory / "report.html").is_file():
        print(f"Open {directory / 'report.html'} in a browser.")


def play(events: Iterable[Event], speed: float) -> None:
    """Print events one by one, at `speed` times real time; all at once if that is 0."""
    console = Console()
    last = 0.0
    for event in events:
        if speed > 0.0:
            time.sleep(max(event.time - last, 0.0) / speed)
            last = event.time
        where = f"{event.distance / 1e3:7.1f} km"
        console.print(
            f"{clock(event.time)}  {where}  {event.text}",
            style=event.style,
            soft_wrap=True,
            highlight=False,
            markup=False,
        )


def verdict_of_replay(runs: Sequence[Recorded], differences: Sequence[str]) -> None:
    """Print whether the figures of a run follow from its files."""
    console = Console()
    if not differences:
        count = sum(len(run.track.times) for run in runs)
        console.print(
            f"All figures of summary.json follow from the files ({count} samples).", style="bold green"
        )
        return
    console.print("summary.json does not agree with the files:", style="bold red")
    for line in differences:
        print(f"  {line}")


def clock(seconds: float) -> str:
    """Hours, minutes, seconds."""
    whole = round(seconds)
    return f"{whole // 3600}:{whole // 60 % 60:02d}:{whole % 60:02d}"


def _remaining(own: Ownship, route: Route) -> float:
    """Length of the way still to be flown [m]."""
    total, here = 0.0, (own.north, own.east)
    for waypoint in route.waypoints:
        there = (waypoint.north, waypoint.east)
        total += math.dist(here, there)
        here = there
    return total


def _verdict(flown: Flown, score: Score) -> str:
    violations = score.summary["violations"]
    parts = []
    if flown.ending == "interrupted":
        parts.append("Interrupted: the mission was not completed.")
    elif flown.ending == "time limit":
        parts.append(f"Not completed: the time limit of {clock(flown.scenario.limit)} was reached.")
    elif not score.summary["completed"]:
        for vehicle in score.vehicles:
            of = "" if len(score.vehicles) == 1 else f" of {vehicle.name}"
            for moved, words in (
                (False, "was not passed although it could be reached"),
                (True, "cannot be reached, and the nearest place to it that can was not passed either"),
            ):
                fates = [fate for fate in vehicle.fates if not fate.met and fate.goal.replaced is moved]
                if fates:
                    missed = ", ".join(str(fate.goal.waypoint + 1) for fate in fates)
                    parts.append(f"Not completed: waypoint {missed}{of} {words}.")
    if violations:
        times = "once" if violations == 1 else f"{violations} times"
        parts.append(f"A safety sphere was entered {times}.")
    if score.summary.get("fence_breaches"):
        times = score.summary["fence_breaches"]
        parts.append(f"The geofence was left {'once' if times == 1 else f'{times} times'}.")
    if not parts:
        parts.append("Flown safely: the mission was completed and no safety sphere entered.")
    if score.summary["reserve_used"]:
        parts.append("The battery's reserve was used.")
    return " ".join(parts)


def _rows(flown: Flown, score: Score) -> list[tuple[str, str, str]]:
    summary = score.summary
    reach = flown.performance.acceptance_radius
    rows = [
        ("flight time", clock(summary["flight_time_s"]), ""),
        (
            "path flown",
            f"{summary['path_length_m']:,.0f} m",
            f"waypoints count as reached within {reach:.0f} m",
        ),
        ("shortest safe way", *_optimum(summary)),
        ("mission as finally flown", f"{summary['plan_length_m']:,.0f} m", "waypoint to waypoint"),
    ]
    if summary["min_separation_m"] is not None:
        radius = summary["violation_radius_m"]
        nearest = f"to obstacle {summary['closest_obstacle']}, whose sphere has {radius:,.0f} m"
        rows.append(("closest approach", f"{summary['min_separation_m']:,.1f} m", nearest))
        margin = "outside every sphere" if summary["min_margin_m"] >= 0.0 else "inside a sphere"
        rows.append(("least margin", f"{summary['min_margin_m']:,.1f} m", margin))
    of = f"of {len(score.separations)} obstacles" if len(score.vehicles) == 1 else "all vehicles together"
    rows.append(("spheres entered", str(summary["violations"]), of))
    rows.append(
        ("changes of the route", str(summary["replans"]), "" if flown.avoidance else "avoidance was off")
    )
    rows.append(("waypoints replaced", str(summary["waypoints_replaced"]), "by the nearest safe point"))
    if summary["state_of_charge"] is not None:
        told = "the reserve was used" if summary["reserve_used"] else "the reserve was not touched"
        rows.append(("battery at the end", f"{100.0 * summary['state_of_charge']:.0f} %", told))
    if summary["decision_ms"]["median"] is not None:
        longest = f"99 % took less than {summary['decision_ms']['p99']:.1f} ms"
        rows.append(
            ("time of a decision", f"{summary['decision_ms']['median']:.1f} ms", f"median; {longest}")
        )
    return rows


def _fleet(score: Score) -> Table:
    """What became of each of several own vehicles."""
    table = Table(box=None, pad_edge=False)
    table.add_column("vehicle", style="bold")
    for title in ("mission", "entries", "closest approach", "path flown", "÷ shortest", "route changes"):
        table.add_column(title, justify="right")
    for vehicle in score.vehicles:
        s = vehicle.figures
        near, best = s["min_separation_m"], s["optimum_length_m"]
        table.add_row(
            vehicle.name,
            "completed" if s["completed"] else "not completed",
            str(s["violations"]),
            "–" if near is None else f"{near:,.1f} m",
            f"{s['path_length_m']:,.0f} m",
            "–" if not best else f"{s['path_length_m'] / best:.5f}",
            str(s["replans"]),
        )
    return table


def _optimum(summary: dict[str, float]) -> tuple[str, str]:
    optimum = summary["optimum_length_m"]
    if optimum is None:
        return "none", "no way is free of all spheres"
    return f"{optimum:,.0f} m", f"the flown path is {summary['path_length_m'] / optimum:.5f} of it"
