"""The simulated autopilot: bytes in, time steps, bytes out."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from offboard.link import VehicleState
from offboard.sitl.aircraft import HIGHEST, LOWEST, Aircraft
from offboard.sitl.announcing import Announcing
from offboard.sitl.ardupilot import ARDUPILOT, MISSION_TOTAL
from offboard.sitl.captain import Captain
from offboard.sitl.commands import Command, Commands
from offboard.sitl.dialect import Message, Packed, mavlink
from offboard.sitl.downloads import MISSION
from offboard.sitl.flavour import Flavour, Role, Say
from offboard.sitl.items import WireItem
from offboard.sitl.links import Links
from offboard.sitl.missions import MissionProtocol
from offboard.sitl.parameters import Parameters
from offboard.sitl.px4 import PX4
from offboard.sitl.services import Handler, handlers
from offboard.sitl.streams import SECONDS, Streams
from offboard.sitl.telemetry import Telemetry

FLAVOURS: dict[str, Flavour] = {"px4": PX4, "ardupilot": ARDUPILOT}
"""Autopilots by the name that users give."""
AUTOPILOT = mavlink.MAV_COMP_ID_AUTOPILOT1


@dataclass(frozen=True, slots=True)
class Settings:
    """How an autopilot is set up."""

    flavour: Flavour = PX4
    system_id: int = 1
    parameters: Mapping[str, float] = field(default_factory=dict)
    """Values other than the autopilot's own."""
    start_time: float = 0.0
    """Unix time at which it is switched on [s]."""
    retry: float = 0.2
    """Time until a mission item is asked for again [s]; faster than real time this is simulated time."""
    warm_up: float = 0.0
    """It cannot be armed for so long after it was switched on [s]."""
    signing_key: bytes | None = None
    """Secret key: frames that are not signed with it are dropped, its own are signed."""
    signing_clock: Callable[[], float] = time.time
    """Unix time for signatures [s]: true time, however fast the simulation is."""


class Autopilot:
    """A MAVLink autopilot that flies an aircraft; it knows no transport and no clock.

    Whoever owns time calls `step`, or `advance` and then `tick`; whoever owns the transport
    calls `feed` and `flush`, with a number of its own for each peer.

    Parameters
    ----------
    aircraft : Aircraft
        What it flies.
    settings : Settings
        How it is set up. Airspeed, acceptance radius and bank limit among its parameters are the
        aircraft's, unless others are given.

    Raises
    ------
    ValueError
        If a parameter is unknown or out of range, or the system ID.
    """

    def __init__(self, aircraft: Aircraft, settings: Settings | None = None) -> None:
        self.settings = settings or Settings()
        if not 1 <= self.settings.system_id <= 255:
            raise ValueError(f"system_id = {self.settings.system_id}, must be between 1 and 255")
        self.aircraft = aircraft
        self.flavour = self.settings.flavour
        self.parameters = Parameters(
            self.flavour.parameters, self._given(aircraft), bytewise=self.flavour.bytewise
        )
        self._links = Links(self.settings.system_id, self.settings.signing_key, self.settings.signing_clock)
        self._announcing = Announcing(self.flavour, self._links)
        self._say = self._announcing.say
        self.captain = Captain(aircraft, self.flavour, self.parameters, self._say, self._item_reached)
        self.telemetry = Telemetry(self.captain, self.settings.start_time)
        self._missions = MissionProtocol(self.flavour, self, self._links.send, self.settings.retry)
        self._commands = Commands(self.captain, self, self._say)
        self._handlers: dict[str, Handler] = {
            "COMMAND_LONG": self._command,
            "COMMAND_INT": self._command,
            "SET_MODE": self._set_mode,
            "MISSION_SET_CURRENT": self._set_current,
            **handlers(self._links, self.parameters, aircraft),
        }
        if self.flavour.home_item:
            self._store((self.home(),))

    # The public face

    def feed(self, data: bytes, link: int = 0) -> None:
        """Bytes that have come in on a link, whole frames or not, garbage or not."""
        messages = self._links[link].messages(data)
        for message in messages:
            self._handle(link, message)
        if messages:
            self.captain.step()
            self._announcing.changes(self.captain, self.telemetry)

    def step(self, duration: float) -> None:
        """Let `duration` seconds pass: fly, then tell of it."""
        self.advance(duration)
        self.tick()

    def tick(self) -> None:
        """What is to be told at the present instant, after the aircraft has moved on."""
        now = self.aircraft.clock
        self._missions.step(now)
        self._announcing.changes(self.captain, self.telemetry)
        self._announcing.repeat(now)
        made: dict[int, Packed | None] = {}
        for link in self._links:
            for message_id in link.streams.due(now):
                if message_id not in made:
                    message = self.telemetry.message(message_id)
                    made[message_id] = None if message is None else link.codec.prepare(message)
                if (packed := made[message_id]) is not None:
                    link.put(packed)

    def flush(self, link: int = 0) -> bytes:
        """What is to be sent on a link."""
        return b"".join(self.frames(link))

    def frames(self, link: int = 0) -> list[bytes]:
        """The same, frame by frame."""
        state = self._links[link]
        out, state.out = state.out, []
        return out

    def open(self, link: int) -> None:
        """Begin to send on a link."""
        self._links[link]

    def close(self, link: int) -> None:
        """Forget a link."""
        self._links.close(link)

    def broadcast(self, message: Message) -> None:
        """Send a message on every link."""
        self._links.broadcast(message)

    def load_mission(self, items: Sequence[WireItem]) -> None:
        """Put a mission in the memory, as if it had been there at power-on; home goes in by itself."""
        self._store((self.home(), *items) if self.flavour.home_item else tuple(items))

    def load_areas(self, fence: Sequence[WireItem], rally: Sequence[WireItem]) -> None:
        """Put a geofence and rally points in the memory, as if they had been there at power-on."""
        self._missions.store(mavlink.MAV_MISSION_TYPE_FENCE, fence)
        self._missions.store(mavlink.MAV_MISSION_TYPE_RALLY, rally)

    def restart(self) -> None:
        """Switch off and on again: the clock begins at 0, the mode is the first, the mission is kept."""
        self.aircraft.clock = 0.0
        self.captain.power_on()
        for link in self._links:
            link.streams = Streams()
        self._announcing.forget()

    # What a world needs of a vehicle

    @property
    def finished(self) -> bool:
        """Never: it goes on until it is switched off."""
        return False

    def state(self) -> VehicleState:
        """Position and motion."""
        return self.aircraft.vehicle_state()

    def advance(self, duration: float) -> None:
        """Fly on; `tick` tells of it."""
        self.aircraft.advance(duration)
        self.captain.step()

    # What the mission protocol needs

    def home(self) -> WireItem:
        """Home as an item."""
        frame = self.aircraft.frame
        latitude, longitude = round(frame.latitude_deg * 1e7), round(frame.longitude_deg * 1e7)
        return WireItem(
            mavlink.MAV_FRAME_GLOBAL,
            mavlink.MAV_CMD_NAV_WAYPOINT,
            x=latitude,
            y=longitude,
            z=frame.altitude_m,
        )

    def current_item(self) -> int:
        """Seq of the item that is flown to."""
        return self.captain.current

    def too_far(self, item: WireItem) -> int | None:
        """The MAV_MISSION_RESULT for an item that lies out of reach; None if it does not."""
        frame = self.aircraft.frame
        if not item.has_place:
            return None
        if not LOWEST <= item.above_home(frame.altitude_m) <= HIGHEST:
            return int(mavlink.MAV_MISSION_INVALID_PARAM7)
        try:
            frame.to_map(item.latitude_deg, item.longitude_deg)
        except ValueError:
            return int(mavlink.MAV_MISSION_INVALID_PARAM5_X)
        return None

    def uploaded(self, items: Sequence[WireItem], flagged: int | None) -> None:
        """A mission has come in as a whole."""
        self.captain.take_mission(items, flagged)

    def overwritten(self, items: Sequence[WireItem], complete: bool) -> None:
        """One item of the mission has been written over, or the last one of an upload."""
        self.captain.overwrite(items)
        if len(items) != self.parameters[MISSION_TOTAL]:
            self.parameters.set(MISSION_TOTAL, len(items))
            self.broadcast(self.parameters.message(MISSION_TOTAL, index=0xFFFF))
        if complete:
            self._say(Say.RECEIVED)

    def gave_up(self) -> None:
        """An upload has come to nothing."""
        self._say(Say.GAVE_UP)

    # What commands need

    def send_message(self, link: int, message_id: int) -> bool:
        """Send one message; False if there is no such message."""
        message = self.telemetry.message(message_id)
        if message is not None:
            self._links.send(link, message)
        return self.telemetry.knows(message_id)

    def set_interval(self, link: int, message_id: int, interval: float) -> bool:
        """Send a message every so often [s], 0 as usual, negative never; False if there is none such."""
        if message_id not in SECONDS or message_id in self.flavour.fixed_rates:
            return False
        streams = self._links[link].streams
        if interval == 0.0:
            streams.usual(message_id)
        else:
            streams.set(message_id, interval)
        return True

    def tell_interval(self, link: int, message_id: int) -> None:
        """Tell how often a message is sent."""
        interval = self._links[link].streams.intervals.get(message_id)
        microseconds = 0 if interval is None else -1 if math.isinf(interval) else round(1e6 * interval)
        self._links.send(link, mavlink.MAVLink_message_interval_message(message_id, microseconds))

    def armable(self) -> str | None:
        """Why the aircraft cannot be armed yet; None if it can."""
        return "Gyros inconsistent" if self.aircraft.clock < self.settings.warm_up else None

    # Inside

    def _given(self, aircraft: Aircraft) -> dict[str, float]:
        """Parameters that are the aircraft's, under those given."""
        performance, roles = aircraft.performance, self.flavour.roles
        own = {
            roles[Role.AIRSPEED]: performance.airspeed,
            roles[Role.ACCEPTANCE]: performance.acceptance_radius,
            roles[Role.BANK]: round(math.degrees(performance.max_bank), 3),
        }
        identity = next(name for name in ("MAV_SYS_ID", "SYSID_THISMAV") if name in self.flavour.parameters)
        return own | {identity: self.settings.system_id} | dict(self.settings.parameters)

    def _store(self, items: Sequence[WireItem]) -> None:
        self._missions.store(MISSION, items)
        if self.flavour.atomic:
            self.captain.take_mission(items, None)
        else:
            self.captain.overwrite(items)
            self.parameters.set(MISSION_TOTAL, len(items))

    def _handle(self, link: int, message: Message) -> None:
        """Do what a message asks, if it is for us and not from someone who pretends to be us."""
        header = message.get_header()
        if header.srcSystem in (0, self.settings.system_id) and header.srcComponent in (0, AUTOPILOT):
            return
        if getattr(message, "target_system", 0) not in (0, self.settings.system_id):
            return
        if getattr(message, "target_component", 0) not in (0, AUTOPILOT):
            return
        partner = (link, header.srcSystem, header.srcComponent)
        if self._guided_item(link, message) or self._missions.handle(partner, message, self.aircraft.clock):
            return
        handler = self._handlers.get(message.get_type())
        if handler is not None:
            handler(link, message)

    def _command(self, link: int, message: Message) -> None:
        header = message.get_header()
        result = self._commands.carry_out(Command.of(message), link)
        ack = mavlink.MAVLink_command_ack_message(
            message.command, result, 0, 0, header.srcSystem, header.srcComponent
        )
        self._links.send(link, ack)

    def _guided_item(self, link: int, message: Message) -> bool:
        """ArduPilot's old way to a place: a mission item with `current` 2; 3 changes the altitude alone."""
        is_item = message.get_type() in ("MISSION_ITEM", "MISSION_ITEM_INT")
        if not is_item or not self.flavour.home_item or message.current not in (2, 3):
            return False
        item, header = WireItem.of(message), message.get_header()
        result = item.problem(MISSION, nan_allowed=False) or self.too_far(item)
        if result is None:
            open_place = message.current == 3
            place = (math.nan, math.nan) if open_place else (item.latitude_deg, item.longitude_deg)
            command = Command(
                mavlink.MAV_CMD_DO_REPOSITION, (-1.0, 1.0, 0.0, math.nan), *place, item.z, item.frame
            )
            done = self._commands.carry_out(command, link) == mavlink.MAV_RESULT_ACCEPTED
            result = mavlink.MAV_MISSION_ACCEPTED if done else mavlink.MAV_MISSION_ERROR
        answer = mavlink.MAVLink_mission_ack_message(header.srcSystem, header.srcComponent, result)
        self._links.send(link, answer)
        return True

    def _set_mode(self, link: int, message: Message) -> None:  # noqa: ARG002
        if message.base_mode & mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED:
            self._commands.change_mode(message.custom_mode)

    def _set_current(self, link: int, message: Message) -> None:
        header = message.get_header()
        self._missions.heard((link, header.srcSystem, header.srcComponent))
        if self.captain.set_current(message.seq):
            self.send_message(link, mavlink.MAVLINK_MSG_ID_MISSION_CURRENT)

    def _item_reached(self, seq: int) -> None:
        self._announcing.reached(seq, self.aircraft.clock)
