"""Waypoint lists measured by the paper's rules."""

from __future__ import annotations

import math

import pytest

from scenarios.paper.measures import measure
from scenarios.paper.published import published

LEG = [(0.0, 0.0), (60_000.0, 0.0)]
OBSTACLE = [(30_000.0, 0.0)]


def broken(point, obstacles=OBSTACLE):
    return measure([LEG[0], point, LEG[1]], obstacles, LEG, 1000.0).broken


def test_the_mission_itself_has_no_new_waypoint():
    found = measure(published().mission)
    assert found.new == ()
    assert found.broken == ("g3",)  # it is in the way of four obstacles
    assert found.length == pytest.approx(431_633.19, abs=0.01)


@pytest.mark.parametrize(
    ("point", "expected"),
    [
        ((30_000.0, 2000.0), ()),
        ((30_000.0, 1900.0), ("g1",)),
        ((30_000.0, 4100.0), ("g2",)),
        ((27_000.0, 1040.0), ("g3",)),
        ((30_000.0, 0.0), ("g1", "g3")),
    ],
)
def test_each_constraint(point, expected):
    assert broken(point) == expected


def test_a_turn_over_thirty_degrees_breaks_g4():
    found = measure([(26_000.0, 0.0), (30_000.0, 2500.0), LEG[1]], OBSTACLE, LEG, 1000.0)
    assert found.broken == ("g4",)
    assert math.degrees(found.new[0].turn) == pytest.approx(36.8, abs=0.1)
    assert "turns by 36.8°" in found.details


def test_the_nearest_of_the_cluster_counts():
    hill = [(30_000.0, 0.0), (30_800.0, 0.0), (31_600.0, 0.0)]
    found = measure([LEG[0], (34_800.0, 2200.0), LEG[1]], hill, LEG, 1000.0)
    assert found.new[0].nearest == pytest.approx(math.hypot(3200.0, 2200.0))
