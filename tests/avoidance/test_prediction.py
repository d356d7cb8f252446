"""Closest point of approach along a route, in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from avoidance.prediction import route_separation


def test_head_on_meets_in_the_middle() -> None:
    route = np.array([[[0.0, 0.0], [10_000.0, 0.0]]])
    separation = route_separation(route, 15.0, np.array([[9000.0, 600.0]]), np.array([[-15.0, 0.0]]))
    assert separation[0, 0] == pytest.approx(600.0)


def test_beyond_the_horizon_nothing_counts() -> None:
    route = np.array([[[0.0, 0.0], [10_000.0, 0.0]]])
    position, velocity = np.array([[9000.0, 0.0]]), np.array([[-15.0, 0.0]])
    assert route_separation(route, 15.0, position, velocity, horizon=100.0)[0, 0] == pytest.approx(6000.0)


numbers = st.floats(-8000.0, 8000.0)


@given(
    st.lists(st.tuples(numbers, numbers), min_size=2, max_size=4),
    st.tuples(numbers, numbers),
    st.tuples(st.floats(-40.0, 40.0), st.floats(-40.0, 40.0)),
)
def test_no_sampled_moment_is_closer(
    corners: list[tuple[float, float]], position: tuple[float, float], velocity: tuple[float, float]
) -> None:
    route = np.array(corners)
    value = route_separation(route[None], 15.0, np.array([position]), np.array([velocity]))[0, 0]
    lengths = np.hypot(*np.diff(route, axis=0).T)
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    for travelled in np.linspace(0.0, ends[-1], 200):
        own = np.array([np.interp(travelled, ends, route[:, axis]) for axis in (0, 1)])
        other = np.array(position) + np.array(velocity) * travelled / 15.0
        assert value <= np.hypot(*(own - other)) + 1e-6
