"""Table 7: the swarm and two of its variants, by both readings of the fitness."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from avoidance.parameters import PRESETS
from avoidance.search import OPTIMISERS
from scenarios.paper.published import published
from scenarios.paper.searches import CASES, READINGS, iterations, optimum, problem
from scenarios.paper.section import Grid, Head, Section, number
from scenarios.paper.words import words
from scenarios.paper.worlds import Options, with_more
from scenarios.planners import PLANNERS

VARIANTS = ("pso", "gcpso", "mpso")


def section(options: Options) -> Section:
    """The table; quick, so nothing is stored."""
    rows = figures(options)
    heads = (
        Head("case", left=True),
        Head("planner", left=True),
        Head("mean", "printed"),
        Head("median", "printed"),
        *(
            Head(title, f"ours, {name}", ours=True)
            for name in PRESETS
            for title in ("mean", "median", "feasible", "optimum")
        ),
    )
    grids = []
    for reading in READINGS:
        lines = []
        for row in (r for r in rows if r["reading"] == reading):
            cells = [row["case"], PLANNERS[row["planner"]]]
            cells += [number(row["printed"][key], ",.0f") for key in ("mean", "median")]
            for name in PRESETS:
                ours = row[name]
                cells += [number(ours[key], ",.1f") for key in ("mean", "median")]
                cells += [f"{ours['feasible']} of {ours['runs']}", number(ours["optimum"], ",.1f")]
            lines.append(tuple(cells))
        grids.append(Grid(heads, tuple(lines), f"Reading: {reading}"))
    text = words("table7", runs=options.runs)
    return Section("table7", text.title, text.intro, tuple(grids), (), text.remarks, rows)


def figures(options: Options) -> list[dict[str, Any]]:
    """Every case, reading and planner, with the parameters of both presets."""
    printed = {(row.case, row.planner): row for row in published().table7}
    names = VARIANTS if options.own not in OPTIMISERS else with_more(VARIANTS, options.planner)
    rows = []
    for reading in READINGS:
        for case in CASES:
            for planner in names:
                row = printed.get((case, planner))
                paper = {"mean": row.mean if row else None, "median": row.median if row else None}
                rows.append(
                    {"reading": reading, "case": case, "planner": planner, "printed": paper}
                    | {name: _searched(case, reading, planner, name, options.runs) for name in PRESETS}
                )
    return rows


def _searched(case: str, reading: str, planner: str, preset: str, runs: int) -> dict[str, Any]:
    question = problem(case, reading, replace(PRESETS[preset], optimiser=planner))
    ends = []
    for run in range(runs):
        *_, last = iterations(question, np.random.default_rng(run))
        ends.append(last.best)
    found = [value for value in ends if np.isfinite(value)]
    return {
        "mean": float(np.mean(found)) if found else None,
        "median": float(np.median(found)) if found else None,
        "feasible": len(found),
        "runs": runs,
        "optimum": optimum(question),
    }
