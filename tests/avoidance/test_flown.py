"""The segments that enclose the flown curve."""

from __future__ import annotations

import math

import numpy as np
import pytest

from avoidance.flown import flown_segments, turn_angle
from tests.avoidance.worlds import PERFORMANCE


def test_a_straight_route_is_its_own_hull() -> None:
    starts, ends, extra = flown_segments(np.array([[[0.0, 0.0], [1000.0, 0.0]]]), 0.0, PERFORMANCE)
    assert extra.max() == 0.0
    assert starts[..., 1].max() == ends[..., 1].max() == 0.0


def test_a_gentle_corner_adds_its_chord() -> None:
    route = np.array([[[0.0, 0.0], [1000.0, 0.0], [2000.0, 500.0]]])
    starts, ends, extra = flown_segments(route, None, PERFORMANCE)
    assert starts.shape == (1, 3, 2)
    assert starts[0, 2].tolist() == [885.0, 0.0]  # acceptance radius and one second before the waypoint
    assert ends[0, 2, 1] > 0.0
    assert extra.max() == 0.0


def test_a_reversal_needs_two_turn_radii_to_the_side() -> None:
    route = np.array([[[0.0, 0.0], [1000.0, 0.0], [0.0, 1.0]]])
    _, _, extra = flown_segments(route, None, PERFORMANCE)
    assert extra[0, 2] == pytest.approx(2 * PERFORMANCE.turn_radius)


def test_a_turn_from_the_present_course_runs_on_first() -> None:
    route = np.array([[[0.0, 0.0], [0.0, 5000.0]]])  # to the east, flying north
    starts, ends, _ = flown_segments(route, 0.0, PERFORMANCE)
    ahead = PERFORMANCE.turn_radius * math.tan(math.pi / 4) + 30.0
    assert ends[0, 1].tolist() == pytest.approx([ahead, 0.0])
    assert starts[0, 2].tolist() == pytest.approx([ahead, 0.0])


def test_turn_angle_is_unsigned() -> None:
    north, west = np.array([[1.0, 0.0]]), np.array([[0.0, -1.0]])
    assert turn_angle(north, west)[0] == pytest.approx(math.pi / 2)
