"""One mission edit on its way to a vehicle over a session."""

from __future__ import annotations

import math
from dataclasses import dataclass

from avoidance import Waypoint
from offboard.edits import Edit, EditAction, Observed
from offboard.frames import MapFrame
from offboard.link import EditStatus
from offboard.live.autopilots import Mode, Rules
from offboard.live.limits import EditTimes
from offboard.live.messages import Ask, Reply, Session
from offboard.live.telemetry import Telemetry
from offboard.mission_list import MissionList
from offboard.orbit import Orbit
from offboard.raw_mission import Composed, RawItem

NO_MISSION = 1
"""MISSION_STATE of an autopilot that finds nothing to fly in what it has accepted."""

BUSY = "BUSY"
"""MAVSDK's word while it still works on an earlier upload."""
BUSY_FOR = 0.05
"""It is asked again after this time [s, wall clock]."""


@dataclass(frozen=True, slots=True)
class EditRecord:
    """What became of one edit."""

    time: float
    """Vehicle's clock when it was begun [s]."""
    status: EditStatus
    milliseconds: float
    """From then to its end, by the wall clock [ms]."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """A mission as it is to be."""

    mission: MissionList
    """Its waypoints."""
    composed: Composed
    """Everything in it."""
    hold: Orbit | None
    """Circled first."""
    target: Waypoint
    """Where the vehicle is to fly to."""
    current: int
    """Entry that is flown to first."""


class EditRun:
    """Sends a mission, selects the item, and watches until the vehicle is seen to fly it.

    Parameters
    ----------
    session : Session
        The link.
    rules : Rules
        Of the autopilot.
    wanted : Wanted
        The mission.
    wire : tuple of RawItem
        The same as this autopilot takes it.
    times : EditTimes
        How long it may take.
    frame : MapFrame
        The map.
    start : bool
        True to put the vehicle into its mission mode if it is in another.
    """

    def __init__(
        self,
        session: Session,
        rules: Rules,
        wanted: Wanted,
        wire: tuple[RawItem, ...],
        times: EditTimes,
        frame: MapFrame,
        *,
        start: bool = False,
    ) -> None:
        self.wanted = wanted
        self.begun = session.wall()
        self.started = False
        """True once the vehicle has been told to fly its mission; whoever takes note puts it back."""
        self.entry = wanted.current
        """Entry that is flown to first."""
        self.target = wanted.target
        """Where the vehicle is to fly to."""
        self._session = session
        self._rules = rules
        self._wire = wire
        self._frame = frame
        self._current = rules.first_item + wanted.composed.current
        tolerance = 5.0 if wanted.hold is None else 5.0 + 2.0 * wanted.hold.radius
        self._edit = Edit(
            Observed(rules.total(len(wire)), self._current, wanted.target),
            timeout=times.attempt,
            attempts=times.attempts,
            target_tolerance=tolerance,
            select=True,
            start=start,
        )
        self._upload = self._select = -1
        self._sent = self._selected = self._send_again = math.inf
        self._accepted = False
        self._refused = False

    @property
    def status(self) -> EditStatus:
        """How far it is."""
        return self._edit.status

    @property
    def sent_current(self) -> bool:
        """True once the vehicle has been told which item to fly to."""
        return self._selected < math.inf

    def record(self, time: float, status: EditStatus) -> EditRecord:
        """What became of it, begun at a time of the vehicle's clock [s]."""
        return EditRecord(time, status, 1e3 * (self._session.wall() - self.begun))

    def reply(self, reply: Reply) -> None:
        """Take over the outcome of a request; those of others and of earlier attempts are left alone.

        That MAVSDK is busy with an earlier upload, which has been called off, is no answer of the vehicle's.
        """
        if reply.token == self._upload and reply.why == BUSY:
            self._send_again = self._session.wall() + BUSY_FOR
        elif reply.token == self._upload:
            self._accepted, self._refused = reply.ok, not reply.ok
        elif reply.token == self._select and not reply.ok:
            self._refused = True

    def move_on(self) -> None:
        """The vehicle has reached the target while the edit was on its way: fly to the item behind it."""
        entries = self.wanted.composed.entries
        here = self._current - self._rules.first_item
        following = next((i for i in range(here + 1, len(entries)) if entries[i] is not None), None)
        if following is None:
            return
        entry = entries[following]
        if entry is None:
            return
        self._current = self._rules.first_item + following
        self.entry, self.target = entry, self.wanted.mission.entries[entry].waypoint
        self._edit.wanted = Observed(self._edit.wanted.total, self._current, self.target)

    def work(self, telemetry: Telemetry) -> EditAction:
        """Do what is next; the action tells when to fall back."""
        action = self._edit.poll(self._session.wall(), self._observed(telemetry))
        match action:
            case EditAction.WAIT if self._session.wall() >= self._send_again:
                self._send_again = math.inf
                self._upload = self._session.upload(self._wire, self._current)
            case EditAction.SEND:
                self._send_again = math.inf
                self._accepted = self._refused = False
                self._sent, self._selected = self._session.wall(), math.inf
                self._select = -1
                self._upload = self._session.upload(self._wire, self._current)
            case EditAction.SELECT:
                self._selected = self._session.wall()
                self._select = self._session.ask(Ask.SELECT, self._current)
            case EditAction.START:
                self.started = True
                self._session.ask(Ask.MISSION_MODE)
            case _:
                pass
        return action

    def _observed(self, telemetry: Telemetry) -> Observed:
        """What the vehicle has shown since the item was selected.

        A target that fits counts from the upload on: PX4 flies to the flagged item at once. That PX4 finds
        nothing to fly counts while it flies its mission: in Hold it says so of each, until it is started.
        """
        flying = self._rules.mode(telemetry.custom_mode) is Mode.MISSION
        shown, target = telemetry.mission, telemetry.target
        nothing = Observed(-1, -1, None, self._refused, self._accepted, flying)
        if shown is None or shown.arrived < self._selected:
            return nothing
        where = None
        if target is not None and flying:
            where = Waypoint(*self._frame.to_map(target.latitude_deg, target.longitude_deg), 0.0)
            if target.arrived < self._selected and not (target.arrived >= self._sent and self._near(where)):
                return nothing
        refused = self._refused or (flying and shown.state == NO_MISSION and shown.total > 0)
        total = shown.total if shown.total or where is None else self._edit.wanted.total
        return Observed(total, shown.current, where, refused, self._accepted, flying)

    def _near(self, where: Waypoint) -> bool:
        """True if a place is where the vehicle is to fly to."""
        away = math.hypot(where.north - self.target.north, where.east - self.target.east)
        return away <= self._edit.target_tolerance
