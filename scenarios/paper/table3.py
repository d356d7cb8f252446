"""Table 3: how flying time, computing time and length grow with the number of obstacles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from scenarios.compare_flight import Job, Record
from scenarios.paper.published import FieldRow, published
from scenarios.paper.section import Cell, Grid, Head, Section, number
from scenarios.paper.words import words
from scenarios.paper.worlds import Options, field_job
from scenarios.planners import PLANNERS
from scenarios.statistics import wilson

WORDS = {"40+hill": "40 and a hill", "40+moving": "40 and 2 moving"}
HEADS = (
    Head("obstacles", left=True),
    Head("flying time", "paper [min]"),
    Head("flying time", "ours [min]", ours=True),
    Head("algorithm", "paper [s]"),
    Head("algorithm", "ours [s]", ours=True),
    Head("length", "paper [m]"),
    Head("plan length", "ours [m]", ours=True),
    Head("path flown", "ours [m]", ours=True),
    Head("÷ shortest", "flown, of the shortest safe way", ours=True),
    Head("added", "paper [m]"),
    Head("added", "ours [m]", ours=True),
    Head("safe", "ours, where a way exists", ours=True),
    Head("share", "95 % Wilson", ours=True),
)
CLEAR = "0"
"""The row without obstacles: no world differs, so one run says all."""


def runs_of(row: FieldRow, options: Options) -> int:
    """Runs of a row."""
    return 1 if row.obstacles == CLEAR else options.runs


def jobs(options: Options) -> list[Job]:
    """All flights of the table."""
    return [
        field_job(options, row.obstacles, index, options.own)
        for row in published().table3
        for index in range(runs_of(row, options))
    ]


def section(options: Options, records: Mapping[str, Record]) -> Section:
    """The table, ours beside the paper's."""
    rows = []
    for row in published().table3:
        names = [field_job(options, row.obstacles, i, options.own).name for i in range(runs_of(row, options))]
        rows.append((row, _figures([records[name] for name in names])))
    clear = rows[0][1]["plan_length_m"]
    empty = published().table3[0].path_length_m
    lines = tuple(
        (
            WORDS.get(row.obstacles, row.obstacles),
            number(row.flight_min, ".2f"),
            number(ours["flight_min"], ".2f"),
            number(row.algorithm_s, ".1f"),
            number(ours["algorithm_s"], ".2f"),
            number(row.path_length_m),
            number(ours["plan_length_m"]),
            number(ours["path_length_m"]),
            number(ours["length_ratio"], ".4f"),
            number(row.path_length_m - empty),
            number(None if ours["plan_length_m"] is None else ours["plan_length_m"] - clear),
            _success(ours),
            f"[{100 * ours['success']['low']:.0f}, {100 * ours['success']['high']:.0f}] %",
        )
        for row, ours in rows
    )
    text = words(
        "table3",
        runs=options.runs,
        fidelity=options.fidelity,
        planner=PLANNERS[options.own],
        preset=options.preset,
        reach=f"{options.parameters.acceptance_radius:,.0f} m",
    )
    data = [{"obstacles": row.obstacles, "paper": _printed(row), "ours": ours} for row, ours in rows]
    return Section("table3", text.title, text.intro, (Grid(HEADS, lines),), (), text.remarks, data)


def _printed(row: FieldRow) -> dict[str, float | None]:
    return {
        "flight_min": row.flight_min,
        "algorithm_s": row.algorithm_s,
        "path_length_m": row.path_length_m,
    }


def _figures(records: Sequence[Record]) -> dict[str, Any]:
    able = [record for record in records if record["feasible"]]
    safe = [record for record in able if record["safe"]]
    share = wilson(len(safe), len(able))
    best = [r for r in safe if r["summary"]["optimum_length_m"]]
    return {
        "runs": len(records),
        "feasible": len(able),
        "successes": len(safe),
        "success": {"value": share.value, "low": share.low or 0.0, "high": share.high or 1.0},
        "flight_min": mean([r["summary"]["flight_time_s"] / 60.0 for r in safe]),
        "algorithm_s": mean([r["algorithm_s"] for r in safe]),
        "plan_length_m": mean([r["summary"]["plan_length_m"] for r in safe]),
        "path_length_m": mean([r["summary"]["path_length_m"] for r in safe]),
        "length_ratio": mean(
            [r["summary"]["path_length_m"] / r["summary"]["optimum_length_m"] for r in best]
        ),
        "min_margin_m": min(
            (r["summary"]["min_margin_m"] for r in records if r["summary"]["min_margin_m"] is not None),
            default=None,
        ),
        "waypoints_replaced": mean([float(r["summary"]["waypoints_replaced"]) for r in records]),
    }


def _success(ours: Mapping[str, Any]) -> Cell:
    done, able = ours["successes"], ours["feasible"]
    return Cell(f"{done} of {able}", "good" if done == able else "bad")


def mean(values: Sequence[float]) -> float | None:
    """Mean of some figures; None of none."""
    return float(np.mean(values)) if values else None
