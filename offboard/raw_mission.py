"""A mission as MAVLink carries it: waypoints, and what is to be done at them, in one list.

The avoidance core and `MissionList` know waypoints only. `RawMission` keeps everything else (speeds,
cameras, jumps, whatever it is) beside them, untouched, and puts an edited `MissionList` back among it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from avoidance import Waypoint
from offboard.errors import LinkError
from offboard.frames import MapFrame
from offboard.mission import MissionItem, MissionPlan, VehicleAction
from offboard.mission_list import Entry, MissionList
from offboard.orbit import Orbit

WAYPOINT, LOITER_UNLIMITED, LOITER_TURNS, LOITER_TIME, LAND, TAKE_OFF = 16, 17, 18, 19, 21, 22
"""MAV_CMD numbers."""
LOITER_TO_ALTITUDE, SPLINE, VTOL_TAKE_OFF, VTOL_LAND = 31, 82, 84, 85
"""MAV_CMD numbers."""
CHANGE_SPEED, JUMP = 178, 177
"""MAV_CMD numbers."""
FLOWN_TO = frozenset(
    {
        *(WAYPOINT, LOITER_UNLIMITED, LOITER_TURNS, LOITER_TIME, LAND, TAKE_OFF),
        *(LOITER_TO_ALTITUDE, SPLINE, VTOL_TAKE_OFF, VTOL_LAND),
    }
)
"""Commands that a vehicle flies to."""
RETURN = 20
"""MAV_CMD number."""
ENDS = frozenset({LOITER_UNLIMITED, LAND, VTOL_LAND, RETURN})
"""Commands after which nothing comes."""
TAKE_OFFS = frozenset({TAKE_OFF, VTOL_TAKE_OFF})
LANDINGS = frozenset({LAND, VTOL_LAND})
ABSOLUTE, MISSION, RELATIVE = frozenset({0, 5}), 2, frozenset({3, 6})
"""MAV_FRAME numbers: altitude above mean sea level, no position, altitude above home."""
RELATIVE_INT = 6
"""MAV_FRAME of what we write."""
DEGREE = 1e7
"""Units of MISSION_ITEM_INT in a degree."""

_ACTIONS = {
    TAKE_OFF: VehicleAction.TAKEOFF,
    VTOL_TAKE_OFF: VehicleAction.TAKEOFF,
    LAND: VehicleAction.LAND,
    VTOL_LAND: VehicleAction.LAND,
}


@dataclass(frozen=True, slots=True)
class RawItem:
    """A mission item exactly as MAVLink has it (MISSION_ITEM_INT)."""

    command: int
    """MAV_CMD."""
    frame: int
    """MAV_FRAME."""
    params: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    """param1 to param4."""
    x: int = 0
    """Latitude [1e-7 deg] where the frame has one."""
    y: int = 0
    """Longitude [1e-7 deg] where the frame has one."""
    z: float = 0.0
    """Altitude [m] in the frame."""
    autocontinue: int = 1
    """1 goes on with the next item by itself."""

    def same(self, other: RawItem) -> bool:
        """True if both mean the same: autopilots change what does not matter on the way."""
        if self.command != other.command:
            return False
        return self.same_place(other) if self.command in FLOWN_TO else self._same_values(other)

    def _same_values(self, other: RawItem) -> bool:
        """True if the parameters are alike, to what a float keeps of them; NaN and 0 leave one open."""
        pairs = zip(self.params, other.params, strict=True)
        return all(math.isclose(_given(a), _given(b), rel_tol=1e-3, abs_tol=1e-2) for a, b in pairs)

    def same_place(self, other: RawItem) -> bool:
        """True if both are at one place, to what the wire keeps of it."""
        return abs(self.x - other.x) <= 2 and abs(self.y - other.y) <= 2 and abs(self.z - other.z) <= 0.5


@dataclass(frozen=True, slots=True)
class RawMission:
    """A mission as uploaded or downloaded, ArduPilot's home item left out."""

    items: tuple[RawItem, ...]
    """All of it."""
    flown_to: tuple[int, ...]
    """Indices of the items that are flown to; entry i of its `plan()` is item `flown_to[i]`."""

    @classmethod
    def of(cls, items: Sequence[RawItem]) -> RawMission:
        """A mission of these items.

        Raises
        ------
        LinkError
            If none of them is flown to.
        """
        found = tuple(
            index
            for index, item in enumerate(items)
            if item.command in FLOWN_TO and (item.x or item.y or item.command not in TAKE_OFFS | LANDINGS)
        )
        if not found:
            raise LinkError("the mission has no item to fly to")
        if len(found) > 1 and _waits_there(items[found[-2]], items[found[-1]]):
            found = found[:-1]
        return cls(tuple(items), found)

    @classmethod
    def of_plan(cls, plan: MissionPlan) -> RawMission:
        """The mission of a plan with MAVSDK's items; a speed becomes an item of its own."""
        items: list[RawItem] = []
        for item in plan.mission_items:
            items.append(_raw(item))
            if not math.isnan(item.speed_m_s):
                items.append(RawItem(CHANGE_SPEED, MISSION, (0.0, item.speed_m_s, -1.0, 0.0)))
        return cls.of(items)

    @property
    def takes_off(self) -> bool:
        """True if it begins with a take-off."""
        return any(item.command in TAKE_OFFS for item in self.items)

    @property
    def lands(self) -> bool:
        """True if it has a landing."""
        return any(item.command in LANDINGS for item in self.items)

    def plan(self, home_altitude: float) -> MissionPlan:
        """Its waypoints as MAVSDK's items; altitudes [m] above a home at `home_altitude` [m].

        Raises
        ------
        LinkError
            If the altitude of one is neither above the sea nor above home: heights of the ground are not
            known here, and a detour at the wrong height is none.
        """
        for index in self.flown_to:
            if self.items[index].frame not in ABSOLUTE | RELATIVE:
                words = "must be above mean sea level (0, 5) or above home (3, 6)"
                raise LinkError(f"item {index}: altitude in MAV_FRAME {self.items[index].frame}; it {words}")
        return MissionPlan.of(
            [
                replace(_item(self.items[index], home_altitude), speed_m_s=self._speed_after(number))
                for number, index in enumerate(self.flown_to)
            ]
        )

    def first_speed(self) -> float | None:
        """Speed that is set before the first waypoint [m/s]; None if there is none."""
        speeds = [i.params[1] for i in self.items[: self.flown_to[0]] if i.command == CHANGE_SPEED]
        return speeds[-1] if speeds and speeds[-1] > 0.0 else None

    def entry_of(self, index: int) -> int:
        """Number of the waypoint that is flown to while item `index` is current."""
        return next((n for n, at in enumerate(self.flown_to) if at >= index), len(self.flown_to))

    def attached(self, number: int) -> range:
        """Indices of the items to be done after waypoint `number`, before the next (-1: before the first)."""
        begin = 0 if number < 0 else self.flown_to[number] + 1
        end = self.flown_to[number + 1] if number + 1 < len(self.flown_to) else len(self.items)
        return range(begin, end)

    def _speed_after(self, number: int) -> float:
        changes = [self.items[i] for i in self.attached(number) if self.items[i].command == CHANGE_SPEED]
        speeds = [change.params[1] for change in changes if change.params[1] > 0.0]
        return speeds[-1] if speeds else math.nan


@dataclass(frozen=True, slots=True)
class Composed:
    """A mission ready to be sent, and where things are in it."""

    items: tuple[RawItem, ...]
    """All of it, without ArduPilot's home item."""
    entries: tuple[int | None, ...]
    """For each item the entry of the `MissionList` it is; None for what is no waypoint of the list."""
    current: int
    """Index of the item to fly to now."""

    def item_of(self, entry: int) -> RawItem | None:
        """The last item of an entry; None if it has none."""
        found = [item for item, of in zip(self.items, self.entries, strict=True) if of == entry]
        return found[-1] if found else None

    def entry_of(self, index: int) -> int:
        """Entry that is flown to while item `index` is current; one past the last after the last."""
        for entry in self.entries[max(index, 0) :]:
            if entry is not None:
                return entry
        return 1 + max((entry for entry in self.entries if entry is not None), default=-1)


def compose(
    raw: RawMission,
    mission: MissionList,
    current: int,
    frame: MapFrame,
    *,
    anchor: Waypoint | None = None,
    hold: Orbit | None = None,
) -> Composed:
    """Put an edited list of waypoints back among everything else of a mission.

    Parameters
    ----------
    raw : RawMission
        As uploaded; `Waypoint.item` of the list counts its waypoints.
    mission : MissionList
        As it is to be now.
    current : int
        Entry to fly to now. Injected entries before it have been passed and are left out.
    frame : MapFrame
        The map.
    anchor : Waypoint, optional
        Put before the current entry: an autopilot may fly the line from the item before the current one.
    hold : Orbit, optional
        Circled first, for as long as nothing else is said.

    Returns
    -------
    Composed
        Items in the order in which they are flown. What belongs to a waypoint that was skipped is done
        where it would have been. Jumps lead where they led.
    """
    build = _Builder(raw)
    build.attached(-1)
    at: int | None = None
    for position, entry in enumerate(mission.entries):
        number = entry.waypoint.item
        uploaded = number is not None and number < len(raw.flown_to)
        if position < current and not uploaded:
            continue
        if number is not None and uploaded:
            build.skipped(number)
        if position == current:
            if anchor is not None:
                build.add(_raw_at(anchor, frame))
            at = len(build.items)
            if hold is not None:
                build.add(_orbit(hold, frame), position)
        if number is not None and uploaded:
            build.moved_to[raw.flown_to[number]] = len(build.items)
        build.add(_entry(raw, entry, frame), position)
        if number is not None and uploaded:
            build.attached(number)
    build.skipped(len(raw.flown_to))
    build.end()
    items = tuple(_jump(item, build.moved_to) for item in build.items)
    return Composed(items, tuple(build.entries), len(items) - 1 if at is None else at)


class _Builder:
    """The list that `compose` makes."""

    def __init__(self, raw: RawMission) -> None:
        self._raw = raw
        self._next = 0
        self.items: list[RawItem] = []
        self.entries: list[int | None] = []
        self.moved_to: dict[int, int] = {}

    def add(self, item: RawItem, entry: int | None = None) -> None:
        """One item."""
        self.items.append(item)
        self.entries.append(entry)

    def attached(self, number: int) -> None:
        """What is to be done at a waypoint (-1: before the first)."""
        self._next = max(self._next, number + 1)
        for index in self._raw.attached(number):
            self.moved_to[index] = len(self.items)
            self.add(self._raw.items[index])

    def skipped(self, number: int) -> None:
        """What is to be done at the waypoints before this one that are no longer there."""
        while self._next < number:
            self.attached(self._next)

    def end(self) -> None:
        """A vehicle that has come to the last waypoint circles there: it goes on taking missions."""
        last = next((item for item in reversed(self.items) if item.command in FLOWN_TO | ENDS), None)
        if last is not None and last.command not in ENDS:
            self.add(replace(last, command=LOITER_UNLIMITED, params=(0.0, 0.0, 0.0, math.nan)))


def _given(value: float) -> float:
    return 0.0 if math.isnan(value) else value


def _waits_there(last: RawItem, after: RawItem) -> bool:
    """True if an item only makes the vehicle circle at the waypoint before it: no waypoint of its own."""
    return after.command == LOITER_UNLIMITED and abs(after.x - last.x) <= 2 and abs(after.y - last.y) <= 2


def _jump(item: RawItem, moved_to: dict[int, int]) -> RawItem:
    """A jump to where its target is now."""
    if item.command != JUMP:
        return item
    target = moved_to.get(int(item.params[0]), int(item.params[0]))
    return replace(item, params=(float(target), *item.params[1:]))


def _entry(raw: RawMission, entry: Entry, frame: MapFrame) -> RawItem:
    """The item of one entry: as uploaded, moved, or new."""
    number = entry.waypoint.item
    if number is not None and number >= len(raw.flown_to):
        return _raw(entry.item)  # an operator put it in
    if number is None:
        radius = entry.item.acceptance_radius_m
        return _raw_at(entry.waypoint, frame, 0.0 if math.isnan(radius) else radius)
    item = raw.items[raw.flown_to[number]]
    if not entry.waypoint.moved:
        return item
    there = _raw_at(entry.waypoint, frame)
    return replace(item, frame=there.frame, x=there.x, y=there.y, z=there.z)


def _raw_at(waypoint: Waypoint, frame: MapFrame, radius: float = 0.0) -> RawItem:
    """A plain waypoint."""
    latitude_deg, longitude_deg = frame.to_geodetic(waypoint.north, waypoint.east)
    return RawItem(
        WAYPOINT,
        RELATIVE_INT,
        (0.0, radius, 0.0, math.nan),
        round(latitude_deg * DEGREE),
        round(longitude_deg * DEGREE),
        waypoint.altitude,
    )


def _orbit(orbit: Orbit, frame: MapFrame) -> RawItem:
    """A circle without end; a negative radius turns to the left."""
    item = _raw_at(Waypoint(orbit.north, orbit.east, orbit.altitude), frame)
    return replace(
        item, command=LOITER_UNLIMITED, params=(0.0, 0.0, orbit.radius * orbit.direction, math.nan)
    )


def _raw(item: MissionItem) -> RawItem:
    """MAVSDK's item as MAVLink's."""
    yaw = item.yaw_deg
    radius = 0.0 if math.isnan(item.acceptance_radius_m) else item.acceptance_radius_m
    command, params = WAYPOINT, (0.0, radius, 0.0, yaw)
    if item.vehicle_action is VehicleAction.TAKEOFF:
        command, params = TAKE_OFF, (0.0, 0.0, 0.0, yaw)
    elif item.vehicle_action is VehicleAction.LAND:
        command, params = LAND, (0.0, 0.0, 0.0, yaw)
    elif item.loiter_time_s > 0.0:
        command, params = LOITER_TIME, (item.loiter_time_s, 0.0, 0.0, 0.0)
    return RawItem(
        command,
        RELATIVE_INT,
        params,
        round(item.latitude_deg * DEGREE),
        round(item.longitude_deg * DEGREE),
        item.relative_altitude_m,
    )


def _item(raw: RawItem, home_altitude: float) -> MissionItem:
    """MAVLink's item as MAVSDK's, as far as that goes."""
    return MissionItem(
        latitude_deg=raw.x / DEGREE,
        longitude_deg=raw.y / DEGREE,
        relative_altitude_m=raw.z - home_altitude if raw.frame in ABSOLUTE else raw.z,
        loiter_time_s=raw.params[0] if raw.command == LOITER_TIME and raw.params[0] > 0.0 else math.nan,
        acceptance_radius_m=raw.params[1] if raw.command == WAYPOINT and raw.params[1] > 0.0 else math.nan,
        vehicle_action=_ACTIONS.get(raw.command, VehicleAction.NONE),
    )
