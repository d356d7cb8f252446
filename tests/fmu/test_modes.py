"""Linearised modes of both aircraft in level flight against those of the project's aircraft data."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fmu import load_aircraft
from fmu.cosimulation import CoSimulation

# Eigenvalues at 15 m/s from aircraft.json, "modes": real and imaginary part [1/s], and the air density there.
DENSITY = {"skywalker_x8": 1.225, "techpod": 1.18}
MODES = {
    ("skywalker_x8", "longitudinal"): {"short period": (-6.2207, 7.4811), "phugoid": (-0.0306, 0.7728)},
    ("skywalker_x8", "lateral"): {
        "roll": (-18.4275, 0), "Dutch roll": (-1.6153, 3.8306), "spiral": (-0.1989, 0),
    },
    ("techpod", "longitudinal"): {"short period": (-16.2741, 9.0416), "phugoid": (-0.2328, 0.3944)},
    ("techpod", "lateral"): {"roll": (-14.9036, 0), "Dutch roll": (-1.2555, 3.588), "spiral": (-0.0526, 0)},
}  # fmt: skip
STATES = {"longitudinal": ("u", "w", "q", "pitch"), "lateral": ("v", "p", "r", "bank")}
TRIM = {name: f"state.{name}" for name in ("u", "w", "pitch", "elevator", "throttle")}
SMALL = 1e-5


@pytest.fixture(scope="module")
def unit(fmu_file):
    with CoSimulation(fmu_file) as opened:
        yield opened


def altitude_of(density):
    """Altitude of a density in the standard troposphere [m]: T/T0 = (rho/rho0)^(1/4.2559)."""
    return 288.15 / 0.0065 * (1 - (density / 1.225) ** (1 / 4.25587611))


def start(aircraft):
    still = {"environment.gravity": 9.81, "environment.gravity_gradient": 0.0, "ground.present": 0}
    altitude = altitude_of(DENSITY[aircraft])
    return load_aircraft(aircraft) | still | {"initial.altitude": altitude, "command.altitude": altitude}


def derivative(unit, values, x):
    """Time derivative of (u, v, w, p, q, r, bank, pitch), surfaces and throttle held."""
    speed = math.sqrt(x["u"] ** 2 + x["v"] ** 2 + x["w"] ** 2)
    here = {f"initial.{name}": x[name] for name in ("p", "q", "r", "bank", "pitch", "elevator", "throttle")}
    here |= {"initial.airspeed": speed, "initial.alpha": math.atan2(x["w"], x["u"])}
    here |= {"initial.beta": math.asin(x["v"] / speed), "initial.trimmed": 0}
    unit.restart(values | here)
    names = ("u", "v", "w", "p", "q", "r")
    rates = dict(zip(names, unit.read([f"rate.{name}" for name in names]), strict=True))
    turn = x["q"] * math.sin(x["bank"]) + x["r"] * math.cos(x["bank"])
    rates["bank"] = x["p"] + turn * math.tan(x["pitch"])
    rates["pitch"] = x["q"] * math.cos(x["bank"]) - x["r"] * math.sin(x["bank"])
    return rates


def eigenvalues(unit, aircraft, plane):
    """Of the Jacobian by central differences about the trim in which the FMU starts."""
    values = start(aircraft)
    unit.restart(values)
    trim = dict(zip(TRIM, unit.read(list(TRIM.values())), strict=True))
    at = dict.fromkeys(("v", "p", "q", "r", "bank"), 0.0) | trim
    assert max(abs(rate) for rate in derivative(unit, values, at).values()) < 1e-9
    names = STATES[plane]
    columns = []
    for name in names:
        ahead, behind = (derivative(unit, values, at | {name: at[name] + d}) for d in (SMALL, -SMALL))
        columns.append([(ahead[row] - behind[row]) / (2 * SMALL) for row in names])
    return np.linalg.eigvals(np.array(columns).T)


@pytest.mark.parametrize(("aircraft", "plane"), MODES)
def test_the_modes_are_the_published_ones(unit, aircraft, plane):
    found = eigenvalues(unit, aircraft, plane)
    for name, (real, imaginary) in MODES[aircraft, plane].items():
        nearest = found[np.argmin(abs(found - complex(real, imaginary)))]
        assert nearest.real == pytest.approx(real, abs=2e-3), name
        assert nearest.imag == pytest.approx(imaginary, abs=2e-3), name


@pytest.mark.parametrize("aircraft", DENSITY)
def test_both_aircraft_are_stable(unit, aircraft):
    for plane in STATES:
        assert eigenvalues(unit, aircraft, plane).real.max() < 0
