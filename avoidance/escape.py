"""Leaving a sphere that appeared round the vehicle."""

from __future__ import annotations

import numpy as np

from avoidance.free_space import free_candidates
from avoidance.geofence import Walls
from avoidance.geometry import point_distances, segments_clearance
from avoidance.known import Circles, Known
from avoidance.types import Decision, Detour, Keep, Ownship, Performance, Route, Rung, Threat, Waypoint
from avoidance.words import obstacles

MOST_WAYS_OUT = 200
"""Points looked at for a way out of a sphere."""


class Escape:
    """Leads out of a sphere by the shortest way; remembers that it is on the way out.

    Parameters
    ----------
    performance : Performance
        The room a turn needs.
    """

    def __init__(self, performance: Performance) -> None:
        self._performance = performance
        self._escaping = False

    def decide(self, own: Ownship, route: Route, known: Known) -> Decision | None:
        """Leave the sphere that the vehicle is in; None if it is in none, or no way out is known."""
        circles = known.circles(own.altitude, own.altitude)
        here = (own.north, own.east)
        distance = point_distances(circles.centres, here)
        depth = circles.keep - known.margin[circles.rows] - distance
        if not (depth > 0.0).any():
            self._escaping = False
            return None
        if self._escaping and route.waypoints[0].item is None:
            return Keep(why="the route is clear")
        self._escaping = True
        deepest = int(np.argmax(depth))
        point = way_out(here, circles, known.walls, self._performance.turn_room)
        if point is None:
            return None
        threat = Threat(
            ids=(int(known.ids[circles.rows[deepest]]),),
            leg=0,
            distance=0.0,
            time=0.0,
            clearance=float(distance[deepest]),
            required=float(circles.keep[deepest]),
        )
        waypoint = Waypoint(point[0], point[1], own.altitude)
        own_items = tuple(w for w in route.waypoints if w.item is not None)
        return Detour(
            why=f"{obstacles(threat.ids)} appeared round the vehicle; leave by the shortest way",
            threat=threat,
            rung=Rung.CLOSE,
            route=(waypoint, *own_items),
            waypoint=waypoint,
        )


def way_out(
    here: tuple[float, float], circles: Circles, walls: Walls, turn_room: float
) -> tuple[float, float] | None:
    """The nearest point out of all circles that is reached straight without going deeper into any.

    Parameters
    ----------
    here : (float, float)
        Where the vehicle is, north and east [m].
    circles : Circles
        What is to be kept out of.
    walls : Walls
        What is not to be crossed.
    turn_room : float
        Room beyond the circles that the point has if there is such a point [m].

    Returns
    -------
    (float, float) or None
        North and east [m].
    """
    present = np.minimum(circles.keep, point_distances(circles.centres, here)) - 1.0
    for room in (turn_room, 0.0):
        points = free_candidates(here, circles.centres, circles.keep + room)[:MOST_WAYS_OUT]
        starts = np.broadcast_to(np.array(here), points.shape)
        deeper = segments_clearance(starts, points, circles.centres) < present
        straight = np.flatnonzero(~deeper.any(axis=1) & (walls.clearance(starts, points) > 0.0))
        if len(straight):
            return float(points[straight[0], 0]), float(points[straight[0], 1])
    return None
