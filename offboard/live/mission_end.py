"""Has a vehicle come to the end of its mission?"""

from __future__ import annotations

import math

from offboard.live.aboard import Aboard
from offboard.live.fallback import ORBIT_TURN_RADII
from offboard.mission_list import MissionList
from offboard.raw_mission import LOITER_UNLIMITED, Composed, RawItem

COMPLETE = 5
"""MISSION_STATE at the end."""


def at_end(aboard: Aboard, mission: MissionList, composed: Composed) -> bool:
    """True if a vehicle shows that it has come to the end of the mission that it has."""
    shown = aboard.telemetry.mission
    if shown is None:
        return False
    current, last = shown.current - aboard.rules.first_item, len(mission.entries) - 1
    if composed.entry_of(current) > last:
        return True
    at = max(i for i, entry in enumerate(composed.entries) if entry == last)  # a hold may come before it
    if current != at:
        return False
    item, own, end = composed.items[at], aboard.ownship(), mission.entries[last].waypoint
    away = math.hypot(own.north - end.north, own.east - end.east)
    if item.command == LOITER_UNLIMITED:
        return away <= end_radius(aboard, item)
    reached = aboard.telemetry.reached - aboard.rules.first_item == at
    can = aboard.performance
    near = 2.0 * can.acceptance_radius + 4.0 * can.turn_radius  # the number may be of an earlier list
    return (reached and away <= near) or shown.state == COMPLETE


def end_radius(aboard: Aboard, last: RawItem | None) -> float:
    """How near a vehicle comes to the last item [m]: a mission may end on a circle about it."""
    performance = aboard.performance
    if last is None or last.command != LOITER_UNLIMITED:
        return performance.acceptance_radius
    given = abs(last.params[2])  # NaN leaves it open, as 0 does
    radius = given if given > 0.0 else abs(aboard.parameters.get(aboard.rules.loiter_radius, 0.0))
    radius = max(radius, ORBIT_TURN_RADII * performance.turn_radius)
    return max(performance.acceptance_radius, 1.1 * radius + performance.tracking_error)
