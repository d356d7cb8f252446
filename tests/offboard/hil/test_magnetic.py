"""The field of the World Magnetic Model, against the published test values and a real autopilot's compass."""

from __future__ import annotations

import math
from datetime import UTC, datetime

import pytest

from offboard.hil.magnetic import MagneticField

MID_2025 = datetime(2025, 7, 2, 12, tzinfo=UTC)


@pytest.mark.parametrize(
    ("latitude", "longitude", "north", "east", "down"),
    [  # WMM2025 test values, 2025.0, sea level [nT]
        (80.0, 0.0, 6521.6, 145.9, 54791.5),
        (0.0, 120.0, 39677.9, -109.6, -10580.2),
        (-80.0, 240.0, 6117.5, 15751.9, -52022.5),
    ],
)
def test_published_test_values(latitude, longitude, north, east, down):
    field = MagneticField(datetime(2025, 1, 1, tzinfo=UTC)).at(latitude, longitude, 0.0)
    assert tuple(field) == pytest.approx((north / 1e5, east / 1e5, down / 1e5), abs=2e-6)


def test_the_field_that_px4_was_recorded_with():
    """47.4° N, 8.5° E: 0.213, 0.010, 0.427 G flew (a compass reading without declination of today)."""
    field = MagneticField(MID_2025).at(47.397742, 8.545594, 488.0)
    assert math.hypot(*field) == pytest.approx(math.hypot(0.2136, 0.0103, 0.4273), rel=0.02)
    assert math.degrees(field.declination) == pytest.approx(3.5, abs=0.5)


def test_taken_anew_only_where_it_matters():
    source = MagneticField(MID_2025)
    here = source.at(47.0, 8.0, 500.0)
    assert source.at(47.01, 8.0, 510.0) is here
    assert source.at(48.0, 8.0, 500.0) != here
    assert source.at(48.0, 8.0, 5000.0) != source.at(48.0, 8.0, 0.0)


@pytest.mark.parametrize("year", [1995, 2012, 2021, 2040])
def test_any_year_gives_a_field(year):
    field = MagneticField(datetime(year, 6, 1, tzinfo=UTC)).at(47.0, 8.0, 500.0)
    assert math.hypot(*field) == pytest.approx(0.48, abs=0.02)
