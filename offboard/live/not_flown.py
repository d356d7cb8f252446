"""Decisions that are not flown: the pilot is told of each, and why, but not once a second."""

from __future__ import annotations

import math

from avoidance import Decision
from offboard.live.aboard import Aboard
from offboard.live.watch import Watch

REPEAT = 30.0
"""The same alarm is given again after this time [s]."""


class NotFlown:
    """Tells the pilot of decisions that cannot be commanded, or are not to be.

    Parameters
    ----------
    aboard : Aboard
        The vehicle.
    watch : Watch
        Knows who flies it.
    touch : bool
        False for a dry run: nothing is to be commanded.
    """

    def __init__(self, aboard: Aboard, watch: Watch, *, touch: bool) -> None:
        self._aboard = aboard
        self._watch = watch
        self._touch = touch
        self._told: dict[str, float] = {}

    def tell(self, decision: Decision) -> None:
        """Tell of one decision, unless the same has been told of lately."""
        why, now = self._why(), self._aboard.time
        text = f"{decision.why}; not flown, for {why}" if self._touch else f"{decision.why} (dry run)"
        key = f"{decision.name} {None if decision.threat is None else decision.threat.ids} {why}"
        if now - self._told.get(key, -math.inf) >= REPEAT:
            self._told[key] = now
            self._aboard.tell("alarm" if self._touch else "info", text)

    def _why(self) -> str:
        if not self._touch:
            return "dry run"
        if self._watch.lost:
            return "the link is lost"
        if self._watch.disarmed:
            return "the vehicle is disarmed"
        return f"someone else flies ({self._aboard.mode_name})"
