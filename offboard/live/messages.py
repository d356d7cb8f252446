"""What comes from a vehicle: messages, and the outcomes of what it was asked to do."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Protocol

from offboard.raw_mission import RawItem


@dataclass(frozen=True, slots=True)
class Message:
    """One MAVLink message, decoded."""

    name: str
    """Its name, such as HEARTBEAT."""
    fields: Mapping[str, object]
    """Its fields in MAVLink's units; NaN is None."""
    component: int = 1
    """Component that sent it; 1 is the autopilot."""
    arrived: float = 0.0
    """Wall clock on arrival [s]."""

    def number(self, field: str) -> float:
        """A field as a number; NaN if it is missing or none."""
        value = self.fields.get(field)
        if isinstance(value, bool) or not isinstance(value, int | float):
            return math.nan
        return float(value)

    def whole(self, field: str, otherwise: int = 0) -> int:
        """A field as a whole number; `otherwise` if it is missing or none."""
        value = self.fields.get(field)
        return value if isinstance(value, int) and not isinstance(value, bool) else otherwise


class Ask(Enum):
    """What a vehicle can be asked to do."""

    UPLOAD = "upload the mission"
    SELECT = "set the current item"
    DOWNLOAD = "download the mission"
    MISSION_MODE = "fly the mission"
    HOLD = "hold"
    GOTO = "go to a place"
    ARM = "arm"
    TAKE_OFF = "take off"
    SPEED = "change speed"
    PUT_FENCE = "take a geofence"
    PUT_RALLY = "take rally points"
    GET_FENCE = "give its geofence"
    GET_RALLY = "give its rally points"


@dataclass(frozen=True, slots=True)
class Reply:
    """What became of a request."""

    ask: Ask
    """What was asked."""
    token: int
    """Number of the request."""
    ok: bool
    """True if the vehicle agreed."""
    why: str = ""
    """MAVSDK's word for what went wrong."""
    items: tuple[RawItem, ...] = ()
    """The mission, geofence or rally points, if that was asked for."""
    arrived: float = 0.0
    """Wall clock on arrival [s]."""


class Session(Protocol):
    """A connection to one vehicle; no call waits for the vehicle unless it says so."""

    def poll(self, timeout: float = 0.0) -> list[Message | Reply]:
        """Everything that has come in; waits up to `timeout` wall seconds for the first."""

    def upload(self, items: tuple[RawItem, ...], current: int) -> int:
        """Replace the mission, item `current` flagged as the one to fly; the request's number."""

    def put(self, what: Ask, items: tuple[RawItem, ...]) -> int:
        """Replace the geofence or the rally points; the request's number."""

    def ask(self, what: Ask, *values: float) -> int:
        """Ask for something; its values are those of MAVSDK's call of that name. The request's number."""

    def request_rate(self, message_id: int, rate: float) -> None:
        """Ask for a message so many times a second; there is no answer."""

    def parameter(self, name: str) -> float | None:
        """A parameter of the vehicle, None if it has none of that name. Waits for the answer."""

    def set_parameter(self, name: str, value: float) -> bool:
        """Set a parameter of the vehicle; False if it does not take it. Waits for the answer."""

    @property
    def dropped(self) -> int | None:
        """Frames not let in for they were not signed with our key, or old; None on a link without a key."""

    def wall(self) -> float:
        """Wall clock [s], the one that `arrived` is of."""

    def close(self) -> None:
        """End the connection."""
