"""The report of a run: one HTML file that needs no network, written from the run's directory alone."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping, Sequence
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import Any

from scenarios.recorded import read_fleet
from scenarios.report_data import Run, shown
from scenarios.report_figures import Figure, flight_over_time, separation_over_time
from scenarios.report_geometry import Encounter, Pass, encounters, nearest, passes
from scenarios.report_maps import encounter_view, map_key, stretch, top_view
from scenarios.report_text import (
    decision_table,
    doubts,
    encounter_title,
    fleet_table,
    key_figures,
    origin,
    page_name,
    verdict,
)

MOST_PANELS = 12
"""More encounters than this are not drawn; the closest ones are."""


def write_report(directory: Path) -> Path:
    """Write `report.html` into a run directory; of several own vehicles the others get pages beside it.

    Parameters
    ----------
    directory : Path
        A run directory: summary.json, scenario.toml, track.csv, obstacles.csv, traffic.csv and
        decisions.jsonl are read.

    Returns
    -------
    Path
        The first vehicle's page; each file is complete or was not touched.

    Raises
    ------
    RunDirectoryError
        If a file is missing or cannot be understood; names it.
    """
    runs = [shown(recorded) for recorded in read_fleet(Path(directory))]
    paths = [Path(directory) / page_name(run.vehicle, number) for number, run in enumerate(runs)]
    for path, run in zip(paths, runs, strict=True):
        _write_page(path, render(run))
    return paths[0]


def _write_page(path: Path, page: str) -> None:
    unfinished = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        unfinished.write_text(page, encoding="utf-8")
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)


def render(run: Run) -> str:
    """The page as text."""
    from plotly.offline import get_plotlyjs  # noqa: PLC0415 (reads 5 MB; only a report needs it)

    closest = passes(run)
    groups = encounters(run, closest)
    shown = _shown(groups)
    plots: dict[str, Figure] = {"top-view": top_view(run)}
    plots |= {f"encounter-{i}": encounter_view(run, g) for i, g in enumerate(shown, start=1)}
    over_time = separation_over_time(run, nearest(run), closest)
    if over_time is not None:
        plots["separation"] = over_time
    plots["flight"] = flight_over_time(run)
    tone, headline, sentence = verdict(run)
    return _filled(
        (files("scenarios") / "report_page.html").read_text(encoding="utf-8"),
        {
            "title": escape(f"{headline}: {run.scenario.name}"),
            "tone": tone,
            "verdict": escape(headline),
            "sentence": escape(sentence),
            "origin": escape(origin(run)),
            "doubts": doubts(run),
            "fleet": fleet_table(run),
            "figures": key_figures(run),
            "scale": _scale(run),
            "key": map_key(run),
            "encounters_intro": _intro(groups, shown),
            "encounters": "\n".join(_panel(i, g) for i, g in enumerate(shown, start=1)),
            "separation": _separation(over_time),
            "decisions": decision_table(run),
            "run_data": _script(_counts(run, shown, closest)),
            "plots": _script(plots),
            "plotly": get_plotlyjs(),
        },
    )


def _shown(groups: Sequence[Encounter]) -> list[Encounter]:
    """The closest encounters, in order of time."""

    def margin(group: Encounter) -> float:
        return group.tightest.margin if group.tightest else float("inf")

    return sorted(sorted(groups, key=margin)[:MOST_PANELS], key=lambda g: g.start)


def _intro(groups: Sequence[Encounter], shown: Sequence[Encounter]) -> str:
    if not groups:
        return "There was none: no decision was taken, and nothing came within 1 km of a safety sphere."
    text = (
        "A kilometre is as long north as east here, so circles are round. A thin line joins the aircraft to "
        "the obstacle at the moment of the closest pass, with the distance between them; numbers beside the "
        "diamonds are those of the decision table. Drag to look closer, double-click to go back."
    )
    left = len(groups) - len(shown)
    return text + (f" The {len(shown)} closest are shown; {left} more are left out." if left else "")


def _panel(number: int, group: Encounter) -> str:
    title, text = encounter_title(group)
    return (
        f'<figure class="encounter"><h3>{number}. {escape(title)}</h3><p class="soft">{escape(text)}</p>'
        f'<div class="plot" id="encounter-{number}" role="img" aria-label="{escape(title)}"></div></figure>'
    )


def _scale(run: Run) -> str:
    factor = stretch(run)
    if factor == 1.0:
        return "A kilometre is as long north as east."
    long, short = ("east", "north") if factor > 1.0 else ("north", "east")
    times = max(factor, 1.0 / factor)
    return (
        f"<strong>Stretched: a kilometre {long} is drawn {times:g} times as long as a kilometre {short}"
        "</strong>, or the flight would be a thin line. So circles look like flat ellipses here; "
        "the close-ups below are true to scale."
    )


def _separation(figure: Figure | None) -> str:
    if figure is None:
        return "<p>There was no obstacle and no traffic in this world.</p>"
    return (
        "<p>At every instant, the distance in three dimensions to whatever safety sphere was nearest (blue), "
        "and that sphere's radius (orange area), which must never be entered. What lies beyond the upper "
        "edge is far away; double-click to see all.</p>\n"
        '<div class="plot" id="separation" role="img" '
        'aria-label="Distance to the nearest obstacle over time"></div>'
    )


def _counts(run: Run, shown: Sequence[Encounter], closest: Sequence[Pass]) -> Mapping[str, Any]:
    """What a script can check against the files and against what plotly drew."""
    return {
        "spheres": len(run.hazards),
        "waypoints": sum(len(mark.waypoints) for mark in run.decisions),
        "decisions": len(run.decisions),
        "encounters": len(shown),
        "min_separation_m": round(min(p.distance for p in closest), 3) if closest else None,
        "min_margin_m": round(min(p.margin for p in closest), 3) if closest else None,
        "summary": run.summary,
    }


def _script(value: object) -> str:
    """JSON that may stand inside a script element."""
    text = json.dumps(value, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _filled(template: str, values: Mapping[str, str]) -> str:
    return re.sub(r"\{\{(\w+)\}\}", lambda match: values[match[1]], template)
