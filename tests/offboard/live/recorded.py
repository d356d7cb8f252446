"""A peer for MAVSDK that answers as a recorded autopilot did: its traffic, in its order, at its times.

What it says by itself is sent as it was recorded. Its answers are those that it gave, addressed to whoever
asks now. We put an anchor into an edit that the recorded ground station did not: item numbers and totals
behind an upload are moved by as much.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from offboard.framing import Framer
from offboard.sitl.dialect import Codec, Extended, mavlink
from tests.offboard.sitl.recording import STATION, frames

SILENT = {
    "MISSION_REQUEST", "MISSION_REQUEST_INT", "MISSION_ACK", "MISSION_COUNT", "MISSION_ITEM_INT",
    "COMMAND_ACK", "COMMAND_LONG", "PARAM_VALUE", "MISSION_CURRENT", "MISSION_ITEM_REACHED", "TIMESYNC",
}  # fmt: skip
"""Answers, given when they are asked for, and what is moved."""
PARAMETERS = {
    "px4": {
        "FW_AIRSPD_TRIM": 12.0, "FW_R_LIM": 45.0, "NAV_ACC_RAD": 50.0, "NAV_TRAFF_AVOID": 1.0,
        "MIS_TKO_LAND_REQ": 0.0, "NAV_LOITER_RAD": 80.0, "SYS_HITL": 0.0, "SYS_AUTOSTART": 10041.0,
        "ADSB_ICAO_ID": 0.0,
    },
    "ardupilot": {
        "AIRSPEED_CRUISE": 22.0, "ROLL_LIMIT_DEG": 45.0, "WP_RADIUS": 90.0, "AVD_ENABLE": 0.0,
        "SIM_SPEEDUP": 1.0, "WP_LOITER_RAD": 80.0, "ADSB_ICAO_ID": 0.0,
    },
}  # fmt: skip
"""The recordings were made without asking for these."""


@dataclass
class Upload:
    """An upload as it was recorded."""

    count: int
    flagged: int
    acknowledged: float
    items: list = field(default_factory=list)
    """As the autopilot has them."""
    sent: list = field(default_factory=list)


class Recorded:
    """A recording from a time on; it stands still before each recorded upload until there is one."""

    def __init__(self, name: str, begin: float, *, gates: bool = True) -> None:
        self._kind = name.split("_", maxsplit=1)[0]
        self.time = begin
        self._gates = gates
        decode = Codec(1).decode
        every = [(t, frame, decode(frame)) for t, frame in frames(name)]
        every = [(t, frame, message) for t, frame, message in every if message is not None]
        self.system = next(m.get_srcSystem() for _, _, m in every if m.get_type() == "HEARTBEAT")
        if self.system == STATION:
            self.system = 1
        self._uploads = _uploads(every)
        self._next = sum(upload.acknowledged < begin for upload in self._uploads)
        theirs = [(t, frame, m) for t, frame, m in every if m.get_srcSystem() == self.system]
        self._ask_with = [m.get_type() for _, _, m in theirs if m.get_type().startswith("MISSION_REQUEST")][
            -1
        ]
        self._stream = [entry for entry in theirs if entry[2].get_type() not in SILENT or _moved(entry[2])]
        known = [e for e in self._stream if e[0] < begin]
        self._first = {
            m.get_type(): frame
            for _, frame, m in known
            if m.get_type() in ("HOME_POSITION", "MISSION_CURRENT")
        }
        self._at = len(known)
        self.items = list(self._uploads[self._next - 1].items) if self._next else []
        self.sent = [upload.sent for upload in self._uploads]
        self._steps = 0
        self._shift, self._more, self._from = 0, 0, 10**6
        self._incoming: list = []
        self._wanted = 0
        self._partner = (0, 0)
        self._codec = Codec(self.system)
        self._framer = Framer(Codec(255).decode)
        self._out = b"".join(self._first.values())

    @property
    def waits(self) -> bool:
        """True while it stands still before an upload."""
        gate = self._gate()
        return gate is not None and self.time >= gate

    def step(self, duration: float) -> None:
        gate = self._gate()
        self.time = self.time + duration if gate is None else min(self.time + duration, gate)
        self._steps += 1
        if self._steps % 5 == 0:  # as often as it is asked for: the recordings have it at the beginning only
            self._out += self._first.get("HOME_POSITION", b"")
        if not self._gates and self._next < len(self._uploads):
            upload = self._uploads[self._next]
            if self.time >= upload.acknowledged:
                self.items, self._next = upload.items, self._next + 1
        while self._at < len(self._stream) and self._stream[self._at][0] <= self.time:
            _, frame, message = self._stream[self._at]
            self._out += self._move(frame, message) if _moved(message) else frame
            self._at += 1
        stamp = mavlink.MAVLink_system_time_message(round(self.time * 1e6), round(self.time * 1e3))
        self._out += self._codec.pack(stamp)

    def feed(self, data: bytes) -> None:
        for message in self._framer.feed(data):
            self._partner = (message.get_srcSystem(), message.get_srcComponent())
            answer = getattr(self, f"_on_{message.get_type().lower()}", None)
            if answer is not None:
                answer(message)

    def flush(self) -> bytes:
        data, self._out = self._out, b""
        return data

    def _say(self, make: type, *values: object) -> None:
        self._out += self._codec.pack(make(*self._partner, *values))

    def _gate(self) -> float | None:
        if not self._gates or self._next >= len(self._uploads):
            return None
        return self._uploads[self._next].acknowledged

    def _move(self, frame: bytes, message: object) -> bytes:
        """An item's number and a total as they are with what has been uploaded to us."""
        seq = message.seq + (self._shift if message.seq >= self._from else 0)
        if message.get_type() == "MISSION_ITEM_REACHED":
            return self._codec.pack(mavlink.MAVLink_mission_item_reached_message(seq))
        total = message.total if message.total in (0, 65535) else message.total + self._more
        now = mavlink.MAVLink_mission_current_message(seq, total, message.mission_state, message.mission_mode)
        payload = frame[10 : 10 + frame[1]].ljust(18, b"\0")
        return self._codec.pack(Extended(now, int.from_bytes(payload[6:10], "little")))

    # What MAVSDK says

    def _on_param_request_read(self, message: object) -> None:
        name = message.param_id
        if name in PARAMETERS[self._kind]:
            value = mavlink.MAVLink_param_value_message(
                name.encode(), PARAMETERS[self._kind][name], mavlink.MAV_PARAM_TYPE_REAL32, 900, 1
            )
            self._out += self._codec.pack(value)

    def _on_command_long(self, message: object) -> None:
        accepted = mavlink.MAV_RESULT_ACCEPTED
        ack = mavlink.MAVLink_command_ack_message(message.command, accepted, 0, 0, *self._partner)
        self._out += self._codec.pack(ack)

    def _on_mission_request_list(self, message: object) -> None:
        count = len(self.items) if message.mission_type == 0 else 0
        self._say(mavlink.MAVLink_mission_count_message, count, message.mission_type)

    def _on_mission_request_int(self, message: object) -> None:
        item = self.items[message.seq]
        values = [getattr(item, n) for n in ("seq", "frame", "command", "current", "autocontinue")]
        values += [getattr(item, f"param{n}") for n in range(1, 5)] + [item.x, item.y, item.z]
        self._say(mavlink.MAVLink_mission_item_int_message, *values)

    def _on_mission_count(self, message: object) -> None:
        self._incoming, self._wanted = [], message.count
        self._ask()

    def _ask(self) -> None:
        ints = self._ask_with == "MISSION_REQUEST_INT"
        make = (
            mavlink.MAVLink_mission_request_int_message if ints else mavlink.MAVLink_mission_request_message
        )
        self._say(make, len(self._incoming))

    def _on_mission_item_int(self, message: object) -> None:
        if message.seq != len(self._incoming):
            return
        self._incoming.append(message)
        if len(self._incoming) < self._wanted:
            self._ask()
            return
        self.items = self._incoming
        self._say(mavlink.MAVLink_mission_ack_message, mavlink.MAV_MISSION_ACCEPTED)
        if self._next < len(self._uploads):
            upload = self._uploads[self._next]
            flagged = next((m.seq for m in self.items if m.current), 0)
            self._shift, self._more = flagged - upload.flagged, len(self.items) - upload.count
            self._from = upload.flagged
            self.time, self._next = max(self.time, upload.acknowledged), self._next + 1
            while self._at < len(self._stream) and self._stream[self._at][0] < upload.acknowledged:
                self._at += 1


def _moved(message: object) -> bool:
    return message.get_type() in ("MISSION_CURRENT", "MISSION_ITEM_REACHED")


def _uploads(every: list) -> list[Upload]:
    """Each mission that the recorded ground station has put aboard."""
    found: list[Upload] = []
    for time, _, message in every:
        kind, ours = message.get_type(), message.get_srcSystem() == STATION
        if kind == "MISSION_COUNT" and ours:
            found.append(Upload(message.count, 0, float("inf")))
        elif kind == "MISSION_ITEM_INT" and ours and message.seq == len(found[-1].items):
            found[-1].items.append(message)
            found[-1].sent.append(message)
            if message.current:
                found[-1].flagged = message.seq
        elif kind == "MISSION_ITEM_INT" and not ours and found and message.seq < len(found[-1].items):
            found[-1].items[message.seq] = message  # read back: as it has it
        elif kind == "MISSION_ACK" and not ours and message.type == mavlink.MAV_MISSION_ACCEPTED:
            found[-1].acknowledged = min(found[-1].acknowledged, time)
    return [upload for upload in found if upload.acknowledged < float("inf")]
