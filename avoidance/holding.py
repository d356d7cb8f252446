"""Waiting where no way is known, and giving up a waypoint that no way leads to."""

from __future__ import annotations

from avoidance.contingency import Orbit
from avoidance.route_check import Blocked
from avoidance.types import Hold, Ownship, Replace, Route, Rung, Waypoint
from avoidance.words import threat_words


def holding_words(blocked: Blocked) -> str:
    """Why the vehicle holds."""
    return f"{threat_words(blocked.threat)}; no way round is known, hold here"


def hold_on(own: Ownship, orbit: Orbit, blocked: Blocked) -> Hold:
    """Wait on an orbit."""
    north, east = orbit.centre
    return Hold(
        why=holding_words(blocked),
        threat=blocked.threat,
        rung=Rung.ORBIT,
        centre=Waypoint(north, east, own.altitude),
        radius=orbit.radius,
        direction=orbit.direction,
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
