"""Paths, their clearance and the waypoints that fly them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from avoidance.geometry import segments_clearance
from avoidance.tangent_graph import shortest_path

disc = st.tuples(st.floats(-10_000.0, 10_000.0), st.floats(-6_000.0, 6_000.0), st.floats(50.0, 3_000.0))
START, GOAL = (-15_000.0, 0.0), (15_000.0, 0.0)


def turns(corners: np.ndarray) -> np.ndarray:
    legs = np.diff(corners, axis=0)
    legs = legs[np.hypot(*legs.T) > 1e-3]
    course = np.arctan2(legs[:, 1], legs[:, 0])
    return np.abs(np.mod(np.diff(course) + math.pi, math.tau) - math.pi)


@settings(max_examples=60, deadline=None)
@given(st.lists(disc, min_size=1, max_size=12), st.sampled_from([5.0, 15.0, 30.0, 60.0, 90.0]))
def test_waypoints_keep_outside_and_turn_gently(world, most_deg) -> None:
    table = np.array(world)
    path = shortest_path(START, GOAL, table[:, :2], table[:, 2])
    assume(path is not None)

    corners = path.polyline(math.radians(most_deg))

    np.testing.assert_array_equal(corners[[0, -1]], [START, GOAL])
    assert (segments_clearance(corners[:-1], corners[1:], table[:, :2]) >= table[:, 2] * (1.0 - 2e-9)).all()
    assert turns(corners).max(initial=0.0) <= math.radians(most_deg) + 1e-5
    assert np.hypot(*np.diff(corners, axis=0).T).sum() >= path.length * (1.0 - 1e-9)


def test_waypoints_of_a_quarter_turn() -> None:
    """An arc of 90° at 30° a corner: three corners at r / cos 15° from the centre."""
    path = shortest_path((1_000.0, 0.0), (0.0, 1_000.0), np.zeros((1, 2)), np.array([1_000.0]))

    corners = path.polyline(math.radians(30.0))

    assert np.hypot(*corners[1:-1].T) == pytest.approx([1_000.0 / math.cos(math.radians(15.0))] * 3)
    angles = np.degrees(np.arctan2(corners[1:-1, 1], corners[1:-1, 0]))
    assert angles == pytest.approx([15.0, 45.0, 75.0], abs=1e-4)


def test_corners_multiply_where_a_neighbour_is_close() -> None:
    """A disc 1 m from the arc leaves no room for a corner 35 m outside it."""
    centres, radii = np.array([(0.0, 0.0), (0.0, 2_001.0)]), np.array([1_000.0, 1_000.0])
    ends = (-1_200.0, 300.0), (1_200.0, 300.0)

    roomy = shortest_path(*ends, centres[:1], radii[:1]).polyline(math.radians(30.0))
    corners = shortest_path(*ends, centres, radii).polyline(math.radians(30.0))

    assert segments_clearance(roomy[:-1], roomy[1:], centres)[:, 1].min() < 999.0
    assert len(corners) > len(roomy)
    assert (segments_clearance(corners[:-1], corners[1:], centres) >= radii * (1.0 - 2e-9)).all()


@pytest.mark.parametrize("bad", [0.0, -0.1, 1.6, math.nan])
def test_corner_limit_out_of_range_is_refused(bad) -> None:
    path = shortest_path(START, GOAL, np.empty((0, 2)), np.empty(0))

    with pytest.raises(ValueError, match="max_turn"):
        path.polyline(bad)


def test_clearance_is_the_least_over_sampled_points() -> None:
    rng = np.random.default_rng(4)
    centres, radii = rng.uniform(-6_000.0, 6_000.0, (8, 2)), rng.uniform(500.0, 1_500.0, 8)
    others = rng.uniform(-12_000.0, 12_000.0, (50, 2))
    path = shortest_path(START, GOAL, centres, radii)
    assert (path.discs >= 0).any()

    fine = path.polyline(math.radians(0.02))
    sampled = segments_clearance(fine[:-1], fine[1:], others).min(axis=0)

    np.testing.assert_allclose(path.clearance(others), sampled, rtol=0, atol=1e-3)
