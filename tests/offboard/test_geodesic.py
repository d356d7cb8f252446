from __future__ import annotations

import math

import numpy as np
import pytest
from pymap3d.vincenty import vdist, vreckon

from offboard.geodesic import direct, inverse


@pytest.mark.parametrize("latitude", [-75.0, -30.0, 0.5, 14.39, 60.0])
@pytest.mark.parametrize("azimuth", [0.0, 1e-6, 37.0, 90.0, 180.0, 301.0])
@pytest.mark.parametrize("distance", [1.0, 5e3, 4e5])
def test_agrees_with_pymap3d_one_point_at_a_time(latitude: float, azimuth: float, distance: float) -> None:
    there = direct(math.radians(latitude), math.radians(76.6), np.array(distance), np.radians(azimuth))
    expected = vreckon(latitude, 76.6, distance, azimuth)
    back = inverse(math.radians(latitude), math.radians(76.6), *there)
    length, _ = vdist(latitude, 76.6, float(expected[0]), float(expected[1]))

    assert math.degrees(there[0]) == pytest.approx(float(expected[0]), abs=1e-9)
    assert (math.degrees(there[1]) - float(expected[1]) + 180.0) % 360.0 - 180.0 == pytest.approx(0, abs=1e-9)
    assert float(back[0]) == pytest.approx(float(length), abs=1e-4)


def test_coinciding_points_spoil_nothing() -> None:
    latitudes, longitudes = np.radians([14.39, 15.0, 14.39]), np.radians([76.60, 76.60, 77.0])

    together, _ = inverse(latitudes[0], longitudes[0], latitudes, longitudes)
    alone = [float(inverse(latitudes[0], longitudes[0], latitudes[i], longitudes[i])[0]) for i in range(3)]

    assert together[0] == 0.0
    np.testing.assert_allclose(together, alone, rtol=0, atol=1e-6)


def test_a_quarter_of_the_equator_has_its_length() -> None:
    distance, azimuth = inverse(0.0, 0.0, np.array(0.0), np.array(0.5 * math.pi))

    assert float(distance) == pytest.approx(0.5 * math.pi * 6378137.0, abs=1e-3)
    assert float(azimuth) == pytest.approx(0.5 * math.pi)


def test_antipodal_points_are_refused() -> None:
    with pytest.raises(ValueError, match="opposite sides"):
        inverse(0.1, 0.2, np.array(-0.1), np.array(0.2 + math.pi - 1e-4))
