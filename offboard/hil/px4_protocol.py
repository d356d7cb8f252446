"""The simulator's side of PX4's MAVLink API: measurements out, actuator commands in; no I/O, no clock.

Notes
-----
In lockstep HIL_SENSOR's time is PX4's clock: PX4 stands still until the next one. The plant runs free until
the first HIL_ACTUATOR_CONTROLS; from then on one answers each HIL_SENSOR, with the same time.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from offboard.hil.framing import Frame, Framer, Writer
from offboard.hil.geodesy import Place, true_north
from offboard.hil.plant import Truth
from offboard.hil.sensors import Fix, Reading

HEARTBEAT, COMMAND_LONG, HIL_ACTUATOR_CONTROLS, HIL_SENSOR = 0, 76, 93, 107
"""Message IDs that a simulator looks at."""
ARMED = 128
"""Bit of HIL_ACTUATOR_CONTROLS.mode."""
LOCKSTEP = 1
"""Bit of HIL_ACTUATOR_CONTROLS.flags."""
_SENSOR = struct.Struct("<Q13fIB")
"""HIL_SENSOR in wire order: time, 13 measurements, fields_updated, id."""
_ACTUATORS = struct.Struct("<QQ16fB")
"""HIL_ACTUATOR_CONTROLS in wire order: time, flags, controls, mode."""
_ZERO_CELSIUS = 273.15
_GRAVITY = 9.80665
_SEA_LEVEL = 101325.0


class Actuators(NamedTuple):
    """One HIL_ACTUATOR_CONTROLS."""

    time_usec: int
    """PX4's clock [µs]; in lockstep that of the HIL_SENSOR it answers."""
    controls: tuple[float, ...]
    """16 outputs: surfaces -1 to 1, engines 0 to 1; all 0 while disarmed."""
    armed: bool
    lockstep: bool


@dataclass(slots=True)
class Heard:
    """What some bytes from PX4 contain."""

    actuators: list[Actuators] = field(default_factory=list)
    """Commands, in their order."""
    others: list[Frame] = field(default_factory=list)
    """Everything else, as it came."""
    systems: set[int] = field(default_factory=set)
    """System IDs that were heard."""


class Px4Link:
    """Turns measurements into MAVLink 2 and MAVLink into actuator commands.

    Parameters
    ----------
    system, component : int
        The simulator's own IDs.
    """

    def __init__(self, system: int = 1, component: int = 200) -> None:
        from pymavlink.dialects.v20 import common  # noqa: PLC0415  (slow import)

        self._common: Any = common
        self._out = common.MAVLink(None, srcSystem=system, srcComponent=component)
        self._sensor = Writer(HIL_SENSOR, common.MAVLink_hil_sensor_message.crc_extra, self._out)
        self._framer = Framer()
        self._skipped = 0
        self.broken = 0
        """Frames whose content could not be read."""

    @property
    def skipped(self) -> int:
        """Bytes that belonged to no frame."""
        return self._skipped + self._framer.skipped

    def forget(self) -> None:
        """Begin a new connection: what is left of the old one's bytes is thrown away."""
        self._skipped += self._framer.skipped
        self._framer = Framer()

    def hear(self, data: bytes) -> Heard:
        """What PX4 says."""
        heard = Heard()
        for frame in self._framer.feed(data):
            heard.systems.add(frame.system)
            if frame.message != HIL_ACTUATOR_CONTROLS:
                heard.others.append(frame)
            elif (found := self._actuators(frame)) is not None:
                heard.actuators.append(found)
        return heard

    def _actuators(self, frame: Frame) -> Actuators | None:
        payload = frame.payload
        if len(payload) > _ACTUATORS.size:
            self.broken += 1
            return None
        time_usec, flags, *controls, mode = _ACTUATORS.unpack(payload.ljust(_ACTUATORS.size, b"\0"))
        return Actuators(time_usec, tuple(controls), bool(mode & ARMED), bool(flags & LOCKSTEP))

    def sensor(self, reading: Reading) -> bytes:
        """HIL_SENSOR: FRD, gauss, hectopascal, degrees Celsius."""
        r = reading
        payload = _SENSOR.pack(
            round(r.time * 1e6),
            *r.accel,
            *r.gyro,
            *r.mag,
            r.static_pressure / 100.0,
            r.differential_pressure / 100.0,
            pressure_altitude(r.static_pressure),
            r.temperature - _ZERO_CELSIUS,
            r.updated,
            0,
        )
        return self._sensor.frame(payload)

    def gps(self, fix: Fix) -> bytes:
        """HIL_GPS; `eph` and `epv` are centimetres to PX4."""
        speed = math.hypot(fix.velocity_north, fix.velocity_east)
        course = math.degrees(math.atan2(fix.velocity_east, fix.velocity_north)) % 360.0
        message = self._common.MAVLink_hil_gps_message(
            round(fix.time * 1e6),
            3 if fix.valid else 0,
            round(fix.latitude_deg * 1e7),
            round(fix.longitude_deg * 1e7),
            round(fix.altitude_m * 1e3),
            min(round(fix.horizontal * 100.0), 65535),
            min(round(fix.vertical * 100.0), 65535),
            min(round(speed * 100.0), 65535),
            round(fix.velocity_north * 100.0),
            round(fix.velocity_east * 100.0),
            round(fix.velocity_down * 100.0),
            min(round(course * 100.0), 35999),
            fix.satellites,
        )
        return bytes(message.pack(self._out))

    def state(self, truth: Truth, place: Place, altitude_m: float) -> bytes:
        """HIL_STATE_QUATERNION, which PX4 only logs: position, attitude and motion, true.

        Parameters
        ----------
        truth : Truth
            Of this step.
        place : Place
            Where it is.
        altitude_m : float
            Above mean sea level.
        """
        t = true_north(truth, place.convergence)
        airspeed = min(round(t.airspeed * 100.0), 65535)
        message = self._common.MAVLink_hil_state_quaternion_message(
            round(t.time * 1e6),
            (t.qw, t.qx, t.qy, t.qz),
            t.p,
            t.q,
            t.r,
            round(place.latitude_deg * 1e7),
            round(place.longitude_deg * 1e7),
            round(altitude_m * 1e3),
            round(t.velocity_north * 100.0),
            round(t.velocity_east * 100.0),
            round(t.velocity_down * 100.0),
            airspeed,
            airspeed,
            *(_milli_g(force) for force in (t.force_x, t.force_y, t.force_z)),
        )
        return bytes(message.pack(self._out))

    def heartbeat(self) -> bytes:
        """HEARTBEAT: hardware starts MAVLink on its USB port when it hears one."""
        message = self._common.MAVLink_heartbeat_message(
            self._common.MAV_TYPE_GENERIC, self._common.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3
        )
        return bytes(message.pack(self._out))


def pressure_altitude(pressure: float) -> float:
    """Altitude [m] at a pressure [Pa], below 11 km (US Standard Atmosphere 1976)."""
    return 288.15 / 0.0065 * (1.0 - math.pow(max(pressure, 1.0) / _SEA_LEVEL, 1.0 / 5.25587611))


def _milli_g(force: float) -> int:
    return min(max(round(force / _GRAVITY * 1e3), -32767), 32767)
