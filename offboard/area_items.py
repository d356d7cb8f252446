"""Geofences and rally points as MAVLink carries them: lists of items beside the mission."""

from __future__ import annotations

import math
from collections.abc import Sequence

from offboard.errors import LinkError
from offboard.geofence import FenceCircle, FencePolygon, FenceType, GeofenceData
from offboard.raw_mission import ABSOLUTE, DEGREE, RELATIVE, RawItem

RETURN_POINT, POLYGON_IN, POLYGON_OUT, CIRCLE_IN, CIRCLE_OUT, RALLY = 5000, 5001, 5002, 5003, 5004, 5100
"""MAV_CMD numbers."""
GLOBAL, RELATIVE_ALTITUDE = 0, 3
"""MAV_FRAME numbers of what we write, as QGroundControl does."""
_TYPES = {
    POLYGON_IN: FenceType.INCLUSION,
    POLYGON_OUT: FenceType.EXCLUSION,
    CIRCLE_IN: FenceType.INCLUSION,
    CIRCLE_OUT: FenceType.EXCLUSION,
}

RallyPlace = tuple[float, float, float]
"""Latitude, longitude [deg] and altitude above home [m]."""


def fence_items(fence: GeofenceData) -> tuple[RawItem, ...]:
    """A geofence as items: a vertex each with the number of its polygon's vertices, a circle each."""
    items = []
    for polygon in fence.polygons:
        command = POLYGON_IN if polygon.fence_type is FenceType.INCLUSION else POLYGON_OUT
        items += [_at(command, GLOBAL, float(len(polygon.points)), place) for place in polygon.points]
    for circle in fence.circles:
        command = CIRCLE_IN if circle.fence_type is FenceType.INCLUSION else CIRCLE_OUT
        items.append(_at(command, GLOBAL, circle.radius_m, circle.point))
    return tuple(items)


def fence_of_items(items: Sequence[RawItem]) -> GeofenceData:
    """The geofence that items describe; a point to return to is no area.

    Raises
    ------
    LinkError
        If they cannot be understood; names the item. An area that is not understood is never left out.
    """
    polygons, circles = [], []
    number = 0
    while number < len(items):
        item = items[number]
        size = item.params[0]
        if item.command in (CIRCLE_IN, CIRCLE_OUT):
            if not 0.0 < size < math.inf:
                raise LinkError(f"item {number} of the geofence: radius = {size:g}, must be above 0")
            circles.append(FenceCircle(_place(item), size, _TYPES[item.command]))
        elif item.command in (POLYGON_IN, POLYGON_OUT):
            corners = items[number : number + int(size)] if 3.0 <= size < math.inf else ()
            same = [each for each in corners if (each.command, each.params[0]) == (item.command, size)]
            if not corners or len(same) != int(size):
                raise LinkError(f"item {number} of the geofence: a polygon of {size:g} corners is not whole")
            polygons.append(FencePolygon(tuple(map(_place, corners)), _TYPES[item.command]))
            number += len(corners) - 1
        elif item.command != RETURN_POINT:
            raise LinkError(f"item {number} of the geofence: MAV_CMD {item.command} is no area")
        number += 1
    return GeofenceData(tuple(polygons), tuple(circles))


def rally_items(points: Sequence[RallyPlace]) -> tuple[RawItem, ...]:
    """Rally points as items."""
    return tuple(_at(RALLY, RELATIVE_ALTITUDE, 0.0, (lat, lon), up) for lat, lon, up in points)


def rally_of_items(items: Sequence[RawItem], home_altitude: float) -> tuple[RallyPlace, ...]:
    """The rally points that items describe, above a home at `home_altitude` [m].

    Raises
    ------
    LinkError
        If one is none, or its altitude is neither above the sea nor above home.
    """
    found = []
    for number, item in enumerate(items):
        if item.command != RALLY or item.frame not in ABSOLUTE | RELATIVE:
            words = f"MAV_CMD {item.command} in MAV_FRAME {item.frame}"
            raise LinkError(f"item {number} of the rally points: {words} is not understood")
        altitude = item.z - home_altitude if item.frame in ABSOLUTE else item.z
        found.append((*_place(item), altitude))
    return tuple(found)


def _at(command: int, frame: int, size: float, place: tuple[float, float], altitude: float = 0.0) -> RawItem:
    latitude_deg, longitude_deg = place
    x, y = round(latitude_deg * DEGREE), round(longitude_deg * DEGREE)
    return RawItem(command, frame, (size, 0.0, 0.0, 0.0), x, y, altitude)


def _place(item: RawItem) -> tuple[float, float]:
    return item.x / DEGREE, item.y / DEGREE
