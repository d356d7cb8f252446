"""Mission items and plans with MAVSDK's names, units and defaults."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

NAN = math.nan


class CameraAction(IntEnum):
    """What the camera does at an item (MAVSDK's numbers)."""

    NONE = 0
    TAKE_PHOTO = 1
    START_PHOTO_INTERVAL = 2
    STOP_PHOTO_INTERVAL = 3
    START_VIDEO = 4
    STOP_VIDEO = 5
    START_PHOTO_DISTANCE = 6
    STOP_PHOTO_DISTANCE = 7


class VehicleAction(IntEnum):
    """What the vehicle does at an item (MAVSDK's numbers)."""

    NONE = 0
    TAKEOFF = 1
    LAND = 2
    TRANSITION_TO_FW = 3
    TRANSITION_TO_MC = 4


_REQUIRED = (
    ("latitude_deg", -90.0, 90.0),
    ("longitude_deg", -180.0, 180.0),
    ("relative_altitude_m", -1e4, 1e5),
)
"""Fields that every item must give, with their least and greatest value."""
_POSITIVE = ("speed_m_s", "acceptance_radius_m")
"""Fields that must be above zero where they are given."""


@dataclass(frozen=True, slots=True)
class MissionItem:
    """One item of a mission, field for field MAVSDK's `MissionItem`; NaN means "not given".

    `speed_m_s` is, as in MAVSDK, the speed from this item on, not the speed towards it.
    """

    latitude_deg: float
    longitude_deg: float
    relative_altitude_m: float
    speed_m_s: float = NAN
    is_fly_through: bool = True
    gimbal_pitch_deg: float = NAN
    gimbal_yaw_deg: float = NAN
    camera_action: CameraAction = CameraAction.NONE
    loiter_time_s: float = NAN
    camera_photo_interval_s: float = NAN
    acceptance_radius_m: float = NAN
    yaw_deg: float = NAN
    camera_photo_distance_m: float = NAN
    vehicle_action: VehicleAction = VehicleAction.NONE

    def problems(self) -> list[str]:
        """What keeps the item from being flown, a phrase each; empty if nothing does."""
        found = [
            f"{name} = {getattr(self, name)}, must be between {low:g} and {high:g}"
            for name, low, high in _REQUIRED
            if not low <= getattr(self, name) <= high  # also refuses NaN
        ]
        for name in _POSITIVE:
            value = getattr(self, name)
            if value <= 0.0 or math.isinf(value):
                found.append(f"{name} = {value}, must be above 0, or NaN for not given")
        if self.loiter_time_s < 0.0 or math.isinf(self.loiter_time_s):
            found.append(f"loiter_time_s = {self.loiter_time_s}, must be 0 or more, or NaN for not given")
        return found


@dataclass(frozen=True, slots=True)
class MissionPlan:
    """The items of a mission in the order in which they are flown."""

    mission_items: tuple[MissionItem, ...]

    @classmethod
    def of(cls, items: Sequence[MissionItem]) -> MissionPlan:
        """A plan of these items."""
        return cls(tuple(items))

    def check(self) -> None:
        """Make sure that the plan can be flown.

        Raises
        ------
        ValueError
            If it has no item, or a value is missing or out of range; names every item, field and value.
        """
        if not self.mission_items:
            raise ValueError("mission_items is empty: a mission needs at least one item")
        problems = [
            f"item {index}: {problem}"
            for index, item in enumerate(self.mission_items)
            for problem in item.problems()
        ]
        if problems:
            raise ValueError("; ".join(problems))


@dataclass(frozen=True, slots=True)
class MissionProgress:
    """Item being flown to, and how many there are; `current == total` once the mission is finished."""

    current: int
    total: int
