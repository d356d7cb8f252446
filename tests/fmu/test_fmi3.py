"""The FMI 3.0 interface refuses wrong calls and values, by name, and keeps instances apart."""

from __future__ import annotations

import ctypes
import math

import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave

from fmu.variables import REFERENCE, TABLE
from fmu.views import VIEWS


@pytest.fixture
def slave(library):
    """A second view of the library through fmpy's own class, with its log."""
    unit = FMU3Slave(
        guid=library._token,
        modelIdentifier="sidestep_aircraft",
        unzipDirectory=str(library._folder),
        instanceName="raw",
    )
    unit.log = []
    unit.instantiate(loggingOn=True, logMessage=lambda _e, _s, _c, text: unit.log.append(text.decode()))
    yield unit
    unit.fmi3FreeInstance(unit.component)


def start(slave):
    slave.enterInitializationMode()
    slave.exitInitializationMode()


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("aircraft.mass", math.nan),
        ("aircraft.mass", -1.0),
        ("command.altitude", math.inf),
        ("command.airspeed", 0.0),
        ("wind.north", 1e3),
        ("command.throttle", 1.01),
    ],
)
def test_bad_values_are_refused_by_name_and_change_nothing(slave, name, value):
    before = slave.getFloat64([REFERENCE[name], REFERENCE["initial.north"]])
    with pytest.raises(FMICallException):
        slave.setFloat64([REFERENCE["initial.north"], REFERENCE[name]], [77.0, value])
    assert name in slave.log[-1]
    assert slave.getFloat64([REFERENCE[name], REFERENCE["initial.north"]]) == before


@pytest.mark.parametrize(("name", "value"), [("fidelity", 2), ("command.mode", -1), ("guidance.law", 9)])
def test_bad_choices_are_refused(slave, name, value):
    with pytest.raises(FMICallException):
        slave.setInt32([REFERENCE[name]], [value])
    assert name in slave.log[-1]


def test_wrong_references_and_types_are_refused(slave):
    with pytest.raises(FMICallException):
        slave.getFloat64([len(TABLE) + len(VIEWS)])
    with pytest.raises(FMICallException):
        slave.getFloat64([REFERENCE["fidelity"]])
    assert "fidelity" in slave.log[-1]
    with pytest.raises(FMICallException):
        slave.setFloat64([REFERENCE["state.north"]], [1.0])
    assert "state.north" in slave.log[-1]
    with pytest.raises(FMICallException):
        slave.getString([0])
    assert slave.getString([]) == []


def test_calls_out_of_order_are_refused(slave):
    with pytest.raises(FMICallException):
        slave.doStep(0.0, 0.1)
    with pytest.raises(FMICallException):
        slave.exitInitializationMode()
    start(slave)
    with pytest.raises(FMICallException):
        slave.enterInitializationMode()
    with pytest.raises(FMICallException):
        slave.setFloat64([REFERENCE["aircraft.mass"]], [3.0])
    assert "fixed" in slave.log[-1]
    slave.terminate()
    with pytest.raises(FMICallException):
        slave.doStep(0.0, 0.1)
    assert "Terminated" in slave.log[-1]


@pytest.mark.parametrize(
    "arguments", [(0.5, 0.1), (0.0, 0.0), (0.0, -0.1), (0.0, math.nan), (math.nan, 0.1), (0.0, 1e9)]
)
def test_bad_steps_are_refused_and_the_run_goes_on(slave, arguments):
    start(slave)
    with pytest.raises(FMICallException):
        slave.doStep(*arguments)
    assert slave.doStep(0.0, 0.1)[3] == pytest.approx(0.1)


def test_the_stop_time_holds(slave):
    slave.enterInitializationMode(startTime=5.0, stopTime=6.0)
    slave.exitInitializationMode()
    assert slave.doStep(5.0, 1.0)[3] == pytest.approx(6.0)
    with pytest.raises(FMICallException):
        slave.doStep(6.0, 0.1)


def test_a_wrong_token_gets_no_instance(slave):
    slave.guid = "not this one"
    old = slave.component
    with pytest.raises(Exception, match="instantiate"):
        slave.instantiate()
    slave.component = old


def test_functions_for_other_interfaces_answer_with_an_error(slave):
    with pytest.raises(FMICallException):
        slave.fmi3SetTime(slave.component, 1.0)
    assert "fmi3SetTime" in slave.log[-1]
    with pytest.raises(FMICallException):
        slave.fmi3EnterConfigurationMode(slave.component)
    with pytest.raises(FMICallException):
        slave.fmi3GetContinuousStates(slave.component, (ctypes.c_double * 18)(), 18)
    assert "other interface" in slave.log[-1]


def test_impossible_bodies_are_refused_at_initialisation(slave):
    """The X8's published tensor: principal moments 0.105, 0.170, 2.005 kg m2."""
    names = [f"aircraft.inertia.{k}" for k in ("xx", "yy", "zz", "xz")]
    slave.setFloat64([REFERENCE[n] for n in names], [1.229, 0.1702, 0.8808, 0.9343])
    slave.enterInitializationMode()
    with pytest.raises(FMICallException):
        slave.exitInitializationMode()
    assert "aircraft.inertia" in slave.log[-1]


def test_outputs_can_be_read_in_initialisation_mode(slave):
    slave.setFloat64([REFERENCE["initial.altitude"]], [321.0])
    slave.enterInitializationMode()
    assert slave.getFloat64([REFERENCE["state.altitude"]]) == [321.0]
    slave.exitInitializationMode()
    assert slave.getBoolean([REFERENCE["state.stalled"]]) == [False]


def test_reset_gives_the_start_values_back(slave):
    slave.setFloat64([REFERENCE["initial.altitude"]], [321.0])
    start(slave)
    slave.doStep(0.0, 1.0)
    slave.reset()
    assert slave.getFloat64([REFERENCE["initial.altitude"]]) == [200.0]
    start(slave)
    assert slave.getFloat64([REFERENCE["time"], REFERENCE["state.altitude"]]) == [0.0, 200.0]


def test_divergence_is_an_error_not_a_number(slave):
    """A surface that spins the aircraft up without damping must end in an error."""
    wild = {"aircraft.aero.Cl_p": 1000.0, "aircraft.aero.Cl_aileron": 1000.0, "command.aileron": 1.0}
    slave.setFloat64([REFERENCE[n] for n in wild], list(wild.values()))
    slave.setInt32([REFERENCE["command.mode"]], [0])
    start(slave)
    with pytest.raises(FMICallException):
        slave.doStep(0.0, 60.0)
    assert "diverged" in slave.log[-1]
