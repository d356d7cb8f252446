"""The earth's magnetic field by the World Magnetic Model, as a magnetometer of the aircraft feels it."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from typing import NamedTuple

NANOTESLA_PER_GAUSS = 1e5
REACH = 0.05
"""The field is taken anew after this change of latitude or longitude [deg]; it changes by some 1e-4 G."""
CLIMB = 500.0
"""… or of altitude [m]."""


class Field(NamedTuple):
    """Magnetic field, true north, east, down [G]."""

    north: float
    east: float
    down: float

    @property
    def declination(self) -> float:
        """Direction of magnetic north, clockwise from true north [rad]."""
        return math.atan2(self.east, self.north)


class MagneticField:
    """The field about a place, for a date.

    Parameters
    ----------
    start : datetime
        When the run starts; the model of its five years is used, the nearest one outside 2010 to 2030.

    Notes
    -----
    World Magnetic Model, NOAA/NCEI and British Geological Survey, by the package pygeomag.
    """

    def __init__(self, start: datetime) -> None:
        from pygeomag import GeoMag  # noqa: PLC0415  (needed by PX4 only)

        self._year = _decimal_year(start)
        epoch = int(min(max(self._year, 2010.0), 2029.0) // 5 * 5)
        self._model = GeoMag(coefficients_file=f"wmm/WMM_{epoch}.COF")
        self._place = (math.inf, math.inf, math.inf)
        self._field = Field(0.0, 0.0, 0.0)

    def at(self, latitude_deg: float, longitude_deg: float, altitude_m: float) -> Field:
        """The field at a place, altitude above mean sea level."""
        latitude, longitude, altitude = self._place
        near = abs(latitude_deg - latitude) <= REACH and abs(longitude_deg - longitude) <= REACH
        if not near or not abs(altitude_m - altitude) <= CLIMB:
            self._place = (latitude_deg, longitude_deg, altitude_m)
            found = self._model.calculate(
                glat=latitude_deg,
                glon=longitude_deg,
                alt=altitude_m / 1e3,
                time=self._year,
                allow_date_outside_lifespan=True,
            )
            self._field = Field(*(each / NANOTESLA_PER_GAUSS for each in (found.x, found.y, found.z)))
        return self._field


def _decimal_year(start: datetime) -> float:
    begin = datetime(start.year, 1, 1, tzinfo=UTC)
    end = datetime(start.year + 1, 1, 1, tzinfo=UTC)
    return start.year + (start.astimezone(UTC) - begin) / (end - begin)
