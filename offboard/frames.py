"""Geodetic coordinates ↔ map metres about home.

The map is azimuthal equidistant on the WGS-84 ellipsoid: a point at geodesic distance s and azimuth α
from home lies at north = s·cos α, east = s·sin α. Distance and direction from home are exact; altitude is
carried beside the map, for a tangent plane would be 9.7 km off in height at 350 km.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import overload

import numpy as np
from pymap3d.vincenty import vdist, vreckon

from avoidance.types import Floats

FURTHEST = 10_000e3
"""A map about home means nothing beyond this distance [m]."""


@dataclass(frozen=True, slots=True)
class MapFrame:
    """The map about one home position.

    Examples
    --------
    >>> home = MapFrame(14.39, 76.60, 600.0)
    >>> north, east = home.to_map(15.29, 76.60)
    >>> f"{north:.2f} {east:.2f}"
    '99582.45 0.00'
    """

    latitude_deg: float
    """Geodetic latitude of home, -90 to 90 [deg]."""
    longitude_deg: float
    """Longitude of home, -180 to 180 [deg]."""
    altitude_m: float = 0.0
    """Altitude of home above mean sea level [m]; map altitudes count from here."""

    def __post_init__(self) -> None:
        """Check the position.

        Raises
        ------
        ValueError
            If a coordinate is not finite or out of its range.
        """
        for name, value, limit in (
            ("latitude_deg", self.latitude_deg, 90.0),
            ("longitude_deg", self.longitude_deg, 180.0),
            ("altitude_m", self.altitude_m, 1e5),
        ):
            if not abs(value) <= limit:  # also refuses NaN
                raise ValueError(f"{name} = {value}, must be between {-limit:g} and {limit:g}")

    @overload
    def to_map(self, latitude_deg: float, longitude_deg: float) -> tuple[float, float]: ...
    @overload
    def to_map(self, latitude_deg: Floats, longitude_deg: Floats) -> tuple[Floats, Floats]: ...
    def to_map(
        self, latitude_deg: float | Floats, longitude_deg: float | Floats
    ) -> tuple[float | Floats, float | Floats]:
        """North and east [m] of geodetic positions [deg].

        Parameters
        ----------
        latitude_deg, longitude_deg : float or array, any shape
            Positions [deg].

        Returns
        -------
        north, east : float or array of the same shape
            Map coordinates [m].

        Raises
        ------
        ValueError
            If a position is not finite, or further than 10,000 km from home.
        """
        points = np.array([latitude_deg, longitude_deg], dtype=np.float64)
        if not np.all(np.isfinite(points)):
            raise ValueError(
                f"latitude_deg = {latitude_deg}, longitude_deg = {longitude_deg}, must be finite"
            )
        north, east = self._each(_inverse, points[0], points[1])
        return _plain(north), _plain(east)

    @overload
    def to_geodetic(self, north: float, east: float) -> tuple[float, float]: ...
    @overload
    def to_geodetic(self, north: Floats, east: Floats) -> tuple[Floats, Floats]: ...
    def to_geodetic(
        self, north: float | Floats, east: float | Floats
    ) -> tuple[float | Floats, float | Floats]:
        """Latitude and longitude [deg] of map positions [m].

        Parameters
        ----------
        north, east : float or array, any shape
            Map coordinates [m].

        Returns
        -------
        latitude_deg, longitude_deg : float or array of the same shape
            Positions [deg], longitude from -180 up to 180.

        Notes
        -----
        The round trip closes to a micrometre within 400 km.
        """
        latitude, longitude = self._each(_direct, *np.array([north, east], dtype=np.float64))
        return _plain(latitude), _plain(longitude)

    def _each(
        self,
        convert: Callable[[float, float, float, float], tuple[float, float]],
        first: Floats,
        second: Floats,
    ) -> Floats:
        """Convert point by point, shape (2, ...): pymap3d errs on arrays in which two points coincide."""
        pairs = [
            convert(self.latitude_deg, self.longitude_deg, a, b)
            for a, b in zip(first.ravel().tolist(), second.ravel().tolist(), strict=True)
        ]
        return np.array(pairs, dtype=np.float64).reshape(-1, 2).T.reshape(2, *first.shape)


def _inverse(
    home_latitude: float, home_longitude: float, latitude: float, longitude: float
) -> tuple[float, float]:
    """North and east [m] of a position [deg] on the geodesic from home [deg]."""
    if (latitude, longitude) == (home_latitude, home_longitude):
        return 0.0, 0.0
    distance, azimuth = vdist(home_latitude, home_longitude, latitude, longitude)
    if not float(distance) < FURTHEST:
        raise ValueError(
            f"latitude_deg = {latitude}, longitude_deg = {longitude}, is {float(distance) / 1000:.0f} km "
            f"from home, must be within {FURTHEST / 1000:.0f} km"
        )
    direction = math.radians(float(azimuth))
    return float(distance) * math.cos(direction), float(distance) * math.sin(direction)


def _direct(home_latitude: float, home_longitude: float, north: float, east: float) -> tuple[float, float]:
    """Latitude and longitude [deg] at the end of the geodesic from home [deg] to a map point [m]."""
    distance = math.hypot(north, east)
    if distance == 0.0:
        return home_latitude, home_longitude
    azimuth = math.degrees(math.atan2(east, north))
    latitude, longitude = vreckon(home_latitude, home_longitude, distance, azimuth)
    return float(latitude), (float(longitude) + 180.0) % 360.0 - 180.0


def _plain(value: float | Floats) -> float | Floats:
    """A float for a single number, else the array."""
    array = np.asarray(value, dtype=np.float64)
    return array if array.ndim else float(array)
