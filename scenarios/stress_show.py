"""What the terminal shows of a stress campaign."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from scenarios.cases import KINDS
from scenarios.statistics import Estimate
from scenarios.stress import RUNGS, Campaign, Row, quantile
from scenarios.trial import Outcome

WIDEST = 160
"""Columns of a table that goes to a file or a pipe."""
RUNG_WORDS = {
    "waypoint": "a waypoint, all constraints",
    "wide_turn": "a waypoint, turn limit lifted",
    "far": "a waypoint, search limit lifted",
    "close": "a waypoint, tolerance lifted",
    "route": "several waypoints",
    "orbit": "no way known, orbit",
}
"""The ladder for a stranger."""


def progress(outcomes: Iterable[Outcome], campaign: Campaign) -> Iterator[Outcome]:
    """Pass outcomes on with a progress bar on stderr; silent where stderr is not a terminal."""
    from rich.progress import (  # noqa: PLC0415  # noqa: PLC0415
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(bar_width=30),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        TextColumn("{task.fields[bad]}"),
        console=Console(stderr=True),
        transient=True,
        disable=not sys.stderr.isatty(),
    )
    bad = 0
    with bar:
        task = bar.add_task(campaign.kind, total=len(campaign.cases), bad="")
        for outcome in outcomes:
            bad += outcome.failing
            bar.update(task, advance=1, bad=f"{bad} failing" if bad else "")
            yield outcome


def table(rows: Sequence[Row], campaign: Campaign) -> None:
    """Print the figures of a campaign for somebody who has never seen one."""
    kind = KINDS[campaign.kind]
    console = Console()
    if not console.is_terminal:
        console.width = max(console.width, WIDEST)
    console.print(
        f"{campaign.kind}: {kind.words}; {campaign.runs} worlds each, seed {campaign.seed}, "
        f"{campaign.fidelity} vehicle, preset {campaign.parameters.name}, "
        f"planner {campaign.parameters.optimiser}",
        style="bold",
        highlight=False,
    )
    lines = Table(box=None, pad_edge=False)
    lines.add_column("", no_wrap=True)
    for row in rows:
        what = "intruder" if kind.traffic else "obstacle"
        lines.add_column(f"{row.obstacles} {what}{'' if row.obstacles == 1 else 's'}", justify="right")
    columns = [_traffic_column(row) if kind.traffic else _field_column(row) for row in rows]
    for number, name in enumerate(name for name, _ in columns[0]):
        lines.add_row(name, *(column[number][1] for column in columns))
    console.print(lines)
    console.print("Brackets: 95 % intervals (Wilson; risk ratios paired, Bonett and Price).", highlight=False)


def failures(files: Sequence[tuple[Outcome, Path]]) -> None:
    """Print where the failing worlds lie."""
    console = Console()
    if not files:
        console.print("No run failed.", style="bold green")
        return
    console.print(f"{len(files)} failing; each flies again:", style="bold red", highlight=False)
    for outcome, path in sorted(files, key=lambda pair: (pair[0].case.obstacles, pair[0].case.index)):
        console.print(
            f"  sidestep fly {path}   # {outcome.why}", soft_wrap=True, highlight=False, markup=False
        )


def _field_column(row: Row) -> list[tuple[str, str]]:
    lengths = row.figures("length_ratio")
    return [
        ("worlds", str(len(row.outcomes))),
        ("feasible: start not walled in", str(row.feasible)),
        ("completed, no sphere entered", f"{row.successes} of {row.feasible}"),
        *_percent_rows(row.success),
        ("spheres entered", str(sum(o.violations for o in row.outcomes))),
        ("least distance from a sphere", _metres(row.figures("min_margin"))),
        ("flown ÷ shortest safe path, median", _number(quantile(lengths, 50.0, 5), 5)),
        ("  95 % are below", _number(quantile(lengths, 95.0, 5), 5)),
        *_risk_rows("risk of a sphere, with ÷ without", row.risk("loss")),
        *_decisions(row),
    ]


def _traffic_column(row: Row) -> list[tuple[str, str]]:
    added = row.figures("added_path")
    return [
        ("encounters", str(len(row.outcomes))),
        ("completed, 1 km kept", f"{row.successes} of {row.feasible}"),
        *_percent_rows(row.success),
        ("entries below 1 km", str(sum(o.violations for o in row.outcomes))),
        ("least separation", _metres(row.figures("min_separation"))),
        ("path added, median", _number(quantile(added, 50.0, 3), 2, " %")),
        ("  95 % are below", _number(quantile(added, 95.0, 3), 2, " %")),
        *_risk_rows("risk below 1 km, with ÷ without", row.risk("loss")),
        *_risk_rows("  2,000 ft and 250 ft (well clear)", row.risk("well_clear")),
        *_risk_rows("  500 ft and 100 ft (NMAC)", row.risk("nmac")),
        *_decisions(row),
    ]


def _decisions(row: Row) -> list[tuple[str, str]]:
    shares = row.rungs
    return [
        ("route changes in a run, median", _number(quantile(row.figures("replans"), 50.0, 1), 1)),
        *((f"  {RUNG_WORDS[name]}", _percent(shares[name])) for name in RUNGS),
        ("  waypoints replaced a run (apart)", f"{row.per_run('replaced'):.1f}"),
        ("  returns to the leg a run (apart)", f"{row.per_run('resumed'):.1f}"),
        ("time of a decision, median", _number(quantile(row.decision_ms, 50.0, 2), 1, " ms")),
        ("  99 % are below", _number(quantile(row.decision_ms, 99.0, 2), 1, " ms")),
    ]


def _percent_rows(estimate: Estimate) -> list[tuple[str, str]]:
    if estimate.value is None or estimate.low is None or estimate.high is None:
        return [("  share", "–"), ("", "")]
    interval = f"[{100 * estimate.low:.1f}, {100 * estimate.high:.1f}] %"
    return [("  share", f"{100 * estimate.value:.1f} %"), ("", interval)]


def _risk_rows(name: str, estimate: Estimate) -> list[tuple[str, str]]:
    if estimate.value is None or estimate.low is None:
        return [(name, "–"), ("", "")]
    high = "∞" if estimate.high is None else f"{estimate.high:.4f}"
    return [(name, f"{estimate.value:.4f}"), ("", f"[{estimate.low:.4f}, {high}]")]


def _metres(values: Sequence[float]) -> str:
    return f"{min(values):,.1f} m" if values else "–"


def _number(value: float | None, digits: int, unit: str = "") -> str:
    return "–" if value is None else f"{value:.{digits}f}{unit}"


def _percent(value: float | None) -> str:
    return "–" if value is None else f"{100.0 * value:.1f} %"
