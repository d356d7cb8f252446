"""ArduPilot's side of its JSON protocol, flown by the scripted pilot; it parses as ArduPilot does."""

from __future__ import annotations

import socket
from dataclasses import dataclass, field
from typing import Any

from offboard.hil.attitude import euler
from offboard.hil.channels import Airframe
from offboard.hil.json_protocol import Servos, pack_servos
from offboard.hil.plant import NEUTRAL
from offboard.hil.scripted import Believed, ScriptedPilot

FIELDS = {
    "timestamp": ("", 1),
    "gyro": ('"imu":', 3),
    "accel_body": ('"imu":', 3),
    "position": ("", 3),
    "quaternion": ("", 4),
    "velocity": ("", 3),
    "airspeed": ("", 1),
}
"""What is looked for: the section it stands in, and how many numbers it has."""

OPTIONAL = ("airspeed",)


def read_line(text: str) -> dict[str, tuple[float, ...]]:
    """The numbers of an answer, found as ArduPilot finds them: by searching for the key.

    Raises
    ------
    ValueError
        If one is missing or has the wrong number of values.
    """
    found: dict[str, tuple[float, ...]] = {}
    for key, (section, count) in FIELDS.items():
        begin = text.find(f'"{key}":', text.find(section))
        if begin < 0 and key in OPTIONAL:
            continue
        if begin < 0:
            raise ValueError(f"{key} is missing")
        value = text[begin + len(key) + 3 :]
        if count == 1:
            found[key] = (float(value[: min(i for i in (value.find(","), value.find("}")) if i >= 0)]),)
        else:
            found[key] = tuple(float(part) for part in value[1 : value.index("]")].split(","))
        if len(found[key]) != count:
            raise ValueError(f"{key} has {len(found[key])} values, not {count}")
    return found


@dataclass(slots=True)
class ScriptedArduPilot:
    """Sends servo packets over UDP, and flies by what comes back."""

    port: int
    """Of the plant on this machine."""
    airframe: Airframe
    """Whose channels it drives."""
    pilot: ScriptedPilot = field(default_factory=ScriptedPilot)
    """Who flies."""
    rate: int = 400
    """Steps per second that it asks for [Hz]."""
    channels: int = 16
    """16 or 32."""
    believed: Believed | None = None
    """From the last answer."""
    felt: dict[str, tuple[float, ...]] = field(default_factory=dict)
    """The last answer's numbers."""
    count: int = 0
    """Of the next packet."""
    answers: int = 0
    """Taken so far."""
    _socket: Any = None

    def __post_init__(self) -> None:
        """Open the socket."""
        self.open()

    def open(self) -> None:
        """Take a new socket, as a firmware that starts again does."""
        self.close()
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def restart(self) -> None:
        """Begin at frame zero, from another port."""
        self.open()
        self.count = 0
        self.believed = None

    def packet(self) -> bytes:
        """The servo packet that is due."""
        axes = NEUTRAL if self.believed is None else self.pilot.fly(self.believed)
        return pack_servos(Servos(self.rate, self.count, tuple(self.airframe.pwm_for(axes, self.channels))))

    def send(self, data: bytes | None = None) -> None:
        """Send the packet that is due, or these bytes."""
        self._socket.sendto(self.packet() if data is None else data, ("127.0.0.1", self.port))

    def receive(self, timeout: float = 1.0) -> str | None:
        """Take an answer; None if none has come within `timeout` [s]."""
        self._socket.settimeout(timeout)
        try:
            text: str = self._socket.recv(65536).decode("ascii")
        except (TimeoutError, BlockingIOError):
            return None
        self.felt = read_line(text)
        self.believed = _believe(self.felt)
        self.count += 1
        self.answers += 1
        return text

    def close(self) -> None:
        """Free the socket."""
        if self._socket is not None:
            self._socket.close()


def _believe(felt: dict[str, tuple[float, ...]]) -> Believed:
    """ArduPilot's sensors are simulated from the truth; here the truth itself is believed."""
    w, x, y, z = felt["quaternion"]
    bank, pitch, heading = euler(w, x, y, z)
    p, q, r = felt["gyro"]
    return Believed(
        felt["timestamp"][0], bank, pitch, heading, p, q, r,
        -felt["position"][2], -felt["velocity"][2], felt.get("airspeed", (0.0,))[0],
    )  # fmt: skip
