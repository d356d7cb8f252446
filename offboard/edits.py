"""Mission edits: the route a decision asks for, and how far a vehicle is with taking it over.

Free of I/O and of clocks: `Edit` follows one edit on its way to a vehicle; whoever talks to the vehicle
polls it and does what it says.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum

from avoidance import Decision, Detour, Hold, Keep, Replace, Reroute, Resume, Waypoint
from offboard.link import EditStatus


def route_of(decision: Decision) -> tuple[Waypoint, ...] | None:
    """The remaining route that a decision asks for; None if it leaves the mission as it is.

    Raises
    ------
    ValueError
        If a decision that changes the route carries none.
    """
    match decision:
        case Keep():
            return None
        case Hold() | Resume():
            return decision.route
        case Detour() | Replace() | Reroute() if decision.route is None:
            raise ValueError(f"route = None, a {decision.name} needs the whole remaining route")
    return decision.route


class EditAction(Enum):
    """What whoever talks to the vehicle must do next about an edit."""

    SEND = "send"
    """Send the mission, current item included."""
    SELECT = "select"
    """The mission has been taken: say which item is current."""
    START = "start"
    """The mission is in place, but the vehicle does something else: tell it to fly it."""
    WAIT = "wait"
    """Nothing: the vehicle has time left to take it over."""
    FALL_BACK = "fall back"
    """Give up the edit and bring the vehicle to safety another way."""
    NONE = "none"
    """Nothing: the edit is over."""


@dataclass(frozen=True, slots=True)
class Observed:
    """What a vehicle shows of the mission it flies."""

    total: int
    """Number of items."""
    current: int
    """Index of the current item."""
    target: Waypoint | None = None
    """Where it is flying to; None if the vehicle does not tell."""
    refused: bool = False
    """True if it has refused what was sent last."""
    accepted: bool = True
    """True once it has acknowledged what was sent last."""
    flying: bool = True
    """True while it flies its mission."""


@dataclass(slots=True)
class Edit:
    """One mission edit: begin, confirm, retry, fall back.

    An edit is confirmed by what the vehicle is seen to fly, not by its acknowledgement: the item index
    alone proves nothing, for it is the same before and after a waypoint was put before it.

    Examples
    --------
    >>> edit = Edit(Observed(total=9, current=3))
    >>> edit.poll(0.0, None).value, edit.poll(0.2, None).value
    ('send', 'wait')
    >>> edit.poll(0.3, Observed(total=9, current=3)).value, edit.status.value
    ('none', 'confirmed')
    """

    wanted: Observed
    """What the vehicle shows once it has taken the edit over."""
    timeout: float = 1.0
    """Time that each attempt is given [s]."""
    attempts: int = 3
    """How often it is sent before it is given up."""
    target_tolerance: float = 5.0
    """The vehicle's target may lie this far from the one sent [m]."""
    select: bool = False
    """True for a vehicle that must be told the current item after it has taken a mission."""
    start: bool = False
    """True if the vehicle is to be told to fly its mission, should it do something else."""
    status: EditStatus = field(default=EditStatus.PENDING, init=False)
    """How far the edit is."""
    _sent: int = field(default=0, init=False, repr=False)
    _deadline: float = field(default=-math.inf, init=False, repr=False)
    _selected: bool = field(default=False, init=False, repr=False)
    _started: bool = field(default=False, init=False, repr=False)

    @property
    def worst_case(self) -> float:
        """Longest time until it is confirmed or given up [s]."""
        return self.timeout * self.attempts

    def poll(self, now: float, observed: Observed | None) -> EditAction:
        """What to do at time `now` [s], given what the vehicle shows (None if nothing new is known)."""
        if self.status is not EditStatus.PENDING:
            return EditAction.NONE
        refused = False
        if self._sent and observed is not None:
            refused = observed.refused
            if not refused and (step := self._step(observed)) is not None:
                return step
        if not refused and now < self._deadline:
            return EditAction.WAIT
        if self._sent < self.attempts:
            self._sent += 1
            self._deadline = now + self.timeout
            self._selected = self._started = False
            return EditAction.SEND
        self.status = EditStatus.REFUSED if refused else EditStatus.TIMED_OUT
        return EditAction.FALL_BACK

    def _step(self, observed: Observed) -> EditAction | None:
        """What follows from what the vehicle shows; None if there is nothing but to wait."""
        if self.select and not self._selected:
            self._selected = observed.accepted
            return EditAction.SELECT if observed.accepted else None
        if (observed.total, observed.current) != (self.wanted.total, self.wanted.current):
            return None
        if observed.flying and self._on_target(observed):
            self.status = EditStatus.CONFIRMED
            return EditAction.NONE
        if self.start and not observed.flying and not self._started:
            self._started = True
            return EditAction.START
        return None

    def _on_target(self, observed: Observed) -> bool:
        """True if the vehicle flies where it should, or does not tell."""
        if observed.target is None or self.wanted.target is None:
            return True
        north = observed.target.north - self.wanted.target.north
        east = observed.target.east - self.wanted.target.east
        return math.hypot(north, east) <= self.target_tolerance
