"""What the sensors of an aircraft read: the truth with noise, bias, latency and failures.

Noise is white with the standard deviations of `SensorModel`; a bias drawn once per run stands for what a
calibration leaves. The accelerometer sits in the centre of gravity.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from offboard.hil.attitude import to_body
from offboard.hil.faults import Fault
from offboard.hil.geodesy import Geodesy
from offboard.hil.magnetic import Field, MagneticField
from offboard.hil.plant import Truth

ACCEL, GYRO, MAG, DIFFERENTIAL, BARO = 0x7, 0x38, 0x1C0, 0x400, 0x1A00
"""Groups of HIL_SENSOR's `fields_updated`: all bits of a group or none."""
_BLOCK = 4096
_ZERO = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class SensorModel:
    """Noise (one standard deviation), bias and timing of each sensor.

    The noise is that with which PX4 1.17 armed and flew.
    """

    accel_noise: float = 0.02
    """[m/s²]"""
    accel_bias: float = 0.01
    """Standard deviation from run to run [m/s²]."""
    gyro_noise: float = 0.001
    """[rad/s]"""
    gyro_bias: float = 0.0005
    """Standard deviation from run to run [rad/s]."""
    mag_noise: float = 0.001
    """[G]"""
    baro_noise: float = 1.0
    """[Pa]"""
    differential_noise: float = 0.5
    """[Pa]"""
    mag_every: int = 3
    """Steps from one reading to the next."""
    pressure_every: int = 5
    """Steps from one reading of barometer and airspeed to the next."""
    gps_rate: float = 10.0
    """[Hz]"""
    gps_latency: float = 0.1
    """From measurement to message [s]."""
    gps_horizontal: float = 0.5
    """White noise of the position, and the accuracy that is told [m]."""
    gps_vertical: float = 0.8
    """[m]"""
    gps_speed: float = 0.05
    """[m/s]"""

    @classmethod
    def silent(cls) -> SensorModel:
        """Without noise and bias, for checks of the plant."""
        return cls(
            accel_noise=0.0,
            accel_bias=0.0,
            gyro_noise=0.0,
            gyro_bias=0.0,
            mag_noise=0.0,
            baro_noise=0.0,
            differential_noise=0.0,
            gps_horizontal=0.0,
            gps_vertical=0.0,
            gps_speed=0.0,
        )


class Reading(NamedTuple):
    """One step's measurements in PX4's units' SI counterparts; what is not new repeats the last value."""

    time: float
    """[s]"""
    accel: tuple[float, float, float]
    """Specific force, body [m/s²]."""
    gyro: tuple[float, float, float]
    """Body rates [rad/s]."""
    mag: tuple[float, float, float]
    """Body [G]."""
    static_pressure: float
    """[Pa]"""
    differential_pressure: float
    """[Pa]"""
    temperature: float
    """[K]"""
    updated: int
    """Which groups are new."""


class Fix(NamedTuple):
    """One GPS message."""

    time: float
    """When it was measured [s]."""
    valid: bool
    latitude_deg: float
    longitude_deg: float
    altitude_m: float
    """Above mean sea level."""
    velocity_north: float
    """True north [m/s]."""
    velocity_east: float
    """[m/s]"""
    velocity_down: float
    """[m/s]"""
    horizontal: float
    """Accuracy [m]."""
    vertical: float
    """Accuracy [m]."""
    satellites: int


class Sensors:
    """All sensors of one aircraft.

    Parameters
    ----------
    geodesy : Geodesy
        The map about home.
    field : MagneticField
        For the magnetometer.
    rng : numpy.random.Generator
        All noise comes from it.
    model : SensorModel
        Noise, bias, timing.
    faults : sequence of Fault
        What fails, and when.
    """

    def __init__(
        self,
        geodesy: Geodesy,
        field: MagneticField,
        rng: np.random.Generator,
        model: SensorModel | None = None,
        faults: Sequence[Fault] = (),
    ) -> None:
        self.model = SensorModel() if model is None else model
        self.geodesy = geodesy
        self._field = field
        self._normal = _normals(rng).__next__
        self._faults: dict[str, tuple[Fault, ...]] = {
            name: tuple(fault for fault in faults if fault.name == name) for name in {f.name for f in faults}
        }
        self._accel_bias = self._three(self.model.accel_bias)
        self._gyro_bias = self._three(self.model.gyro_bias)
        self.restart()

    def restart(self) -> None:
        """Forget the flight so far; biases stay, as in a sensor that is switched on again."""
        self._count = 0
        self._mag = _ZERO
        self._static = self._differential = 0.0
        self._trapped: float | None = None
        self._next_fix = 0.0
        self._fixes: deque[tuple[float, Fix]] = deque()

    def failing(self, name: str, time: float) -> Fault | None:
        """The fault of this name that is active at a time [s], if any."""
        for fault in self._faults.get(name, ()):
            if fault.active(time):
                return fault
        return None

    def read(self, truth: Truth) -> Reading:
        """This step's measurements."""
        model, time, first = self.model, truth.time, self._count == 0
        updated = ACCEL | GYRO
        if first or (self._count % model.mag_every == 0 and not self.failing("mag-lost", time)):
            self._mag = self._magnetometer(truth)
            updated |= MAG
        if first or self._count % model.pressure_every == 0:
            updated |= self._pressures(truth)
        self._count += 1
        force = (truth.force_x, truth.force_y, truth.force_z)
        accel = self._inertial(force, "accel-bias", self._accel_bias, model.accel_noise, time)
        gyro = self._inertial(
            (truth.p, truth.q, truth.r), "gyro-bias", self._gyro_bias, model.gyro_noise, time
        )
        return Reading(
            time, accel, gyro, self._mag, self._static, self._differential, truth.temperature, updated
        )

    def fix(self, truth: Truth) -> Fix | None:
        """A GPS message that is due by now, if any."""
        if truth.time >= self._next_fix:
            self._next_fix += 1.0 / self.model.gps_rate
            self._fixes.append((truth.time + self.model.gps_latency, self._measure(truth)))
        if self._fixes and truth.time >= self._fixes[0][0]:
            return self._fixes.popleft()[1]
        return None

    def field_in_map(self, truth: Truth) -> Field:
        """The magnetic field about the aircraft in the map's axes [G]."""
        place = self.geodesy.at(truth.north, truth.east)
        altitude = self.geodesy.frame.altitude_m + truth.altitude
        field = self._field.at(place.latitude_deg, place.longitude_deg, altitude)
        c, s = math.cos(place.convergence), math.sin(place.convergence)
        return Field(c * field.north + s * field.east, c * field.east - s * field.north, field.down)

    def _three(self, sigma: float) -> tuple[float, float, float]:
        normal = self._normal
        return (sigma * normal(), sigma * normal(), sigma * normal())

    def _inertial(
        self,
        true: tuple[float, float, float],
        fault: str,
        bias: tuple[float, float, float],
        noise: float,
        time: float,
    ) -> tuple[float, float, float]:
        step = _ZERO
        if self._faults and (found := self.failing(fault, time)) is not None:
            step = (found.values[0], found.values[1], found.values[2])
        normal = self._normal
        return (
            true[0] + bias[0] + step[0] + noise * normal(),
            true[1] + bias[1] + step[1] + noise * normal(),
            true[2] + bias[2] + step[2] + noise * normal(),
        )

    def _magnetometer(self, truth: Truth) -> tuple[float, float, float]:
        field = self.field_in_map(truth)
        body = to_body(truth, field)
        noise = self._three(self.model.mag_noise)
        return (body[0] + noise[0], body[1] + noise[1], body[2] + noise[2])

    def _pressures(self, truth: Truth) -> int:
        """Read barometer and pitot tube; the groups that are new."""
        updated, model = DIFFERENTIAL, self.model
        if self._count == 0 or not self.failing("baro-lost", truth.time):
            self._static = truth.static_pressure + model.baro_noise * self._normal()
            updated |= BARO
        total = truth.static_pressure + truth.differential_pressure
        if self.failing("airspeed-blocked", truth.time):
            total = self._trapped = total if self._trapped is None else self._trapped
        else:
            self._trapped = None
        self._differential = total - truth.static_pressure + model.differential_noise * self._normal()
        return updated

    def _measure(self, truth: Truth) -> Fix:
        model, normal = self.model, self._normal
        north = truth.north + model.gps_horizontal * normal()
        east = truth.east + model.gps_horizontal * normal()
        place = self.geodesy.at(north, east)
        altitude = self.geodesy.frame.altitude_m + truth.altitude + model.gps_vertical * normal()
        vn, ve, vd = truth.velocity_north, truth.velocity_east, truth.velocity_down
        c, s = math.cos(place.convergence), math.sin(place.convergence)
        lost = self.failing("gps-lost", truth.time) is not None
        return Fix(
            truth.time,
            not lost,
            place.latitude_deg,
            place.longitude_deg,
            altitude,
            c * vn - s * ve + model.gps_speed * normal(),
            s * vn + c * ve + model.gps_speed * normal(),
            vd + model.gps_speed * normal(),
            99.99 if lost else max(model.gps_horizontal, 0.1),
            99.99 if lost else max(model.gps_vertical, 0.1),
            0 if lost else 12,
        )


def _normals(rng: np.random.Generator) -> Iterator[float]:
    """Standard normal numbers, drawn many at a time (one at a time costs 20 times as much)."""
    while True:
        yield from rng.standard_normal(_BLOCK).tolist()
