"""A `Vehicle` over a session: PX4 or ArduPilot, simulated or real."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from avoidance import Decision, Hold, Performance, Replace, Route, Waypoint
from offboard.edits import route_of
from offboard.errors import LinkError
from offboard.link import VehicleState
from offboard.live.aboard import Aboard, request_rates
from offboard.live.asking import SLOWEST_POLL, Asking
from offboard.live.autopilots import Mode
from offboard.live.editor import Editor, OnBoard
from offboard.live.loading import Loading, flies_to_the_same
from offboard.live.messages import Ask, Message, Reply
from offboard.live.not_flown import NotFlown
from offboard.live.telemetry import Telemetry
from offboard.live.watch import Seen, Watch
from offboard.mission import MissionItem, MissionPlan, MissionProgress
from offboard.mission_list import MissionList
from offboard.orbit import Orbit
from offboard.raw_mission import RawMission

OBSTACLES = frozenset({"ADSB_VEHICLE", "OBSTACLE_DISTANCE", "OBSTACLE_DISTANCE_3D", "COLLISION"})
"""Messages that are handed on to whoever makes scans of them."""
WORDS = {
    Seen.LINK_BACK: ("warning", "the link is back"),
    Seen.NO_POSITION: (
        "alarm",
        "the vehicle tells no position any more; where it is meanwhile is a guess: take over",
    ),
    Seen.POSITION_BACK: ("warning", "the vehicle tells its position again"),
    Seen.ARMED: ("info", "the vehicle has been armed"),
}
"""What is only told."""


class LiveVehicle:
    """A vehicle that is reached over a link.

    A human wins: once anyone else changes the mode, nothing is commanded until the mission mode is given
    back. Whatever keeps a decision from being flown becomes an alarm.

    Parameters
    ----------
    aboard : Aboard
        The vehicle as `offboard.live.starting.open_vehicle` has found it.
    touch : bool
        False decides and tells, and commands nothing.
    """

    def __init__(self, aboard: Aboard, *, touch: bool = True) -> None:
        self.aboard = aboard
        self.touch = touch
        self.watch = Watch(aboard.rules, expected=aboard.mode, disarmed=not aboard.telemetry.armed)
        self.editor = Editor(aboard, self.watch)
        self._asking = Asking(aboard.session, self.pump)
        self._not_flown = NotFlown(aboard, self.watch, touch=touch)
        self._loading = Loading(aboard, self.editor, self.request, self._begun)
        self.link_losses = 0
        self.on_obstacle: Callable[[Message, Telemetry], None] | None = None
        """Given what comes in about obstacles, whoever makes scans of it."""
        self.finished_at = math.inf
        """When the last waypoint was reached [s]."""
        self._finished = False
        self._paused = False
        self._route: Route | None = None
        self._route_key: object = None

    # --- what the avoidance core and the loop need ----------------------------------------------------

    @property
    def performance(self) -> Performance:
        """From the vehicle's own parameters."""
        return self.aboard.performance

    @property
    def time(self) -> float:
        """Seconds since the start by the vehicle's clock; goes on while the link is silent."""
        return self.aboard.time

    @property
    def silent(self) -> float:
        """How long nothing has been heard of it [s, wall clock]."""
        return max(self.aboard.session.wall() - self.aboard.telemetry.heard, 0.0)

    @property
    def heard_until(self) -> float:
        """When its position was last told [s]."""
        fix = self.aboard.telemetry.fix
        return 0.0 if fix is None else self.aboard.clock.ours(fix.time)

    @property
    def finished(self) -> bool:
        """True once the last waypoint has been reached."""
        return self._finished

    @property
    def mission(self) -> MissionList | None:
        """The waypoints as the vehicle has them, or will have after the edit under way."""
        latest = self.editor.latest
        return None if latest is None else latest.mission

    @property
    def holding(self) -> bool:
        """True while it does not fly along its mission."""
        latest = self.editor.latest
        return (
            self._paused or self.aboard.mode is not Mode.MISSION or latest is None or latest.hold is not None
        )

    def state(self) -> VehicleState:
        """The latest state; moved on at its last velocity while the link is silent. Never blocks."""
        self.pump()
        return VehicleState(self.aboard.ownship(), self.editor.status)

    def route(self) -> Route:
        """What is still to be flown, an edit under way included; the same object until something changes.

        It begins at the waypoint before the current one, and where the vehicle is while it holds, turns on
        to the line of an edit or waits for one.
        """
        latest = self.editor.latest
        own = self.aboard.ownship()
        here = Waypoint(own.north, own.east, own.altitude)
        if latest is None:
            return Route(here, ())
        current = self.editor.current()
        ahead = latest.mission.ahead(current)
        if self.holding:
            return Route(here, ahead, held=True)
        key = (current, latest.mission)
        if self._route is None or self._route_key != key:
            before = latest.mission.entries[current - 1].waypoint if current else here
            self._route = Route(here if self.editor.busy else before, ahead, held=False)
            self._route_key = key
        return self._route

    def begin(self, decision: Decision) -> None:
        """Start the edit that a decision asks for; if that cannot be, the pilot is told. Never blocks."""
        route = route_of(decision)
        latest = self.editor.latest
        if self._finished or latest is None or (route is None and not isinstance(decision, Hold)):
            return
        if not (self.watch.ours and self.touch):
            self._not_flown.tell(decision)
            return
        current = self.editor.current()
        mission = latest.mission
        if route is not None:
            mission = mission.with_route(current, route, self.aboard.frame)
        hold = None
        if isinstance(decision, Hold):
            hold = Orbit.about(decision.centre, decision.radius, decision.direction)
        if (mission.entries, hold) != (latest.mission.entries, latest.hold):
            if hold is not None or (isinstance(decision, Replace) and decision.waypoint is None):
                self.aboard.tell("warning", decision.why)
            self.editor.change(mission, current, hold)

    # --- MAVSDK's mission interface; these wait for the vehicle -----------------------------------------

    def upload_mission(self, mission_plan: MissionPlan) -> None:
        """Replace the whole mission; the vehicle must be told to start it.

        Raises
        ------
        ValueError
            If the plan cannot be flown; names item, field and value.
        LinkError
            If the vehicle does not take it.
        """
        mission_plan.check()
        self.upload_raw(RawMission.of_plan(mission_plan))

    def upload_raw(self, raw: RawMission) -> None:
        """Replace the whole mission, whatever is in it, and set its first item.

        Raises
        ------
        LinkError
            If the vehicle does not take it, or would not fly it.
        """
        self._loading.upload(raw)
        self._select(self.aboard.rules.first_item)

    def download_mission(self) -> MissionPlan:
        """The mission as it is now, injected items included."""
        return MissionPlan(self._loaded().mission.items())

    def adopt_mission(self) -> None:
        """Take over the mission that the vehicle has.

        Raises
        ------
        LinkError
            If it has none, or does not give it.
        """
        self._loading.adopt()

    def has_mission(self, raw: RawMission) -> bool:
        """True if the vehicle flies to the same places in the same order, a take-off before them apart."""
        return flies_to_the_same(self._loaded().composed, raw)

    def start_mission(self) -> None:
        """Start, or resume after a pause, at the current item."""
        self._loaded()
        self._command(Ask.MISSION_MODE, Mode.MISSION, "fly its mission")
        self._paused = False

    def pause_mission(self) -> None:
        """Circle where it is until `start_mission`."""
        self._command(Ask.HOLD, Mode.HOLD, "hold")
        self._paused = True

    def set_speed(self, airspeed: float) -> None:
        """Fly at another airspeed [m/s] from now on."""
        self.request(self.aboard.session.ask(Ask.SPEED, airspeed), f"fly at {airspeed:g} m/s")

    def set_current_mission_item(self, index: int) -> None:
        """Fly to waypoint `index` of the mission as it is now.

        Raises
        ------
        ValueError
            If there is no such waypoint any more.
        """
        now = self._loaded()
        total = len(now.mission.entries)
        if not 0 <= index < total:
            raise ValueError(f"index = {index}, must be between 0 and {total - 1}")
        at = next((i for i, entry in enumerate(now.composed.entries) if entry == index), None)
        if at is None:
            raise ValueError(f"index = {index}: a detour that has been flown is no longer in the mission")
        self._select(self.aboard.rules.first_item + at)

    def mission_progress(self) -> MissionProgress:
        """Current waypoint and how many there are; both the same once the mission is finished."""
        total = len(self._loaded().mission.entries)
        return MissionProgress(total if self._finished else min(self.editor.current(), total), total)

    def is_mission_finished(self) -> bool:
        """True once the last waypoint has been reached (MAVSDK's name for `finished`)."""
        return self._finished

    def inject(self, mission_items: Sequence[MissionItem]) -> None:
        """Put items before the current one, in flight, and fly to the first of them."""
        now = self.editor.latest or self._loaded()
        MissionPlan.of(mission_items).check()
        current = self.editor.current()
        self.editor.change(
            now.mission.with_injected(current, mission_items, self.aboard.frame), current, None
        )

    # --- the link ---------------------------------------------------------------------------------------

    def pump(self, timeout: float = 0.0) -> None:
        """Take over what has come in and do what follows; waits up to `timeout` wall seconds for it."""
        session, telemetry = self.aboard.session, self.aboard.telemetry
        for one in session.poll(timeout):
            if isinstance(one, Reply):
                self._on_reply(one)
                continue
            telemetry.feed(one)
            if self.on_obstacle is not None and one.name in OBSTACLES:
                self.on_obstacle(one, telemetry)
        wall = session.wall()
        if telemetry.fix is not None:
            self.aboard.clock.heard(telemetry.fix.time, wall)
        for severity, text in telemetry.texts:
            self.aboard.tell("info" if severity > 4 else "warning", f"{self.aboard.rules.name}: {text}")
            if text and text == self.aboard.rules.mission_taken:
                self._loading.taken_aboard()
        telemetry.texts.clear()
        for seen in self.watch.look(telemetry, self.time, wall):
            self._on_seen(seen)
        self._follow(wall)

    def wait_until(self, time: float) -> None:
        """Let the vehicle's clock come to a time [s], doing all that is to be done meanwhile."""
        while self.time < time:
            self.pump(SLOWEST_POLL)

    def wait_for(self, ready: Callable[[], bool], timeout: float) -> bool:
        """Wait until something is so; False if it is not within `timeout` wall seconds."""
        return self._asking.wait_for(ready, timeout)

    def request(self, token: int, words: str, timeout: float = 10.0) -> Reply:
        """Wait for the outcome of a request to the session; a `LinkError` with `words` if it fails."""
        return self._asking.request(token, words, timeout)

    def close(self) -> None:
        """End the connection; the vehicle flies on as it does."""
        self.aboard.session.close()

    # --- inside -----------------------------------------------------------------------------------------

    def _loaded(self) -> OnBoard:
        now = self.editor.on_board
        if now is None:
            raise LinkError("the vehicle has no mission")
        return now

    def _begun(self) -> None:
        """Another mission."""
        self._finished, self._route = False, None

    def _follow(self, wall: float) -> None:
        """Edits, the end of the mission, and missions that are not ours."""
        if self.watch.ours and self.touch:
            self.editor.work()
        if not self._finished and self.editor.at_end():
            self._finished = True
            self.finished_at = self.time
            self.aboard.tell("info", "the last waypoint has been reached")
        differs = not self.watch.lost and self.editor.differs()
        differs = self.watch.mission_differs(differs, wall)
        if not self._asking.waiting:  # MAVSDK does one list at a time
            self._loading.follow(differs)

    def _on_reply(self, reply: Reply) -> None:
        self._asking.on_reply(reply)
        self.editor.on_reply(reply)
        self._loading.on_reply(reply)

    def _on_seen(self, seen: Seen) -> None:
        """What follows from what the watch has noticed."""
        tell, name = self.aboard.tell, self.aboard.mode_name
        match seen:
            case Seen.LINK_LOST:
                self.link_losses += 1
                self.editor.give_up()
                tell("alarm", "the link is lost; the vehicle flies on along the mission that it has")
            case Seen.RESTARTED:
                self.editor.give_up()
                self._loading.look_again()
                if self.touch:
                    request_rates(self.aboard.session)
                tell("alarm", "the autopilot has restarted; its mission is looked at again")
            case Seen.TAKEN:
                self.editor.give_up()
                tell(
                    "alarm",
                    f"mode {name}: someone else flies; nothing is commanded until the mission mode is back",
                )
            case Seen.GIVEN_BACK:
                self._paused = False
                self._route = None
                tell("info", f"mode {name}: the mission is flown again")
            case Seen.DROPPED:
                tell(
                    "warning",
                    f"our edit made the vehicle go to {name}; the mission is sent and started again",
                )
                if self.touch:
                    self.editor.again()
            case Seen.DISARMED if not self._finished:
                self.editor.give_up()
                tell("alarm", "the vehicle has been disarmed")
            case _ if seen in WORDS:
                tell(*WORDS[seen])
            case _:
                pass

    def _select(self, item: int) -> None:
        self.request(self.aboard.session.ask(Ask.SELECT, item), f"fly to item {item}")
        self._route = None

    def _command(self, ask: Ask, mode: Mode, words: str) -> None:
        """Change the mode, and wait until it is seen."""
        self.watch.expect(mode, self.aboard.mode)
        self.request(self.aboard.session.ask(ask), words)
        if not self.wait_for(lambda: self.aboard.mode is mode, 5.0):
            raise LinkError(f"the vehicle agreed to {words}, but is in mode {self.aboard.mode_name}")
