"""What a vehicle has told of itself, put together from its messages. Pure: messages in, facts out."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import ClassVar

from offboard.live.facts import Attitude, Fix, MissionShown, TargetShown
from offboard.live.messages import Message

AUTOPILOT = 1
"""MAV_COMP_ID of the autopilot."""
ARMED = 128
"""Bit of HEARTBEAT.base_mode."""
OUT_OF_ORDER = 10.0
"""A message up to this much older than the newest is late; an older one means a restart [s]."""
RESTART_PROOF = 3
"""So many messages in a row that are older than that are believed."""
DEGREE = 1e7
METRES = 111_000.0
"""In a degree of latitude, roughly."""
FARTHEST = 5e6
"""A target further away than this is none [m]."""
NO_MISSION = 65535
"""MISSION_CURRENT.total of PX4 without a mission."""
FASTEST = 500.0
"""No vehicle flies faster than this [m/s] ..."""
JUMP = 1000.0
"""... nor is it found further than this from where it would be then [m]: not a position, but a fault."""
STALE = 30.0
"""Positions are kept this long for those who ask about the past [s]."""


@dataclass(slots=True)
class Telemetry:
    """The latest of everything. `feed` takes messages in the order in which they arrive."""

    autopilot: int = -1
    """MAV_AUTOPILOT; -1 before the first heartbeat."""
    custom_mode: int = -1
    """HEARTBEAT.custom_mode."""
    armed: bool = False
    mission: MissionShown | None = None
    target: TargetShown | None = None
    reached: int = -1
    """Item of the last MISSION_ITEM_REACHED; they repeat."""
    on_ground: bool | None = None
    """EXTENDED_SYS_STATE; None if it is not sent."""
    attitude: Attitude | None = None
    """The newest."""
    attitudes: deque[Attitude] = field(default_factory=lambda: deque(maxlen=30))
    """The last few, in their order."""
    airspeed: float = math.nan
    """[m/s]."""
    battery: float = math.nan
    """State of charge, 0 to 1."""
    home: tuple[float, float, float] | None = None
    """Latitude, longitude [deg], altitude above mean sea level [m]."""
    texts: list[tuple[int, str]] = field(default_factory=list)
    """Severity and text of each STATUSTEXT since this was last emptied."""
    restarts: int = 0
    """How often the vehicle's clock has begun anew."""
    heard: float = -math.inf
    """Wall clock of the last message [s]."""
    heartbeat: float = -math.inf
    """Wall clock of the last heartbeat [s]."""
    placed: float = -math.inf
    """Wall clock of the last position that was taken [s]."""
    late: int = 0
    """Messages that came out of order and were left out."""
    fixes: deque[Fix] = field(default_factory=deque)
    """Positions of the last while, in their order."""
    _older: int = 0

    @property
    def fix(self) -> Fix | None:
        """The newest position."""
        return self.fixes[-1] if self.fixes else None

    def feed(self, message: Message) -> None:
        """Take over one message; what is out of range is left out."""
        self.heard = max(self.heard, message.arrived)
        if message.component != AUTOPILOT:
            return
        take = self._TAKE.get(message.name)
        if take is not None:
            take(self, message)

    def at(self, time: float) -> Fix | None:
        """The position at a time of the vehicle's clock [s], between the two nearest.

        After the newest it is the newest; before the oldest it is None.
        """
        if not self.fixes or time < self.fixes[0].time:
            return None
        after = self.fixes[-1]
        for before in reversed(self.fixes):
            if before.time <= time <= after.time:
                return after if before is after else _between(before, after, time)
            after = before
        return self.fixes[-1]

    def _heartbeat(self, message: Message) -> None:
        self.autopilot = message.whole("autopilot", -1)
        self.custom_mode = message.whole("custom_mode", -1)
        self.armed = bool(message.whole("base_mode") & ARMED)
        self.heartbeat = message.arrived

    def _attitude(self, message: Message) -> None:
        values = [message.number(key) for key in ("roll", "pitch", "yaw")]
        time = message.number("time_boot_ms") / 1e3
        if not all(map(math.isfinite, (time, *values))):
            return
        self.attitude = Attitude(time, *values)
        if self.attitudes and not 0.0 <= time - self.attitudes[-1].time < OUT_OF_ORDER:
            self.attitudes.clear()
        self.attitudes.append(self.attitude)

    def _airspeed(self, message: Message) -> None:
        if 0.0 <= (airspeed := message.number("airspeed")) < 1e3:
            self.airspeed = airspeed

    def _reached(self, message: Message) -> None:
        self.reached = message.whole("seq", -1)

    def _target(self, message: Message) -> None:
        place = message.number("lat_int") / DEGREE, message.number("lon_int") / DEGREE
        if _on_earth(*place) and (self.fix is None or _apart(self.fix, *place) < FARTHEST):
            self.target = TargetShown(*place, message.arrived)

    def _landed(self, message: Message) -> None:
        landed = message.whole("landed_state")
        self.on_ground = None if landed == 0 else landed == 1

    def _text(self, message: Message) -> None:
        self.texts.append((message.whole("severity", 6), str(message.fields.get("text", "")).strip()))

    def _home(self, message: Message) -> None:
        place = message.number("latitude") / DEGREE, message.number("longitude") / DEGREE
        if _on_earth(*place) and math.isfinite(altitude := message.number("altitude")):
            self.home = (*place, altitude / 1e3)

    def _battery(self, message: Message) -> None:
        if 0 <= (left := message.whole("battery_remaining", -1)) <= 100:
            self.battery = left / 100.0

    def attitude_at(self, time: float) -> Attitude | None:
        """The attitude at a time of the vehicle's clock [s], between the two nearest; None if unknown."""
        for before, after in pairwise(self.attitudes):
            if before.time <= time <= after.time and after.time > before.time:
                part = (time - before.time) / (after.time - before.time)
                turn = math.remainder(after.yaw - before.yaw, 2.0 * math.pi)
                return Attitude(
                    time,
                    before.roll + part * (after.roll - before.roll),
                    before.pitch + part * (after.pitch - before.pitch),
                    before.yaw + part * turn,
                )
        return self.attitude

    def _mission(self, message: Message) -> None:
        total = message.whole("total")
        self.mission = MissionShown(
            message.whole("seq"),
            0 if total == NO_MISSION else total,
            message.whole("mission_state"),
            message.whole("mission_id"),
            message.arrived,
        )

    def _position(self, message: Message) -> None:
        latitude_deg, longitude_deg = message.number("lat") / DEGREE, message.number("lon") / DEGREE
        time = message.number("time_boot_ms") / 1e3
        values = [message.number(key) for key in ("relative_alt", "alt", "vx", "vy", "vz")]
        if not (_on_earth(latitude_deg, longitude_deg) and all(map(math.isfinite, (time, *values)))):
            return
        newest = self.fix
        if newest is not None and time <= newest.time:
            if time > newest.time - OUT_OF_ORDER:
                self.late += 1
                return
            self._older += 1
            if self._older < RESTART_PROOF:
                return
            self.restarts += 1
            self.fixes.clear()
        elif newest is not None and _apart(newest, latitude_deg, longitude_deg) > JUMP + FASTEST * (
            time - newest.time
        ):
            return
        self._older = 0
        self.placed = message.arrived
        heading = message.number("hdg") / 100.0
        self.fixes.append(
            Fix(
                time,
                latitude_deg,
                longitude_deg,
                values[0] / 1e3,
                values[1] / 1e3,
                values[2] / 100.0,
                values[3] / 100.0,
                -values[4] / 100.0,
                math.radians(heading) if 0.0 <= heading < 360.0 else math.nan,
            )
        )
        while self.fixes[0].time < time - STALE:
            self.fixes.popleft()

    _TAKE: ClassVar[dict[str, Callable[[Telemetry, Message], None]]] = {
        "HEARTBEAT": _heartbeat,
        "GLOBAL_POSITION_INT": _position,
        "ATTITUDE": _attitude,
        "VFR_HUD": _airspeed,
        "MISSION_CURRENT": _mission,
        "MISSION_ITEM_REACHED": _reached,
        "POSITION_TARGET_GLOBAL_INT": _target,
        "EXTENDED_SYS_STATE": _landed,
        "STATUSTEXT": _text,
        "HOME_POSITION": _home,
        "BATTERY_STATUS": _battery,
    }


def _between(a: Fix, b: Fix, time: float) -> Fix:
    """A position between two, by their share of the time."""
    part = (time - a.time) / (b.time - a.time)
    keep = 1.0 - part
    return Fix(
        time,
        keep * a.latitude_deg + part * b.latitude_deg,
        keep * a.longitude_deg + part * _near(b.longitude_deg, a.longitude_deg),
        keep * a.altitude + part * b.altitude,
        keep * a.amsl + part * b.amsl,
        keep * a.velocity_north + part * b.velocity_north,
        keep * a.velocity_east + part * b.velocity_east,
        keep * a.climb_rate + part * b.climb_rate,
        b.heading,
    )


def _apart(fix: Fix, latitude_deg: float, longitude_deg: float) -> float:
    """Roughly how far a place is from a position [m]."""
    aside_deg = math.remainder(longitude_deg - fix.longitude_deg, 360.0)
    return METRES * math.hypot(
        latitude_deg - fix.latitude_deg, aside_deg * math.cos(math.radians(latitude_deg))
    )


def _near(longitude_deg: float, other: float) -> float:
    """A longitude less than half a turn from another [deg]."""
    return other + (longitude_deg - other + 180.0) % 360.0 - 180.0


def _on_earth(latitude_deg: float, longitude_deg: float) -> bool:
    """True for a place that can be, (0, 0) left out: autopilots send it before they know."""
    return (
        abs(latitude_deg) <= 90.0 and abs(longitude_deg) <= 180.0 and (latitude_deg, longitude_deg) != (0, 0)
    )
