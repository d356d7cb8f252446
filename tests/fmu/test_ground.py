"""Held, launched, flying, landed; contact is an event; nothing is undefined at zero airspeed."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.fmi3 import FMU3Slave

from fmu.variables import REFERENCE, TABLE

HELD, LAUNCHED, FLYING, LANDED = range(4)
CATAPULT = {"launch.mode": 1, "launch.speed": 16.0, "launch.length": 4.0, "launch.pitch": 0.15}
RUNWAY = {"launch.mode": 2}


def outputs(plant):
    return np.array([plant.get(row.name) for row in TABLE if row.causality == "output"])


@pytest.mark.parametrize("wind", [(0, 0, 0), (4, 2, 0)])
@pytest.mark.parametrize("fidelity", ["6dof", "kinematic"])
def test_held_aircraft_stay_and_all_outputs_are_numbers(fidelity, wind, make_plant):
    plant = make_plant(fidelity=fidelity, parameters=CATAPULT, wind=wind)
    before = plant.state
    for _ in range(5):
        plant.step(1.0)
        assert np.isfinite(outputs(plant)).all()
    assert plant.get("flight.phase") == HELD
    assert plant.state[1:7] == before[1:7]
    assert plant.get("state.ground_speed") == 0.0
    force = [plant.get(f"sensor.specific_force.{axis}") for axis in "xyz"]
    assert math.hypot(*force) == pytest.approx(9.81, rel=1e-5)


@pytest.mark.parametrize("aircraft", ["skywalker_x8", "techpod"])
@pytest.mark.parametrize("launch", [CATAPULT, RUNWAY])
def test_a_launched_aircraft_climbs_away(launch, aircraft, make_plant):
    plant = make_plant(aircraft=aircraft, parameters=launch)
    plant.fly_leg(0, 0, 5000, 0, 60, 15)
    plant.set("command.launch", 1)
    phases = []
    for _ in range(600):
        plant.step(0.1)
        phases.append(plant.get("flight.phase"))
    assert phases[-1] == FLYING
    assert LANDED not in phases
    assert plant.state.altitude == pytest.approx(60, abs=0.5)
    assert plant.state.airspeed == pytest.approx(15, abs=0.2)


def test_the_catapult_gives_its_speed_over_its_length(make_plant):
    """v2 = 2 a s: 16 m/s over 4 m takes 0.5 s at 32 m/s2."""
    plant = make_plant(parameters=CATAPULT)
    plant.set("command.launch", 1)
    plant.step(0.3)
    assert plant.get("flight.phase") == LAUNCHED
    assert plant.get("state.ground_speed") == pytest.approx(0.3 * 32 * math.cos(0.15), rel=1e-9)
    assert plant.get("sensor.specific_force.x") == pytest.approx(32 + 9.81 * math.sin(0.15), rel=1e-4)
    plant.step(0.21)
    assert plant.get("flight.phase") == FLYING


def test_the_runway_is_left_at_the_speed_for_it(make_plant):
    plant = make_plant(parameters=RUNWAY)
    plant.set("command.launch", 1)
    while plant.get("flight.phase") != FLYING:
        plant.step(0.01)
        assert plant.time < 30
        assert plant.state.altitude >= 0.0
    assert plant.state.airspeed == pytest.approx(14.0, abs=0.1)


@pytest.mark.parametrize("step", [0.1, 1.7, 40.0])
@pytest.mark.parametrize("fidelity", ["6dof", "kinematic"])
def test_contact_is_found_to_the_nanosecond_whatever_the_step(fidelity, step, make_plant):
    plant = make_plant(fidelity=fidelity, altitude=20.0)
    plant.fly_leg(0, 0, 5000, 0, -100, 15)
    while plant.time < 40:
        plant.step(step)
    assert plant.get("flight.phase") == LANDED
    assert plant.state.altitude == 0.0
    reference = make_plant(fidelity=fidelity, altitude=20.0)
    reference.fly_leg(0, 0, 5000, 0, -100, 15)
    reference.step(40.0)
    assert plant.state.north == pytest.approx(reference.state.north, abs=1e-3)
    assert plant.get("flight.contact_speed") == pytest.approx(1.2, abs=0.1)


def test_without_ground_the_aircraft_flies_on_below(make_plant):
    plant = make_plant(altitude=20.0, parameters={"ground.present": 0})
    plant.fly_leg(0, 0, 5000, 0, -20, 15)
    plant.step(60.0)
    assert plant.state.altitude == pytest.approx(-20, abs=0.5)


def test_a_launch_without_ground_is_refused(library):
    from fmu import FmuPlant, PlantError  # noqa: PLC0415

    with pytest.raises(PlantError, match=r"launch\.mode"):
        FmuPlant(library, parameters=CATAPULT | {"ground.present": 0})


def raw(library, **options):
    unit = FMU3Slave(
        guid=library._token, modelIdentifier="sidestep_aircraft", unzipDirectory=str(library._folder),
        instanceName="raw",
    )  # fmt: skip
    unit.log = []
    unit.instantiate(loggingOn=True, logMessage=lambda _e, _s, c, text: unit.log.append((c, text)), **options)
    unit.setFloat64([REFERENCE["initial.altitude"], REFERENCE["command.altitude"]], [20.0, -100.0])
    unit.enterInitializationMode()
    unit.exitInitializationMode()
    return unit


def test_a_step_ends_early_at_the_contact_where_the_importer_allows_it(library):
    unit = raw(library, earlyReturnAllowed=True)
    time = 0.0
    while unit.getInt32([REFERENCE["flight.phase"]]) != [LANDED]:
        _, _, early, time = unit.doStep(time, 10.0)
        assert time < 60
    assert early
    assert time % 10.0 != 0.0
    assert any(category == b"logEvents" and b"contact" in text for category, text in unit.log)
    assert unit.doStep(time, 10.0)[3] == pytest.approx(time + 10.0)
    unit.freeInstance()


def test_in_event_mode_the_importer_carries_the_contact_out(library):
    unit = raw(library, earlyReturnAllowed=True, eventModeUsed=True)
    unit.updateDiscreteStates()
    unit.enterStepMode()
    time, phases = 0.0, []
    while time < 40.0:
        event, _, _, time = unit.doStep(time, 5.0)
        if event:
            unit.enterEventMode()
            phases.append(unit.getInt32([REFERENCE["flight.phase"]])[0])
            unit.updateDiscreteStates()
            phases.append(unit.getInt32([REFERENCE["flight.phase"]])[0])
            unit.enterStepMode()
    assert phases == [FLYING, LANDED]
    unit.freeInstance()


def test_fmpy_handles_the_events_in_co_simulation(fmu_file):
    result = simulate_fmu(
        str(fmu_file), stop_time=40.0, output_interval=5.0, early_return_allowed=True, use_event_mode=True,
        start_values={"initial.altitude": 20.0, "command.altitude": -100.0},
        output=["flight.phase", "state.altitude"],
    )  # fmt: skip
    assert result["flight.phase"][-1] == LANDED
    assert result["state.altitude"][-1] == 0.0
