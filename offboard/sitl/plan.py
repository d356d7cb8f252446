"""A mission as it is flown: the legs of a list of wire items."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from functools import lru_cache

from avoidance import Waypoint
from offboard.frames import MapFrame
from offboard.sequencer import Target
from offboard.sitl.dialect import mavlink
from offboard.sitl.items import PLACES, WireItem


class Kind(Enum):
    """How a leg ends."""

    POINT = "point"
    """Near its end or past it, after the time to be spent there."""
    CIRCLE = "circle"
    """Never: it is circled about."""
    TAKEOFF = "take-off"
    """At its altitude."""
    LAND = "land"
    """On the ground."""


@dataclass(frozen=True, slots=True)
class Leg:
    """One item that is flown."""

    seq: int
    """Its index in the list."""
    kind: Kind
    target: Target
    """Where to, how fast, how long to stay."""
    radius: float
    """Of the circle about it, where there is one [m]."""
    direction: int = 1
    """+1 clockwise seen from above, -1 anticlockwise."""


@dataclass(frozen=True, slots=True)
class Defaults:
    """What holds where an item does not say."""

    airspeed: float
    """[m/s]"""
    acceptance_radius: float
    """[m]"""
    orbit_radius: float
    """[m]"""
    limit_radius: Callable[[float], float]
    """From the radius of a circle as given to the one flown [m]."""


@dataclass(frozen=True, slots=True)
class Plan:
    """The legs of a mission, in the order of the list."""

    legs: tuple[Leg, ...] = ()
    jumps: Mapping[int, tuple[int, int]] = field(default_factory=dict)
    """Index of a leg after which a jump follows: to which seq, and how often (-1 for ever)."""
    targets: tuple[Target, ...] = field(init=False)
    """The legs as sequencing sees them."""

    def __post_init__(self) -> None:
        """Take the targets out of the legs."""
        object.__setattr__(self, "targets", tuple(leg.target for leg in self.legs))

    @classmethod
    def of(cls, items: Sequence[WireItem], first: int, frame: MapFrame, defaults: Defaults) -> Plan:
        """The legs of items from index `first` on; places are put on the map of `frame`."""
        legs: list[Leg] = []
        jumps: dict[int, tuple[int, int]] = {}
        airspeed = defaults.airspeed
        for seq, item in enumerate(items):
            if seq < first:
                continue
            if item.command == mavlink.MAV_CMD_DO_CHANGE_SPEED and item.param2 > 0.0:
                airspeed = item.param2
            elif item.command == mavlink.MAV_CMD_DO_JUMP and legs:
                jumps.setdefault(len(legs) - 1, (_whole(item.param1), _whole(item.param2)))
            elif item.command in PLACES or item.command == mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH:
                legs.append(_leg(seq, item, legs, frame, airspeed, defaults))
        return cls(tuple(legs), jumps)

    def index_of(self, seq: int) -> int:
        """The first leg that item `seq` or one behind it stands for; the number of legs if none does."""
        return next((index for index, leg in enumerate(self.legs) if leg.seq >= seq), len(self.legs))

    def with_leg(self, leg: Leg) -> Plan:
        """The plan with one leg put in place of whatever item `leg.seq` stands for now."""
        before = [each for each in self.legs if each.seq < leg.seq]
        after = [each for each in self.legs if each.seq > leg.seq]
        shift = len(before) + 1 + len(after) - len(self.legs)
        jumps = {at if at < len(before) else at + shift: jump for at, jump in self.jumps.items()}
        return Plan((*before, leg, *after), jumps)


def _leg(
    seq: int, item: WireItem, before: Sequence[Leg], frame: MapFrame, airspeed: float, defaults: Defaults
) -> Leg:
    """The leg of one item; one without a place is flown where the leg before it ends."""
    kind = _KINDS.get(item.command, Kind.POINT)
    altitude = item.above_home(frame.altitude_m)
    if item.command == mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH:
        place = Waypoint(0.0, 0.0, before[-1].target.waypoint.altitude if before else 100.0)
    elif item.has_place:
        place = Waypoint(*_on_map(frame, item.latitude_deg, item.longitude_deg), altitude)
    else:
        end = before[-1].target.waypoint if before else Waypoint(0.0, 0.0, altitude)
        place = Waypoint(end.north, end.east, altitude)
    given = item.param2 if item.command == mavlink.MAV_CMD_NAV_LOITER_TO_ALT else item.param3
    wanted = given if abs(given) > 0.0 and item.command in _CIRCLED else defaults.orbit_radius
    radius = defaults.limit_radius(wanted)
    acceptance = defaults.acceptance_radius
    if item.command == mavlink.MAV_CMD_NAV_WAYPOINT and item.param2 > 0.0:
        acceptance = item.param2
    stay = _stay(item, radius, airspeed)
    if stay > 0.0:
        acceptance = max(acceptance, 1.2 * radius)  # the circle is joined from outside
    target = Target(place, acceptance, airspeed, math.inf if kind is not Kind.POINT else stay)
    return Leg(seq, kind, target, radius, -1 if wanted < 0.0 else 1)


@lru_cache(maxsize=8192)
def _on_map(frame: MapFrame, latitude_deg: float, longitude_deg: float) -> tuple[float, float]:
    """A place on the map; remembered, for a plan is made anew with each item that is written over."""
    return frame.to_map(latitude_deg, longitude_deg)


def _stay(item: WireItem, radius: float, airspeed: float) -> float:
    """How long an item has the aircraft circle [s]."""
    match item.command:
        case mavlink.MAV_CMD_NAV_LOITER_UNLIM | mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH:
            return math.inf
        case mavlink.MAV_CMD_NAV_LOITER_TIME:
            return max(_number(item.param1), 0.0)
        case mavlink.MAV_CMD_NAV_LOITER_TURNS:
            return max(_number(item.param1), 0.0) * math.tau * radius / airspeed
        case mavlink.MAV_CMD_NAV_WAYPOINT:
            return max(_number(item.param1), 0.0)
    return 0.0


_KINDS = {
    mavlink.MAV_CMD_NAV_LOITER_UNLIM: Kind.CIRCLE,
    mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH: Kind.CIRCLE,
    mavlink.MAV_CMD_NAV_TAKEOFF: Kind.TAKEOFF,
    mavlink.MAV_CMD_NAV_LAND: Kind.LAND,
}
_CIRCLED = {
    mavlink.MAV_CMD_NAV_LOITER_UNLIM,
    mavlink.MAV_CMD_NAV_LOITER_TURNS,
    mavlink.MAV_CMD_NAV_LOITER_TIME,
    mavlink.MAV_CMD_NAV_LOITER_TO_ALT,
}


def _number(value: float) -> float:
    """0 for what is not given."""
    return 0.0 if math.isnan(value) else value


def _whole(value: float) -> int:
    """A parameter that counts."""
    return int(_number(value))
