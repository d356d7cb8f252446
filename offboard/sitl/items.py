"""Mission items as they are on the wire, and what is wrong with them."""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass

from offboard.sitl.dialect import Message, mavlink

DEGREES = 1e-7
"""Unit of a latitude or longitude in an integer item [deg]."""

GLOBAL_FRAMES = {
    mavlink.MAV_FRAME_GLOBAL: mavlink.MAV_FRAME_GLOBAL,
    mavlink.MAV_FRAME_GLOBAL_INT: mavlink.MAV_FRAME_GLOBAL,
    mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT: mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT,
    mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT: mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT,
}
"""Frames of items with a place: above mean sea level, or above home."""
PLACES = {
    mavlink.MAV_CMD_NAV_WAYPOINT,
    mavlink.MAV_CMD_NAV_LOITER_UNLIM,
    mavlink.MAV_CMD_NAV_LOITER_TURNS,
    mavlink.MAV_CMD_NAV_LOITER_TIME,
    mavlink.MAV_CMD_NAV_LOITER_TO_ALT,
    mavlink.MAV_CMD_NAV_LAND,
    mavlink.MAV_CMD_NAV_TAKEOFF,
}
"""Commands that are flown to a place."""
OTHERS = {
    mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH,
    mavlink.MAV_CMD_NAV_DELAY,
    mavlink.MAV_CMD_CONDITION_DELAY,
    mavlink.MAV_CMD_DO_JUMP,
    mavlink.MAV_CMD_DO_CHANGE_SPEED,
    mavlink.MAV_CMD_DO_SET_HOME,
    mavlink.MAV_CMD_DO_LAND_START,
    mavlink.MAV_CMD_DO_SET_ROI,
    mavlink.MAV_CMD_DO_SET_ROI_LOCATION,
    mavlink.MAV_CMD_DO_SET_ROI_NONE,
    mavlink.MAV_CMD_DO_SET_SERVO,
    mavlink.MAV_CMD_DO_SET_RELAY,
    mavlink.MAV_CMD_DO_MOUNT_CONTROL,
    mavlink.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW,
    mavlink.MAV_CMD_DO_DIGICAM_CONTROL,
    mavlink.MAV_CMD_DO_SET_CAM_TRIGG_DIST,
    mavlink.MAV_CMD_IMAGE_START_CAPTURE,
    mavlink.MAV_CMD_IMAGE_STOP_CAPTURE,
    mavlink.MAV_CMD_VIDEO_START_CAPTURE,
    mavlink.MAV_CMD_VIDEO_STOP_CAPTURE,
    mavlink.MAV_CMD_SET_CAMERA_MODE,
}
"""Commands that are understood; most of them concern what this aircraft has not, and are passed over."""
FENCE = {
    mavlink.MAV_CMD_NAV_FENCE_RETURN_POINT,
    mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION,
    mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION,
    mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION,
    mavlink.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION,
}
RALLY = {mavlink.MAV_CMD_NAV_RALLY_POINT}
FURTHEST_UP = 1e5
"""No altitude is beyond this, up or down [m]."""


@dataclass(frozen=True, slots=True)
class WireItem:
    """One item of a mission, geofence or list of rally points as MISSION_ITEM_INT carries it."""

    frame: int
    """MAV_FRAME."""
    command: int
    """MAV_CMD."""
    param1: float = 0.0
    param2: float = 0.0
    param3: float = 0.0
    param4: float = 0.0
    x: int = 0
    """Latitude [1e-7 deg]."""
    y: int = 0
    """Longitude [1e-7 deg]."""
    z: float = 0.0
    """Altitude in `frame` [m]."""
    autocontinue: int = 1

    @classmethod
    def of(cls, message: Message) -> WireItem:
        """The item of a MISSION_ITEM_INT, or of a MISSION_ITEM with its degrees as floats.

        A place that is no number becomes one that `problem` refuses.
        """
        m = message
        x, y = m.x, m.y
        if m.get_type() == "MISSION_ITEM":
            x, y = (_scaled(value) for value in (x, y))
        return cls(m.frame, m.command, m.param1, m.param2, m.param3, m.param4, x, y, m.z, m.autocontinue)

    @property
    def latitude_deg(self) -> float:
        """Latitude [deg]."""
        return self.x * DEGREES

    @property
    def longitude_deg(self) -> float:
        """Longitude [deg]."""
        return self.y * DEGREES

    @property
    def has_place(self) -> bool:
        """True if it gives a latitude and longitude (0, 0 stands for none)."""
        return self.command in PLACES and (self.x, self.y) != (0, 0)

    def above_home(self, home_altitude: float) -> float:
        """Altitude above home [m], where home lies at an altitude above mean sea level [m]."""
        if GLOBAL_FRAMES.get(self.frame) == mavlink.MAV_FRAME_GLOBAL:
            return self.z - home_altitude
        return self.z

    def problem(self, mission_type: int, nan_allowed: bool) -> int | None:
        """The MAV_MISSION_RESULT with which an autopilot refuses the item; None if it takes it.

        Parameters
        ----------
        mission_type : int
            MAV_MISSION_TYPE of the list.
        nan_allowed : bool
            Whether a parameter may be left open (PX4) or must be a number (ArduPilot).
        """
        known = {
            mavlink.MAV_MISSION_TYPE_MISSION: PLACES | OTHERS,
            mavlink.MAV_MISSION_TYPE_FENCE: FENCE,
            mavlink.MAV_MISSION_TYPE_RALLY: RALLY,
        }[mission_type]
        if self.command not in known:
            return int(mavlink.MAV_MISSION_UNSUPPORTED)
        if (wrong := self._parameter_problem(nan_allowed)) is not None or self.command in OTHERS:
            return wrong
        if self.frame not in GLOBAL_FRAMES:
            return int(mavlink.MAV_MISSION_UNSUPPORTED_FRAME)
        return self._place_problem()

    def _place_problem(self) -> int | None:
        """What is wrong with the place; comparisons also refuse NaN."""
        for value, limit, wrong in (
            (self.x, 90e7, mavlink.MAV_MISSION_INVALID_PARAM5_X),
            (self.y, 180e7, mavlink.MAV_MISSION_INVALID_PARAM6_Y),
            (self.z, FURTHEST_UP, mavlink.MAV_MISSION_INVALID_PARAM7),
        ):
            if not abs(value) <= limit:
                return int(wrong)
        return None

    def _parameter_problem(self, nan_allowed: bool) -> int | None:
        """What is wrong with the first four parameters."""
        for number, value in enumerate((self.param1, self.param2, self.param3, self.param4)):
            if abs(value) > 1e9 or (math.isnan(value) and not nan_allowed):
                return int(mavlink.MAV_MISSION_INVALID_PARAM1) + number
        return None


def checksum(items: Sequence[WireItem]) -> int:
    """A number that tells lists apart; the item that is flown to does not enter it."""
    value = 0
    for item in items:
        value = zlib.crc32(repr(item).encode(), value)
    return value


def _scaled(degrees: float) -> int:
    """Degrees as an integer; one that is out of every range if they are no number."""
    return round(degrees / DEGREES) if abs(degrees) <= 200.0 else 2_147_483_647
