"""Waiting where no way is known, and giving up a waypoint that no way leads to."""

from __future__ import annotations

import math

from avoidance.geometry import point_distances
from avoidance.known import Known
from avoidance.route_check import Blocked
from avoidance.types import Hold, Ownship, Performance, Replace, Route, Rung, Waypoint
from avoidance.words import threat_words

HOLD_RADII = 1.5
"""Radius of a holding orbit in turn radii."""


def holding_words(blocked: Blocked) -> str:
    """Why the vehicle holds."""
    return f"{threat_words(blocked.threat)}; no way round is known, hold here"


def holding_orbit(own: Ownship, known: Known, blocked: Blocked, performance: Performance) -> Hold:
    """Orbit on the side with more room."""
    radius = HOLD_RADII * performance.turn_radius
    centre, direction, most = (own.north, own.east), 1, -math.inf
    circles = known.circles(own.altitude, own.altitude)
    for side in (1, -1):
        angle = own.course + side * 0.5 * math.pi
        point = (own.north + radius * math.cos(angle), own.east + radius * math.sin(angle))
        room = float((point_distances(circles.centres, point) - circles.keep).min(initial=math.inf))
        if room > most:
            centre, direction, most = point, side, room
    return Hold(
        why=holding_words(blocked),
        threat=blocked.threat,
        rung=Rung.ORBIT,
        centre=Waypoint(centre[0], centre[1], own.altitude),
        radius=radius,
        direction=direction,
    )


def skipped(route: Route, blocked: Blocked, end: int) -> Replace:
    """Give up mission item route.waypoints[end], that no route leads to."""
    return Replace(
        why=f"{threat_words(blocked.threat)}; no route to waypoint "
        f"{(route.waypoints[end].item or 0) + 1} can be flown, so it is skipped",
        threat=blocked.threat,
        rung=Rung.ORBIT,
        route=route.waypoints[end + 1 :],
        waypoint=None,
    )
