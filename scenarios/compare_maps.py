"""Maps of flights in the paper's layout: x (north) to the right, y (east) upwards, in kilometres.

Seen from above, that is a mirror image: what turns to the left on the map turns to the right in the air.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from scenarios.compare_flight import Record
from scenarios.report_figures import (
    DECISION,
    FONT,
    MISSION,
    SPHERE,
    TINT,
    TRAFFIC,
    WAYPOINT,
    Figure,
    Trace,
    layout_of,
)

COLOURS = ("#0072b2", "#d55e00", "#00795c", "#a0427f", "#8a6d00", "#4b4b9f", "#111111", "#5a9bd4", "#c08457")
"""Lines of several flights, told apart with every common form of colour blindness."""
DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot", "solid", "dash", "dot")
OUTER = 1000.0
"""New waypoints keep RS + this [m]."""

Points = Sequence[Sequence[float]]


def course_map(
    records: Mapping[str, Record],
    *,
    window: tuple[float, float, float, float] | None = None,
    waypoints: bool = True,
    height: int = 520,
) -> Figure:
    """Flights through the same world over one another.

    Parameters
    ----------
    records : mapping
        Flights by label; obstacles and mission are those of the first.
    window : (x0, x1, y0, y1), optional
        Part of the map to show [m], a kilometre the same length both ways; else everything, each axis with
        its own scale.
    waypoints : bool
        Show the waypoints put in.
    height : int
        Of the figure [px].
    """
    first = next(iter(records.values()))
    traces = [*_spheres(first["obstacles"]), *_mission(first["mission"])]
    many = len(records) > 1
    for number, (label, record) in enumerate(records.items()):
        traces += _traffic(record, show=number == 0)
        colour = COLOURS[number % len(COLOURS)]
        look = {"color": colour, "dash": DASHES[number % len(DASHES)], "width": 2.2}
        traces.append(_line(label, record["track"], "flown") | {"line": look})
        if waypoints:
            traces += _put_in(record, colour if many else WAYPOINT, legend=not many)
    layout = layout_of("x, north of home [km]", "y, east of home [km]", height=height)
    layout["legend"] |= {"y": -0.22, "yanchor": "top"}
    layout["margin"] |= {"b": 130}
    if window is not None:
        x0, x1, y0, y1 = (value / 1e3 for value in window)
        layout["xaxis"] |= {"range": [x0, x1], "constrain": "range"}
        layout["yaxis"] |= {"range": [y0, y1], "scaleanchor": "x", "scaleratio": 1.0, "constrain": "range"}
    return {"data": traces, "layout": layout}


def list_map(lists: Mapping[str, Points], obstacles: Sequence[Sequence[float]], **options: Any) -> Figure:  # noqa: ANN401
    """Waypoint lists that were not flown, over one another; options as of `course_map`."""
    records = {
        label: {"track": points, "obstacles": obstacles, "mission": points, "traffic": [], "changes": []}
        for label, points in lists.items()
    }
    return course_map(records, waypoints=False, **options)


def _spheres(obstacles: Sequence[Sequence[float]]) -> list[Trace]:
    if not obstacles:
        return []
    angle = np.linspace(0.0, 2.0 * math.pi, 73)
    found = []
    for extra, dash, fill, name in (
        (OUTER, "dash", None, "1 km further out"),
        (0.0, "solid", TINT, "safety sphere"),
    ):
        x: list[float | None] = []
        y: list[float | None] = []
        for _, north, east, radius in obstacles:
            x += [*((north + (radius + extra) * np.cos(angle)) / 1e3).round(4).tolist(), None]
            y += [*((east + (radius + extra) * np.sin(angle)) / 1e3).round(4).tolist(), None]
        trace: Trace = {
            "type": "scatter",
            "mode": "lines",
            "name": name,
            "x": x,
            "y": y,
            "line": {"color": SPHERE, "width": 1.0 if fill is None else 1.5, "dash": dash},
            "hoverinfo": "skip",
            "meta": {"role": "spheres" if fill else "outer-spheres"},
        }
        found.append(trace | ({} if fill is None else {"fill": "toself", "fillcolor": fill}))
    names = [f"obstacle {int(o[0])}, {o[3]:,.0f} m" for o in obstacles]
    look = {"symbol": "x-thin", "size": 6, "line": {"width": 1.5, "color": SPHERE}}
    marks = _marks("obstacles", [o[1:3] for o in obstacles], "obstacles", look, names)
    return [*found, marks | {"showlegend": False}]


def _mission(points: Points) -> list[Trace]:
    line = _line("mission", points, "mission") | {"line": {"color": MISSION, "width": 1.5, "dash": "dot"}}
    labels = [f"WP{i}" for i in range(1, len(points) + 1)]
    look = {"symbol": "circle-open", "size": 9, "color": MISSION, "line": {"width": 2}}
    marks = _marks("mission waypoints", points, "mission-waypoints", look, labels)
    marks |= {"mode": "markers+text", "text": labels, "textposition": "top center", "showlegend": False}
    return [line, marks | {"textfont": FONT}]


def _traffic(record: Record, *, show: bool) -> list[Trace]:
    if not show:
        return []
    found = []
    for mover in record["traffic"]:
        line = _line(f"intruder {mover['id']}", mover["track"], "traffic")
        found.append(line | {"line": {"color": TRAFFIC, "width": 1.5, "dash": "dot"}})
        if not mover["closest"]:
            continue
        own, other = mover["closest"]
        ring = _line("its sphere at the closest pass", _ring(other, mover["radius"]), "traffic-sphere")
        found.append(ring | {"line": {"color": SPHERE, "width": 1.5}, "fill": "toself", "fillcolor": TINT})
        join = _line("closest pass", [own, other], "closest")
        found.append(join | {"line": {"color": TRAFFIC, "width": 1.3}, "showlegend": False})
    return found


def _ring(centre: Sequence[float], radius: float) -> Points:
    angle = np.linspace(0.0, 2.0 * math.pi, 73)
    north, east = centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle)
    return np.column_stack((north, east)).tolist()  # type: ignore[no-any-return]


def _put_in(record: Record, colour: str, *, legend: bool) -> list[Trace]:
    """Waypoints put in that are still in the final plan, and where they were decided on."""
    placed = [(point, change) for change in record["changes"] for point in change["waypoints"]]
    if not placed:
        return []
    look = {"symbol": "square", "size": 8, "color": colour, "line": {"width": 1, "color": "#fff"}}
    texts = [change["why"] for _, change in placed]
    points = _marks("new waypoint", [point for point, _ in placed], "waypoints", look, texts)
    at = [change["place"] for change in record["changes"]]
    look = {"symbol": "diamond", "size": 8, "color": DECISION if legend else colour}
    marks = _marks("decided here", at, "decisions", look, [c["why"] for c in record["changes"]])
    return [points | {"showlegend": legend}, marks | {"showlegend": legend}]


def _line(name: str, points: Points, role: str) -> Trace:
    return {
        "type": "scatter",
        "mode": "lines",
        "name": name,
        "x": [round(p[0] / 1e3, 4) for p in points],
        "y": [round(p[1] / 1e3, 4) for p in points],
        "meta": {"role": role},
    }


def _marks(name: str, points: Points, role: str, look: dict[str, Any], texts: Sequence[str]) -> Trace:
    trace = _line(name, points, role)
    return trace | {"mode": "markers", "marker": look, "hovertext": list(texts), "hoverinfo": "text"}
