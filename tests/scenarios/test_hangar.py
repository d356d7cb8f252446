"""What the hangar tells of the vehicle under test: its battery, under the sun of place and time."""

from __future__ import annotations

import math
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from scenarios.hangar import Hangar
from scenarios.load import parse
from scenarios.run import preset
from scenarios.scenario import FIDELITIES, Point
from scenarios.score import score
from scenarios.show import _verdict
from tests.scenarios.flights import ENCOUNTER, encounter


def after(hours, begin):
    """Energy after some hours of straight flight from a time (UTC) on; home is at 76.6 degrees east."""
    scenario = replace(parse(ENCOUNTER), start_time_utc=begin)
    with Hangar(scenario, preset("default")) as hangar:
        vehicle = hangar.own_vehicle(scenario.mission)
        for _ in range(hours):
            vehicle.plant.step(3600.0)
        return hangar.energy()


def test_the_sun_carries_the_flight_by_day():
    energy = after(3, datetime(2020, 3, 21, 4, 0, tzinfo=UTC))
    assert not energy.reserve_used
    assert energy.state_of_charge > 0.95


def test_a_night_flight_eats_the_reserve_and_the_summary_says_so():
    energy = after(3, datetime(2020, 3, 21, 15, 0, tzinfo=UTC))
    # 3 h x 73.7 W / 0.97 of 250 Wh leave 9 %, and the reserve is 20 %
    assert energy.reserve_used
    assert energy.state_of_charge == pytest.approx(1 - 3 * 73.7 / 0.97 / 250, abs=0.02)
    flown, _ = encounter()
    judged = score(flown, energy)
    assert judged.summary["reserve_used"] is True
    assert "reserve was used" in _verdict(flown, judged)


def test_nothing_is_told_of_a_battery_that_was_not_asked():
    flown, judged = encounter()
    assert judged.summary["state_of_charge"] is None
    assert "reserve" not in _verdict(flown, judged)


def test_energy_needs_a_vehicle():
    with (
        Hangar(parse(ENCOUNTER), preset("default")) as hangar,
        pytest.raises(ValueError, match="own_vehicle"),
    ):
        hangar.energy()


def gust(fidelity, seed, number=0, turbulence="moderate"):
    """Eastward gust about one of the own vehicles after 60 s."""
    scenario = parse(ENCOUNTER)
    wind = replace(scenario.wind, turbulence=turbulence)
    settings = replace(scenario.vehicle, fidelity=fidelity)
    with Hangar(replace(scenario, wind=wind, vehicle=settings, seed=seed), preset("default")) as hangar:
        vehicle = [hangar.own_vehicle() for _ in range(number + 1)][-1]
        vehicle.plant.step(60.0)
        return vehicle.plant.get("air.gust_east")


@pytest.mark.parametrize("fidelity", ["6dof", "kinematic"])
def test_gusts_follow_the_seed_and_each_vehicle_has_its_own(fidelity):
    first = gust(fidelity, 1)
    assert first != 0.0
    assert gust(fidelity, 1) == first
    assert len({first, gust(fidelity, 2), gust(fidelity, 1, number=1)}) == 3
    assert gust(fidelity, 1, turbulence="none") == 0.0


@pytest.mark.parametrize(("guidance", "limit"), [("default", 10.0), ("paper", 65.0)])
def test_a_vehicle_tells_how_far_gusts_carry_it(guidance, limit):
    scenario = parse(ENCOUNTER)
    wind = replace(scenario.wind, turbulence="moderate")
    with Hangar(replace(scenario, wind=wind), preset(guidance)) as hangar:
        performance = hangar.own_vehicle().performance
    assert performance.tracking_error == limit
    assert performance.wind_bound == pytest.approx(scenario.wind.speed + 4.26, abs=0.01)


def promised(airspeed=15.0, wind=(0.0, 0.0), turbulence="none"):
    scenario = parse(ENCOUNTER)
    blowing = replace(scenario.wind, north=wind[0], east=wind[1], turbulence=turbulence)
    vehicle = replace(scenario.vehicle, airspeed=airspeed)
    with Hangar(replace(scenario, wind=blowing, vehicle=vehicle), preset("default")) as hangar:
        return hangar.own_vehicle().performance


def test_in_still_air_a_vehicle_keeps_closer_to_its_legs():
    still, fast, windy, gusty = (
        promised(),
        promised(airspeed=18.0),
        promised(wind=(6.0, 0.0)),
        promised(turbulence="light"),
    )
    assert still.tracking_error < fast.tracking_error < windy.tracking_error == gusty.tracking_error
    assert still.capture_distance < fast.capture_distance < windy.capture_distance


@pytest.mark.parametrize("fidelity", list(FIDELITIES.values()))
@pytest.mark.parametrize("speed", [0.0, 8.0])
def test_legs_are_kept_to_as_promised(fidelity, speed):
    """After changes of course of every size; a sample of what benchmarks/vehicle_limits.py measures."""
    scenario = parse(ENCOUNTER)
    wind = replace(scenario.wind, north=0.0, east=speed, turbulence="none")
    vehicle = replace(scenario.vehicle, fidelity=fidelity, acceptance_radius=20.0)
    rng, course, points = np.random.default_rng(3), 0.0, [Point(0.0, 0.0, 200.0)]
    for _ in range(12):
        north = points[-1].north + 1500.0 * math.cos(course)
        points.append(Point(north, points[-1].east + 1500.0 * math.sin(course), 200.0))
        course += rng.choice((-1.0, 1.0)) * rng.uniform(1.5, math.pi)
    flight = replace(scenario, mission=tuple(points), wind=wind, vehicle=vehicle)
    with Hangar(flight, preset("default")) as hangar:
        own, looked = hangar.own_vehicle(), 0
        while not own.finished:
            own.advance(0.5)
            here, route = own.state().ownship, own.route()
            if not route.waypoints:
                break
            begin, end = (complex(w.north, w.east) for w in (route.origin, route.waypoints[0]))
            leg = end - begin
            off = (complex(here.north, here.east) - begin) / (leg / abs(leg))
            if own.performance.capture_distance <= off.real <= abs(leg):
                looked += 1
                assert abs(off.imag) <= own.performance.tracking_error
    assert looked > 500


def test_a_waypoint_that_cannot_be_reached_is_not_said_to_be_reachable():
    flown, judged = encounter()
    (vehicle,) = judged.vehicles
    fate = vehicle.fates[-1]
    for point, words in (
        ((fate.goal.north, fate.goal.east), "although it could be"),
        ((0.0, 9.0), "cannot be reached"),
    ):
        missed = replace(fate, goal=replace(fate.goal, point=point), passed_at=None)
        figures = judged.summary | {"completed": False}
        story = _verdict(
            flown, replace(judged, summary=figures, vehicles=(replace(vehicle, fates=(missed,)),))
        )
        assert story.startswith(f"Not completed: waypoint {fate.goal.waypoint + 1}")
        assert words in story
