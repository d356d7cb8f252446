"""Eqs. (2)-(6)."""

from __future__ import annotations

import numpy as np
import pytest

from avoidance.cost import path_length, risk


def test_path_length_is_the_sum_of_both_segments() -> None:
    points = np.array([[3.0, 4.0], [0.0, 10.0]])
    assert path_length(points, (0.0, 0.0), (3.0, 14.0)).tolist() == [15.0, pytest.approx(10.0 + 5.0)]


def test_risk_as_printed_squares_the_sum_of_intrusions() -> None:
    centres = np.array([[0.0, 0.0], [0.0, 1000.0]])
    value = risk(np.array([[0.0, 500.0]]), centres, 2000.0, squared_metres=True)
    assert value[0] == pytest.approx((1500.0 + 1500.0) ** 2)


def test_risk_without_dimension_adds_squared_relative_intrusions() -> None:
    centres = np.array([[0.0, 0.0], [0.0, 1000.0]])
    value = risk(np.array([[0.0, 500.0]]), centres, 2000.0, squared_metres=False)
    assert value[0] == pytest.approx(2 * 0.75**2)


def test_obstacles_beyond_the_risk_distance_cost_nothing() -> None:
    assert risk(np.array([[0.0, 0.0]]), np.array([[0.0, 2000.0]]), 2000.0, squared_metres=True)[0] == 0.0


def test_no_obstacles_no_risk() -> None:
    assert risk(np.zeros((3, 2)), np.empty((0, 2)), 2000.0, squared_metres=False).tolist() == [0.0, 0.0, 0.0]
