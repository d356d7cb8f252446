"""Figs. 24 and 25: fitness of the particles of one iteration, and the best by iteration."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from avoidance.parameters import PRESETS, Parameters
from avoidance.search import OPTIMISERS
from scenarios.compare_maps import COLOURS
from scenarios.paper.searches import READINGS, Iteration, iterations, optimum, problem
from scenarios.paper.section import Plot, Section
from scenarios.paper.words import words
from scenarios.paper.worlds import Options
from scenarios.report_figures import Figure, Trace, layout_of

CASE = "obstacle 2"
SHOWN_ITERATION = 3
"""Of Fig. 24; the seeds are iteration 0."""
LENGTHS = (10, 20, 30)
"""Iterations of Fig. 25 (a), (b) and (c)."""
GAMMA = 100.0
"""γ of Eq. (31), as the paper has it."""
OPTIMUM = "#111111"


@dataclass(frozen=True, slots=True)
class Curve:
    """The runs of one setting."""

    label: str
    runs: tuple[tuple[Iteration, ...], ...]
    optimum: float

    def bests(self) -> list[list[float]]:
        """Best feasible f of each iteration, run by run."""
        return [[iteration.best for iteration in run] for run in self.runs]


def fig24(options: Options) -> Section:
    """Fitness of each particle in one iteration."""
    text = words("fig24", iteration=SHOWN_ITERATION)
    plots, data = [], []
    for curve in _curves(options, LENGTHS[-1], runs=1):
        iteration = curve.runs[0][SHOWN_ITERATION]
        name = f"fig24-{curve.label.replace(' ', '-').replace(',', '')}"
        plots.append(Plot(name, curve.label, _particles(curve, iteration)))
        data.append(
            {
                "setting": curve.label,
                "iteration": SHOWN_ITERATION,
                "fitness": iteration.costs.round(2).tolist(),
                "feasible": iteration.feasible.tolist(),
                "best": iteration.best if math.isfinite(iteration.best) else None,
                "optimum": round(curve.optimum, 2),
            }
        )
    return Section("fig24", text.title, text.intro, (), tuple(plots), text.remarks, data)


def fig25(options: Options) -> Section:
    """Best feasible fitness by iteration."""
    plots, data = [], []
    for length, letter in zip(LENGTHS, "abc", strict=True):
        curves = _curves(options, length, options.runs)
        caption = f"({letter}) {length} iterations"
        plots.append(Plot(f"fig25-{letter}", caption, _convergence(curves)))
        data += [_figures(curve, length) for curve in curves]
    condition = _condition(curves)
    text = words("fig25", runs=options.runs, condition=condition, stopped=_stopped(options))
    return Section("fig25", text.title, text.intro, (), tuple(plots), text.remarks, data)


def progress_condition(bests: Sequence[float], lowest: float, gamma: float = GAMMA) -> float:
    """Share of steps that get nearer to the optimum by at least γ, or are already within γ of it.

    Parameters
    ----------
    bests : sequence
        Best f by iteration.
    lowest : float
        The optimum's f.
    gamma : float
        γ [m].

    Notes
    -----
    Eq. (31), read on a curve as the paper reads it on Fig. 25: distance to the optimality region is taken as
    difference of f, the region as what is within γ.
    """
    kept = [
        later <= lowest + gamma or earlier - later >= gamma for earlier, later in itertools.pairwise(bests)
    ]
    return float(np.mean(kept)) if kept else 1.0


def _settings(options: Options) -> dict[str, Parameters]:
    """Who is shown: the paper's parameters, ours from the same seeds, and ours."""
    planner = options.own if options.own in OPTIMISERS else "pso"
    paper, default = (replace(PRESETS[name], optimiser=planner) for name in ("paper", "default"))
    return {
        "paper parameters": paper,
        "default parameters, the paper's seeds": replace(default, rule_seeds=False),
        "default parameters": default,
    }


def _curves(options: Options, length: int, runs: int) -> list[Curve]:
    found = []
    for label, parameters in _settings(options).items():
        swarm = replace(parameters.swarm, iterations=length, stop_change=0.0, stop_iterations=length + 1)
        question = problem(CASE, READINGS[1], replace(parameters, swarm=swarm))
        flown = tuple(tuple(iterations(question, np.random.default_rng(run))) for run in range(runs))
        found.append(Curve(label, flown, optimum(question)))
    return found


def _stopped(options: Options) -> str:
    question = problem(CASE, READINGS[0], _settings(options)["paper parameters"])
    ends = sorted(
        {len(list(iterations(question, np.random.default_rng(run)))) - 1 for run in range(options.runs)}
    )
    return " or ".join(map(str, ends))


def _figures(curve: Curve, length: int) -> dict[str, object]:
    bests = np.array(curve.bests())
    return {
        "setting": curve.label,
        "iterations": length,
        "optimum": round(curve.optimum, 3),
        "best_median": [round(v, 3) if math.isfinite(v) else None for v in np.median(bests, axis=0)],
        "final": [round(v, 3) if math.isfinite(v) else None for v in bests[:, -1]],
        "never_worse": bool((bests[:, 1:] <= bests[:, :-1]).all()),
        "eq31_share": round(float(np.mean([progress_condition(run, curve.optimum) for run in bests])), 4),
        "eq31_share_1m": round(
            float(np.mean([progress_condition(run, curve.optimum, 1.0) for run in bests])), 4
        ),
    }


def _condition(curves: Sequence[Curve]) -> str:
    """What can be said of Eq. (31) from the curves of the longest runs."""
    told = [_figures(curve, LENGTHS[-1]) for curve in curves]
    worse = [row["setting"] for row in told if not row["never_worse"]]
    first = "never gets worse in any run" if not worse else f"gets worse with {', '.join(map(str, worse))}"
    shares = "; ".join(f"{row['setting']}: {100.0 * float(str(row['eq31_share_1m'])):.0f} %" for row in told)
    trivial = all(float(str(row["eq31_share"])) == 1.0 for row in told)
    wide = "does not always hold"
    if trivial:
        wide = "holds for every step, but only because no run is ever 100 m from the optimum"
    return (
        f"The best {first} (the algorithm condition). Eq. (31) with γ = 100 m {wide}. With γ = 1 m, the "
        f"share of steps that come nearer by that much or have arrived is: {shares}."
    )


def _particles(curve: Curve, iteration: Iteration) -> Figure:
    index = np.arange(1, len(iteration.costs) + 1)
    symbols = ["circle" if good else "circle-open" for good in iteration.feasible]
    look = {"symbol": symbols, "size": 10, "color": COLOURS[0], "line": {"width": 2, "color": COLOURS[0]}}
    dots = _trace("particle", index.tolist(), iteration.costs.round(2).tolist(), "particles")
    traces = [dots | {"mode": "markers", "marker": look}]
    ends = [0.5, len(index) + 0.5]
    if math.isfinite(iteration.best):
        best = _trace("best feasible so far (gbest)", ends, [iteration.best] * 2, "best")
        traces.append(best | {"line": {"color": COLOURS[2], "width": 2}})
    traces.append(_optimum_line(curve, ends))
    layout = layout_of("particle", "fitness f", height=340)
    layout["yaxis"] |= {"tickformat": ",.0f"}
    layout["margin"] |= {"l": 96}
    layout["legend"] |= {"y": -0.2, "yanchor": "top"}
    layout["margin"] |= {"b": 110}
    if iteration.costs.max() > 2.0 * iteration.costs.min():
        layout["yaxis"] |= {"type": "log", "tickformat": "~s", "nticks": 5}
    return {"data": traces, "layout": layout}


def _convergence(curves: Sequence[Curve]) -> Figure:
    traces: list[Trace] = []
    for curve, colour in zip(curves, COLOURS, strict=False):
        for run, bests in enumerate(curve.bests()):
            values = [round(v, 2) if math.isfinite(v) else None for v in bests]
            line = _trace(curve.label, list(range(len(values))), values, "convergence")
            traces.append(
                line
                | {
                    "line": {"color": colour, "width": 1.3, "shape": "hv"},
                    "opacity": 0.75,
                    "legendgroup": curve.label,
                    "showlegend": run == 0,
                }
            )
    last = len(curves[0].runs[0]) - 1
    traces.append(_optimum_line(curves[-1], [0, last]))
    layout = layout_of("iteration", "best feasible fitness f", height=440)
    layout["yaxis"] |= {"tickformat": ",.0f"}
    layout["margin"] |= {"l": 96}
    layout["legend"] |= {"y": -0.2, "yanchor": "top"}
    layout["margin"] |= {"b": 110}
    return {"data": traces, "layout": layout}


def _optimum_line(curve: Curve, ends: Sequence[float]) -> Trace:
    line = _trace(f"optimum {curve.optimum:,.1f}", list(ends), [round(curve.optimum, 2)] * 2, "optimum")
    return line | {"line": {"color": OPTIMUM, "width": 1.8, "dash": "dash"}}


def _trace(name: str, x: Sequence[float], y: Sequence[float | None], role: str) -> Trace:
    return {
        "type": "scatter",
        "mode": "lines",
        "name": name,
        "x": list(x),
        "y": list(y),
        "meta": {"role": role},
    }
