"""COMMAND_LONG and COMMAND_INT: what an autopilot does when it is told to."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from avoidance import Waypoint
from offboard.sitl.captain import Captain
from offboard.sitl.dialect import Message, mavlink
from offboard.sitl.flavour import Say
from offboard.sitl.items import GLOBAL_FRAMES
from offboard.sitl.modes import Task

ACCEPTED: int = mavlink.MAV_RESULT_ACCEPTED
REJECTED: int = mavlink.MAV_RESULT_TEMPORARILY_REJECTED
DENIED: int = mavlink.MAV_RESULT_DENIED
UNSUPPORTED: int = mavlink.MAV_RESULT_UNSUPPORTED
FAILED: int = mavlink.MAV_RESULT_FAILED
FORCE = 21196
"""Magic number in param2 that disarms in flight."""


@dataclass(frozen=True, slots=True)
class Command:
    """A command, whichever message carried it."""

    number: int
    """MAV_CMD."""
    parameters: tuple[float, ...]
    """The first four."""
    latitude_deg: float
    longitude_deg: float
    altitude: float
    """As given [m]."""
    frame: int
    """MAV_FRAME of the place."""

    @classmethod
    def of(cls, message: Message) -> Command:
        """The command of a COMMAND_LONG, or of a COMMAND_INT with its degE7."""
        m = message
        four = (m.param1, m.param2, m.param3, m.param4)
        if m.get_type() == "COMMAND_INT":
            given = m.x not in (0x7FFFFFFF, -0x80000000)
            latitude, longitude = (m.x * 1e-7, m.y * 1e-7) if given else (math.nan, math.nan)
            return cls(m.command, four, latitude, longitude, m.z, m.frame)
        return cls(m.command, four, m.param5, m.param6, m.param7, mavlink.MAV_FRAME_GLOBAL)


class Desk(Protocol):
    """What commands need of the autopilot beside who flies it."""

    def send_message(self, link: int, message_id: int) -> bool:
        """Send one message; False if there is no such message."""

    def set_interval(self, link: int, message_id: int, interval: float) -> bool:
        """Send a message every so often [s], 0 as usual, negative never; False if there is none such."""

    def tell_interval(self, link: int, message_id: int) -> None:
        """Tell how often a message is sent."""

    def armable(self) -> str | None:
        """Why the aircraft cannot be armed yet; None if it can."""

    def restart(self) -> None:
        """Switch off and on again."""


class Commands:
    """Carries commands out.

    Parameters
    ----------
    captain : Captain
        Who flies.
    desk : Desk
        The rest of the autopilot.
    say : callable
        Told what is to be said about a refusal.
    """

    def __init__(self, captain: Captain, desk: Desk, say: Callable[..., None]) -> None:
        self._captain = captain
        self._desk = desk
        self._say = say
        self._handlers: dict[int, Callable[[Command, int], int]] = {
            mavlink.MAV_CMD_COMPONENT_ARM_DISARM: self._arm,
            mavlink.MAV_CMD_DO_SET_MODE: self._mode,
            mavlink.MAV_CMD_MISSION_START: self._start,
            mavlink.MAV_CMD_NAV_TAKEOFF: self._task(Task.TAKEOFF),
            mavlink.MAV_CMD_NAV_LAND: self._task(Task.LAND),
            mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH: self._task(Task.RETURN),
            mavlink.MAV_CMD_NAV_LOITER_UNLIM: self._task(Task.HOLD),
            mavlink.MAV_CMD_DO_REPOSITION: self._reposition,
            mavlink.MAV_CMD_DO_CHANGE_SPEED: self._speed,
            mavlink.MAV_CMD_DO_PAUSE_CONTINUE: self._pause,
            mavlink.MAV_CMD_DO_SET_MISSION_CURRENT: self._current,
            mavlink.MAV_CMD_SET_MESSAGE_INTERVAL: self._set_interval,
            mavlink.MAV_CMD_GET_MESSAGE_INTERVAL: self._get_interval,
            mavlink.MAV_CMD_REQUEST_MESSAGE: self._request,
            mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES: self._capabilities,
            mavlink.MAV_CMD_GET_HOME_POSITION: self._home,
            mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN: self._reboot,
        }

    def carry_out(self, command: Command, link: int) -> int:
        """MAV_RESULT of a command."""
        handler = self._handlers.get(command.number)
        return UNSUPPORTED if handler is None else handler(command, link)

    def _arm(self, command: Command, link: int) -> int:  # noqa: ARG002
        wanted, force = command.parameters[0], command.parameters[1] == FORCE
        if wanted not in (0.0, 1.0):
            return DENIED
        if wanted == 0.0:
            return ACCEPTED if self._captain.disarm(force) else REJECTED
        why = None if self._captain.armed else self._desk.armable()
        why = why or self._captain.arm()
        if why is None:
            return ACCEPTED
        self._say(Say.NOT_ARMED, why=why)
        return REJECTED if self._captain.flavour.atomic else FAILED

    def _mode(self, command: Command, link: int) -> int:  # noqa: ARG002
        flags, main, sub = command.parameters[:3]
        custom = int(flags) & mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED if math.isfinite(flags) else 0
        if not custom or not 0.0 <= main < 256.0:
            return DENIED
        number = int(main)
        if self._captain.flavour.atomic:
            number = number << 16 | (int(sub) << 24 if 0.0 <= sub < 256.0 else 0)
        return self.change_mode(number)

    def change_mode(self, custom_mode: int) -> int:
        """Change to the mode with this number."""
        mode = self._captain.flavour.mode_numbered(custom_mode)
        if mode is None:
            return DENIED
        if self._captain.set_mode(mode):
            return ACCEPTED
        return REJECTED if self._captain.flavour.atomic else FAILED

    def _start(self, command: Command, link: int) -> int:  # noqa: ARG002
        first = command.parameters[0]
        captain = self._captain
        mode = captain.flavour.mode_for(Task.MISSION)
        if not captain.set_mode(mode):
            return REJECTED if captain.flavour.atomic else FAILED
        if first > 0.0 and not captain.set_current(int(first)):
            return DENIED
        return ACCEPTED

    def _task(self, task: Task) -> Callable[[Command, int], int]:
        """A command that is a mode."""

        def change(command: Command, link: int) -> int:  # noqa: ARG001
            captain = self._captain
            if task is Task.TAKEOFF:
                above = command.altitude
                if captain.flavour.atomic:
                    above -= captain.aircraft.frame.altitude_m  # PX4 counts from sea level
                captain.takeoff_altitude = above if above > 0.0 else None
            return ACCEPTED if captain.set_mode(captain.flavour.mode_for(task)) else REJECTED

        return change

    def _reposition(self, command: Command, link: int) -> int:  # noqa: ARG002
        captain = self._captain
        state, frame = captain.aircraft.state, captain.aircraft.frame
        speed, _, radius, yaw = command.parameters
        if not captain.aircraft.moving:
            return REJECTED
        north, east, altitude = state.north, state.east, state.altitude
        if math.isfinite(command.latitude_deg) and math.isfinite(command.longitude_deg):
            if abs(command.latitude_deg) > 90.0 or abs(command.longitude_deg) > 180.0:
                return DENIED
            try:
                north, east = frame.to_map(command.latitude_deg, command.longitude_deg)
            except ValueError:
                return DENIED
        if math.isfinite(command.altitude):
            altitude = command.altitude
            if GLOBAL_FRAMES.get(command.frame) == mavlink.MAV_FRAME_GLOBAL:
                altitude -= frame.altitude_m
            if not -1000.0 <= altitude <= 20_000.0:
                return DENIED
        if speed > 0.0:
            captain.set_speed(speed)
        given = abs(radius) if math.isfinite(radius) and radius != 0.0 else None
        direction = -1 if radius < 0.0 or (given is None and yaw == 1.0) else 1
        captain.go_to(Waypoint(north, east, altitude), given, direction)
        return ACCEPTED

    def _speed(self, command: Command, link: int) -> int:  # noqa: ARG002
        kind, speed = command.parameters[:2]
        if kind not in (0.0, 1.0) or math.isnan(speed):
            return DENIED
        if speed == -2.0:
            self._captain.set_speed(None)
        elif speed > 0.0 and math.isfinite(speed):
            self._captain.set_speed(speed)
        elif speed != -1.0:
            return DENIED
        return ACCEPTED

    def _pause(self, command: Command, link: int) -> int:  # noqa: ARG002
        tasks = {0.0: Task.HOLD, 1.0: Task.MISSION}
        task = tasks.get(command.parameters[0])
        if task is None:
            return DENIED
        mode = self._captain.flavour.mode_for(task)
        return ACCEPTED if self._captain.set_mode(mode) else REJECTED

    def _current(self, command: Command, link: int) -> int:  # noqa: ARG002
        seq = command.parameters[0]
        good = math.isfinite(seq) and self._captain.set_current(int(seq))
        return ACCEPTED if good else DENIED

    def _set_interval(self, command: Command, link: int) -> int:
        number, microseconds = command.parameters[:2]
        if not (math.isfinite(number) and math.isfinite(microseconds)):
            return DENIED
        return ACCEPTED if self._desk.set_interval(link, int(number), microseconds * 1e-6) else FAILED

    def _get_interval(self, command: Command, link: int) -> int:
        number = command.parameters[0]
        if not 0.0 <= number < 65536.0:
            return DENIED
        self._desk.tell_interval(link, int(number))
        return ACCEPTED

    def _request(self, command: Command, link: int) -> int:
        number = command.parameters[0]
        good = 0.0 <= number < 2**24 and self._desk.send_message(link, int(number))
        return ACCEPTED if good else FAILED

    def _capabilities(self, command: Command, link: int) -> int:  # noqa: ARG002
        self._desk.send_message(link, mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION)
        return ACCEPTED

    def _home(self, command: Command, link: int) -> int:  # noqa: ARG002
        self._desk.send_message(link, mavlink.MAVLINK_MSG_ID_HOME_POSITION)
        return ACCEPTED

    def _reboot(self, command: Command, link: int) -> int:  # noqa: ARG002
        if self._captain.aircraft.moving:
            return DENIED
        self._desk.restart()
        return ACCEPTED
