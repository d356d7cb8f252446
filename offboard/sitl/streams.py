"""Who gets which message how often."""

from __future__ import annotations

import math
from collections.abc import Iterator

from offboard.sitl.dialect import mavlink

SECONDS: dict[int, float] = {
    mavlink.MAVLINK_MSG_ID_HEARTBEAT: 1.0,
    mavlink.MAVLINK_MSG_ID_SYS_STATUS: 1.0,
    mavlink.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: 1.0,
    mavlink.MAVLINK_MSG_ID_BATTERY_STATUS: 2.0,
    mavlink.MAVLINK_MSG_ID_HOME_POSITION: 2.0,
    mavlink.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN: 10.0,
    mavlink.MAVLINK_MSG_ID_GPS_RAW_INT: 1.0,
    mavlink.MAVLINK_MSG_ID_WIND_COV: 2.0,
    mavlink.MAVLINK_MSG_ID_ATTITUDE: 0.2,
    mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: 0.2,
    mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED: 1.0,
    mavlink.MAVLINK_MSG_ID_VFR_HUD: 0.5,
    mavlink.MAVLINK_MSG_ID_ALTITUDE: 1.0,
    mavlink.MAVLINK_MSG_ID_MISSION_CURRENT: 1.0,
    mavlink.MAVLINK_MSG_ID_POSITION_TARGET_GLOBAL_INT: 1.0,
    mavlink.MAVLINK_MSG_ID_NAV_CONTROLLER_OUTPUT: 1.0,
    mavlink.MAVLINK_MSG_ID_SYSTEM_TIME: 1.0,
}
"""Usual time between two of a message [s]; within a step they are sent in this order."""
GROUPS = {
    mavlink.MAV_DATA_STREAM_EXTENDED_STATUS: (
        mavlink.MAVLINK_MSG_ID_SYS_STATUS,
        mavlink.MAVLINK_MSG_ID_GPS_RAW_INT,
        mavlink.MAVLINK_MSG_ID_MISSION_CURRENT,
        mavlink.MAVLINK_MSG_ID_NAV_CONTROLLER_OUTPUT,
        mavlink.MAVLINK_MSG_ID_POSITION_TARGET_GLOBAL_INT,
    ),
    mavlink.MAV_DATA_STREAM_POSITION: (
        mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT,
        mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED,
    ),
    mavlink.MAV_DATA_STREAM_EXTRA1: (mavlink.MAVLINK_MSG_ID_ATTITUDE,),
    mavlink.MAV_DATA_STREAM_EXTRA2: (mavlink.MAVLINK_MSG_ID_VFR_HUD,),
}
GROUPS[mavlink.MAV_DATA_STREAM_ALL] = tuple(message for group in GROUPS.values() for message in group)
"""What the old data streams stand for."""


class Streams:
    """When a link gets which message."""

    def __init__(self) -> None:
        self.intervals = dict(SECONDS)
        self._due = dict.fromkeys(SECONDS, -math.inf)
        self._next = -math.inf

    def set(self, message_id: int, interval: float) -> None:
        """Send a message every so often [s]; 0 or infinite stops it."""
        self.intervals[message_id] = interval if interval > 0.0 else math.inf
        self._due[message_id] = -math.inf if math.isfinite(self.intervals[message_id]) else math.inf
        self._next = -math.inf

    def usual(self, message_id: int) -> None:
        """Send a message as often as usual."""
        self.set(message_id, SECONDS[message_id])

    def due(self, now: float) -> Iterator[int]:
        """The messages whose time has come."""
        if now < self._next - 1e-9:
            return
        for message_id, due in self._due.items():
            if now >= due - 1e-9:
                interval = self.intervals[message_id]
                self._due[message_id] = max(due + interval, now + 0.5 * interval)
                yield message_id
        self._next = min(self._due.values())
