"""Waiting where no way is known, and giving up a waypoint that no way leads to."""

from __future__ import annotations

import math
from dataclasses import dataclass

from avoidance.contingency import Orbit
from avoidance.route_check import Blocked
from avoidance.types import Hold, Ownship, Replace, Route, Rung, Waypoint
from avoidance.words import threat_words

FIRST_WAIT = 3.0
"""A way that is not there is looked for again after this time [s] ..."""
LONGEST_WAIT = 15.0
"""... each time after twice as long, but no longer than this, until something new is known [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class NoWay:
    """That there was no way round, and how long that is believed while the vehicle flies on."""

    route: Route | None = None
    """What was to be flown."""
    version: int = -1
    """Of what was known."""
    wait: float = 0.0
    """How long to believe it [s]."""
    until: float = -math.inf
    """Then it is looked for again [s]."""

    def lasts(self, own: Ownship, route: Route, version: int) -> bool:
        """True if it need not be looked for again yet."""
        return self._same(route, version) and own.time < self.until

    def again(self, own: Ownship, route: Route, version: int) -> NoWay:
        """After another search in vain."""
        wait = min(2.0 * self.wait, LONGEST_WAIT) if self._same(route, version) else FIRST_WAIT
        return NoWay(route, version, wait, own.time + wait)

    def _same(self, route: Route, version: int) -> bool:
        return self.route is route and self.version == version


def holding_words(blocked: Blocked) -> str:
    """Why the vehicle holds."""
    return f"{threat_words(blocked.threat)}; no way round is known, hold here"


def hold_on(own: Ownship, orbit: Orbit, blocked: Blocked) -> Hold:
    """Wait on an orbit."""
    north, east = orbit.centre
    return Hold(
        why=holding_words(blocked),
        threat=blocked.threat,
        rung=Rung.ORBIT,
        centre=Waypoint(north, east, own.altitude),
        radius=orbit.radius,
        direction=orbit.direction,
    )


def skipped(route: Route, blocked: Blocked, end: int) -> Replace:
    """Give up mission item route.waypoints[end], that no route leads to."""
    return Replace(
        why=f"{threat_words(blocked.threat)}; no route to waypoint "
        f"{(route.waypoints[end].item or 0) + 1} can be flown, so it is skipped",
        threat=blocked.threat,
        rung=Rung.ORBIT,
        route=route.waypoints[end + 1 :],
        waypoint=None,
    )
