"""The connection to one vehicle over MAVSDK. Its threads and callbacks end here, in a queue."""

from __future__ import annotations

import contextlib
import json
import queue
import time
from collections.abc import Callable
from itertools import count
from typing import TYPE_CHECKING, Any

from offboard.live.messages import Ask, Message, Reply
from offboard.raw_mission import RawItem

if TYPE_CHECKING:
    from mavsdk import Mavsdk, System

    from offboard.live.relay import Relay

MESSAGES = (
    "HEARTBEAT",
    "GLOBAL_POSITION_INT",
    "ATTITUDE",
    "VFR_HUD",
    "SYSTEM_TIME",
    "MISSION_CURRENT",
    "MISSION_ITEM_REACHED",
    "POSITION_TARGET_GLOBAL_INT",
    "EXTENDED_SYS_STATE",
    "STATUSTEXT",
    "HOME_POSITION",
    "BATTERY_STATUS",
    "ADSB_VEHICLE",
    "OBSTACLE_DISTANCE",
    "OBSTACLE_DISTANCE_3D",
    "COLLISION",
)
"""What is listened to."""
MISSION_LIST, FENCE_LIST, RALLY_LIST = 0, 1, 2
"""MAV_MISSION_TYPE numbers."""
SET_MESSAGE_INTERVAL = 511
"""MAV_CMD number."""
CHANGE_SPEED = 178
"""MAV_CMD number."""


class MavsdkSession:
    """A `Session` over MAVSDK.

    Parameters
    ----------
    mavsdk : Mavsdk
        MAVSDK with a connection; closed with the session.
    system : System
        The vehicle.
    relay : Relay, optional
        What carries its bytes, if MAVSDK does not do so itself; closed with the session.
    """

    def __init__(self, mavsdk: Mavsdk, system: System, relay: Relay | None = None) -> None:
        from mavsdk.plugins.action import Action  # noqa: PLC0415
        from mavsdk.plugins.mavlink_direct import MavlinkDirect  # noqa: PLC0415
        from mavsdk.plugins.mission_raw import MissionRaw  # noqa: PLC0415
        from mavsdk.plugins.param import Param  # noqa: PLC0415

        self._mavsdk = mavsdk
        self._relay = relay
        self._system = system
        self._queue: queue.SimpleQueue[Message | Reply] = queue.SimpleQueue()
        self._tokens = count(1)
        self._uploading = 0
        self._mission = MissionRaw(system)
        self._action = Action(system)
        self._parameters = Param(system)
        self._direct = MavlinkDirect(system)
        for name in MESSAGES:
            self._direct.subscribe_message(name, self._on_message)

    @property
    def system_id(self) -> int:
        """MAVLink system number of the vehicle."""
        return int(self._system.get_system_id())

    @property
    def dropped(self) -> int | None:
        """Frames not let in for they were not signed with our key, or old; None on a link without a key."""
        return None if self._relay is None else self._relay.dropped

    def poll(self, timeout: float = 0.0) -> list[Message | Reply]:
        """Everything that has come in; waits up to `timeout` wall seconds for the first."""
        found: list[Message | Reply] = []
        try:
            found.append(self._queue.get(timeout=timeout) if timeout > 0.0 else self._queue.get_nowait())
            while True:
                found.append(self._queue.get_nowait())
        except queue.Empty:
            return found

    def upload(self, items: tuple[RawItem, ...], current: int) -> int:
        """Replace the mission, item `current` flagged as the one to fly; the request's number."""
        token = next(self._tokens)
        if self._uploading:  # it would refuse another one as BUSY until it gives this one up
            self._cancel_upload()
        self._uploading = token
        raw = [_mavsdk_item(item, index, index == current) for index, item in enumerate(items)]
        self._mission.upload_mission_async(raw, self._on_reply(Ask.UPLOAD, token))
        return token

    def put(self, what: Ask, items: tuple[RawItem, ...]) -> int:
        """Replace the geofence or the rally points; the request's number."""
        send, kind = {
            Ask.PUT_FENCE: (self._mission.upload_geofence_async, FENCE_LIST),
            Ask.PUT_RALLY: (self._mission.upload_rally_points_async, RALLY_LIST),
        }[what]
        token = next(self._tokens)
        raw = [_mavsdk_item(item, index, current=False, kind=kind) for index, item in enumerate(items)]
        send(raw, self._on_reply(what, token))
        return token

    def ask(self, what: Ask, *values: float) -> int:
        """Ask for something; its values are those of MAVSDK's call of that name. The request's number."""
        token = next(self._tokens)
        answer = self._on_reply(what, token)
        match what:
            case Ask.SELECT:
                self._mission.set_current_mission_item_async(int(values[0]), answer)
            case Ask.DOWNLOAD:
                self._mission.download_mission_async(self._on_list(what, token))
            case Ask.GET_FENCE:
                self._mission.download_geofence_async(self._on_list(what, token))
            case Ask.GET_RALLY:
                self._mission.download_rallypoints_async(self._on_list(what, token))
            case Ask.MISSION_MODE:
                self._mission.start_mission_async(answer)
            case Ask.HOLD:
                self._mission.pause_mission_async(answer)
            case Ask.GOTO:
                self._action.goto_location_fixedwing_async(*values, answer)
            case Ask.ARM:
                self._action.arm_async(answer)
            case Ask.TAKE_OFF:
                self._action.takeoff_async(answer)
            case Ask.SPEED:
                self._action.set_current_speed_async(values[0], answer)
            case Ask.UPLOAD | Ask.PUT_FENCE | Ask.PUT_RALLY:
                raise ValueError("lists are uploaded by `upload` and `put`")
        return token

    def request_rate(self, message_id: int, rate: float) -> None:
        """Ask for a message so many times a second; there is no answer."""
        from mavsdk.plugins.mavlink_direct import MavlinkMessage  # noqa: PLC0415

        fields = {
            "target_system": self.system_id,
            "target_component": 1,
            "command": SET_MESSAGE_INTERVAL,
            "confirmation": 0,
            "param1": message_id,
            "param2": 1e6 / rate,
            **dict.fromkeys(("param3", "param4", "param5", "param6", "param7"), 0.0),
        }
        command = MavlinkMessage("COMMAND_LONG", 0, 0, self.system_id, 1, json.dumps(fields))
        self._direct.send_command_async(command, lambda *_: None)

    def parameter(self, name: str) -> float | None:
        """A parameter of the vehicle, None if it has none of that name or does not answer; waits."""
        from mavsdk.plugins.param import ParamError, ParamResult  # noqa: PLC0415

        for get in (self._parameters.get_param_float, self._parameters.get_param_int):
            try:
                return float(get(name))
            except ParamError as error:
                if error.result is not ParamResult.WRONG_TYPE:
                    return None
        return None

    def set_parameter(self, name: str, value: float) -> bool:
        """Set a parameter of the vehicle; False if it does not take it. Waits for the answer."""
        from mavsdk.plugins.param import ParamError  # noqa: PLC0415

        for put, number in (
            (self._parameters.set_param_int, round(value)),
            (self._parameters.set_param_float, value),
        ):
            try:
                put(name, number)
            except ParamError:
                continue
            return True
        return False

    def wall(self) -> float:
        """Wall clock [s]."""
        return time.monotonic()

    def close(self) -> None:
        """End the connection and MAVSDK's threads."""
        if self._relay is not None:
            self._relay.close()
        self._mavsdk.destroy()

    def _on_message(self, message: Any, _: object) -> None:  # noqa: ANN401  (MAVSDK is untyped)
        """Take over one message; runs in MAVSDK's thread."""
        fields = json.loads(message.fields_json)
        self._queue.put(Message(message.message_name, fields, message.component_id, self.wall()))

    def _cancel_upload(self) -> None:
        from mavsdk.plugins.mission_raw import MissionRawError  # noqa: PLC0415

        with contextlib.suppress(MissionRawError):  # it has just come to its end
            self._mission.cancel_mission_upload()

    def _on_reply(self, what: Ask, token: int) -> Callable[..., None]:
        def answer(result: Any, *_: object) -> None:  # noqa: ANN401
            if token == self._uploading:
                self._uploading = 0
            ok = result.name == "SUCCESS"
            self._queue.put(Reply(what, token, ok, result.name, arrived=self.wall()))

        return answer

    def _on_list(self, what: Ask, token: int) -> Callable[..., None]:
        def answer(result: Any, items: list[Any], *_: object) -> None:  # noqa: ANN401
            ok = result.name == "SUCCESS"
            raw = tuple(_raw(item) for item in items) if ok else ()
            self._queue.put(Reply(what, token, ok, result.name, raw, self.wall()))

        return answer


def _mavsdk_item(item: RawItem, seq: int, current: bool, kind: int = MISSION_LIST) -> Any:  # noqa: ANN401
    from mavsdk.plugins.mission_raw import MissionItem  # noqa: PLC0415

    return MissionItem(
        seq=seq,
        frame=item.frame,
        command=item.command,
        current=int(current),
        autocontinue=item.autocontinue,
        param1=item.params[0],
        param2=item.params[1],
        param3=item.params[2],
        param4=item.params[3],
        x=item.x,
        y=item.y,
        z=item.z,
        mission_type=kind,
    )


def _raw(item: Any) -> RawItem:  # noqa: ANN401
    return RawItem(
        item.command,
        item.frame,
        (item.param1, item.param2, item.param3, item.param4),
        item.x,
        item.y,
        item.z,
        item.autocontinue,
    )
