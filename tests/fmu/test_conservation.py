"""What no body can gain or lose without air: energy, angular momentum, and its direction in space."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fmu import load_aircraft
from fmu.cosimulation import CoSimulation
from tests.fmu.aircraft_twin import dcm

GRAVITY = 9.81
TUMBLING = {"initial.p": 2.0, "initial.q": 1.0, "initial.r": -1.5, "initial.bank": 0.4, "initial.pitch": -0.3}
RATES = tuple(f"state.{axis}" for axis in "pqr")
MOTION = (*(f"state.velocity_{axis}" for axis in ("north", "east", "down")), "state.altitude")
ATTITUDE = ("state.bank", "state.pitch", "state.heading")


@pytest.fixture(scope="module")
def unit(fmu_file):
    with CoSimulation(fmu_file) as opened:
        yield opened


def body(aircraft):
    """The aircraft without wings and engine, thrown tumbling high above ground."""
    values = load_aircraft(aircraft)
    values |= {name: 0.0 for name in values if name.startswith("aircraft.aero.")}
    values |= {"aircraft.aero.alpha_min": -math.pi, "aircraft.aero.alpha_max": math.pi}
    values |= {"aircraft.propulsion.model": 1, "aircraft.propulsion.max_thrust": 0.0, "ground.present": 0}
    values |= {"environment.gravity": GRAVITY, "environment.gravity_gradient": 0.0, "command.mode": 0}
    return values | {"initial.trimmed": 0, "initial.altitude": 5000.0} | TUMBLING


def tensor(values):
    xx, yy, zz, xz = (values[f"aircraft.inertia.{axis}"] for axis in ("xx", "yy", "zz", "xz"))
    return np.array([[xx, 0, -xz], [0, yy, 0], [-xz, 0, zz]])


def invariants(unit, values):
    """Angular momentum north-east-down, rotational energy, energy per mass of the centre of gravity."""
    rates = np.array(unit.read(RATES))
    momentum = dcm(*unit.read(ATTITUDE)).T @ tensor(values) @ rates
    *velocity, altitude = unit.read(MOTION)
    energy = np.dot(velocity, velocity) / 2 + GRAVITY * altitude
    return np.array([*momentum, rates @ tensor(values) @ rates, energy])


@pytest.mark.parametrize("aircraft", ["skywalker_x8", "techpod"])
def test_energy_and_the_vector_of_angular_momentum_are_kept(aircraft, unit):
    values = body(aircraft)
    unit.restart(values)
    before = invariants(unit, values)
    for _ in range(20):
        unit.step(1.0)
        np.testing.assert_allclose(invariants(unit, values), before, rtol=1e-6, atol=1e-7)


def test_the_integration_is_of_fourth_order(unit):
    """Halving the step divides the drift of the rates by 2^4."""
    values, ends = body("skywalker_x8"), []
    for step in (0.01, 0.005, 0.00125):
        unit.restart(values)
        for _ in range(round(4.0 / step)):
            unit.step(step)
        ends.append(np.array(unit.read(RATES)))
    coarse, fine = (np.linalg.norm(end - ends[-1]) for end in ends[:2])
    assert coarse / fine == pytest.approx(16, rel=0.15)


def test_air_only_takes_energy_from_a_body_without_engine(unit):
    """The whole aircraft, engine off and surfaces held, in still air: total energy falls at every step."""
    values = load_aircraft() | {"aircraft.propulsion.model": 1, "aircraft.propulsion.max_thrust": 0.0}
    values |= {"environment.gravity": GRAVITY, "environment.gravity_gradient": 0.0, "command.mode": 0}
    unit.restart(
        values | {"initial.trimmed": 0, "initial.altitude": 3000.0, "initial.airspeed": 20.0} | TUMBLING
    )
    inertia = tensor(values)

    def energy():
        rates = np.array(unit.read(RATES))
        *velocity, altitude = unit.read(MOTION)
        motion = values["aircraft.mass"] * (np.dot(velocity, velocity) / 2 + GRAVITY * altitude)
        return motion + rates @ inertia @ rates / 2

    before = energy()
    for _ in range(200):
        unit.step(0.05)
        now = energy()
        assert now < before
        before = now
