"""Geofence and rally points of a live vehicle: put aboard with a mission, or taken as they are aboard."""

from __future__ import annotations

from collections.abc import Sequence

from offboard.area_items import RallyPlace, fence_items, fence_of_items, rally_items, rally_of_items
from offboard.errors import LinkError
from offboard.geofence import GeofenceData
from offboard.live.messages import Ask
from offboard.live.vehicle import LiveVehicle
from offboard.raw_mission import RawItem

PATIENCE = 10.0
"""A list is waited for so long [s, wall clock]."""


def put_fence(vehicle: LiveVehicle, fence: GeofenceData) -> bool:
    """Put a geofence aboard; False, and a warning, if the vehicle does not take it."""
    return _put(vehicle, Ask.PUT_FENCE, fence_items(fence), "geofence")


def put_rally(vehicle: LiveVehicle, points: Sequence[RallyPlace]) -> bool:
    """Put rally points aboard; False, and a warning, if the vehicle does not take them."""
    return _put(vehicle, Ask.PUT_RALLY, rally_items(points), "list of rally points")


def fence_aboard(vehicle: LiveVehicle) -> GeofenceData:
    """The geofence that the vehicle has; none, and an alarm, if it cannot be had or understood."""
    try:
        return fence_of_items(_got(vehicle, Ask.GET_FENCE, "geofence"))
    except LinkError as error:
        vehicle.aboard.tell("alarm", f"the geofence on board is not known and not kept to: {error}")
        return GeofenceData()


def rally_aboard(vehicle: LiveVehicle) -> tuple[RallyPlace, ...]:
    """The rally points that the vehicle has; none, and a warning, if they cannot be had or understood."""
    try:
        items = _got(vehicle, Ask.GET_RALLY, "rally points")
        return rally_of_items(items, vehicle.aboard.home.altitude_m)
    except LinkError as error:
        vehicle.aboard.tell("warning", f"the rally points on board are not used: {error}")
        return ()


def _put(vehicle: LiveVehicle, ask: Ask, items: tuple[RawItem, ...], words: str) -> bool:
    try:
        vehicle.request(vehicle.aboard.session.put(ask, items), f"take the {words}", PATIENCE)
    except LinkError as error:
        vehicle.aboard.tell("warning", f"{error}; we keep to it, the autopilot does not know it")
        return False
    vehicle.aboard.tell("info", f"the {words} of the mission is on board, {len(items)} items")
    return True


def _got(vehicle: LiveVehicle, ask: Ask, words: str) -> tuple[RawItem, ...]:
    reply = vehicle.request(vehicle.aboard.session.ask(ask), f"give its {words}", PATIENCE)
    return reply.items
