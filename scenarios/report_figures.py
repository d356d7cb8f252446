"""The report's curves over time, and what all its figures share, as plain data that plotly.js draws.

Figures are dictionaries in plotly's format; building them needs no plotly. Each trace carries `meta.role`,
by which tests and scripts find it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np

from avoidance.types import Floats
from scenarios.report_data import Run
from scenarios.report_geometry import Nearest, Pass, extremes

Figure: TypeAlias = dict[str, Any]
Trace: TypeAlias = dict[str, Any]

# Okabe and Ito's colours, told apart with every common form of colour blindness; shapes differ as well.
MISSION = "#6b6b6b"
FLOWN = "#0072b2"
SPHERE = "#d55e00"
WAYPOINT = "#00795c"
DECISION = "#a0427f"
TRAFFIC = "#111111"
FENCE = "#8a6d00"
RALLY = "#117733"
TINT = "rgba(213,94,0,.16)"
FONT = {"family": "system-ui, sans-serif", "size": 13, "color": "#1d2530"}
GRID = "#e3e7ec"


def separation_over_time(run: Run, near: Nearest, passes: Sequence[Pass]) -> Figure | None:
    """Distance to the nearest sphere's centre over time, above the radius that must be kept."""
    met = np.isfinite(near.distance)
    if not met.any():
        return None
    k = extremes([near.distance, -near.required])
    hours = run.track.times[k] / 3600.0
    required = np.where(met[k], near.required[k], 0.0) / 1e3
    ids = ["" if i < 0 else str(run.hazards[i].id) for i in near.hazard[k].tolist()]
    area = {"line": {"color": SPHERE, "width": 2, "shape": "hv"}, "fill": "tozeroy", "fillcolor": TINT}
    line = {"line": {"color": FLOWN, "width": 1.6}, "text": ids}
    hover = {"hovertemplate": "%{y:.3f} km to obstacle %{text}<extra></extra>"}
    traces = [
        trace_of("Safety radius of the nearest: never below", hours, required, "required") | area,
        trace_of("Distance to the nearest", hours, near.distance[k] / 1e3, "separation") | line | hover,
        _closest_mark(min(passes, key=lambda p: p.margin)),
    ]
    layout = layout_of("Time since the start [h]", "Distance [km]", height=360)
    layout["yaxis"]["range"] = [0.0, 6.0 * float(near.required[met].max()) / 1e3]
    layout["xaxis"]["range"] = [0.0, float(run.track.times[-1]) / 3600.0]
    return {"data": traces, "layout": layout}


def flight_over_time(run: Run) -> Figure:
    """Bank, airspeed and altitude over time, one above the other."""
    track = run.track
    panels = (
        ("bank", "Bank [°]", track.banks_deg),
        ("airspeed", "Airspeed [m/s]", track.airspeeds),
        ("altitude", "Altitude [m]", track.positions[:, 2]),
    )
    layout = layout_of("Time since the start [h]", "", height=620) | {"showlegend": False}
    layout["xaxis"] |= {"anchor": "y3", "range": [0.0, float(track.times[-1]) / 3600.0]}
    traces: list[Trace] = []
    for row, (role, title, values) in enumerate(panels, start=1):
        suffix = "" if row == 1 else str(row)
        foot = 1.0 - row / 3.0
        layout[f"yaxis{suffix}"] = axis_of(title) | {"domain": [foot + 0.03, foot + 0.31], "anchor": "x"}
        k = extremes([values])
        line = trace_of(title, track.times[k] / 3600.0, values[k], role)
        traces.append(line | {"yaxis": f"y{suffix}", "line": {"width": 1.2, "color": FLOWN}})
    return {"data": traces, "layout": layout}


def _closest_mark(p: Pass) -> Trace:
    trace = trace_of(
        "Closest to a sphere", np.array([p.time / 3600.0]), np.array([p.distance / 1e3]), "closest"
    )
    text = [f"<b>{p.distance:,.0f} m</b> from obstacle {p.hazard.id}"]
    look = {"symbol": "diamond", "size": 11, "color": DECISION, "line": {"width": 1, "color": "#fff"}}
    return trace | {"mode": "markers+text", "marker": look, "text": text, "textposition": "top center"}


def trace_of(name: str, x: Floats, y: Floats, role: str) -> Trace:
    return {
        "type": "scatter",
        "mode": "lines",
        "name": name,
        "x": finite(x),
        "y": finite(y),
        "meta": {"role": role},
    }


def finite(values: Floats) -> list[float | None]:
    """Rounded for the file; null, which breaks a line, where a value is not finite."""
    return [round(v, 5) if math.isfinite(v) else None for v in values.tolist()]


def axis_of(title: str) -> dict[str, Any]:
    return {
        "title": {"text": title},
        "gridcolor": GRID,
        "zeroline": False,
        "linecolor": "#9aa4b0",
        "ticks": "outside",
    }


def layout_of(x: str, y: str, height: int | None = None) -> dict[str, Any]:
    layout: dict[str, Any] = {
        "font": FONT,
        "paper_bgcolor": "#fff",
        "plot_bgcolor": "#fff",
        "margin": {"l": 62, "r": 16, "t": 12, "b": 48},
        "legend": {"orientation": "h", "y": 1.02, "yanchor": "bottom", "x": 0.0, "xanchor": "left"},
        "hovermode": "closest",
        "dragmode": "zoom",
        "xaxis": axis_of(x),
        "yaxis": axis_of(y),
    }
    return layout | ({"height": height} if height else {})
