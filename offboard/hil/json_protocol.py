"""ArduPilot's "JSON" simulator protocol: servo packets in, one line of JSON out; no I/O, no clock.

ArduPilot sends a packet and waits for the answer; after a second without one it sends the same packet again.
A frame counter that goes back to zero is a firmware that has started again.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import NamedTuple

from offboard.hil.plant import Truth

_HEADER = struct.Struct("<HHI")
_CHANNELS = {18458: struct.Struct("<16H"), 29569: struct.Struct("<32H")}
"""Pulse widths by the packet's magic number: 16 channels, or 32 with SERVO_32_ENABLE."""
_MAGICS = {16: 18458, 32: 29569}
SLOWEST_RATE = 10
"""ArduPilot ignores steps of 0.1 s and more [Hz]."""
_WRAP = 1 << 32
_LOST_AFTER = 0.5
"""A packet that comes again this long after its answer went out says that the answer was lost [s]."""
_ANSWER = (
    '\n{"timestamp":%.6f,"imu":{"gyro":[%.6f,%.6f,%.6f],"accel_body":[%.6f,%.6f,%.6f]},'
    '"position":[%.6f,%.6f,%.6f],"quaternion":[%.8f,%.8f,%.8f,%.8f],"velocity":[%.6f,%.6f,%.6f],'
    '"airspeed":%.4f}\n'
)
"""Without blanks: ArduPilot's parser searches for `key":` and reads what follows."""


class Servos(NamedTuple):
    """One servo packet."""

    rate: int
    """Steps per second that the firmware asks for [Hz]."""
    frame: int
    """Frame counter."""
    pwm: tuple[int, ...]
    """Pulse widths [µs]; 0: no output."""


def parse_servos(data: bytes) -> Servos | None:
    """A servo packet, or None if the bytes are none."""
    if len(data) < _HEADER.size:
        return None
    magic, rate, count = _HEADER.unpack_from(data)
    channels = _CHANNELS.get(magic)
    if channels is None or len(data) != _HEADER.size + channels.size or rate < SLOWEST_RATE:
        return None
    return Servos(rate, count, channels.unpack_from(data, _HEADER.size))


def pack_servos(servos: Servos) -> bytes:
    """The bytes of a servo packet, as ArduPilot sends it.

    Raises
    ------
    ValueError
        If it has neither 16 nor 32 channels.
    """
    if len(servos.pwm) not in _MAGICS:
        raise ValueError(f"len(pwm) = {len(servos.pwm)}, must be 16 or 32")
    magic = _MAGICS[len(servos.pwm)]
    return _HEADER.pack(magic, servos.rate, servos.frame) + _CHANNELS[magic].pack(*servos.pwm)


def answer(truth: Truth, time: float, north: float, east: float, airspeed: float) -> bytes:
    """The line that answers a servo packet.

    Parameters
    ----------
    truth : Truth
        What the sensors feel; ArduPilot adds the noise.
    time : float
        Time stamp [s].
    north, east : float
        Position in ArduPilot's metres from home [m].
    airspeed : float
        What the pitot tube makes of it [m/s].
    """
    t = truth
    text = _ANSWER % (
        time, t.p, t.q, t.r, t.force_x, t.force_y, t.force_z, north, east, -t.altitude,
        t.qw, t.qx, t.qy, t.qz, t.velocity_north, t.velocity_east, t.velocity_down, airspeed,
    )  # fmt: skip
    return text.encode("ascii")


@dataclass(frozen=True, slots=True)
class Step:
    """Advance the plant by a step with these servos, then answer."""

    servos: Servos
    duration: float
    """[s]"""
    restart: bool = False
    """True: put the plant back to its start first."""
    missed: int = 0
    """Frames that never arrived before this one."""


@dataclass(frozen=True, slots=True)
class Repeat:
    """Send the last answer once more; the plant stands still."""


@dataclass(frozen=True, slots=True)
class Ignored:
    """Do nothing."""

    why: str
    """"garbage", "duplicate" or "late"."""


class JsonSession:
    """What to do about each datagram; knows the conversation, not the plant.

    Examples
    --------
    >>> session = JsonSession()
    >>> packet = pack_servos(Servos(200, 0, (1500,) * 16))
    >>> session.take(packet, "a", 0.0).duration
    0.005
    >>> session.answered(0.001)
    >>> session.take(packet, "a", 0.002), session.take(packet, "a", 1.1)
    (Ignored(why='duplicate'), Repeat())
    """

    def __init__(self) -> None:
        self._last: int | None = None
        self._sender: object = None
        self._answered: float | None = None

    def take(self, data: bytes, sender: object, now: float) -> Step | Repeat | Ignored:
        """Judge a datagram from `sender` that is read at `now` [s] (any steady clock)."""
        servos = parse_servos(data)
        if servos is None:
            return Ignored("garbage")
        moved, again = sender != self._sender, servos.frame == self._last
        if self._last is None:
            return self._accept(servos, sender)
        if (moved and servos.frame == 0) or (servos.frame == 0 and not again):
            return self._accept(servos, sender, restart=True)
        if again:
            return self._again(now)
        ahead = (servos.frame - self._last) % _WRAP
        if ahead < _WRAP // 2:
            return self._accept(servos, sender, missed=ahead - 1)
        return self._accept(servos, sender, restart=True) if moved else Ignored("late")

    def answered(self, now: float) -> None:
        """The answer to the last step has been sent."""
        self._answered = now

    def _again(self, now: float) -> Repeat | Ignored:
        """The same packet again: was the answer lost, or is it still on its way?"""
        if self._answered is None or now - self._answered < _LOST_AFTER:
            return Ignored("duplicate")
        self._answered = now
        return Repeat()

    def _accept(self, servos: Servos, sender: object, *, restart: bool = False, missed: int = 0) -> Step:
        self._last, self._sender, self._answered = servos.frame, sender, None
        return Step(servos, 1.0 / servos.rate, restart, missed)
