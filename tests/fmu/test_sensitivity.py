"""Directional derivatives against differences of the model itself and against the twin."""

from __future__ import annotations

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Model

from fmu.variables import REFERENCE, STATES

RATES = ["rate.u", "rate.v", "rate.w", "rate.p", "rate.q", "rate.r"]


@pytest.fixture
def model(library):
    """A Model Exchange instance in Continuous-Time Mode, direct surfaces, turning flight."""
    unit = FMU3Model(
        guid=library._token, modelIdentifier="sidestep_aircraft", unzipDirectory=str(library._folder),
        instanceName="differentiated",
    )  # fmt: skip
    unit.instantiate()
    unit.setInt32([REFERENCE["command.mode"]], [0])
    unit.setBoolean([REFERENCE["initial.trimmed"]], [False])
    start = {
        "bank": 0.4,
        "pitch": 0.1,
        "alpha": 0.06,
        "beta": 0.03,
        "p": 0.1,
        "q": 0.2,
        "r": 0.3,
        "elevator": 0.02,
    }
    unit.setFloat64([REFERENCE[f"initial.{k}"] for k in start], list(start.values()))
    unit.enterInitializationMode()
    unit.exitInitializationMode()
    unit.updateDiscreteStates()
    unit.enterContinuousTimeMode()
    yield unit
    unit.freeInstance()


def moved(model, index, by):
    """Rates with one continuous state moved."""
    import ctypes  # noqa: PLC0415

    x = np.array(model.getFloat64([REFERENCE[name] for name, _ in STATES]))
    y = x.copy()
    y[index] += by
    pointer = ctypes.POINTER(ctypes.c_double)
    model.setContinuousStates(y.ctypes.data_as(pointer), len(y))
    rates = np.array(model.getFloat64([REFERENCE[name] for name in RATES]))
    model.setContinuousStates(x.ctypes.data_as(pointer), len(x))
    return rates


@pytest.mark.parametrize("index", [2, 3, 4, 5, 7, 10, 11, 12, 13, 14, 16])
def test_derivatives_by_states_are_those_of_differences(index, model):
    given = model.getDirectionalDerivative(
        [REFERENCE[n] for n in RATES], [REFERENCE[STATES[index][0]]], [1.0]
    )
    step = 1e-5
    own = (moved(model, index, step) - moved(model, index, -step)) / (2 * step)
    np.testing.assert_allclose(given, own, rtol=1e-6, atol=1e-7)
    assert index == 2 or np.abs(own).max() > 1e-3


def test_the_seed_is_a_direction(model):
    knowns = [REFERENCE["state.u"], REFERENCE["state.elevator"], REFERENCE["wind.down"]]
    unknowns = [REFERENCE[name] for name in RATES]
    parts = [model.getDirectionalDerivative(unknowns, [known], [1.0]) for known in knowns]
    whole = model.getDirectionalDerivative(unknowns, knowns, [0.5, -2.0, 3.0])
    np.testing.assert_allclose(whole, np.array([0.5, -2.0, 3.0]) @ np.array(parts), rtol=1e-6, atol=1e-8)


def test_what_is_asked_must_make_sense(model):
    for unknown, known in (("aircraft.mass", "state.u"), ("rate.u", "aircraft.mass"), ("rate.u", "rate.v")):
        with pytest.raises(FMICallException):
            model.getDirectionalDerivative([REFERENCE[unknown]], [REFERENCE[known]], [1.0])


def test_it_changes_nothing(model):
    names = [REFERENCE[name] for pair in STATES for name in pair]
    before = model.getFloat64(names)
    model.getDirectionalDerivative([REFERENCE["rate.u"]], [REFERENCE["state.w"]], [1.0])
    assert model.getFloat64(names) == before
