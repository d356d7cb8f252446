"""The mission that a live vehicle flies, and the edits on their way to it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from avoidance import Waypoint
from offboard.edits import EditAction
from offboard.errors import LinkError
from offboard.link import EditStatus
from offboard.live.aboard import Aboard
from offboard.live.autopilots import Mode
from offboard.live.edit_run import EditRecord, EditRun, Wanted
from offboard.live.fallback import Deferred, Fallback
from offboard.live.ground_track import Fit, TrackCheck
from offboard.live.messages import Reply
from offboard.live.mission_end import at_end, end_radius
from offboard.live.watch import Watch
from offboard.mission_list import MissionList
from offboard.orbit import Orbit
from offboard.raw_mission import WAYPOINT, Composed, RawItem, RawMission, compose

EXPECTED_EDIT = 0.3
"""An edit takes about this long; where the vehicle will be then is put before the new item [s]."""


@dataclass(frozen=True, slots=True)
class OnBoard:
    """A mission as the vehicle has it, or will have it."""

    mission: MissionList
    """Its waypoints."""
    composed: Composed
    """Everything in it."""
    hold: Orbit | None = None
    """Circled until something else is said."""


class Editor:
    """Keeps what the vehicle has, changes it, and falls back if it cannot be changed.

    Parameters
    ----------
    aboard : Aboard
        The vehicle.
    watch : Watch
        Told of everything that we command.
    """

    def __init__(self, aboard: Aboard, watch: Watch) -> None:
        self.on_board: OnBoard | None = None
        self.status = EditStatus.IDLE
        self.records: list[EditRecord] = []
        self.ended = -math.inf
        """When the last edit came to its end, whatever became of it [s, wall clock]."""
        self._aboard = aboard
        self._watch = watch
        self._raw: RawMission | None = None
        self._run: EditRun | None = None
        self._begun = 0.0
        self._check: TrackCheck | None = None
        self._checked_again = False
        self._fallback = Fallback(aboard, watch)
        self._mission_id = 0

    @property
    def latest(self) -> OnBoard | None:
        """What the vehicle has, or will have if an edit is under way."""
        if self._run is None or self.on_board is None:
            return self.on_board
        wanted = self._run.wanted
        return OnBoard(wanted.mission, wanted.composed, wanted.hold)

    @property
    def busy(self) -> bool:
        """True while an edit is under way, or the vehicle turns on to its line."""
        return self._run is not None or self._check is not None

    @property
    def sending(self) -> bool:
        """True while an edit is under way: what is on board meanwhile is anybody's guess."""
        return self._run is not None

    @property
    def fallen_back(self) -> bool:
        """True while the vehicle circles because an edit could not be made."""
        return self._fallback.active

    @property
    def fallbacks(self) -> int:
        """How often it had to."""
        return self._fallback.count

    def current(self) -> int:
        """Number of the waypoint that is flown to, or will be once the edit under way is flown."""
        if self._run is not None:
            return self._run.entry
        shown = self._aboard.telemetry.mission
        if self.on_board is None or shown is None:
            return 0
        return self.on_board.composed.entry_of(shown.current - self._aboard.rules.first_item)

    def set(self, raw: RawMission, mission: MissionList, composed: Composed) -> None:
        """The vehicle has this mission, and no edit is under way.

        In flight it must be seen to fly it: ArduPilot goes on to its old target until an item is selected.
        """
        self._raw = raw
        self.on_board = OnBoard(mission, composed)
        self._run = self._check = None
        self._fallback.end()
        item = composed.item_of(current := self.current())
        if self._watch.ours and item is not None and item.command == WAYPOINT:
            target = mission.entries[current].waypoint
            self._check = TrackCheck.begin(self._aboard.ownship(), target, self._aboard.performance)
        self._mission_id = 0
        self.status = EditStatus.IDLE

    def at_end(self) -> bool:
        """True if the vehicle shows that it has come to the end of its mission."""
        now = self.on_board
        if now is None or self._run is not None or now.hold is not None:
            return False
        return at_end(self._aboard, now.mission, now.composed)

    def end_radius(self) -> float:
        """How near the vehicle comes to its last waypoint [m]: a mission may end on a circle about it."""
        now = self.on_board
        last = None if now is None else now.composed.item_of(len(now.mission.entries) - 1)
        return end_radius(self._aboard, last)

    def differs(self) -> bool:
        """True if the vehicle shows a mission other than the one that it should have."""
        shown, now = self._aboard.telemetry.mission, self.on_board
        if now is None or shown is None or self._run is not None or self.fallen_back:
            return False
        rules = self._aboard.rules
        if shown.total and shown.total != rules.total(rules.first_item + len(now.composed.items)):
            return True
        if shown.mission_id and not self._mission_id:
            self._mission_id = shown.mission_id
        return shown.mission_id != self._mission_id

    def same_as_before(self) -> None:
        """What looked like another mission has been looked at, and is the one that is on board."""
        shown = self._aboard.telemetry.mission
        self._mission_id = 0 if shown is None else shown.mission_id

    def change(self, mission: MissionList, current: int, hold: Orbit | None, *, start: bool = False) -> None:
        """Begin an edit; one under way is given up for it.

        After a fall-back it waits until the mission is tried again: a vehicle that refuses is not asked
        once a second, and whoever takes it out of the fall-back is noticed.
        """
        if self.fallen_back and self._run is None and not self._fallback.due:
            self._fallback.deferred = Deferred(mission, current, hold)
            return
        raw = self._loaded()
        aboard = self._aboard
        own = aboard.ownship()
        anchor = Waypoint(
            own.north + EXPECTED_EDIT * own.velocity_north,
            own.east + EXPECTED_EDIT * own.velocity_east,
            own.altitude,
        )
        composed = compose(raw, mission, current, aboard.frame, anchor=anchor, hold=hold)
        target = _target(mission, current, hold, anchor)
        self._send(Wanted(mission, composed, hold, target, current), start=start or self.fallen_back)

    def again(self) -> None:
        """Send the mission as it should be once more, and start it: our own edit made it leave it."""
        now = self.latest
        if now is not None:
            self._watch.edited(self._aboard.time, again=True)
            self.change(now.mission, self.current(), now.hold, start=True)

    def give_up(self) -> None:
        """End the edit under way without any further command: somebody else flies, or the link is lost."""
        if self._run is not None:
            self._finish(EditStatus.REFUSED)
        self._check = None
        self._fallback.end()

    def on_reply(self, reply: Reply) -> None:
        """Take over the outcome of a request."""
        if self._run is not None:
            self._run.reply(reply)
        self._fallback.on_reply(reply)

    def work(self) -> None:
        """Do what is next."""
        if self._hold_ended():
            self._aboard.tell("warning", "someone else has ended the hold: another item is flown to")
        who = self._fallback.taken() if self.fallen_back else None
        if who is not None:
            self.give_up()
            self._watch.taken()
            self._aboard.tell("alarm", f"{who}; nothing is commanded until the mission mode is back")
        elif self._run is not None:
            self._work_on(self._run)
        elif self.fallen_back:
            again = self._fallback.deferred
            if again is not None and self._fallback.due:
                self.change(again.mission, again.current, again.hold, start=True)
        elif self._check is not None:
            self._look_at_track(self._check)

    # --- inside -----------------------------------------------------------------------------------------

    def _work_on(self, run: EditRun) -> None:
        """An edit on its way."""
        self._move_on(run)
        action = run.work(self._aboard.telemetry)
        if run.started:
            self._watch.expect(Mode.MISSION, self._aboard.mode)
            run.started = False
        if run.status is EditStatus.CONFIRMED:
            self._confirmed(run)
        elif action is EditAction.FALL_BACK:
            self._fall_back(run)

    def _hold_ended(self) -> bool:
        """True, once, if another item than the circle that was sent is flown to: not by our doing."""
        shown, now = self._aboard.telemetry.mission, self.on_board
        if self._run is not None or shown is None or now is None or now.hold is None:
            return False
        if shown.current == self._aboard.rules.first_item + now.composed.current:
            return False
        self.on_board = replace(now, hold=None)
        return True

    def _loaded(self) -> RawMission:
        if self._raw is None:
            raise LinkError("no mission has been uploaded")
        return self._raw

    def _send(self, wanted: Wanted, *, start: bool) -> None:
        aboard = self._aboard
        if self._run is not None:
            self._finish(EditStatus.TIMED_OUT)
        wire: tuple[RawItem, ...] = aboard.rules.wire(wanted.composed.items, aboard.home)
        self._run = EditRun(
            aboard.session, aboard.rules, wanted, wire, aboard.times.of(len(wire)), aboard.frame, start=start
        )
        self._begun = aboard.time
        self.status = EditStatus.PENDING
        self._watch.edited(self._begun, again=start)
        self._run.work(aboard.telemetry)

    def _finish(self, status: EditStatus) -> None:
        run = self._run
        if run is None:
            return
        self.records.append(run.record(self._begun, status))
        self.ended = self._aboard.session.wall()
        self.status = status
        self._run = None

    def _move_on(self, run: EditRun) -> None:
        """The vehicle may reach its target while an edit of what lies behind it is on its way."""
        before, shown = self.on_board, self._aboard.telemetry.mission
        if before is None or shown is None or run.sent_current or run.wanted.hold is not None:
            return
        was = before.composed.entry_of(shown.current - self._aboard.rules.first_item)
        old, new = before.mission.entries, run.wanted.mission.entries
        same = run.entry < min(len(old), len(new)) and old[run.entry].waypoint == new[run.entry].waypoint
        if same and was == run.entry + 1 and shown.arrived > run.begun:
            run.move_on()

    def _confirmed(self, run: EditRun) -> None:
        wanted = run.wanted
        self.on_board = OnBoard(wanted.mission, wanted.composed, wanted.hold)
        shown = self._aboard.telemetry.mission
        self._mission_id = 0 if shown is None else shown.mission_id
        self._finish(EditStatus.CONFIRMED)
        if self.fallen_back:
            self._aboard.tell("info", "the vehicle flies its mission again")
        self._fallback.end()
        self._watch.edited(self._aboard.time, again=self._watch.retried)
        circle = 0.0 if wanted.hold is None else wanted.hold.radius
        self._check = TrackCheck.begin(self._aboard.ownship(), run.target, self._aboard.performance, circle)

    def _look_at_track(self, check: TrackCheck) -> None:
        """The ground track after an edit."""
        shown = self.on_board
        if self._aboard.mode is not Mode.MISSION or shown is None:
            self._check = None
            return
        current = self.current()
        on_leg = shown.hold is None and current < len(shown.mission.entries)
        if on_leg and shown.mission.entries[current].waypoint != check.target:
            self._check = None  # it has been there
            return
        fit = check.look(self._aboard.ownship())
        if fit is Fit.OPEN:
            return
        self._check = None
        if fit is Fit.ON:
            self._checked_again = False
            return
        self._aboard.tell("alarm", "the vehicle does not fly along the line of its mission; look at it")
        if not self._checked_again:
            self._checked_again = True
            self.change(shown.mission, current, shown.hold)

    def _fall_back(self, run: EditRun) -> None:
        """An edit could not be made: circle where its first waypoint is to be, and try again from there."""
        self._finish(run.status)
        self._fallback.begin(run.wanted, "refused" if run.status is EditStatus.REFUSED else "did not confirm")


def _target(mission: MissionList, current: int, hold: Orbit | None, anchor: Waypoint) -> Waypoint:
    """Where the vehicle is to fly to."""
    if hold is not None:
        return Waypoint(hold.north, hold.east, hold.altitude)
    if current < len(mission.entries):
        return mission.entries[current].waypoint
    return anchor
