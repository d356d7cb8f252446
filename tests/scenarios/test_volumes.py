"""Well clear and near mid-air collision, against cases that are worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scenarios.track import MovingTrack, Track
from scenarios.volumes import NMAC, WELL_CLEAR, Cylinder, entered


def meeting(relative) -> tuple[Track, MovingTrack]:
    relative = np.array(relative, dtype=float)
    times, still = np.arange(float(len(relative))), np.zeros(len(relative))
    there = np.where(np.isnan(relative), math.nan, np.zeros_like(relative))
    return Track("own", times, np.nan_to_num(relative), still, still, still), MovingTrack(1, 1e3, there)


def test_feet_in_metres():
    assert (WELL_CLEAR.radius, WELL_CLEAR.height) == (pytest.approx(609.6), pytest.approx(76.2))
    assert (NMAC.radius, NMAC.height) == (pytest.approx(152.4), pytest.approx(30.48))


@pytest.mark.parametrize(
    ("relative", "inside"),
    [
        ([(-5000, 600, 0), (5000, 600, 0)], True),  # between two samples
        ([(-5000, 620, 0), (5000, 620, 0)], False),
        ([(-5000, 0, 80), (5000, 0, 80)], False),  # above
        ([(-5000, 0, 1000), (5000, 0, -1000)], True),  # down through the middle
        ([(-5000, 0, 0), (5000, 0, 2000)], False),  # level only before, near only above
        ([(100, 0, 0), (100, 0, 0)], True),  # does not move
        ([(700, 0, 0), (700, 0, 0)], False),
        ([(math.nan, 0, 0), (math.nan, 0, 0)], False),  # does not exist
    ],
)
def test_well_clear(relative, inside):
    assert entered(*meeting(relative), WELL_CLEAR) is inside


coordinate = st.floats(-2000.0, 2000.0)


@given(st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=2, max_size=4))
def test_agrees_with_sampling(corners):
    cylinder = Cylinder(600.0, 300.0)
    shares = np.linspace(0.0, 1.0, 400)[:, None]
    points = np.concatenate(
        [a + shares * (np.array(b) - a) for a, b in zip(np.array(corners), corners[1:], strict=False)]
    )
    depth = np.maximum(np.hypot(points[:, 0], points[:, 1]) - 600.0, np.abs(points[:, 2]) - 300.0)
    if depth.min() < -1e-6:
        assert entered(*meeting(corners), cylinder)
    elif depth.min() > 15.0:
        assert not entered(*meeting(corners), cylinder)
