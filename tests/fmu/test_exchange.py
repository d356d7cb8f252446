"""Model Exchange: states, derivatives, indicators and events of both versions, driven by hand and by fmpy."""

from __future__ import annotations

import ctypes

import numpy as np
import pytest
from fmpy import extract, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Model
from scipy.integrate import solve_ivp

from fmu.variables import INDICATORS, REFERENCE, STATES

N = len(STATES)
POINTER = ctypes.POINTER(ctypes.c_double)


@pytest.fixture
def model(fmu_file, library, tmp_path):
    unit = FMU3Model(
        guid=library._token,
        modelIdentifier="sidestep_aircraft",
        unzipDirectory=extract(str(fmu_file), str(tmp_path)),
        instanceName="exchanged",
    )
    unit.log = []
    unit.instantiate(loggingOn=True, logMessage=lambda _e, _s, _c, text: unit.log.append(text.decode()))
    yield unit
    unit.freeInstance()


def start(model, **values):
    for name, value in values.items():
        model.setFloat64([REFERENCE[name.replace("__", ".")]], [value])
    model.enterInitializationMode()
    model.exitInitializationMode()
    info = model.updateDiscreteStates()
    model.enterContinuousTimeMode()
    return info


def states(model):
    values = np.zeros(N)
    model.getContinuousStates(values.ctypes.data_as(POINTER), N)
    return values


def derivatives(model, time=None, x=None):
    if time is not None:
        model.setTime(time)
        x = np.ascontiguousarray(x)
        model.setContinuousStates(x.ctypes.data_as(POINTER), N)
    values = np.zeros(N)
    model.getContinuousStateDerivatives(values.ctypes.data_as(POINTER), N)
    return values


def test_states_and_derivatives_are_the_variables_that_the_table_names(model):
    start(model)
    x, dx = states(model), derivatives(model)
    assert model.getFloat64([REFERENCE[name] for name, _ in STATES]) == pytest.approx(x, abs=0)
    assert model.getFloat64([REFERENCE[name] for _, name in STATES]) == pytest.approx(dx, abs=0)


def test_guidance_asks_for_time_events_every_10_ms(model):
    *_, defined, time = start(model)
    assert defined
    assert time == pytest.approx(0.01)
    model.setTime(0.01)
    model.enterEventMode()
    assert model.updateDiscreteStates()[-1] == pytest.approx(0.02)


def test_direct_surfaces_need_no_time_events_without_sun(model):
    model.setInt32([REFERENCE["command.mode"]], [0])
    *_, defined, _ = start(model, aircraft__battery__capacity=0.0)
    assert not defined


def test_an_adaptive_solver_agrees_with_co_simulation(model, make_plant):
    """Direct surfaces: scipy's eighth-order solver against the model's own steps of 10 ms."""
    surfaces = {"command.aileron": 0.04, "command.elevator": 0.02, "command.throttle": 0.4}
    plant = make_plant(parameters={"command.mode": 0} | surfaces)
    plant.step(4.0)
    model.setInt32([REFERENCE["command.mode"]], [0])
    start(model, **{name.replace(".", "__"): value for name, value in surfaces.items()})
    done = solve_ivp(
        lambda t, x: derivatives(model, t, x), (0, 4), states(model), method="DOP853", rtol=1e-11, atol=1e-11
    )
    own = [plant.get(name) for name, _ in STATES]
    np.testing.assert_allclose(done.y[:17, -1], own[:17], rtol=1e-6, atol=2e-6)
    assert abs(plant.state.bank) > 0.3
    assert done.y[17, -1] == pytest.approx(own[17], abs=2.0)  # the battery holds its rate for 10 ms in steps


@pytest.mark.parametrize("version", ["fmu_file", "fmi2_file"])
@pytest.mark.parametrize("solver", ["Euler", "CVode"])
def test_fmpy_flies_it_with_either_solver(version, solver, request, make_plant):
    names = ["state.north", "state.east", "state.altitude"]
    commands = {"command.leg.from_east": 30.0, "command.leg.to_east": 30.0, "command.altitude": 206.0}
    plant = make_plant(parameters=commands)
    plant.step(8.0)
    file = request.getfixturevalue(version)
    result = simulate_fmu(
        str(file), fmi_type="ModelExchange", solver=solver, stop_time=8.0, start_values=commands, output=names
    )
    for name in names:
        assert result[name][-1] == pytest.approx(plant.get(name), abs=0.05), name


@pytest.mark.parametrize("version", ["fmu_file", "fmi2_file"])
def test_a_descent_into_the_ground_is_a_state_event(version, request):
    """fmpy finds the zero of the indicator; the aircraft lies where it touched."""
    names = ["state.altitude", "state.ground_speed", "flight.phase", "flight.contact_speed"]
    result = simulate_fmu(
        str(request.getfixturevalue(version)), fmi_type="ModelExchange", solver="CVode", stop_time=12.0,
        start_values={"initial.altitude": 8.0, "command.altitude": -50.0}, output=names,
    )  # fmt: skip
    last = {name: result[name][-1] for name in names}
    assert (last["state.ground_speed"], last["flight.phase"]) == (0.0, 3)
    assert last["state.altitude"] == pytest.approx(0.0, abs=1e-6)
    assert 0.5 < last["flight.contact_speed"] < 1.5


def test_calls_in_the_wrong_state_are_refused(model):
    with pytest.raises(FMICallException):
        model.setTime(1.0)
    assert "Instantiated" in model.log[-1]
    start(model)
    with pytest.raises(FMICallException):
        model.setInt32([REFERENCE["command.mode"]], [0])
    assert "Event Mode" in model.log[-1]
    with pytest.raises(FMICallException):
        model.updateDiscreteStates()
    bad = np.full(N, np.nan)
    with pytest.raises(FMICallException):
        model.setContinuousStates(bad.ctypes.data_as(POINTER), N)
    with pytest.raises(FMICallException):
        model.setTime(-5.0)


def test_the_kinematic_aircraft_is_refused_with_the_reason(model):
    model.setInt32([REFERENCE["fidelity"]], [1])
    model.enterInitializationMode()
    with pytest.raises(FMICallException):
        model.exitInitializationMode()
    assert "Co-Simulation only" in model.log[-1]


def test_the_quaternion_is_drawn_to_unit_length(model):
    model.setInt32([REFERENCE["command.mode"]], [0])
    start(model)
    x = states(model)
    x[6:10] *= 1.001
    grown = derivatives(model, 0.0, x)[6:10] @ x[6:10]
    assert grown < -0.001
    assert len(INDICATORS) == 3
