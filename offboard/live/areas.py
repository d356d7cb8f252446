"""Geofence and rally points of a live vehicle: put aboard with a mission, or taken as they are aboard."""

from __future__ import annotations

from collections.abc import Sequence

from avoidance import Waypoint
from avoidance.geofence import FenceArea, Geofence
from offboard.area_items import RallyPlace, fence_items, fence_of_items, rally_items, rally_of_items
from offboard.errors import LinkError
from offboard.frames import MapFrame
from offboard.geofence import FenceType, GeofenceData
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
    aboard = vehicle.aboard
    try:
        fence = fence_of_items(_got(vehicle, Ask.GET_FENCE, "geofence"))
        _check_reach(aboard.frame, [place for area in fence.polygons for place in area.points])
        _check_reach(aboard.frame, [area.point for area in fence.circles])
    except LinkError as error:
        aboard.tell("alarm", f"the geofence on board is not known and not kept to: {error}")
        return GeofenceData()
    if areas := len(fence.polygons) + len(fence.circles):
        aboard.tell("info", f"the geofence on board is kept to, {areas} areas")
    return fence


def rally_aboard(vehicle: LiveVehicle) -> tuple[RallyPlace, ...]:
    """The rally points that the vehicle has; none, and a warning, if they cannot be had or understood."""
    aboard = vehicle.aboard
    try:
        rally = rally_of_items(_got(vehicle, Ask.GET_RALLY, "rally points"), aboard.home.altitude_m)
        _check_reach(aboard.frame, [(lat, lon) for lat, lon, _ in rally])
    except LinkError as error:
        aboard.tell("warning", f"the rally points on board are not used: {error}")
        return ()
    if rally:
        aboard.tell("info", f"the rally points on board are used, {len(rally)} of them")
    return rally


def areas_for_core(vehicle: LiveVehicle) -> tuple[Geofence, tuple[Waypoint, ...]]:
    """Geofence and rally points that the vehicle has, as those who decide take them; what fails is told."""
    frame, fence = vehicle.aboard.frame, fence_aboard(vehicle)
    inside = FenceType.INCLUSION
    polygons = [
        FenceArea(p.fence_type is inside, tuple(frame.to_map(*corner) for corner in p.points))
        for p in fence.polygons
    ]
    circles = [
        FenceArea(c.fence_type is inside, centre=frame.to_map(*c.point), radius=c.radius_m)
        for c in fence.circles
    ]
    rally = tuple(Waypoint(*frame.to_map(*place), altitude) for *place, altitude in rally_aboard(vehicle))
    return Geofence((*polygons, *circles)), rally


def _check_reach(frame: MapFrame, places: Sequence[tuple[float, float]]) -> None:
    """Make sure that places [deg] lie on the map, else a `LinkError`."""
    try:
        for place in places:
            frame.to_map(*place)
    except ValueError as error:
        raise LinkError(str(error)) from error


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
