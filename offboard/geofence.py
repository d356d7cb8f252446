"""A geofence as plan files and MAVSDK have it: areas to stay in, areas to stay out of."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum


class FenceType(Enum):
    """What an area is for."""

    INCLUSION = "inclusion"
    EXCLUSION = "exclusion"


@dataclass(frozen=True, slots=True)
class FencePolygon:
    """An area within straight edges."""

    points: tuple[tuple[float, float], ...]
    """Latitude and longitude of each corner [deg]; the last is joined to the first."""
    fence_type: FenceType


@dataclass(frozen=True, slots=True)
class FenceCircle:
    """An area within a distance of a point."""

    point: tuple[float, float]
    """Latitude and longitude of the centre [deg]."""
    radius_m: float
    """Radius [m]."""
    fence_type: FenceType


@dataclass(frozen=True, slots=True)
class GeofenceData:
    """All areas: inside at least one of those to stay in, if there are any, and outside all others."""

    polygons: tuple[FencePolygon, ...] = ()
    circles: tuple[FenceCircle, ...] = ()


def fence_object(fence: GeofenceData) -> dict[str, object]:
    """The geofence of a `.plan` file as JSON (QGroundControl's "Plan File Format", version 2)."""
    return {
        "version": 2,
        "circles": [
            {
                "version": 1,
                "inclusion": c.fence_type is FenceType.INCLUSION,
                "circle": {"center": list(c.point), "radius": c.radius_m},
            }
            for c in fence.circles
        ],
        "polygons": [
            {
                "version": 1,
                "inclusion": p.fence_type is FenceType.INCLUSION,
                "polygon": [list(corner) for corner in p.points],
            }
            for p in fence.polygons
        ],
    }


def fence_of(value: object) -> GeofenceData:
    """The geofence that a `.plan` file's object describes; none if there is no object.

    Raises
    ------
    ValueError
        If it cannot be understood; an area that is not understood is never left out.
    """
    if value is None:
        return GeofenceData()
    if not isinstance(value, Mapping):
        raise ValueError("is no object")
    polygons = [_polygon(area) for area in _areas(value, "polygons")]
    circles = [_circle(area) for area in _areas(value, "circles")]
    return GeofenceData(tuple(polygons), tuple(circles))


def _areas(value: Mapping[str, object], key: str) -> Sequence[Mapping[str, object]]:
    areas = value.get(key, [])
    if not isinstance(areas, list) or not all(isinstance(area, Mapping) for area in areas):
        raise ValueError(f"{key} is no list of objects")
    return areas


def _polygon(area: Mapping[str, object]) -> FencePolygon:
    corners = area.get("polygon")
    if not isinstance(corners, list) or len(corners) < 3:
        raise ValueError("a polygon needs at least 3 corners")
    return FencePolygon(tuple(_place(corner) for corner in corners), _type(area))


def _circle(area: Mapping[str, object]) -> FenceCircle:
    circle = area.get("circle")
    if not isinstance(circle, Mapping):
        raise ValueError("a circle has no centre and radius")
    radius = circle.get("radius")
    if isinstance(radius, bool) or not isinstance(radius, int | float) or not 0.0 < radius < math.inf:
        raise ValueError(f"radius = {radius}, must be above 0")
    return FenceCircle(_place(circle.get("center")), float(radius), _type(area))


def _type(area: Mapping[str, object]) -> FenceType:
    inclusion = area.get("inclusion")
    if not isinstance(inclusion, bool):
        raise ValueError(f"inclusion = {inclusion}, must be true or false")
    return FenceType.INCLUSION if inclusion else FenceType.EXCLUSION


def _place(value: object) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) != 2:
        raise ValueError(f"{value} is no latitude and longitude")
    latitude, longitude = value
    for number, limit in ((latitude, 90.0), (longitude, 180.0)):
        if isinstance(number, bool) or not isinstance(number, int | float) or not abs(number) <= limit:
            raise ValueError(f"{value} is no latitude and longitude")
    return float(latitude), float(longitude)
