"""Eqs. (7)-(12)."""

from __future__ import annotations

import math

import numpy as np
import pytest

from avoidance.constraints import (
    feasible_segments,
    flyable_turn,
    safe_waypoint,
    search_space,
    turning_angle,
)

ONE = np.array([[1000.0, 0.0]])


def test_g1_is_the_largest_shortfall() -> None:
    points = np.array([[1000.0, 1500.0], [1000.0, 2500.0]])
    assert safe_waypoint(points, ONE, np.array([2000.0])).tolist() == [500.0, 0.0]


def test_g2_is_measured_from_the_nearest_member_of_the_cluster() -> None:
    members = np.array([[0.0, 0.0], [0.0, 3000.0]])
    assert search_space(np.array([[0.0, 8000.0], [0.0, 6000.0]]), members, 4000.0).tolist() == [1000.0, 0.0]


def test_g3_tests_segments_and_not_lines() -> None:
    starts = np.array([[[0.0, 0.0]], [[0.0, 0.0]]])
    ends = np.array([[[500.0, 0.0]], [[2000.0, 0.0]]])
    behind = np.array([[-800.0, 0.0]])
    assert feasible_segments(starts, ends, np.zeros((2, 1)), behind, np.array([700.0])).tolist() == [0.0, 0.0]
    shortfall = feasible_segments(starts, ends, np.zeros((2, 1)), ONE, np.array([400.0]))
    assert shortfall.tolist() == [0.0, 400.0]


def test_g3_adds_the_room_of_a_turn() -> None:
    starts, ends = np.array([[[0.0, 0.0]]]), np.array([[[0.0, 10.0]]])
    assert feasible_segments(starts, ends, np.array([[90.0]]), ONE, np.array([950.0]))[0] == pytest.approx(
        40.0
    )


def test_g4_as_printed_limits_the_heading_change() -> None:
    points = np.array([[1000.0, 0.0], [1000.0, 1000.0]])
    excess = turning_angle(points, (0.0, 0.0), (2000.0, 0.0), math.radians(30.0))
    assert excess.tolist() == [0.0, pytest.approx(1000.0 * math.radians(60.0))]


@pytest.mark.parametrize(("leg", "shortfall"), [(1000.0, 0.0), (30.0, 10.0)])
def test_g4_asks_for_room_to_turn(leg: float, shortfall: float) -> None:
    point = np.array([[leg, 0.0]])
    value = flyable_turn(point, (0.0, 0.0), (leg, 5000.0), None, 40.0)  # 90 degrees: R tan 45 = 40 m
    assert value[0] == pytest.approx(shortfall)


def test_g4_counts_the_turn_at_the_start() -> None:
    value = flyable_turn(np.array([[0.0, 30.0]]), (0.0, 0.0), (0.0, 5000.0), 0.0, 40.0)
    assert value[0] == pytest.approx(10.0)
