"""Why a decision was taken, in words a pilot understands."""

from __future__ import annotations

import math
from itertools import pairwise

from avoidance.geofence import FENCE
from avoidance.ladder import Plan
from avoidance.types import Rung, Threat, Waypoint

GIVEN_UP = {
    Rung.WIDE_TURN: "; the turn is tighter than one turn radius allows for",
    Rung.FAR: "; no point within the search limit serves",
    Rung.CLOSE: "; no point outside the tolerance serves, only the safety margin is kept",
    Rung.ROUTE: "; no single waypoint serves",
}
"""Why the way is not found on the first rung."""
SHORTER = {
    Rung.CLOSE: "; {:.0f} m shorter than outside the tolerance, only the safety margin is kept",
    Rung.ROUTE: "; {:.0f} m shorter than by a single waypoint",
}
"""Why it is preferred to one that was."""


def obstacles(ids: tuple[int, ...]) -> str:
    """ "obstacle 3" or "obstacles 3, 4 and 5" (at most four are named)."""
    if FENCE in ids:
        others = tuple(i for i in ids if i != FENCE)
        return f"the geofence and {obstacles(others)}" if others else "the geofence"
    if len(ids) == 1:
        return f"obstacle {ids[0]}"
    named = [str(i) for i in ids[:4]]
    if len(ids) > 4:
        return f"obstacles {', '.join(named)} and {len(ids) - 4} more"
    return f"obstacles {', '.join(named[:-1])} and {named[-1]}"


def threat_words(threat: Threat) -> str:
    """What is wrong with the route."""
    who = obstacles(threat.ids)
    if threat.moving:
        return (
            f"{who} (moving) would pass at {threat.clearance:.0f} m in {threat.time:.0f} s, "
            f"{threat.required:.0f} m is to be kept"
        )
    if threat.narrow:
        return (
            f"the passage at {who} {threat.distance / 1000:.1f} km ahead is too narrow to turn round in: "
            f"{threat.required:.0f} m are needed on one side"
        )
    verb = "cuts" if len(threat.ids) == 1 else "cut"
    return (
        f"{who} {verb} the route {threat.distance / 1000:.1f} km ahead: "
        f"{threat.clearance:.0f} m where {threat.required:.0f} m is to be kept"
    )


def detour_words(threat: Threat, plan: Plan) -> str:
    """What is wrong and how it is flown round."""
    start, target = plan.search.start, plan.search.target
    corners = (start, *plan.waypoints, target)
    added = sum(math.dist(a, b) for a, b in pairwise(corners)) - math.dist(start, target)
    if not plan.waypoints:
        return threat_words(threat)
    side = _side(start, plan.waypoints[0], target)
    count = "" if len(plan.waypoints) == 1 else f" by {len(plan.waypoints)} waypoints"
    searched = plan.search.iterations > 0  # else a route was wanted from the first
    given_up = SHORTER if plan.saved > 0.0 else GIVEN_UP
    reason = given_up.get(plan.rung, "").format(plan.saved) if searched else ""
    beyond = "; more of it is expected where nobody has looked yet" if plan.expecting else ""
    return f"{threat_words(threat)}; pass {side}{count}, {added:.0f} m longer{reason}{beyond}"


def replace_words(original: Waypoint, chosen: Waypoint | None, ids: tuple[int, ...]) -> str:
    """Why a mission waypoint is moved or skipped."""
    number = (original.item or 0) + 1
    why = f"waypoint {number} is walled in"
    if ids:
        why = f"waypoint {number} cannot be flown to: {obstacles(ids)} too near"
    if chosen is None:
        return f"{why}; no safe point near it can be reached, so it is skipped"
    moved = math.hypot(chosen.north - original.north, chosen.east - original.east)
    return f"{why}; the nearest safe point is {moved:.0f} m away"


def _side(start: tuple[float, float], via: tuple[float, float], target: tuple[float, float]) -> str:
    north, east = target[0] - start[0], target[1] - start[1]
    across = north * (via[1] - start[1]) - east * (via[0] - start[0])
    return "to the right" if across > 0.0 else "to the left"
