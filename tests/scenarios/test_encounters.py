"""Every encounter comes too near if nobody gives way, and begins far away."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scenarios.encounters import (
    AIRSPEED,
    FIRST_SEEN_SEVERAL,
    LEG,
    describe,
    draw_intruder,
    draw_turning,
    encounter,
)
from scenarios.scenario import Home, Obstacle

HOME = Home(14.39, 76.60, 600.0)


def separation_unmitigated(flight, times):
    """Distances between an own vehicle that flies straight on and a mover, at these times."""
    begin, end = flight.waypoints
    share = times * flight.speed / math.hypot(end.north - begin.north, end.east - begin.east)
    assert share[-1] < 1.0
    north = begin.north + share * (end.north - begin.north)
    east = begin.east + share * (end.east - begin.east)
    return np.hypot(north - AIRSPEED * times, east)


@given(st.integers(0, 2**32 - 1))
def test_unmitigated_it_is_a_loss_on_the_leg_first_seen_far_away(seed):
    (flight,) = encounter(np.random.default_rng(seed), HOME).traffic
    distances = separation_unmitigated(flight, np.arange(0.0, LEG / AIRSPEED + 0.25, 0.25))
    assert distances.min() < 1000.0
    assert distances[0] >= 7999.9
    assert 5.0 <= flight.speed <= 60.0


def test_several_are_seen_from_10_km_and_each_is_a_loss():
    scenario = encounter(np.random.default_rng(3), HOME, intruders=4)
    times = np.arange(0.0, LEG / AIRSPEED, 0.25)
    assert len({flight.id for flight in scenario.traffic}) == 4
    for flight in scenario.traffic:
        distances = separation_unmitigated(flight, times)
        assert distances[0] >= FIRST_SEEN_SEVERAL - 0.1
        assert distances.min() < 1000.0


def test_all_aspects_speeds_and_places_are_drawn():
    rng = np.random.default_rng(0)
    drawn = [draw_intruder(rng, 8000.0) for _ in range(2000)]
    bearings = np.array([math.atan2(i.east, i.north) for i in drawn])
    assert np.histogram(bearings, bins=8, range=(-math.pi, math.pi))[0].min() > 20
    places = np.array(
        [i.passes_at * AIRSPEED for i in drawn]
    )  # 8 km away at the start: few on the first tenth
    assert np.histogram(places, bins=9, range=(0.1 * LEG, LEG))[0].min() > 20
    assert min(i.speed for i in drawn) < 8.0
    assert max(i.speed for i in drawn) > 58.0


@pytest.mark.parametrize(("aircraft", "motions"), [(True, {"6dof", "point"}), (False, {"point"})])
def test_intruders_that_an_aircraft_can_fly_are_aircraft(aircraft, motions):
    rng = np.random.default_rng(1)
    flights = [encounter(rng, HOME, aircraft=aircraft).traffic[0] for _ in range(40)]
    assert {flight.motion for flight in flights} == motions
    assert all(12.0 <= flight.speed <= 22.0 for flight in flights if flight.motion == "6dof")
    assert not any(isinstance(flight, Obstacle) for flight in flights)


@given(st.integers(0, 2**32 - 1))
def test_one_that_turns_is_seen_from_afar_and_then_flies_the_same_encounter(seed):
    drawn = draw_turning(np.random.default_rng(seed), 8000.0)
    assert drawn.turns is not None
    when, angle = drawn.turns
    assert math.hypot(*drawn.start) >= 8000.0
    assert 0.2 * drawn.passes_at <= when <= 0.7 * drawn.passes_at
    north, east = drawn.at(drawn.passes_at)
    assert math.hypot(north - AIRSPEED * drawn.passes_at, east) == pytest.approx(drawn.miss, abs=1e-6)
    corner = np.array(drawn.at(when))
    before = (corner - drawn.start) / when
    after = np.array([drawn.velocity_north, drawn.velocity_east])
    assert np.hypot(*before) == pytest.approx(np.hypot(*after))
    turned = math.atan2(before[0] * after[1] - before[1] * after[0], before @ after)
    assert turned == pytest.approx(angle, abs=1e-6)


def test_the_file_of_one_that_turns_has_the_corner():
    (flight,) = encounter(np.random.default_rng(2), HOME, turning=True).traffic
    assert len(flight.waypoints) == 3


def test_a_turn_is_told_by_its_side():
    straight = draw_turning(np.random.default_rng(2), 8000.0)
    for angle, words in (
        (0.5, "turns 29 deg to the right after 100 s"),
        (-0.5, "turns 29 deg to the left after"),
    ):
        assert words in describe([replace(straight, turns=(100.0, angle))])
