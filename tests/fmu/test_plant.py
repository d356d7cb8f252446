"""The plant: steps of any length, many at once, deterministic, with errors in words."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fmu import FmuPlant, PlantError

FIDELITIES = ("6dof", "kinematic")


def manoeuvre(plant, step):
    """Twelve seconds of turn and climb in steps of one length."""
    plant.fly_leg(-100, 300, 5000, 4000, 230, 16)
    for _ in range(round(12 / step)):
        plant.step(step)
    return np.array(plant.state)


@pytest.mark.parametrize("fidelity", FIDELITIES)
@pytest.mark.parametrize("step", [0.0005, 0.004, 0.01, 0.1, 0.3])
def test_the_step_size_does_not_matter(fidelity, step, make_plant):
    coarse = manoeuvre(make_plant(fidelity=fidelity), 1.0)
    fine = manoeuvre(make_plant(fidelity=fidelity), step)
    # The same where steps are whole periods of the guidance; within one, shorter substeps change the error of
    # RK4 at the corners of the rate limits by millimetres.
    np.testing.assert_allclose(fine, coarse, rtol=0, atol=5e-4 if fidelity == "6dof" else 5e-3)


@pytest.mark.parametrize("fidelity", FIDELITIES)
def test_time_does_not_drift(fidelity, make_plant):
    plant = make_plant(fidelity=fidelity)
    for _ in range(3000):
        plant.step(0.1)
    assert plant.time == 300.0
    assert plant.get("time") == 300.0
    assert plant.state.time == 300.0


@pytest.mark.parametrize("fidelity", FIDELITIES)
def test_runs_are_the_same_bit_for_bit(fidelity, make_plant):
    first, second = (manoeuvre(make_plant(fidelity=fidelity), 0.1) for _ in range(2))
    assert first.tobytes() == second.tobytes()


def test_reset_repeats_the_flight(make_plant):
    plant = make_plant(wind=(2, 1, 0))
    first = manoeuvre(plant, 0.5)
    plant.reset()
    assert plant.state.time == 0
    assert plant.state.altitude == 200
    assert manoeuvre(plant, 0.5).tobytes() == first.tobytes()


def test_instances_do_not_touch_each_other(make_plant):
    alone = manoeuvre(make_plant(), 0.5)
    crowd = [make_plant(east=10.0 * i, fidelity=FIDELITIES[i % 2]) for i in range(200)]
    for _ in range(24):
        for plant in crowd:
            plant.step(0.5)
    mixed = make_plant()
    others = make_plant(aircraft="techpod", guidance="paper")
    mixed.fly_leg(-100, 300, 5000, 4000, 230, 16)
    for _ in range(24):
        mixed.step(0.5)
        others.step(0.25)
    assert np.array(mixed.state).tobytes() == alone.tobytes()
    assert [p.state.east for p in crowd] == pytest.approx([10.0 * i for i in range(200)], abs=1e-9)


def test_starts_where_it_is_told(make_plant):
    plant = make_plant(
        north=100.0, east=-50.0, altitude=300.0, heading=1.0, airspeed=16.0, wind=(3.0, -4.0, 0.5)
    )
    state = plant.state
    assert (state.north, state.east, state.altitude) == (100.0, -50.0, 300.0)
    assert state.heading == pytest.approx(1.0)
    assert state.airspeed == pytest.approx(16.0)
    assert state.velocity_north == pytest.approx(16 * math.cos(1.0) + 3.0)
    assert state.velocity_east == pytest.approx(16 * math.sin(1.0) - 4.0)


def test_wind_set_before_the_first_step_belongs_to_the_start(make_plant):
    plant = make_plant()
    plant.fly_orbit(0, 100, 100, 1, 220, 15)
    plant.set_wind(5.0, 0.0)
    assert plant.state.airspeed == pytest.approx(15.0)
    assert plant.state.velocity_north == pytest.approx(20.0)
    assert plant.get("command.mode") == 2
    plant.step(1.0)
    plant.set_wind(0.0, 0.0)
    assert plant.state.airspeed > 19


def test_direct_surfaces_reach_the_airframe(make_plant):
    plant = make_plant()
    plant.fly_direct(0.1, plant.get("state.elevator"), 0.0, plant.get("state.throttle"))
    plant.step(0.5)
    assert plant.get("state.aileron") == pytest.approx(0.1, abs=1e-3)
    assert plant.state.p > 0.1
    plant.fly_leg(0, 0, 1e5, 0, 200, 15)
    for _ in range(60):
        plant.step(1.0)
    assert abs(plant.state.east) < 0.5


def test_actuators_keep_limits_and_rates(make_plant):
    plant = make_plant()
    trim = plant.get("state.elevator")
    plant.fly_direct(1.0, trim, 1.0, 1.0)
    plant.step(0.05)
    assert 0.05 < plant.get("state.aileron") <= 0.05 * 3.5 + 1e-9
    plant.step(0.5)
    assert plant.get("state.aileron") <= 0.44
    assert plant.get("state.rudder") == 0


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda p: p.fly_leg(math.nan, 0, 1, 0, 200, 15), "command.leg.from_north"),
        (lambda p: p.fly_leg(0, 0, 1, 0, 200, 0), "command.airspeed"),
        (lambda p: p.fly_orbit(0, 0, -5, 1, 200, 15), "command.orbit.radius"),
        (lambda p: p.fly_orbit(0, 0, 50, 0, 200, 15), "direction"),
        (lambda p: p.set_wind(math.inf, 0), "wind.north"),
        (lambda p: p.set("command.altitude", 1e9), "command.altitude"),
        (lambda p: p.set("state.north", 1.0), "state.north"),
        (lambda p: p.set("nonsense", 1.0), "nonsense"),
        (lambda p: p.get("nonsense"), "nonsense"),
        (lambda p: p.step(0.0), "duration"),
        (lambda p: p.step(math.nan), "duration"),
    ],
)
def test_bad_calls_name_what_is_wrong_and_do_no_harm(call, word, make_plant):
    plant, reference = make_plant(), make_plant()
    with pytest.raises(ValueError, match=word):
        call(plant)
    for each in (plant, reference):
        each.step(1.0)
    assert plant.state == reference.state


@pytest.mark.parametrize(
    ("options", "word"),
    [
        ({"aircraft": "concorde"}, "concorde"),
        ({"fidelity": "9dof"}, "fidelity"),
        ({"guidance": "magic"}, "guidance"),
        ({"altitude": math.nan}, "initial.altitude"),
        ({"parameters": {"aircraft.mass": -1.0}}, "aircraft.mass"),
        ({"parameters": {"guidance.law": 0.5}}, "guidance.law"),
    ],
)
def test_bad_starts_are_refused(options, word, library):
    with pytest.raises(ValueError, match=word):
        FmuPlant(library, **options)


def test_no_trim_is_a_plant_error(library):
    with pytest.raises(PlantError, match="no level trim") as caught:
        FmuPlant(library, airspeed=6.0)
    assert caught.value.step == "initialise"


def test_parameters_are_fixed_after_the_first_step(make_plant):
    plant = make_plant()
    plant.set("guidance.max_bank", 0.4)
    assert plant.limits.max_bank == 0.4
    plant.step(0.1)
    with pytest.raises(ValueError, match=r"guidance\.max_bank is fixed"):
        plant.set("guidance.max_bank", 0.5)


def test_a_closed_plant_says_so(library):
    plant = FmuPlant(library)
    plant.close()
    plant.close()
    with pytest.raises(PlantError, match="closed"):
        plant.step(1.0)


def test_limits_tell_the_turn_that_is_flown(make_plant):
    """Published trims: radius 42.43 m for the X8 (with sideslip), 39.74 m for the Techpod."""
    assert make_plant().limits.turn_radius(15.0) == pytest.approx(42.4339, abs=0.1)
    assert make_plant(aircraft="techpod").limits.turn_radius(15.0) == pytest.approx(39.7412, abs=0.1)


@pytest.mark.parametrize("aircraft", ["skywalker_x8", "techpod"])
def test_roll_time_is_enough_and_not_far_too_long(aircraft, make_plant):
    plant = make_plant(aircraft=aircraft)
    plant.fly_orbit(0, 30, 20, 1, 200, 15)
    while plant.state.bank < 0.95 * plant.limits.max_bank:
        plant.step(0.01)
        assert plant.time < 5
    assert 0.6 * plant.limits.roll_time < plant.time <= plant.limits.roll_time + 0.02
