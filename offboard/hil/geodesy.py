"""Map metres to latitude and longitude at every step, and what ArduPilot calls metres from home.

The exact map (`offboard.frames`) solves a geodesic for each point: too slow at 1,000 Hz. Here it is solved
about an anchor that moves with the aircraft, and carried on linearly in between.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from offboard.frames import MapFrame
from offboard.hil.plant import Truth

REACH = 250.0
"""An anchor serves this far [m]; the linear map errs by 5 mm there at 47° of latitude."""
_PROBE = 100.0
METRES_PER_DEGREE = 111318.84502145034
"""ArduPilot's: a sphere of 6,378,100 m (its LOCATION_SCALING_FACTOR)."""


class Place(NamedTuple):
    """A point of the map on the earth."""

    latitude_deg: float
    longitude_deg: float
    convergence: float
    """Direction of the map's north, clockwise from true north [rad]."""


class Geodesy:
    """Latitude, longitude and the map's north at points that lie close to one another.

    Examples
    --------
    >>> place = Geodesy(MapFrame(47.397742, 8.545594)).at(100.0, 0.0)
    >>> round(place.latitude_deg, 6), round(place.longitude_deg, 6)
    (47.398641, 8.545594)
    """

    def __init__(self, frame: MapFrame) -> None:
        self.frame = frame
        self._north = self._east = math.inf
        self._latitude = self._longitude = self._convergence = 0.0
        self._per_north = self._per_east = (0.0, 0.0)

    def at(self, north: float, east: float) -> Place:
        """Where a map point [m] lies on the earth."""
        if not (abs(north - self._north) <= REACH and abs(east - self._east) <= REACH):
            self._anchor(north, east)
        dn, de = north - self._north, east - self._east
        return Place(
            self._latitude + self._per_north[0] * dn + self._per_east[0] * de,
            self._longitude + self._per_north[1] * dn + self._per_east[1] * de,
            self._convergence,
        )

    def ardupilot_offset(self, place: Place) -> tuple[float, float]:
        """North and east of home [m] by which ArduPilot arrives at this latitude and longitude.

        Its metres are those of a sphere: 0.1 % off the ellipsoid's, 100 m after 100 km.
        """
        home = self.frame
        north = place.latitude_deg - home.latitude_deg
        east = (place.longitude_deg - home.longitude_deg + 180.0) % 360.0 - 180.0
        shrink = math.cos(math.radians(home.latitude_deg + 0.5 * north))
        return north * METRES_PER_DEGREE, east * METRES_PER_DEGREE * shrink

    def _anchor(self, north: float, east: float) -> None:
        self._north, self._east = north, east
        self._latitude, self._longitude = self.frame.to_geodetic(north, east)
        self._per_north = self._slope(north, east, _PROBE, 0.0)
        self._per_east = self._slope(north, east, 0.0, _PROBE)
        shrink = math.cos(math.radians(self._latitude))
        # Radii of curvature differ by 0.7 % at most; the angle is small, so their ratio may be left out.
        self._convergence = math.atan2(self._per_north[1] * shrink, self._per_north[0])

    def _slope(self, north: float, east: float, dn: float, de: float) -> tuple[float, float]:
        """Degrees of latitude and longitude per metre, by central difference."""
        ahead = self.frame.to_geodetic(north + dn, east + de)
        behind = self.frame.to_geodetic(north - dn, east - de)
        span = 2.0 * (dn + de)
        turn = (ahead[1] - behind[1] + 180.0) % 360.0 - 180.0
        return (ahead[0] - behind[0]) / span, turn / span


def true_north(truth: Truth, convergence: float) -> Truth:
    """The same motion in axes of true north: attitude and velocity turned by the map's direction [rad]."""
    if abs(convergence) < 1e-12:
        return truth
    t = truth
    ch, sh = math.cos(0.5 * convergence), math.sin(0.5 * convergence)
    c, s = math.cos(convergence), math.sin(convergence)
    return t._replace(
        velocity_north=c * t.velocity_north - s * t.velocity_east,
        velocity_east=s * t.velocity_north + c * t.velocity_east,
        qw=ch * t.qw - sh * t.qz,
        qx=ch * t.qx - sh * t.qy,
        qy=ch * t.qy + sh * t.qx,
        qz=ch * t.qz + sh * t.qw,
    )
