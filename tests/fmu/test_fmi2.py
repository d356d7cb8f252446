"""The FMI 2.0 file: the same bits as FMI 3.0 for the same inputs, and the same strictness."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave

from fmu.variables import REFERENCE, TABLE

OUTPUTS = [
    "state.north",
    "state.east",
    "state.altitude",
    "state.bank",
    "sensor.static_pressure",
    "battery.energy",
]
COMMANDS = {
    "command.mode": 2,
    "command.orbit.east": 80.0,
    "command.altitude": 210.0,
    "turbulence.wind_speed": 4.0,
}


def flown(file, interface):
    result = simulate_fmu(
        str(file), fmi_type=interface, stop_time=5.0, output_interval=0.05, solver="Euler", step_size=0.01,
        start_values=COMMANDS, output=OUTPUTS,
    )  # fmt: skip
    return np.array(result.tolist())


@pytest.mark.parametrize("interface", ["CoSimulation", "ModelExchange"])
def test_both_versions_give_the_same_bits(interface, fmu_file, fmi2_file):
    three, two = flown(fmu_file, interface), flown(fmi2_file, interface)
    assert two.tobytes() == three.tobytes()
    assert abs(two[-1, 4]) > 0.1


def test_steps_through_fmi2_are_those_of_the_plant(slave, make_plant):
    plant = make_plant()
    plant.fly_leg(0, 50, 1000, 50, 220, 16)
    names = ["from_east", "to_north", "to_east"]
    slave.setReal([REFERENCE[f"command.leg.{k}"] for k in names], [50.0, 1000.0, 50.0])
    slave.setReal([REFERENCE["command.altitude"], REFERENCE["command.airspeed"]], [220.0, 16.0])
    start(slave)
    for k in range(50):
        slave.doStep(k * 0.1, 0.1)
        plant.step(0.1)
    assert slave.getReal([REFERENCE["state.north"], REFERENCE["state.bank"]]) == [
        plant.state.north,
        plant.state.bank,
    ]


@pytest.fixture
def slave(fmi2_file, tmp_path):
    folder = extract(str(fmi2_file), str(tmp_path))
    token = read_model_description(folder).guid
    unit = FMU2Slave(
        guid=token, modelIdentifier="sidestep_aircraft", unzipDirectory=folder, instanceName="raw"
    )
    unit.instantiate(loggingOn=False)
    yield unit
    unit.freeInstance()


def start(slave):
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()


@pytest.mark.parametrize(("name", "value"), [("aircraft.mass", math.nan), ("wind.north", 1e3)])
def test_bad_values_are_refused(slave, name, value):
    before = slave.getReal([REFERENCE[name]])
    with pytest.raises(FMICallException):
        slave.setReal([REFERENCE[name]], [value])
    assert slave.getReal([REFERENCE[name]]) == before


def test_wrong_calls_are_refused(slave):
    for call in (
        lambda: slave.doStep(0.0, 0.1),
        slave.exitInitializationMode,
        lambda: slave.getReal([len(TABLE)]),
        lambda: slave.getReal([REFERENCE["fidelity"]]),
        slave.cancelStep,
    ):
        with pytest.raises(FMICallException):
            call()
    start(slave)
    slave.doStep(0.0, 0.1)
    with pytest.raises(FMICallException):
        slave.doStep(0.0, 0.1)


def test_a_serialised_state_comes_back(slave):
    start(slave)
    slave.setInteger([REFERENCE["command.mode"]], [2])
    slave.doStep(0.0, 1.0)
    state = slave.getFMUState()
    data = slave.serializeFMUState(state)
    slave.doStep(1.0, 2.0)
    reached = slave.getReal([REFERENCE["state.east"]])
    slave.setFMUState(slave.deSerializeFMUstate(data))
    slave.doStep(1.0, 2.0)
    assert slave.getReal([REFERENCE["state.east"]]) == reached
    slave.freeFMUState(state)
