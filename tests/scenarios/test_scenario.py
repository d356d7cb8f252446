"""Nominal times, random fields and random streams."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from scenarios.load import load
from scenarios.scenario import RandomField, Wind, ground_speed, nominal_time, scatter, streams


def test_ground_speed_is_the_wind_triangle():
    assert ground_speed(15.0, Wind(), 1.0, 0.0) == 15.0
    assert ground_speed(15.0, Wind(4.0, 0.0), 2.0, 0.0) == pytest.approx(19.0)
    assert ground_speed(15.0, Wind(0.0, 9.0), 1.0, 0.0) == pytest.approx(12.0)
    assert ground_speed(15.0, Wind(3.0, -4.0), 0.0, -1.0) == pytest.approx(4.0 + math.sqrt(15**2 - 3**2))


@pytest.mark.parametrize(("wind", "word"), [(Wind(0.0, 16.0), "crosswind"), (Wind(-16.0, 0.0), "headwind")])
def test_ground_speed_refuses_what_cannot_be_flown(wind: Wind, word: str):
    with pytest.raises(ValueError, match=word):
        ground_speed(15.0, wind, 1.0, 0.0)


def test_nominal_time_adds_the_legs_and_their_speeds():
    scenario = load("single")
    assert nominal_time(scenario) == pytest.approx(40_000.0 / 15.0)
    faster = tuple(replace(p, speed=20.0) for p in scenario.mission)
    assert nominal_time(replace(scenario, mission=faster)) == pytest.approx(2000.0)
    assert replace(scenario, time_limit=9.0).limit == 9.0


def test_random_field_is_what_section_5_6_says():
    """Obstacle i is drawn about waypoint i mod 8 with a standard deviation of 3 km per axis."""
    scenario = replace(load("random"), random=RandomField(count=8000))
    field = scatter(scenario, streams(5)["world"]).obstacles
    points = np.array([(o.north, o.east) for o in field])
    assert len({o.id for o in field}) == 8000
    start = scenario.mission[0]
    assert np.hypot(points[:, 0] - start.north, points[:, 1] - start.east).min() >= 2000.0
    for k, waypoint in enumerate(scenario.mission[1:], start=1):
        off = points[k::8] - (waypoint.north, waypoint.east)
        assert np.abs(off.mean(axis=0)).max() < 3000.0 / math.sqrt(1000) * 4
        assert off.std(axis=0) == pytest.approx([3000.0, 3000.0], rel=0.1)


def test_random_field_depends_on_the_seed_alone():
    scenario = load("random")
    one, same, other = (scatter(scenario, streams(seed)["world"]) for seed in (7, 7, 8))
    assert one == same
    assert one != other
    assert one.random is None
    assert len(one.obstacles) == 40


def test_streams_are_independent():
    first = {name: rng.random() for name, rng in streams(1).items()}
    assert len(set(first.values())) == 4
    second = {name: rng.random() for name, rng in streams(1, vehicle=1).items()}
    assert not set(first.values()) & set(second.values())
    assert first == {name: rng.random() for name, rng in streams(1).items()}
