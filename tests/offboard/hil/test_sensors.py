"""Sensors: noise of the stated size, timing, failures; signs of the magnetometer."""

from __future__ import annotations

import math
from datetime import UTC, datetime

import numpy as np
import pytest

from offboard.frames import MapFrame
from offboard.hil.attitude import to_body
from offboard.hil.faults import parse_faults
from offboard.hil.geodesy import Geodesy
from offboard.hil.magnetic import MagneticField
from offboard.hil.sensors import ACCEL, BARO, DIFFERENTIAL, GYRO, MAG, SensorModel, Sensors
from tests.offboard.hil.fakes import AT_REST

HOME = MapFrame(47.397742, 8.545594, 488.0)
FIELD = MagneticField(datetime(2025, 7, 1, tzinfo=UTC))
FLYING = AT_REST._replace(altitude=100.0, airspeed=15.0, differential_pressure=137.8, velocity_north=15.0)


def make(model=None, faults="", seed=1):
    return Sensors(Geodesy(HOME), FIELD, np.random.default_rng(seed), model, parse_faults(faults))


def run(sensors, seconds, truth=FLYING, rate=250.0):
    """Readings and GPS messages of a stretch of flight that stands still."""
    readings, fixes = [], []
    for step in range(round(seconds * rate)):
        now = truth._replace(time=(step + 1) / rate)
        readings.append(sensors.read(now))
        if (fix := sensors.fix(now)) is not None:
            fixes.append((now.time, fix))
    return readings, fixes


def test_noise_has_the_stated_size_and_rest_reads_minus_g():
    model = SensorModel()
    readings, _ = run(make(), 20.0, AT_REST)
    accel = np.array([each.accel for each in readings])
    gyro = np.array([each.gyro for each in readings])
    mag = np.array([each.mag for each in readings if each.updated & MAG])
    assert accel.std(axis=0) == pytest.approx([model.accel_noise] * 3, rel=0.1)
    assert gyro.std(axis=0) == pytest.approx([model.gyro_noise] * 3, rel=0.1)
    assert mag.std(axis=0) == pytest.approx([model.mag_noise] * 3, rel=0.15)
    assert accel.mean(axis=0) == pytest.approx([0.0, 0.0, -9.81], abs=4 * model.accel_bias)
    assert gyro.mean(axis=0) == pytest.approx([0.0, 0.0, 0.0], abs=4 * model.gyro_bias)
    baro = np.array([each.static_pressure for each in readings if each.updated & BARO])
    assert baro.std() == pytest.approx(model.baro_noise, rel=0.15)


def test_no_group_is_stuck_and_each_has_its_rate():
    readings, _ = run(make(), 3.0)
    for group, every in ((ACCEL, 1), (GYRO, 1), (MAG, 3), (BARO, 5), (DIFFERENTIAL, 5)):
        count = sum(each.updated & group == group for each in readings)
        assert count == math.ceil(len(readings) / every)
        assert all(each.updated & group in (0, group) for each in readings)


def test_without_noise_the_truth_is_read():
    reading = make(SensorModel.silent()).read(FLYING)
    assert reading.accel == (0.0, 0.0, -9.81)
    assert (reading.static_pressure, reading.differential_pressure) == pytest.approx((101325.0, 137.8))


def test_runs_of_one_seed_are_the_same():
    assert run(make(), 1.0) == run(make(), 1.0)
    assert run(make(), 1.0) != run(make(seed=2), 1.0)


@pytest.mark.parametrize(("heading", "expected"), [(0, (1, 0)), (90, (0, -1)), (180, (-1, 0)), (270, (0, 1))])
def test_the_compass_turns_against_the_aircraft(heading, expected):
    half = math.radians(heading) / 2
    truth = AT_REST._replace(qw=math.cos(half), qz=math.sin(half))
    body = to_body(truth, (1.0, 0.0, 0.5))
    assert body == pytest.approx((*expected, 0.5), abs=1e-12)


def test_nose_up_lifts_gravity_forward():
    half = math.radians(30.0) / 2
    truth = AT_REST._replace(qw=math.cos(half), qy=math.sin(half))
    assert to_body(truth, (0.0, 0.0, -9.81)) == pytest.approx((9.81 * 0.5, 0.0, -9.81 * math.cos(2 * half)))


def test_gps_comes_at_its_rate_and_late_by_its_latency():
    _, fixes = run(make(), 5.0)
    assert len(fixes) == pytest.approx(49, abs=1)
    assert all(0.1 - 1e-9 <= now - fix.time <= 0.1041 for now, fix in fixes)
    latitudes = np.array([fix.latitude_deg for _, fix in fixes])
    assert (latitudes - HOME.latitude_deg).std() * 111_200 == pytest.approx(0.5, rel=0.4)
    assert all(fix.valid and fix.satellites == 12 for _, fix in fixes)


def test_gps_speed_is_along_true_north():
    truth = FLYING._replace(north=60e3, east=90e3)
    _, fixes = run(make(SensorModel.silent()), 1.0, truth)
    convergence = Geodesy(HOME).at(60e3, 90e3).convergence
    assert abs(convergence) > 0.005
    assert fixes[0][1].velocity_east == pytest.approx(15.0 * math.sin(convergence))


def test_gps_lost_and_found():
    _, fixes = run(make(faults="gps-lost@1-2"), 3.0)
    states = {round(fix.time): fix.valid for _, fix in fixes if fix.time % 1.0 > 0.3}
    assert {fix.valid for _, fix in fixes if 1.0 <= fix.time < 2.0} == {False}
    assert {fix.satellites for _, fix in fixes if 1.0 <= fix.time < 2.0} == {0}
    assert {fix.valid for _, fix in fixes if not 1.0 <= fix.time < 2.0} == {True}
    assert states


def test_a_blocked_pitot_tube_keeps_its_total_pressure():
    sensors = make(SensorModel.silent(), "airspeed-blocked@1-3")
    run(sensors, 1.5)
    slower = FLYING._replace(time=2.0, differential_pressure=60.0)
    lower = slower._replace(static_pressure=101825.0)
    readings = [sensors.read(slower) for _ in range(5)] + [sensors.read(lower) for _ in range(5)]
    seen = [each.differential_pressure for each in readings if each.updated & DIFFERENTIAL]
    assert seen == pytest.approx([137.8, 137.8 - 500.0])
    freed = [sensors.read(slower._replace(time=3.5)) for _ in range(5)]
    assert freed[-1].differential_pressure == pytest.approx(60.0)


@pytest.mark.parametrize(("fault", "group"), [("mag-lost", MAG), ("baro-lost", BARO)])
def test_a_lost_sensor_is_silent(fault, group):
    readings, _ = run(make(faults=f"{fault}@1-2"), 3.0)
    loud = [each.time for each in readings if each.updated & group]
    assert not [time for time in loud if 1.0 <= time < 2.0]
    assert [time for time in loud if time >= 2.0]


@pytest.mark.parametrize(("fault", "field"), [("accel-bias", "accel"), ("gyro-bias", "gyro")])
def test_a_step_of_the_bias(fault, field):
    readings, _ = run(make(SensorModel.silent(), f"{fault}@1:0.1,-0.2,0.3"), 2.0)
    before, after = getattr(readings[0], field), getattr(readings[-1], field)
    assert np.subtract(after, before) == pytest.approx([0.1, -0.2, 0.3])
