"""Saved states: the same bits afterwards, in the same instance and in others; damaged ones are refused."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

GUSTY = {"turbulence.wind_speed": 5.0, "turbulence.seed": 3}


def fly(plant, seconds):
    for _ in range(seconds):
        plant.step(1.0)
    return np.array([*plant.state, plant.get("battery.energy"), plant.get("rate.u")])


@pytest.mark.parametrize("fidelity", ["6dof", "kinematic"])
def test_a_restored_flight_repeats_itself_bit_for_bit(fidelity, make_plant):
    plant = make_plant(fidelity=fidelity, parameters=GUSTY)
    plant.fly_orbit(0, 100, 80, -1, 220, 16)
    plant.step(7.3)
    saved = plant.save()
    first = fly(plant, 20)
    plant.restore(saved)
    assert plant.time == 7.3
    assert fly(plant, 20).tobytes() == first.tobytes()


def test_another_plant_goes_on_from_there(make_plant):
    one, other = make_plant(parameters=GUSTY), make_plant(aircraft="techpod", north=5000.0)
    one.fly_leg(-100, 300, 5000, 4000, 230, 16)
    one.step(5.0)
    other.step(1.0)
    other.restore(one.save())
    assert other.state == one.state
    assert fly(other, 10).tobytes() == fly(one, 10).tobytes()
    for plant in (one, other):
        plant.fly_orbit(0, 0, 100, 1, 200, 15)
    assert fly(other, 10).tobytes() == fly(one, 10).tobytes()


def test_saving_changes_nothing(make_plant):
    plain, watched = make_plant(), make_plant()
    for _ in range(10):
        plain.step(0.25)
        watched.step(0.25)
        watched.save()
    assert watched.state == plain.state


@pytest.mark.parametrize("damage", [lambda d: d[:-1], lambda d: b"", lambda d: d[:500] + b"\x7f" + d[501:]])
def test_damaged_states_are_refused_and_do_no_harm(damage, make_plant):
    plant, reference = make_plant(), make_plant()
    saved = plant.save()
    with pytest.raises(ValueError, match="saved"):
        plant.restore(dataclasses.replace(saved, model=damage(saved.model)))
    for each in (plant, reference):
        each.step(1.0)
    assert plant.state == reference.state


def test_reset_undoes_a_restore(make_plant):
    plant, other = make_plant(), make_plant(north=800.0)
    other.step(3.0)
    plant.restore(other.save())
    plant.reset()
    assert (plant.time, plant.state.north) == (0.0, 800.0)
