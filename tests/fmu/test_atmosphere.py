"""Air density against the tables of the US Standard Atmosphere 1976 (geometric altitude)."""

from __future__ import annotations

import pytest

TABLE = {0: 1.2250, 1000: 1.1117, 5000: 0.73643, 10000: 0.41351, 15000: 0.19476, 20000: 0.088910}


@pytest.mark.parametrize("altitude", TABLE)
def test_density_follows_the_table(altitude, make_plant):
    plant = make_plant(altitude=altitude, fidelity="kinematic")
    assert plant.get("air.density") == pytest.approx(TABLE[altitude], rel=1e-4)


def test_home_elevation_counts(make_plant):
    high = make_plant(altitude=200.0, home_elevation=800.0)
    assert high.get("air.density") == pytest.approx(TABLE[1000], rel=1e-4)
    assert high.get("state.throttle") > make_plant(altitude=200.0).get("state.throttle")
