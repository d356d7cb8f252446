"""Tables 5 and 6: four planners through the same random worlds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from scenarios.compare_flight import Job, Record
from scenarios.paper.published import PlannerRow, published
from scenarios.paper.section import Cell, Grid, Head, Section, number
from scenarios.paper.sfdrp import Verdict, ranking
from scenarios.paper.words import words
from scenarios.paper.worlds import Options, field_job
from scenarios.planners import PLANNERS
from scenarios.statistics import wilson

COUNTS = (40, 60, 80, 100)
"""Obstacles of each scenario."""
SHOWN = {"better": "dom-better", "equivalent": "dom-equal", "worse": "dom-worse"}


def jobs(options: Options) -> list[Job]:
    """All flights of both tables; PSO's are those of Table 3."""
    return [job for count in COUNTS for name in options.planners for job in _row(options, count, name)]


def table6(options: Options, records: Mapping[str, Record]) -> Section:
    """Table 6."""
    printed = {(row.obstacles, row.planner): row for row in published().table6}
    corners = np.array([point[:2] for point in published().mission], dtype=np.float64)
    straight = float(np.hypot(*(corners[-1] - corners[0])))
    rows = []
    for count in COUNTS:
        for name in options.planners:
            flown = [records[job.name] for job in _row(options, count, name)]
            rows.append((count, name, printed.get((count, name)), _figures(flown, straight)))
    heads = (
        Head("obstacles"),
        Head("planner", left=True),
        Head("PLR", "paper"),
        Head("PLR", "ours, as defined", ours=True),
        Head("÷ shortest", "path flown, of the shortest safe way", ours=True),
        Head("TC", "paper [s]"),
        Head("TC", "ours [s]", ours=True),
        Head("CS", "paper"),
        Head("CS", "ours", ours=True),
        Head("SR", "paper, of 10"),
        Head("SR", "ours", ours=True),
        Head("share", "95 % Wilson interval", ours=True),
    )
    empty = float(np.hypot(*np.diff(corners, axis=0).T).sum()) / straight
    text = words(
        "table6",
        runs=options.runs,
        fidelity=options.fidelity,
        preset=options.preset,
        straight=f"{straight:,.0f}",
        empty=f"{empty:.3f}",
    )
    data = [
        {"obstacles": count, "planner": name, "paper": _printed(row), "ours": ours}
        for count, name, row, ours in rows
    ]
    grid = Grid(heads, tuple(_line(*row) for row in rows))
    return Section("table6", text.title, text.intro, (grid,), (), text.remarks, data)


def table5(options: Options, records: Mapping[str, Record]) -> Section:
    """Table 5."""
    grids, data = [], []
    for letter, count in zip("abcd", COUNTS, strict=True):
        outcomes = {
            name: [_objectives(records[job.name]) for job in _row(options, count, name)]
            for name in options.planners
        }
        verdicts = ranking(outcomes)
        grids.append(_matrix(f"({letter}) {count} obstacles", options.planners, verdicts))
        data += [
            {"obstacles": count, "row": a, "column": b, "verdict": verdict.word, "p_value": verdict.p_value}
            for (a, b), verdict in verdicts.items()
        ]
    text = words("table5")
    return Section("table5", text.title, text.intro, tuple(grids), (), text.remarks, data)


def _row(options: Options, count: int, planner: str) -> list[Job]:
    return [field_job(options, str(count), index, planner) for index in range(options.runs)]


def _objectives(record: Record) -> tuple[float, float, float]:
    """What a run is ranked by, smaller is better; lengths to 1e-4 and distances to 1 m, or noise decides."""
    summary = record["summary"]
    optimum = summary["optimum_length_m"] or summary["path_length_m"]
    margin = 0.0 if summary["min_margin_m"] is None else summary["min_margin_m"]
    failed = float(not record["safe"])
    return failed, round(summary["path_length_m"] / optimum, 4), -round(margin, 0)


def _figures(records: Sequence[Record], straight: float) -> dict[str, Any]:
    able = [record for record in records if record["feasible"]]
    safe = [record for record in able if record["safe"]]
    share = wilson(len(safe), len(able))
    rungs: Counter[str] = Counter()
    for record in records:
        rungs.update(c["rung"] for c in record["changes"] if c["decision"] not in ("replace", "resume"))
    met = [s["first_feasible"] for r in safe for s in r["searches"] if s["first_feasible"] is not None]
    return {
        "runs": len(records),
        "feasible": len(able),
        "successes": len(safe),
        "success": {"value": share.value, "low": share.low, "high": share.high},
        "plr": _mean([r["summary"]["plan_length_m"] / straight for r in safe]),
        "length_ratio": _mean(
            [
                r["summary"]["path_length_m"] / r["summary"]["optimum_length_m"]
                for r in safe
                if r["summary"]["optimum_length_m"]
            ]
        ),
        "time_s": _mean([r["algorithm_s"] for r in safe]),
        "cs": _mean([float(value) for value in met]),
        "searches": len([s for r in safe for s in r["searches"]]),
        "rungs": dict(rungs),
        "replans": _mean([float(r["summary"]["replans"]) for r in safe]),
    }


def _printed(row: PlannerRow | None) -> dict[str, float] | None:
    if row is None:
        return None
    return {"plr": row.plr, "time_s": row.time_s, "cs": row.cs, "successes": row.successes}


def _line(count: int, name: str, row: PlannerRow | None, ours: Mapping[str, Any]) -> tuple[str | Cell, ...]:
    success, able = ours["successes"], ours["feasible"]
    share = ours["success"]
    interval = "–" if share["low"] is None else f"[{100 * share['low']:.0f}, {100 * share['high']:.0f}] %"
    return (
        str(count),
        PLANNERS[name],
        number(None if row is None else row.plr, ".2f"),
        number(ours["plr"], ".3f"),
        number(ours["length_ratio"], ".4f"),
        number(None if row is None else row.time_s, ".1f"),
        number(ours["time_s"], ".2f"),
        number(None if row is None else row.cs, ".2f"),
        number(ours["cs"], ".2f"),
        number(None if row is None else row.successes),
        Cell(f"{success} of {able}", "good" if success == able else "bad"),
        interval,
    )


def _matrix(title: str, names: Sequence[str], verdicts: Mapping[tuple[str, str], Verdict]) -> Grid:
    short = {name: PLANNERS[name].replace(" (our reading)", "") for name in names}
    lines = []
    for a in names:
        cells: list[str | Cell] = [short[a]]
        for b in names:
            if a == b:
                cells.append(Cell("", "dom-self"))
                continue
            verdict = verdicts[a, b]
            p_value = "p < 0.001" if verdict.p_value < 0.001 else f"p = {verdict.p_value:.3f}"
            cells.append(Cell(f"{verdict.word}, {p_value}", SHOWN[verdict.word]))
        lines.append(tuple(cells))
    heads = (Head("row against column", left=True), *(Head(short[name]) for name in names))
    return Grid(heads, tuple(lines), title)


def _mean(values: Sequence[float]) -> float | None:
    return float(np.mean(values)) if values else None
