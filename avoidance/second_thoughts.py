"""A new waypoint that turns out too near to something seen later is chosen again, if a better one exists."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from avoidance.known import Known
from avoidance.route_check import Blocked
from avoidance.types import Decision, Detour, Ownship, Route, Rung, Threat, Waypoint

Place = tuple[float, float]


class SecondThoughts:
    """Remembers which obstacles were known when a waypoint was put in.

    Notes
    -----
    Sec. 5.3: "An alternate waypoint identified to avoid one obstacle may be near another one obstacle which
    may come under radar view later. In such a case that alternate waypoint identified is skipped by choosing
    another safe waypoint considering this new obstacle." The route is clear of it all the same (g3), so each
    obstacle is a reason once, and only a waypoint that meets every constraint takes the place of another.
    """

    def __init__(self) -> None:
        self._settled: dict[Place, set[int]] = {}

    def learn(self, decision: Decision, known: Known) -> None:
        """Note what was known when a waypoint that meets every constraint was put in."""
        if isinstance(decision, Detour) and decision.rung is Rung.WAYPOINT:
            self._settled = {_place(decision.waypoint): set(known.ids.tolist())} | {
                place: ids for place, ids in self._settled.items() if _in(decision.route or (), place)
            }

    def first(self, own: Ownship, route: Route, known: Known) -> Blocked | None:
        """The first waypoint put in that something unknown then lies too near to (g1), or None."""
        for leg, waypoint in enumerate(route.waypoints):
            settled = self._settled.get(_place(waypoint)) if waypoint.item is None else None
            if settled is None:
                continue
            circles = known.circles(waypoint.altitude, waypoint.altitude)
            ids = known.ids[circles.rows]
            away = np.hypot(*(circles.centres - np.array(_place(waypoint))).T)
            new = ~np.isin(ids, list(settled))
            settled.update(ids.tolist())
            near = np.flatnonzero(new & (away < circles.keep_waypoint))
            if near.size:
                nearest = int(near[np.argmin(away[near] - circles.keep_waypoint[near])])
                distance = _distance(own, route, leg)
                threat = Threat(
                    ids=(int(ids[nearest]),),
                    leg=leg,
                    distance=distance,
                    time=distance / max(own.ground_speed, 1.0),
                    clearance=float(away[nearest]),
                    required=float(circles.keep_waypoint[nearest]),
                )
                return Blocked(threat, leg, circles.rows[[nearest]])
        return None


def second_words(threat: Threat, decision: Decision) -> str:
    """Why a waypoint is chosen again."""
    how = decision.why.partition("; ")[2]
    return (
        f"obstacle {threat.ids[0]} has come into view {threat.clearance:.0f} m from the new waypoint, "
        f"which is to keep {threat.required:.0f} m; chosen again: {how}"
    )


def _place(waypoint: Waypoint) -> Place:
    return waypoint.north, waypoint.east


def _in(route: tuple[Waypoint, ...], place: Place) -> bool:
    return any(_place(waypoint) == place for waypoint in route)


def _distance(own: Ownship, route: Route, leg: int) -> float:
    """Along the route to a waypoint [m]."""
    corners = [(own.north, own.east), *(_place(w) for w in route.waypoints[: leg + 1])]
    return sum(math.dist(a, b) for a, b in pairwise(corners))
