"""Who flies the vehicle, and what has become of it: a watch over telemetry. Pure."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from offboard.live.autopilots import Mode, Rules
from offboard.live.telemetry import Telemetry

LINK_LOST = 3.0
"""The link counts as lost after so long without a message; heartbeats come every second [s]."""
BLIND = 3.0
"""A vehicle that is heard but tells no position for so long cannot be led round anything [s]."""
OWN_EDIT = 3.0
"""A mode change this soon after our own edit, to a mode that it can cause, is not a human's [s]."""
CHANGED_FOR = 2.0
"""A mission that is not ours must be seen for this long before it is believed [s]."""


class Seen(Enum):
    """What the watch has noticed."""

    LINK_LOST = "link lost"
    LINK_BACK = "link back"
    NO_POSITION = "no position"
    POSITION_BACK = "the position is back"
    RESTARTED = "autopilot restarted"
    TAKEN = "a human has taken over"
    GIVEN_BACK = "the mission mode is back"
    DROPPED = "our edit made it leave the mission"
    MISSION_CHANGED = "someone else has changed the mission"
    DISARMED = "disarmed"
    ARMED = "armed"


@dataclass(slots=True)
class Watch:
    """Compares what a vehicle shows with what we have asked for.

    Wall clock for the link, the vehicle's own for everything that it does.
    """

    rules: Rules
    """Of the autopilot."""
    expected: Mode = Mode.MISSION
    """What we last asked it to do."""
    lost: bool = False
    """The link is lost."""
    blind: bool = False
    """It is heard, but tells no position."""
    human: bool = False
    """Someone else flies; nothing is commanded until the mission mode is given back."""
    disarmed: bool = True
    _before: Mode | None = None
    _edited: float = -math.inf
    retried: bool = False
    """The last edit has been sent a second time, because the first made the vehicle leave its mission."""
    _restarts: int = 0
    _back: float = -math.inf
    _strange_since: float = math.inf

    @property
    def ours(self) -> bool:
        """True while we may command."""
        return not (self.lost or self.human or self.disarmed)

    def expect(self, mode: Mode, before: Mode) -> None:
        """We have asked for a mode; the one before it is nobody else's doing until the new one is seen."""
        self.expected, self._before = mode, before

    def taken(self) -> None:
        """Someone else flies, though the mode is one that we have asked for."""
        self.human, self.expected, self._before = True, Mode.MISSION, None

    def edited(self, time: float, again: bool = False) -> None:
        """We have edited the mission, at a time of the vehicle's clock [s]; `again` after it was dropped."""
        self._edited, self.retried = time, again

    def look(self, telemetry: Telemetry, time: float, wall: float) -> list[Seen]:
        """What is new at a time of the vehicle's clock and of the wall's [s]."""
        seen = self._link(telemetry, wall)
        if self.lost:
            return seen
        seen += self._position(telemetry, wall)
        if telemetry.restarts != self._restarts:
            self._restarts = telemetry.restarts
            seen.append(Seen.RESTARTED)
        if telemetry.armed == self.disarmed:
            self.disarmed = not telemetry.armed
            seen.append(Seen.DISARMED if self.disarmed else Seen.ARMED)
        if not self.disarmed:
            seen += self._mode(self.rules.mode(telemetry.custom_mode), time)
        return seen

    def mission_differs(self, differs: bool, wall: float) -> bool:
        """True, once, when a mission that is not ours has been seen for a while (wall clock [s])."""
        if not differs:
            self._strange_since = math.inf
            return False
        self._strange_since = min(self._strange_since, wall)
        if wall - self._strange_since < CHANGED_FOR:
            return False
        self._strange_since = math.inf
        return True

    def _link(self, telemetry: Telemetry, wall: float) -> list[Seen]:
        lost = wall - telemetry.heard > LINK_LOST
        if lost == self.lost:
            return []
        self.lost = lost
        self._back = wall
        return [Seen.LINK_LOST if lost else Seen.LINK_BACK]

    def _position(self, telemetry: Telemetry, wall: float) -> list[Seen]:
        blind = wall - max(telemetry.placed, self._back) > BLIND
        if blind == self.blind:
            return []
        self.blind = blind
        return [Seen.NO_POSITION if blind else Seen.POSITION_BACK]

    def _mode(self, mode: Mode, time: float) -> list[Seen]:
        if mode is self.expected or (self.human and mode is Mode.MISSION):
            self._before = None
            back, self.human, self.expected = self.human, False, mode
            return [Seen.GIVEN_BACK] if back else []
        if self.human or mode is self._before:
            return []
        if mode in self.rules.edit_may_cause and time - self._edited < OWN_EDIT and not self.retried:
            self.retried = True
            self._before = mode  # until it flies the mission that is sent again
            return [Seen.DROPPED]
        self.human = True
        return [Seen.TAKEN]
