"""The report's maps: the whole flight, and each encounter close up. East is x, north is y, in kilometres."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

import numpy as np

from avoidance.types import Floats
from scenarios.report_data import Hazard, Mark, Run
from scenarios.report_figures import (
    DECISION,
    FENCE,
    FLOWN,
    FONT,
    MISSION,
    RALLY,
    SPHERE,
    TINT,
    TRAFFIC,
    WAYPOINT,
    Figure,
    Trace,
    layout_of,
    trace_of,
)
from scenarios.report_geometry import Encounter, Pass, inside, ring, simplified

OUTER = 1000.0
"""The dashed circle lies this far outside the sphere [m]: 2 km where the sphere has 1 km."""
EVERYWHERE = (np.full(2, -math.inf), np.full(2, math.inf))


def top_view(run: Run) -> Figure:
    """The whole flight from above, the shorter direction stretched if that is needed to see anything."""
    traces = [
        *_spheres(_placed(run)),
        *_traffic(run, None),
        *_fence(run),
        *_rally(run),
        *_mission(run),
        *_flown(run, None, 5.0),
        _waypoints(run.decisions),
        _decisions(run.decisions),
    ]
    layout = layout_of("East of home [km]", "North of home [km]") | {"showlegend": False}
    layout["yaxis"] |= {"scaleanchor": "x", "scaleratio": 1.0 / stretch(run), "constrain": "domain"}
    layout["xaxis"] |= {"constrain": "domain", "nticks": 6}
    return {"data": traces, "layout": layout}


def stretch(run: Run) -> float:
    """How many times longer a kilometre east is drawn than a kilometre north in the overview.

    A round number, 1 unless the flight is more than three times as long one way as the other.
    """
    seen = [run.track.positions[:, :2], run.mission]
    seen += [place[None, :2] + side * (h.radius + OUTER) for h, place in _placed(run) for side in (-1.0, 1.0)]
    seen += [h.places[np.isfinite(h.places[:, 0]), :2] for h in run.hazards]
    north, east = (max(float(extent), 2000.0) for extent in np.ptp(np.vstack(seen), axis=0))
    wanted = max(north / east, east / north) / 1.2
    if wanted < 2.5:
        return 1.0
    steps = (2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
    factor = min(steps, key=lambda s: abs(math.log(s / wanted)))
    return factor if north > east else 1.0 / factor


def map_key(run: Run) -> str:
    """The legend, with what each sign means."""

    def line(colour: str, width: float, dash: str = "") -> str:
        return f'<path d="M2 7H42" stroke="{colour}" stroke-width="{width}" stroke-dasharray="{dash}"/>'

    signs = [
        (line(MISSION, 2, "5 4"), "The mission as planned, from waypoint to waypoint (WP1, WP2 …)."),
        (line(FLOWN, 3), "What the aircraft flew."),
        (
            f'<circle cx="22" cy="7" r="6" fill="{TINT}" stroke="{SPHERE}" stroke-width="1.5"/>',
            "An obstacle’s safety sphere: entering it is a violation.",
        ),
        (line(SPHERE, 1.2, "4 3"), "1 km further out: new waypoints are kept beyond it where there is room."),
        (
            f'<path d="M22 0 L29 7 L22 14 L15 7 Z" fill="{DECISION}"/>',
            "Where the aircraft was when a decision was taken, numbered as in the table.",
        ),
        (
            f'<rect x="16" y="1" width="12" height="12" fill="{WAYPOINT}"/>',
            "A waypoint put in by avoidance, or standing for one of the mission’s; hollow once given up.",
        ),
    ]
    if run.scenario.geofence:
        text = "The geofence: stay inside (solid), stay out (dashed)."
        signs.append((line(FENCE, 2.5), text))
    if run.scenario.rally:
        sign = f'<path d="M22 1 L29 13 L15 13 Z" fill="none" stroke="{RALLY}" stroke-width="2"/>'
        signs.append((sign, "A rally point (R1, R2 …): where to wait if no way is free."))
    if any(hazard.moving for hazard in run.hazards):
        text = "The path of traffic; its sphere is drawn where it was at the closest pass."
        signs.append((line(TRAFFIC, 2, "2 3"), text))
    return "\n".join(
        f'<li><svg width="44" height="14" aria-hidden="true">{sign}</svg><span>{text}</span></li>'
        for sign, text in signs
    )


def _placed(run: Run) -> list[tuple[Hazard, Floats]]:
    """Every hazard with the place where it is drawn."""
    return [(hazard, hazard.place(run.track.times)) for hazard in run.hazards]


def encounter_view(run: Run, encounter: Encounter) -> Figure:
    """One encounter from above, a kilometre the same length both ways."""
    centre = (encounter.low + encounter.high) / 2.0
    half = max(float((encounter.high - encounter.low).max()) * 0.6, 3000.0)
    low, high = centre - 2.2 * half, centre + 2.2 * half
    spheres = [(h, p) for h, p in _placed(run) if np.all(np.abs(p[:2] - centre) < 2.2 * half + h.radius)]
    layout = layout_of("East of home [km]", "North of home [km]")
    layout["yaxis"] |= {"scaleanchor": "x", "scaleratio": 1.0}
    layout["xaxis"]["range"] = [(centre[1] - half) / 1e3, (centre[1] + half) / 1e3]
    layout["yaxis"]["range"] = [(centre[0] - half) / 1e3, (centre[0] + half) / 1e3]
    layout |= {"showlegend": False, "annotations": _dimensions(encounter)}
    traces = [
        *_spheres(spheres),
        *_traffic(run, (low, high)),
        *_fence(run),
        *_rally(run),
        *_mission(run),
        *_flown(run, (low, high), 0.5),
        *(_dimension(p) for p in encounter.passes),
        _waypoints(encounter.decisions),
        _decisions(encounter.decisions, apart=0.08 * half),
    ]
    return {"data": traces, "layout": layout}


def _mission(run: Run) -> list[Trace]:
    points = run.mission
    line = _map_line("Mission as planned", [points], "mission", color=MISSION, width=1.5, dash="dash")
    labels = [f"WP{i}" for i in range(1, len(points) + 1)]
    look = {"symbol": "circle-open", "size": 9, "color": MISSION, "line": {"width": 2}}
    marks = _map_marks("Mission waypoints", points, "mission-waypoints", look, labels)
    return [line, marks | {"mode": "markers+text", "text": labels, "textposition": "middle right"}]


def _fence(run: Run) -> list[Trace]:
    """The edges of the geofence: solid round what is allowed, dashed round what is not."""
    found = []
    for include, dash in ((True, "solid"), (False, "dash")):
        parts = [area.outline() for area in run.scenario.geofence if area.include is include]
        if parts:
            name = "Geofence, stay inside" if include else "Geofence, stay out"
            found.append(_map_line(name, parts, "geofence", color=FENCE, width=2.5, dash=dash))
    return found


def _rally(run: Run) -> list[Trace]:
    """The rally points, numbered as the decisions name them."""
    points = np.array([(point.north, point.east) for point in run.scenario.rally]).reshape(-1, 2)
    if not len(points):
        return []
    labels = [f"R{i}" for i in range(1, len(points) + 1)]
    look = {"symbol": "triangle-up-open", "size": 11, "color": RALLY, "line": {"width": 2}}
    marks = _map_marks("Rally points", points, "rally", look, labels)
    return [marks | {"mode": "markers+text", "text": labels, "textposition": "middle right"}]


def _traffic(run: Run, window: tuple[Floats, Floats] | None) -> list[Trace]:
    low, high = window or EVERYWHERE
    moving = [hazard.places[:, :2] for hazard in run.hazards if hazard.moving]
    pieces = [piece for places in moving for piece in inside(places, low, high)]
    if not pieces:
        return []
    parts = [piece[simplified(piece, 5.0)] for piece in pieces]
    return [_map_line("Traffic", parts, "traffic", color=TRAFFIC, width=1.5, dash="dot")]


def _spheres(spheres: Sequence[tuple[Hazard, Floats]]) -> list[Trace]:
    if not spheres:
        return []
    rings = [ring(place[0], place[1], hazard.radius) for hazard, place in spheres]
    outer = [ring(place[0], place[1], hazard.radius + OUTER) for hazard, place in spheres]
    solid = _map_line("Safety sphere", rings, "spheres", color=SPHERE, width=1.5)
    wide = _map_line("1 km outside it", outer, "outer-spheres", color=SPHERE, width=1.0, dash="dash")
    centres = np.array([(place[0], place[1]) for _, place in spheres])
    texts = [_hazard_text(hazard) for hazard, _ in spheres]
    look = {"symbol": "x-thin", "size": 6, "line": {"width": 1.5, "color": SPHERE}}
    marks = _map_marks("Obstacles", centres, "obstacles", look, texts) | {"showlegend": False}
    return [wide, solid | {"fill": "toself", "fillcolor": TINT}, marks]


def _hazard_text(hazard: Hazard) -> str:
    text = f"{escape(hazard.kind)} {hazard.id}, safety radius {hazard.radius:,.0f} m"
    return text + (f", appears at {hazard.appears_at:,.0f} s" if hazard.appears_at > 0.0 else "")


def _flown(run: Run, window: tuple[Floats, Floats] | None, tolerance: float) -> list[Trace]:
    low, high = window or EVERYWHERE
    parts = [piece[simplified(piece, tolerance)] for piece in inside(run.track.positions[:, :2], low, high)]
    return [_map_line("Flown", parts, "flown", color=FLOWN, width=2.5)] if parts else []


def _waypoints(decisions: Iterable[Mark]) -> Trace:
    rows = [(w, kept, m) for m in decisions for w, kept in zip(m.waypoints, m.kept, strict=True)]
    texts = [
        f"Waypoint set by decision {m.number}" + ("" if kept else ", given up later") for _, kept, m in rows
    ]
    symbols = ["square" if kept else "square-open" for _, kept, _ in rows]
    look = {"symbol": symbols, "size": 9, "color": WAYPOINT, "line": {"width": 1, "color": WAYPOINT}}
    points = np.array([w for w, _, _ in rows]).reshape(-1, 2)
    return _map_marks("Waypoint put in by avoidance", points, "waypoints", look, texts)


def _decisions(decisions: Sequence[Mark], apart: float | None = None) -> Trace:
    points = np.array([(mark.north, mark.east) for mark in decisions]).reshape(-1, 2)
    texts = [f"Decision {mark.number}: {escape(str(mark.row.get('why', '')))}" for mark in decisions]
    look = {"symbol": "diamond", "size": 11, "color": DECISION, "line": {"width": 1, "color": "#fff"}}
    marks = _map_marks("Where a decision was taken", points, "decisions", look, texts)
    if apart is not None:
        numbers = _joined_numbers(decisions, points, apart)
        marks |= {"mode": "markers+text", "text": numbers, "textposition": "middle left"}
    return marks


def _joined_numbers(decisions: Sequence[Mark], points: Floats, apart: float) -> list[str]:
    """A label per decision; decisions within `apart` [m] of an earlier one share the label of that one."""
    labels, first = [""] * len(decisions), 0
    for i, mark in enumerate(decisions):
        if math.dist(points[i], points[first]) > apart:
            first = i
        begin = decisions[first].number
        labels[first] = f"<b>{begin}</b>" if i == first else f"<b>{begin}–{mark.number}</b>"
    return labels


def _dimension(p: Pass) -> Trace:
    ends = np.array([p.own[:2], p.other[:2]])
    return _map_line("Closest pass", [ends], "closest", color="#111", width=1.3)


def _dimensions(encounter: Encounter) -> list[dict[str, Any]]:
    tightest = sorted(encounter.passes, key=lambda p: p.margin)[:3]
    return [
        {
            "x": p.own[1] / 1e3,
            "y": p.own[0] / 1e3,
            "text": f"{p.distance:,.0f} m",
            "ax": math.copysign(46, p.own[1] - p.other[1]),
            "ay": (-26, 14, -58)[i],
            "arrowhead": 0,
            "arrowwidth": 1,
            "bgcolor": "rgba(255,255,255,.88)",
            "font": FONT | {"size": 13},
        }
        for i, p in enumerate(tightest)
    ]


def _map_line(name: str, parts: Sequence[Floats], role: str, **line: str | float) -> Trace:
    joined = np.vstack([np.vstack([part, (math.nan, math.nan)]) for part in parts])[:-1] / 1e3
    return trace_of(name, joined[:, 1], joined[:, 0], role) | {"line": line, "hoverinfo": "skip"}


def _map_marks(name: str, points: Floats, role: str, marker: dict[str, Any], texts: list[str]) -> Trace:
    where = "<br>%{y:.2f} km north, %{x:.2f} km east<extra></extra>"
    trace = trace_of(name, points[:, 1] / 1e3, points[:, 0] / 1e3, role) | {
        "mode": "markers",
        "marker": marker,
        "customdata": texts,
    }
    return trace | {"hovertemplate": "%{customdata}" + where}
