from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from pymap3d.vincenty import vdist

from offboard.frames import MapFrame

AZIMUTH = st.floats(0.0, 2.0 * math.pi)
DISTANCE = st.floats(0.0, 400_000.0)


@given(
    latitude=st.floats(-85.0, 85.0), longitude=st.floats(-180.0, 180.0), distance=DISTANCE, azimuth=AZIMUTH
)
@example(latitude=14.39, longitude=76.60, distance=400_000.0, azimuth=0.0)
@example(latitude=14.39, longitude=76.60, distance=400_000.0, azimuth=1e-9)
@example(latitude=14.39, longitude=76.60, distance=350_000.0, azimuth=math.pi - 1e-12)
@example(latitude=0.0, longitude=179.99, distance=400_000.0, azimuth=0.5 * math.pi)
@example(latitude=0.0, longitude=180.0, distance=0.0, azimuth=0.0)
@example(latitude=0.0, longitude=-180.0, distance=1e-12, azimuth=1.5 * math.pi)
def test_round_trip_closes_within_a_millimetre(
    latitude: float, longitude: float, distance: float, azimuth: float
) -> None:
    frame = MapFrame(latitude, longitude)
    north, east = distance * math.cos(azimuth), distance * math.sin(azimuth)

    latitude_deg, longitude_deg = frame.to_geodetic(north, east)
    again = frame.to_map(latitude_deg, longitude_deg)

    assert math.dist(again, (north, east)) < 1e-3
    assert -180.0 <= longitude_deg < 180.0


def test_distances_from_home_are_those_on_the_ellipsoid() -> None:
    # Length of the meridian arc by quadrature of the radius of curvature, and of the equator: WGS-84.
    a, f = 6378137.0, 1.0 / 298.257223563
    e2 = f * (2.0 - f)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    phi = np.radians(10.0 + 1.5 * (nodes + 1.0))
    meridian = np.radians(1.5) * np.sum(weights * a * (1.0 - e2) / (1.0 - e2 * np.sin(phi) ** 2) ** 1.5)

    north, east = MapFrame(10.0, 20.0).to_map(13.0, 20.0)
    assert north == pytest.approx(meridian, abs=1e-3)
    assert east == pytest.approx(0.0, abs=1e-6)

    north, east = MapFrame(0.0, 20.0).to_map(0.0, 22.0)
    assert east == pytest.approx(math.radians(2.0) * a, abs=1e-3)
    assert north == pytest.approx(0.0, abs=1e-3)


def test_arrays_give_what_single_positions_give() -> None:
    frame = MapFrame(-33.5, 151.2)
    north, east = np.array([0.0, 1e3, -3e5]), np.array([0.0, -2e3, 1e5])

    latitudes, longitudes = frame.to_geodetic(north, east)
    norths, easts = frame.to_map(latitudes, longitudes)

    singles = [frame.to_geodetic(float(n), float(e)) for n, e in zip(north, east, strict=True)]
    np.testing.assert_allclose(np.column_stack([latitudes, longitudes]), singles, rtol=0, atol=1e-12)
    np.testing.assert_allclose(np.column_stack([norths, easts]), np.column_stack([north, east]), atol=1e-3)
    assert isinstance(singles[0][0], float)


@pytest.mark.parametrize(
    ("latitude", "longitude", "named"),
    [(91.0, 0.0, "latitude_deg"), (0.0, -180.5, "longitude_deg"), (math.nan, 0.0, "latitude_deg")],
)
def test_home_out_of_range_is_refused(latitude: float, longitude: float, named: str) -> None:
    with pytest.raises(ValueError, match=named):
        MapFrame(latitude, longitude)


def test_the_other_side_of_the_earth_is_refused() -> None:
    with pytest.raises(ValueError, match="must be within 10000 km"):
        MapFrame(14.39, 76.60).to_map(-14.39, -103.4)


def test_a_quarter_of_the_equator_has_its_length() -> None:
    """0.5 π a with the WGS-84 semi-major axis, within the limit of the map when halved."""
    north, east = MapFrame(0.0, 0.0).to_map(0.0, 45.0)
    assert north == pytest.approx(0.0, abs=1e-3)
    assert east == pytest.approx(0.25 * math.pi * 6378137.0, abs=1e-3)


@given(
    latitude=st.floats(-85.0, 85.0), longitude=st.floats(-180.0, 180.0), distance=DISTANCE, azimuth=AZIMUTH
)
def test_an_independent_implementation_agrees_within_a_tenth_of_a_millimetre(
    latitude: float, longitude: float, distance: float, azimuth: float
) -> None:
    frame = MapFrame(latitude, longitude)
    place = frame.to_geodetic(distance * math.cos(azimuth), distance * math.sin(azimuth))
    theirs, _ = vdist(latitude, longitude, *place)
    assert math.hypot(*frame.to_map(*place)) == pytest.approx(float(theirs), abs=1e-4)
