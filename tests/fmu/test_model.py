"""What the model offers beside flight: sensors, elevons, arrays, a turning earth, direct surfaces."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave

from fmu.variables import REFERENCE, TABLE
from fmu.views import VIEWS

EARTH_RATE = 7.292115e-5
ARRAYS = {view.name: len(TABLE) + k for k, view in enumerate(VIEWS)}


def test_sensors_read_what_the_textbook_says(make_plant):
    """Sea level on a standard day: 1013.25 hPa, 15 degC; q = rho V2 / 2."""
    plant = make_plant(altitude=0.0, airspeed=16.0)
    assert plant.get("sensor.static_pressure") == pytest.approx(101325.0, rel=1e-5)
    assert plant.get("sensor.temperature") == pytest.approx(288.15)
    assert plant.get("sensor.differential_pressure") == pytest.approx(0.5 * 1.225 * 256, rel=1e-9)
    high = make_plant(altitude=5000.0, fidelity="kinematic")
    assert high.get("sensor.static_pressure") == pytest.approx(54048.0, rel=1e-4)
    assert high.get("sensor.temperature") == pytest.approx(255.676, abs=1e-3)


def test_elevons_share_their_limit(make_plant):
    plant = make_plant()
    plant.fly_direct(0.4, 0.3, 0.0, 0.4)
    plant.step(1.0)
    left, right = plant.get("state.elevon_left"), plant.get("state.elevon_right")
    assert left == pytest.approx(0.44, abs=1e-6)
    assert right == pytest.approx(-0.1, abs=1e-6)
    assert plant.get("state.aileron") == pytest.approx((left - right) / 2)


def test_a_tail_has_limits_of_its_own(make_plant):
    plant = make_plant(aircraft="techpod")
    plant.fly_direct(0.3, 0.3, 0.0, 0.4)
    plant.step(1.0)
    assert plant.get("state.aileron") == pytest.approx(0.3, abs=1e-6)
    assert plant.get("state.elevator") == pytest.approx(0.3, abs=1e-6)


@pytest.mark.parametrize("rate", [250, 400, 1200])
def test_direct_surfaces_at_the_rates_of_autopilots(rate, make_plant):
    """The same flight as with one step per command, within RK4's error at shorter substeps."""
    fast, slow = make_plant(), make_plant()
    for plant in (fast, slow):
        plant.fly_direct(0.02, 0.02, 0.0, 0.4)
    for _ in range(rate):
        fast.step(1 / rate)
    slow.step(1.0)
    np.testing.assert_allclose(fast.state[1:], slow.state[1:], atol=1e-5)


def test_gravity_falls_with_height(make_plant):
    high = make_plant(altitude=5000.0, fidelity="kinematic")
    assert high.get("sensor.specific_force.z") == pytest.approx(-(9.81 - 3.086e-6 * 5000), rel=1e-9)


def thrown(make_plant, **earth):
    """A body at rest over the equator, dropped without air."""
    aero = {
        row.name: 0.0 for row in TABLE if row.name.startswith("aircraft.aero.") and "alpha_m" not in row.name
    }
    body = aero | {"aircraft.aero.alpha_min": -3.2, "aircraft.aero.alpha_max": 3.2, "command.mode": 0}
    body |= {"aircraft.actuator.elevons": 0, "initial.trimmed": 0, "ground.present": 0}
    body |= {"environment.gravity": 9.8, "environment.gravity_gradient": 0.0, "environment.latitude": 0.0}
    return make_plant(altitude=9000.0, airspeed=0.0, parameters=body | earth)


def test_a_falling_body_is_carried_east_by_the_turning_earth(make_plant):
    """Coriolis: east = omega g t3 / 3 at the equator."""
    plant = thrown(make_plant, **{"environment.earth_rate": EARTH_RATE})
    plant.step(30.0)
    assert plant.state.east == pytest.approx(EARTH_RATE * 9.8 * 30**3 / 3, rel=1e-4)
    assert plant.state.north == pytest.approx(0.0, abs=1e-9)


def test_a_body_without_rotation_sees_the_earth_turn_away(make_plant):
    """Over the equator north-east-down turns about north with the earth; the body does not follow."""
    plant = thrown(make_plant, **{"environment.earth_rate": EARTH_RATE})
    plant.step(30.0)
    assert plant.state.bank == pytest.approx(-EARTH_RATE * 30, rel=1e-6)


def test_the_curved_earth_lifts_fast_bodies(make_plant):
    """v2 / R less weight: eastward at 200 m/s."""
    curved = {"environment.earth_curvature": 1 / 6378137.0}
    falls = []
    for extra in ({}, curved):
        moving = thrown(make_plant, **extra, **{"initial.airspeed": 200.0, "initial.heading": math.pi / 2})
        moving.step(10.0)
        falls.append(moving.state.altitude)
    assert falls[1] - falls[0] == pytest.approx(200**2 / 6378137.0 * 10**2 / 2, rel=2e-3)


@pytest.fixture
def slave(library):
    unit = FMU3Slave(
        guid=library._token, modelIdentifier="sidestep_aircraft", unzipDirectory=str(library._folder),
        instanceName="arrays",
    )  # fmt: skip
    unit.instantiate()
    yield unit
    unit.freeInstance()


def test_arrays_and_scalars_share_their_memory(slave):
    slave.setFloat64([ARRAYS["vector.wind"]], [3.0, -2.0, 0.5])
    assert slave.getFloat64([REFERENCE["wind.east"]]) == [-2.0]
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    slave.setInt32([REFERENCE["command.mode"]], [2])
    slave.doStep(0.0, 2.0)
    for view in VIEWS:
        scalars = slave.getFloat64([REFERENCE[row.name] for row in view.rows])
        assert slave.getFloat64([ARRAYS[view.name]], nValues=view.size) == scalars


def test_arrays_are_checked_element_by_element(slave):
    commands = ARRAYS["vector.command_surfaces"]
    with pytest.raises(FMICallException):
        slave.setFloat64([commands], [0.1, 0.1, 0.0, 1.1])
    assert slave.getFloat64([commands], nValues=4) == [0.0, 0.0, 0.0, 0.0]
    with pytest.raises(FMICallException):
        slave.setFloat64([commands], [0.1, 0.1])
