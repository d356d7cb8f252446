"""A mission as a list of items that know what they are: uploaded, moved or injected.

A `MissionList` is a value without I/O: an edit gives a new one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from avoidance import Waypoint
from offboard.frames import MapFrame
from offboard.mission import MissionItem, MissionPlan
from offboard.sequencer import Target

SAME_PLACE = 0.01
"""Positions nearer than this are the same [m]."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One item of a mission together with what it is."""

    item: MissionItem
    """The item itself."""
    waypoint: Waypoint
    """Where it is on the map; `waypoint.item` and `waypoint.moved` say what it stands for."""
    airspeed: float
    """Airspeed on the leg to it [m/s]."""

    @property
    def injected(self) -> bool:
        """True if avoidance put it in."""
        return self.waypoint.item is None


@dataclass(frozen=True, slots=True)
class MissionList:
    """A mission as it is now, and as it was uploaded.

    Examples
    --------
    >>> home = MapFrame(14.39, 76.60)
    >>> plan = MissionPlan.of([MissionItem(14.39, 76.60, 200.0), MissionItem(14.80, 76.60, 200.0)])
    >>> mission = MissionList.of(plan, home, cruise_speed=15.0)
    >>> edited = mission.with_route(1, (Waypoint(20e3, 1e3, 200.0), mission.entries[1].waypoint), home)
    >>> [entry.injected for entry in edited.entries], edited.items()[2] == plan.mission_items[1]
    ([False, True, False], True)
    """

    uploaded: tuple[Entry, ...]
    """The mission as uploaded; `Waypoint.item` is an index into this."""
    entries: tuple[Entry, ...]
    """The mission as it is now, items already passed included."""

    @classmethod
    def of(cls, plan: MissionPlan, frame: MapFrame, cruise_speed: float) -> MissionList:
        """The mission of a plan just uploaded; legs without a speed are flown at `cruise_speed` [m/s]."""
        entries = _entries(plan.mission_items, frame, cruise_speed, first_index=0)
        return cls(entries, entries)

    @property
    def skipped(self) -> tuple[int, ...]:
        """Indices of the uploaded items that the mission no longer has."""
        kept = {entry.waypoint.item for entry in self.entries}
        return tuple(index for index in range(len(self.uploaded)) if index not in kept)

    def ahead(self, current: int) -> tuple[Waypoint, ...]:
        """The waypoints from entry `current` to the end."""
        return tuple(entry.waypoint for entry in self.entries[current:])

    def targets(self, acceptance_radius: float) -> tuple[Target, ...]:
        """The mission as sequencing sees it; the radius [m] is for items that give none."""
        return tuple(
            Target(
                waypoint=entry.waypoint,
                acceptance_radius=_given(entry.item.acceptance_radius_m, acceptance_radius),
                airspeed=entry.airspeed,
                loiter_time=_given(entry.item.loiter_time_s, 0.0),
            )
            for entry in self.entries
        )

    def items(self) -> tuple[MissionItem, ...]:
        """The items as MAVSDK knows them.

        Where an edit has parted an item from the speed change before it, the change is written into the
        item that now precedes it.
        """
        items = []
        for position, entry in enumerate(self.entries):
            item = entry.item
            speed = _given(item.speed_m_s, entry.airspeed)
            following = self.entries[position + 1 : position + 2]
            if following and following[0].airspeed != speed:
                item = replace(item, speed_m_s=following[0].airspeed)
            items.append(item)
        return tuple(items)

    def with_route(self, current: int, route: Sequence[Waypoint], frame: MapFrame) -> MissionList:
        """The mission with everything from entry `current` on replaced by a route.

        Parameters
        ----------
        current : int
            Index of the entry being flown to; those before it stay.
        route : sequence of Waypoint
            The whole remaining route. Uploaded items keep all their fields, moved ones all but their
            place; new waypoints take speed and acceptance radius of the item they precede.
        frame : MapFrame
            The mission's map.

        Raises
        ------
        ValueError
            If the route names an item that was never uploaded, or the same one twice, or has an item at
            another place without saying that it was moved.
        """
        named = [waypoint.item for waypoint in route if waypoint.item is not None]
        if len(set(named)) < len(named):
            raise ValueError(f"route names an item twice: {named}")
        ahead: list[Entry] = []
        following: Entry | None = None
        for waypoint in reversed(route):
            if waypoint.item is None:
                entry = self._injected(waypoint, following, frame)
            else:
                entry = following = self._uploaded(waypoint, frame)
            ahead.append(entry)
        return replace(self, entries=self.entries[:current] + tuple(reversed(ahead)))

    def with_injected(self, current: int, items: Sequence[MissionItem], frame: MapFrame) -> MissionList:
        """The mission with an operator's items put before entry `current`.

        They count as uploaded, behind the others, so that avoidance keeps them. A speed that they give
        holds up to the item they precede.
        """
        speed = (self.entries[current:] or self.entries[-1:] or self.uploaded)[0].airspeed
        new = _entries(items, frame, speed, first_index=len(self.uploaded))
        before, after = self.entries[:current], self.entries[current:]
        last = new[-1].item.speed_m_s
        if after and not math.isnan(last):
            after = (replace(after[0], airspeed=last), *after[1:])
        return MissionList(self.uploaded + new, before + new + after)

    def _uploaded(self, waypoint: Waypoint, frame: MapFrame) -> Entry:
        """The uploaded entry that a waypoint of a route stands for, moved if it says so."""
        index = waypoint.item
        if index is None or not 0 <= index < len(self.uploaded):
            raise ValueError(f"route names item {index}, must be between 0 and {len(self.uploaded) - 1}")
        entry = self.uploaded[index]
        if waypoint.moved:
            return replace(entry, item=_at(entry.item, waypoint, frame), waypoint=waypoint)
        if not same_place(waypoint, entry.waypoint):
            raise ValueError(f"route has item {index} at another place but does not say that it was moved")
        return next((now for now in self.entries if now.waypoint == entry.waypoint), entry)

    def _injected(self, waypoint: Waypoint, following: Entry | None, frame: MapFrame) -> Entry:
        """An entry for a new waypoint, after the manner of the item that it precedes."""
        known = next((entry for entry in self.entries if entry.waypoint == waypoint), None)
        model = following or (self.entries or self.uploaded)[-1]
        if known is not None and known.airspeed == model.airspeed:
            return known
        item = MissionItem(
            latitude_deg=model.item.latitude_deg,
            longitude_deg=model.item.longitude_deg,
            relative_altitude_m=waypoint.altitude,
            acceptance_radius_m=model.item.acceptance_radius_m,
        )
        return Entry(_at(item, waypoint, frame), waypoint, model.airspeed)


def same_place(a: Waypoint, b: Waypoint) -> bool:
    """True if two waypoints are at the same position and altitude."""
    return (
        math.hypot(a.north - b.north, a.east - b.east) <= SAME_PLACE
        and abs(a.altitude - b.altitude) <= SAME_PLACE
    )


def _entries(
    items: Sequence[MissionItem], frame: MapFrame, speed: float, first_index: int
) -> tuple[Entry, ...]:
    """Entries of new items; `speed` [m/s] holds until an item gives another."""
    entries = []
    for index, item in enumerate(items, start=first_index):
        north, east = frame.to_map(item.latitude_deg, item.longitude_deg)
        entries.append(Entry(item, Waypoint(north, east, item.relative_altitude_m, index), speed))
        speed = _given(item.speed_m_s, speed)
    return tuple(entries)


def _at(item: MissionItem, waypoint: Waypoint, frame: MapFrame) -> MissionItem:
    """The item at the place of a waypoint."""
    latitude_deg, longitude_deg = frame.to_geodetic(waypoint.north, waypoint.east)
    return replace(
        item,
        latitude_deg=latitude_deg,
        longitude_deg=longitude_deg,
        relative_altitude_m=waypoint.altitude,
    )


def _given(value: float, otherwise: float) -> float:
    """An item's value, or another if it is not given (NaN)."""
    return otherwise if math.isnan(value) else value
