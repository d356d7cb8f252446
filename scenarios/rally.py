"""Rally points: on the map, in plan files, in the avoidance core."""

from __future__ import annotations

from collections.abc import Sequence

from avoidance import Waypoint
from offboard.frames import MapFrame
from scenarios.scenario import Point


def core_rally(points: Sequence[Point]) -> tuple[Waypoint, ...]:
    """Rally points as the avoidance core takes them."""
    return tuple(Waypoint(point.north, point.east, point.altitude) for point in points)


def rally_data(points: Sequence[Point], frame: MapFrame) -> tuple[tuple[float, float, float], ...]:
    """Rally points as plan files have them."""
    places = [(frame.to_geodetic(point.north, point.east), point.altitude) for point in points]
    return tuple((float(latitude), float(longitude), altitude) for (latitude, longitude), altitude in places)


def rally_points(rally: Sequence[tuple[float, float, float]], frame: MapFrame) -> tuple[Point, ...]:
    """A plan file's rally points on the map."""
    places = [(*frame.to_map(latitude, longitude), altitude) for latitude, longitude, altitude in rally]
    return tuple(Point(round(north, 3), round(east, 3), altitude) for north, east, altitude in places)
