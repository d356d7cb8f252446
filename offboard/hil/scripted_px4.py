"""PX4's side of the simulator API, flown by the scripted pilot from the sensors alone, as PX4 must."""

from __future__ import annotations

import math
import socket
from dataclasses import dataclass, field
from typing import Any

from offboard.hil.attitude import euler, quaternion
from offboard.hil.channels import Airframe
from offboard.hil.framing import Framer
from offboard.hil.plant import NEUTRAL, Axes
from offboard.hil.px4_protocol import ARMED, LOCKSTEP, pressure_altitude
from offboard.hil.scripted import GRAVITY, Believed, ScriptedPilot

HIL_SENSOR, HIL_GPS, HIL_STATE_QUATERNION = 107, 113, 115
SEA_LEVEL_DENSITY = 1.225
_TILT_GAIN = 0.3
"""How fast the attitude follows the accelerometer [1/s]."""
_HEADING_GAIN = 0.5
"""How fast it follows the compass [1/s]."""


@dataclass(slots=True)
class Estimator:
    """Attitude, altitude and speed from IMU, magnetometer, pressures and GPS: a complementary filter.

    The accelerometer shows where down is once the turn's acceleration, rates × airspeed, is taken off it.
    """

    declination: float = 0.0
    """Of the magnetic field [rad]."""
    heading_known: bool = False
    """True once a compass reading has come."""
    fixes: int = 0
    """Valid GPS messages."""
    _time: float | None = None
    _attitude: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    _ground: float | None = None
    _altitude: float = 0.0
    _climb: float = 0.0
    _airspeed: float = 0.0
    _rates: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def sensor(self, m: Any) -> Believed:  # noqa: ANN401  (a pymavlink message)
        """Take a HIL_SENSOR."""
        time = m.time_usec * 1e-6
        period = 0.0 if self._time is None else time - self._time
        self._time = time
        force, rates = (m.xacc, m.yacc, m.zacc), (m.xgyro, m.ygyro, m.zgyro)
        if not self.heading_known and m.fields_updated & 0x1C0:
            self._level(force, (m.xmag, m.ymag, m.zmag))
        if m.fields_updated & 0x400:
            self._airspeed += 0.3 * (
                math.sqrt(max(m.diff_pressure, 0.0) * 200.0 / SEA_LEVEL_DENSITY) - self._airspeed
            )
        self._turn(self._corrected(rates, force, m), period)
        self._rise(m, period)
        self._rates = rates
        bank, pitch, heading = euler(*self._attitude)
        return Believed(time, bank, pitch, heading, *rates, self._altitude, self._climb, self._airspeed)

    def fix(self, m: Any) -> None:  # noqa: ANN401
        """Take a HIL_GPS."""
        if m.fix_type >= 3:
            self.fixes += 1
            self._climb += 0.3 * (-m.vd / 100.0 - self._climb)

    def _level(self, force: tuple[float, float, float], mag: tuple[float, float, float]) -> None:
        """The attitude of an aircraft that stands, from gravity and the compass."""
        bank = math.atan2(-force[1], -force[2])
        pitch = math.atan2(force[0], math.hypot(force[1], force[2]))
        heading = self._compass(bank, pitch, mag)
        self._attitude = quaternion(bank, pitch, heading)
        self.heading_known = True

    def _compass(self, bank: float, pitch: float, mag: tuple[float, float, float]) -> float:
        """True heading by the tilt-compensated magnetometer [rad]."""
        x, y, z = mag
        cr, sr, cp, sp = math.cos(bank), math.sin(bank), math.cos(pitch), math.sin(pitch)
        ahead = x * cp + (y * sr + z * cr) * sp
        right = y * cr - z * sr
        return math.atan2(-right, ahead) + self.declination

    def _corrected(
        self,
        rates: tuple[float, float, float],
        force: tuple[float, float, float],
        m: Any,  # noqa: ANN401
    ) -> tuple[float, float, float]:
        """Rates that also turn the attitude towards what accelerometer and compass show."""
        p, q, r = rates
        v = self._airspeed if self._airspeed > 5.0 else 0.0
        fx, fy, fz = force[0], force[1] - r * v, force[2] + q * v
        size = math.sqrt(fx * fx + fy * fy + fz * fz)
        w, x, y, z = self._attitude
        if abs(size - GRAVITY) < 0.15 * GRAVITY:
            down = (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))
            seen = (-fx / size, -fy / size, -fz / size)
            p += _TILT_GAIN * (seen[1] * down[2] - seen[2] * down[1])
            q += _TILT_GAIN * (seen[2] * down[0] - seen[0] * down[2])
            r += _TILT_GAIN * (seen[0] * down[1] - seen[1] * down[0])
        if m.fields_updated & 0x1C0:
            bank, pitch, heading = euler(w, x, y, z)
            shown = self._compass(bank, pitch, (m.xmag, m.ymag, m.zmag))
            error = 3.0 * _HEADING_GAIN * math.remainder(shown - heading, math.tau)  # one reading in three
            p += error * 2 * (x * z - w * y)
            q += error * 2 * (y * z + w * x)
            r += error * (1 - 2 * (x * x + y * y))
        return p, q, r

    def _turn(self, rates: tuple[float, float, float], period: float) -> None:
        w, x, y, z = self._attitude
        p, q, r = (0.5 * period * rate for rate in rates)
        w, x, y, z = (
            w - x * p - y * q - z * r,
            x + w * p + y * r - z * q,
            y + w * q - x * r + z * p,
            z + w * r + x * q - y * p,
        )
        size = math.sqrt(w * w + x * x + y * y + z * z)
        self._attitude = (w / size, x / size, y / size, z / size)

    def _rise(self, m: Any, period: float) -> None:  # noqa: ANN401
        """Altitude: carried on by the climb, drawn to the barometer."""
        self._altitude += self._climb * period
        if not m.fields_updated & 0x200:
            return
        height = pressure_altitude(m.abs_pressure * 100.0)
        self._ground = height if self._ground is None else self._ground
        error = height - self._ground - self._altitude
        self._altitude += 0.1 * error
        self._climb += 0.02 * error


@dataclass(slots=True)
class ScriptedPx4:
    """Answers HIL_SENSOR with HIL_ACTUATOR_CONTROLS over TCP, flying by the sensors.

    With `hardware` it behaves as a board: no lockstep, `write` and `read` of the board's end of the line are
    given by the caller.
    """

    airframe: Airframe
    """Whose channels it drives."""
    pilot: ScriptedPilot = field(default_factory=ScriptedPilot)
    """Who flies."""
    declination: float = 0.0
    """Of the magnetic field [rad]."""
    boot: int = 38
    """Sensor packets before it answers the first one, as real PX4 does."""
    hardware: bool = False
    """True: a board, which keeps its own time."""
    believed: Believed | None = None
    """From the last HIL_SENSOR."""
    estimator: Estimator = field(init=False)
    sensors: int = 0
    """HIL_SENSOR taken."""
    armed: bool = False
    _common: Any = field(init=False, repr=False)
    _mav: Any = field(init=False, repr=False)
    _framer: Framer = field(init=False, repr=False)
    _socket: Any = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        """Prepare the protocol."""
        from pymavlink.dialects.v20 import common  # noqa: PLC0415  (slow import)

        self._common = common
        self._mav = common.MAVLink(None, srcSystem=4, srcComponent=1)
        self.boot_up()

    def boot_up(self) -> None:
        """Forget everything, as a firmware that starts again does."""
        self._framer = Framer()
        self.estimator = Estimator(self.declination)
        self.believed, self.sensors, self.armed = None, 0, False

    def connect(self, port: int) -> None:
        """Connect to the plant on this machine, and say hello as PX4 does."""
        self._socket = socket.create_connection(("127.0.0.1", port))
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket.setblocking(False)
        self._socket.sendall(self.hello())

    def hello(self) -> bytes:
        """COMMAND_LONG 511 for HIL_STATE_QUATERNION, and one HEARTBEAT."""
        c = self._common
        command = c.MAVLink_command_long_message(
            0, 0, c.MAV_CMD_SET_MESSAGE_INTERVAL, 0, HIL_STATE_QUATERNION, 5000, 0, 0, 0, 0, 0
        )
        beat = c.MAVLink_heartbeat_message(0, c.MAV_AUTOPILOT_PX4, 0, 0, 0, 3)
        return bytes(command.pack(self._mav)) + bytes(beat.pack(self._mav))

    def poll(self) -> int:
        """Take what the plant has sent and answer it; how many HIL_SENSOR it was."""
        before = self.sensors
        try:
            data = self._socket.recv(65536)
        except BlockingIOError:
            return 0
        if answer := self.feed(data):
            self._socket.sendall(answer)
        return self.sensors - before

    def feed(self, data: bytes) -> bytes:
        """Take bytes from the plant; the answers."""
        parts = []
        for frame in self._framer.feed(data):
            if frame.message not in (HIL_SENSOR, HIL_GPS):
                continue
            message = self._mav.decode(bytearray(frame.data))
            if frame.message == HIL_GPS:
                self.estimator.fix(message)
                continue
            self.sensors += 1
            self.believed = self.estimator.sensor(message)
            if self.sensors > self.boot:
                parts.append(self.controls(message.time_usec))
        return b"".join(parts)

    def controls(self, time_usec: int, axes: Axes | None = None) -> bytes:
        """HIL_ACTUATOR_CONTROLS for a time [µs]; all zero while disarmed."""
        if axes is None:
            axes = NEUTRAL if self.believed is None else self.pilot.fly(self.believed)
        self.armed = self.believed is not None and self.pilot.task(self.believed.time).armed
        controls = self.airframe.values_for(axes) if self.armed else [0.0] * 16
        mode = 1 | (ARMED if self.armed else 0)
        flags = 0 if self.hardware else LOCKSTEP
        message = self._common.MAVLink_hil_actuator_controls_message(time_usec, controls, mode, flags)
        return bytes(message.pack(self._mav))

    def close(self) -> None:
        """Close the connection."""
        if self._socket is not None:
            self._socket.close()
