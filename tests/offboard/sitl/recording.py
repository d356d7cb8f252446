"""Recorded traffic of real autopilots, replayed to the simulated one."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass, field
from pathlib import Path

from avoidance import Performance
from offboard.frames import MapFrame
from offboard.framing import Framer
from offboard.sitl.aircraft import Aircraft
from offboard.sitl.autopilot import FLAVOURS, Autopilot, Settings
from offboard.sitl.dialect import Codec
from tests.offboard.fake_plant import FakePlant

FOLDER = Path(__file__).resolve().parents[4] / "shared" / "wire"
HOMES = {"px4": (47.397742, 8.545594, 1.0), "ardupilot": (47.397742, 8.545594, 488.1)}
STATION = 245
PROTOCOL = {
    "MISSION_REQUEST": ("seq",),
    "MISSION_REQUEST_INT": ("seq",),
    "MISSION_ACK": ("type",),
    "MISSION_COUNT": ("count",),
    "MISSION_ITEM_INT": ("seq", "frame", "command", "current", "param1", "param2", "param3"),
    "COMMAND_ACK": ("command", "result"),
}
"""What answers are compared by."""


def frames(name):
    """Seconds since the beginning and bytes of each frame of a recording."""
    data = (FOLDER / f"{name}.tlog").read_bytes()
    first = struct.unpack(">Q", data[:8])[0]
    start = 0
    while start < len(data):
        time = struct.unpack(">Q", data[start : start + 8])[0]
        length = data[start + 9] + (12 if data[start + 8] == 0xFD else 8)
        yield (time - first) * 1e-6, data[start + 8 : start + 8 + length]
        start += 8 + length


class Thrown:
    """A hand launch: the point begins to fly where it is."""

    def launch(self):
        pass


@dataclass
class Replay:
    """Both sides of a recording, as (time, message)."""

    recorded: list = field(default_factory=list)
    ours: list = field(default_factory=list)
    pilot: Autopilot | None = None

    def answers(self, side):
        """Protocol messages in order, by what they are compared by."""
        return [
            (message.get_type(), *(_plain(getattr(message, name)) for name in PROTOCOL[message.get_type()]))
            for _, message in getattr(self, side)
            if message.get_type() in PROTOCOL
        ]

    def at(self, side, kind, begin, end=math.inf):
        """Messages of a type between two times [s]."""
        return [m for time, m in getattr(self, side) if m.get_type() == kind and begin <= time <= end]


def replay(name, *, speed, system=1, **settings):
    """Tell the simulated autopilot at the same times what the real one was told."""
    kind = name.split("_", maxsplit=1)[0]
    latitude, longitude, altitude = HOMES[kind]
    performance = Performance(
        airspeed=speed, max_bank=math.radians(35.0), roll_time=1.0, acceptance_radius=50.0, tracking_error=5.0
    )
    plant = FakePlant(heading=0.0)
    plant.state.altitude = 0.0
    aircraft = Aircraft(plant, MapFrame(latitude, longitude, altitude), performance, Thrown())
    pilot = Autopilot(aircraft, Settings(flavour=FLAVOURS[kind], system_id=system, **settings))
    pilot.open(0)
    result, decode, framer = Replay(pilot=pilot), Codec(1).decode, Framer(Codec(1).decode)

    def listen():
        result.ours += [(aircraft.clock, message) for message in framer.feed(pilot.flush())]

    for time, frame in frames(name):
        while aircraft.clock < time:
            pilot.step(min(0.1, max(time - aircraft.clock, 1e-3)))
            listen()
        if frame[5 if frame[0] == 0xFD else 3] == STATION:
            pilot.feed(frame)
            listen()
        elif (message := decode(frame)) is not None:
            result.recorded.append((time, message))
    return result


def _plain(value):
    return "open" if isinstance(value, float) and math.isnan(value) else value
