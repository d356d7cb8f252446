"""What an autopilot tells by itself: its words, items reached, and each change as soon as there is one."""

from __future__ import annotations

from typing import Protocol

from offboard.sitl.captain import Captain
from offboard.sitl.dialect import Message, mavlink
from offboard.sitl.flavour import Flavour, Say
from offboard.sitl.links import Links


class Tells(Protocol):
    """Makes messages of what the autopilot is doing."""

    def message(self, message_id: int) -> Message | None:
        """A message as it is now; None if there is nothing to tell."""


class Announcing:
    """Broadcasts what nobody has asked for.

    Parameters
    ----------
    flavour : Flavour
        Whose words, and how often they are said.
    links : Links
        Who is told.
    """

    def __init__(self, flavour: Flavour, links: Links) -> None:
        self._flavour = flavour
        self._links = links
        self._text_id = 0
        self._reached: tuple[int, int, float] | None = None
        self._shown: tuple[object, ...] = ()
        self._shown_aim: object = None

    def say(self, event: Say, **values: object) -> None:
        """Tell an event as text, if this autopilot does."""
        text = self._flavour.texts.get(event)
        if text is None:
            return
        self._text_id = (self._text_id + 1) % 0xFFFF if self._flavour.atomic else 0
        words = text[1].format(**values).encode()[:50]
        self._links.broadcast(mavlink.MAVLink_statustext_message(text[0], words, self._text_id, 0))

    def reached(self, seq: int, now: float) -> None:
        """An item has been reached, at a time of the autopilot's clock [s]."""
        self._links.broadcast(mavlink.MAVLink_mission_item_reached_message(seq))
        self._reached = (seq, self._flavour.reached_repeats - 1, now + 1.0)

    def repeat(self, now: float) -> None:
        """PX4 says again and again which item it has reached last."""
        if self._reached is None or now < self._reached[2]:
            return
        seq, left, due = self._reached
        if left <= 0:
            self._reached = None
            return
        self._links.broadcast(mavlink.MAVLink_mission_item_reached_message(seq))
        self._reached = (seq, left - 1, due + 1.0)

    def forget(self) -> None:
        """Switched off and on: what was reached before is not repeated."""
        self._reached = None

    def changes(self, captain: Captain, telemetry: Tells) -> None:
        """Mode, mission and target are told as soon as they change."""
        mode = (captain.mode, captain.armed)
        mission = (captain.current, captain.items, captain.mission_state)
        changed = []
        if self._shown != (mode, mission):
            before, self._shown = self._shown, (mode, mission)
            if before[:1] != (mode,):
                changed.append(mavlink.MAVLINK_MSG_ID_HEARTBEAT)
            if before[1:] != (mission,):
                changed.append(mavlink.MAVLINK_MSG_ID_MISSION_CURRENT)
        if captain.aircraft.aim != self._shown_aim:
            self._shown_aim = captain.aircraft.aim
            changed.append(mavlink.MAVLINK_MSG_ID_POSITION_TARGET_GLOBAL_INT)
            changed.append(mavlink.MAVLINK_MSG_ID_NAV_CONTROLLER_OUTPUT)
        for message_id in changed:
            if (message := telemetry.message(message_id)) is not None:
                self._links.broadcast(message)
