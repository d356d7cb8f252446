"""Closest point of approach along a route, in closed form."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from avoidance.prediction import route_separation
from tests.avoidance.worlds import intruders


def test_head_on_meets_in_the_middle() -> None:
    route = np.array([[[0.0, 0.0], [10_000.0, 0.0]]])
    separation = route_separation(route, 15.0, intruders((9000.0, 600.0, -15.0, 0.0)))
    assert separation[0, 0] == pytest.approx(600.0)


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
    value = route_separation(route[None], 15.0, intruders((*position, *velocity)))[0, 0]
    lengths = np.hypot(*np.diff(route, axis=0).T)
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    for travelled in np.linspace(0.0, ends[-1], 200):
        own = np.array([np.interp(travelled, ends, route[:, axis]) for axis in (0, 1)])
        other = np.array(position) + np.array(velocity) * travelled / 15.0
        assert value <= np.hypot(*(own - other)) + 1e-6


ROUTE = np.array([[[0.0, 0.0], [20_000.0, 0.0]]])
CLIMBS = {
    "level, 600 m above": (800.0, 0.0, 585.0),
    "descends to our altitude": (800.0, -2.0, 0.0),
    "climbs away": (800.0, 2.0, 1185.0),
    "was level with us and leaves": (200.0, 3.0, 885.0),
    "passes through and leaves below": (500.0, -3.0, 585.0),
}


@pytest.mark.parametrize(("altitude", "climb", "gap"), CLIMBS.values(), ids=CLIMBS.keys())
def test_what_climbs_or_descends_is_met_at_the_height_it_has_then(
    altitude: float, climb: float, gap: float
) -> None:
    """Head-on in 300 s; the own band is 185 to 215 m; what nears in height and distance is slant."""
    other = replace(
        intruders((9000.0, 0.0, -15.0, 0.0)), altitudes=np.array([altitude]), climbs=np.array([climb])
    )
    separation = float(route_separation(ROUTE, 15.0, other)[0, 0])
    assert separation <= gap + 1e-9
    assert separation == pytest.approx(gap, rel=0.01)


@given(numbers, st.floats(-3000.0, 3000.0), st.floats(-6.0, 6.0), st.floats(-30.0, 30.0))
def test_no_sampled_moment_is_closer_in_space(east: float, height: float, climb: float, rate: float) -> None:
    other = replace(
        intruders((7000.0, east, rate, -10.0)), altitudes=np.array([height]), climbs=np.array([climb])
    )
    value = float(route_separation(ROUTE, 15.0, other)[0, 0])
    times = np.linspace(0.0, 20_000.0 / 15.0, 400)
    up = height + climb * times
    gap = np.maximum(np.maximum(185.0 - up, up - 215.0), 0.0)
    sampled = np.sqrt((7000.0 + (rate - 15.0) * times) ** 2 + (east - 10.0 * times) ** 2 + gap**2)
    assert value <= sampled.min() + 1e-6
    assert value >= sampled.min() - 100.0
