"""A waypoint list measured: its length, its clearance, and which of the paper's constraints it breaks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from avoidance.flown import as_complex, turn_angle
from avoidance.geometry import segments_clearance
from avoidance.types import Floats
from scenarios.paper.published import published

SAME = 50.0
"""A waypoint within this of one of the mission's is that one (Table 4 moves the third by 10 and 20 m) [m]."""
TOLERANCE = 1000.0
SEARCH_LIMIT = 4000.0
TURN_LIMIT = math.radians(30.0)
ROUNDING = 0.05
"""Lists are printed and stored in whole or tenths of metres; a breach below this is none [m]."""


@dataclass(frozen=True, slots=True)
class NewWaypoint:
    """A waypoint that the mission did not have."""

    place: tuple[float, float]
    """North and east [m]."""
    nearest: float
    """Distance to the nearest obstacle [m]."""
    turn: float
    """Heading change there [rad]."""


@dataclass(frozen=True, slots=True)
class Measure:
    """What a list is worth, by the paper's own rules, as printed."""

    length: float
    """Of the polyline [m]."""
    clearance: float
    """Least distance of the polyline from any obstacle [m]."""
    new: tuple[NewWaypoint, ...]
    """Waypoints put in."""
    broken: tuple[str, ...]
    """Constraints broken: g1 (waypoint too near), g2 (too far), g3 (sphere cut), g4 (turn over 30°)."""

    @property
    def details(self) -> str:
        """What is broken, with the figure that shows it."""
        texts = {
            "g1": lambda: f"g1: waypoint {min(w.nearest for w in self.new):,.0f} m from what it avoids",
            "g2": lambda: f"g2: waypoint {max(w.nearest for w in self.new):,.0f} m away, limit 4,000 m",
            "g3": lambda: f"g3: a segment passes at {self.clearance:,.1f} m",
            "g4": lambda: f"g4: turns by {math.degrees(max(w.turn for w in self.new)):.1f}°, limit 30°",
        }
        return "; ".join(texts[name]() for name in self.broken) or "none"


def measure(
    waypoints: Sequence[Sequence[float]],
    obstacles: Sequence[Sequence[float]] | None = None,
    mission: Sequence[Sequence[float]] | None = None,
    radius: float | None = None,
) -> Measure:
    """Measure a list of waypoints, x (north) and y (east) first [m].

    Parameters
    ----------
    waypoints : sequence of (x, y, …)
        The list.
    obstacles, mission, radius : optional
        Those of Table 4 unless given: places [m], waypoints of the mission [m], RS [m].

    Notes
    -----
    Eqs. (7)-(12) as printed, g3 on every segment and every obstacle (erratum E18). What a new waypoint
    avoids is the cluster (Algorithm 3) of the obstacle nearest to it.
    """
    paper = published()
    points = _places(waypoints)
    centres = _places(paper.obstacles if obstacles is None else obstacles)
    known = _places(paper.mission if mission is None else mission)
    rs = paper.safety_radius if radius is None else radius
    steps = np.diff(points, axis=0)
    gaps = segments_clearance(points[:-1], points[1:], centres)
    new = tuple(_new_waypoints(points, centres, known))
    broken = []
    if any(w.nearest < rs + TOLERANCE - ROUNDING for w in new):
        broken.append("g1")
    if any(w.nearest > SEARCH_LIMIT + ROUNDING for w in new):
        broken.append("g2")
    if float(gaps.min()) < rs - ROUNDING:
        broken.append("g3")
    if any(w.turn > TURN_LIMIT for w in new):
        broken.append("g4")
    return Measure(float(np.hypot(*steps.T).sum()), float(gaps.min()), new, tuple(broken))


def _new_waypoints(points: Floats, centres: Floats, known: Floats) -> list[NewWaypoint]:
    found = []
    for before, point, after in zip(points, points[1:], points[2:], strict=False):
        if np.hypot(*(known - point).T).min() <= SAME:
            continue
        away = float(np.hypot(*(centres - point).T).min())
        turn = float(turn_angle(as_complex(point - before), as_complex(after - point)))
        found.append(NewWaypoint((float(point[0]), float(point[1])), away, turn))
    return found


def _places(rows: Sequence[Sequence[float]]) -> Floats:
    return np.array([row[:2] for row in rows], dtype=np.float64)
