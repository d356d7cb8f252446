"""Whole missions: put aboard, and those that are there taken over, also when somebody else puts one there."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from offboard.errors import LinkError
from offboard.live.aboard import Aboard
from offboard.live.editor import Editor
from offboard.live.messages import Ask, Reply
from offboard.mission_list import MissionList
from offboard.raw_mission import TAKE_OFFS, Composed, RawItem, RawMission, compose

JUST_NOW = 2.0
"""What is said of a mission this soon after ours is said of ours [s, wall clock]."""
ASK_AGAIN = 3.0
"""A mission that could not be had is asked for again after this time [s, wall clock]."""


class Loading:
    """Keeps what the editor takes for the vehicle's mission the same as what the vehicle has.

    Parameters
    ----------
    aboard : Aboard
        The vehicle.
    editor : Editor
        Told of each mission that is new.
    request : callable
        Waits for the outcome of a request, and raises a `LinkError` that says what the vehicle did not do.
    begun : callable
        Called when another mission begins.
    """

    def __init__(
        self,
        aboard: Aboard,
        editor: Editor,
        request: Callable[[int, str], Reply],
        begun: Callable[[], None],
    ) -> None:
        self._aboard = aboard
        self._editor = editor
        self._request = request
        self._begun = begun
        self._download = -1
        self._ask_at = math.inf
        self._uploaded = -math.inf

    def upload(self, raw: RawMission) -> None:
        """Replace the whole mission, whatever is in it.

        Raises
        ------
        LinkError
            If the vehicle does not take it, or would not fly it.
        """
        aboard, rules = self._aboard, self._aboard.rules
        if (problem := rules.problem(raw, aboard.parameters)) is not None:
            if not (aboard.simulated and aboard.session.set_parameter(rules.demand, 0)):
                raise LinkError(problem)
            aboard.parameters[rules.demand] = 0.0
            aboard.tell("info", f"{rules.demand} of the simulated vehicle has been set to 0")
        mission = self._list(raw)
        composed = compose(raw, mission, 0, aboard.frame)
        wire = rules.wire(composed.items, aboard.home)
        token = aboard.session.upload(wire, rules.first_item)
        self._request(token, f"take the mission of {len(wire)} items")
        self._uploaded = aboard.session.wall()
        self._take(raw, mission, composed)

    def adopt(self) -> None:
        """Take over the mission that the vehicle has.

        Raises
        ------
        LinkError
            If it has none, or does not give it.
        """
        self._adopt(self._request(self._aboard.session.ask(Ask.DOWNLOAD), "give its mission"))

    def look_again(self) -> None:
        """The mission may be another one: it is asked for at the next opportunity."""
        self._ask_at = self._aboard.session.wall()

    def taken_aboard(self) -> None:
        """The vehicle says that it has taken a mission: somebody else's, unless we have just sent one."""
        ours = max(self._uploaded, self._editor.ended)
        if not self._editor.sending and self._aboard.session.wall() - ours > JUST_NOW:
            self.look_again()

    def follow(self, differs: bool) -> None:
        """Ask for the mission if it is not ours any more, or could not be had."""
        if self._editor.sending:
            return
        if differs or self._aboard.session.wall() >= self._ask_at:
            self._ask_at = math.inf
            self._download = self._aboard.session.ask(Ask.DOWNLOAD)

    def on_reply(self, reply: Reply) -> None:
        """Take over a mission that was asked for."""
        if reply.token != self._download:
            return
        self._download = -1
        if self._editor.sending:  # half of it may be in the list
            self.look_again()
            return
        try:
            if not reply.ok:
                raise LinkError(reply.why)
            self._adopt(reply)
        except LinkError as error:
            self._aboard.tell("alarm", f"the vehicle's mission is not known, no edit can be made ({error})")
            self._ask_at = self._aboard.session.wall() + ASK_AGAIN

    def _adopt(self, reply: Reply) -> None:
        """Take over what has been downloaded; a `LinkError` if that is no mission that can be kept clear."""
        items = reply.items[self._aboard.rules.first_item :]
        now = self._editor.on_board
        if now is not None and _same(items, now.composed.items):
            self._editor.same_as_before()
            return
        raw = RawMission.of(items)
        mission = self._list(raw)
        entries: list[int | None] = [None] * len(items)
        for number, index in enumerate(raw.flown_to):
            entries[index] = number
        if now is not None:
            words = "someone else has changed the mission; it is taken over as it is now"
            self._aboard.tell("warning", words)
        self._take(raw, mission, Composed(items, tuple(entries), 0))

    def _list(self, raw: RawMission) -> MissionList:
        speed = raw.first_speed() or self._aboard.performance.airspeed
        plan = raw.plan(self._aboard.home.altitude_m)
        try:
            plan.check()
            return MissionList.of(plan, self._aboard.frame, speed)
        except ValueError as error:
            raise LinkError(f"the mission cannot be flown: {error}") from error

    def _take(self, raw: RawMission, mission: MissionList, composed: Composed) -> None:
        aboard = self._aboard
        edit_time = aboard.times.of(len(composed.items)).worst_case
        aboard.performance = replace(aboard.performance, edit_time=edit_time)
        self._editor.set(raw, mission, composed)
        self._begun()


def flies_to_the_same(composed: Composed, raw: RawMission) -> bool:
    """True if two missions lead to the same places in the same order, a take-off before them apart."""
    places = [composed.items[i] for i, entry in enumerate(composed.entries) if entry is not None]
    wanted = [raw.items[i] for i in raw.flown_to]
    more = len(places) - len(wanted)
    begin = more if more > 0 and all(item.command in TAKE_OFFS for item in places[:more]) else 0
    there = places[begin:]
    return len(there) == len(wanted) and all(map(RawItem.same_place, there, wanted))


def _same(items: tuple[RawItem, ...], others: tuple[RawItem, ...]) -> bool:
    """True if two missions mean the same."""
    return len(items) == len(others) and all(a.same(b) for a, b in zip(items, others, strict=True))
