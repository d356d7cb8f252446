"""Waiting where no way is known, and giving up a waypoint that no way leads to."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from avoidance.orbits import Orbit, orbit_from_here
from avoidance.passages import Gap
from avoidance.rally import Rally
from avoidance.route_check import FENCE_SLACK, Blocked, first_blocked_leg
from avoidance.types import Decision, Hold, Keep, Ownship, Replace, Route, Rung, Waypoint
from avoidance.words import threat_words

FIRST_WAIT = 3.0
"""A way that is not there is looked for again after this time [s] ..."""
LONGEST_WAIT = 15.0
"""... each time after twice as long, but no longer than this, until something new is known [s]."""
PATIENCE = 20
"""A mission item that no route leads to is given up after so many attempts from where the vehicle waits."""
LAST_MOMENT = 4.0
"""Nearer to a sphere that its route enters than this many turn radii the vehicle turns, whatever the room."""

CROSSED = 0.1
"""What comes this near to the fence crosses it [m]."""


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


class Vigil:
    """A wait where no way is known: where, and how long for a mission item.

    Parameters
    ----------
    rally : Rally
        Where to wait rather than on the spot.

    Notes
    -----
    The patience for a mission item is used up only where the vehicle waits: on the way to a rally point the
    way on may open as well as there, and an item is not to be lost for the length of the way.
    """

    def __init__(self, rally: Rally) -> None:
        self.under_way = False
        """True from the decision to hold on, until something else is decided."""
        self._rally = rally
        self._refuge: Waypoint | None = None
        self._failures = 0

    def look(self, route: Route) -> None:
        """A vehicle that flies its route does not hold, whatever was decided: somebody else has ended it."""
        if route.held is False:
            self.stop()

    def stop(self) -> None:
        """Something else is decided."""
        self.under_way, self._refuge = False, None

    def end(self) -> None:
        """There is a way."""
        self.stop()
        self._failures = 0

    def tired(self, own: Ownship) -> bool:
        """After another attempt in vain: true once there is no patience left."""
        self._failures += self._refuge is None or self._rally.at(own, self._refuge)
        return self._failures > PATIENCE

    def cut_off(self, gap: Gap) -> bool:
        """True if something has come into the way to the rally point that is flown to."""
        refuge = self._refuge
        return refuge is not None and not self._rally.free(gap.own, refuge, gap.known, flown=True)

    def begin(self, gap: Gap) -> Decision | None:
        """Wait at a rally point that can be reached, else here; None as long as there is no room to."""
        refuge = self._rally.nearest(gap.own, gap.known)
        if refuge is not None:
            self.under_way, self._refuge = True, refuge
            return self._rally.hold(gap.own, refuge, gap.blocked)
        orbit = orbit_from_here(gap.own, gap.known, gap.performance)
        near = gap.blocked.threat.distance <= LAST_MOMENT * gap.performance.turn_radius
        if orbit.clearance < 0.0 and not (near and _enters(gap, orbit.clearance)):
            return None
        self.under_way, self._refuge = True, None
        return hold_on(gap.own, orbit, gap.blocked)

    def words(self, gap: Gap) -> Keep:
        """It goes on."""
        where = "hold here"
        if self._refuge is not None:
            where = self._rally.words(gap.own, self._refuge)
        return Keep(why=holding_words(gap.blocked, where), threat=gap.blocked.threat, rung=Rung.ORBIT)


def _enters(gap: Gap, clearance: float) -> bool:
    """True if the route leads deeper into a sphere, or over the fence, than an orbit does.

    `clearance` is the orbit's, below zero [m]. With the tracking error, on the curve that will be flown: no
    route is left for an orbit that is worse.
    """
    allowed = gap.performance.tracking_error + clearance
    known = replace(
        gap.known,
        margin=gap.known.doubt + allowed,
        slack=np.zeros_like(gap.known.slack),
        walls=replace(gap.known.walls, room=FENCE_SLACK + max(allowed, CROSSED)),
    )
    return first_blocked_leg(gap.own, gap.route, known, gap.performance) is not None


def no_room_yet(blocked: Blocked) -> Keep:
    """There is no room to hold yet."""
    words = f"{threat_words(blocked.threat)}; hold as soon as there is room to"
    return Keep(why=words, threat=blocked.threat, rung=Rung.ORBIT)


def holding_words(blocked: Blocked, where: str = "hold here") -> str:
    """Why the vehicle holds."""
    return f"{threat_words(blocked.threat)}; no way round is known, {where}"


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


def skipped(route: Route, blocked: Blocked, index: int) -> Replace:
    """Give up mission item route.waypoints[index], that no route leads to, or from there on to the next."""
    before = route.waypoints[:index]
    while before and before[-1].item is None:
        before = before[:-1]  # a detour towards it has lost its purpose
    onward = "to" if blocked.leg <= index else "on from"
    return Replace(
        why=f"{threat_words(blocked.threat)}; no route {onward} waypoint "
        f"{(route.waypoints[index].item or 0) + 1} can be flown, so it is skipped",
        threat=blocked.threat,
        rung=Rung.ORBIT,
        route=(*before, *route.waypoints[index + 1 :]),
        waypoint=None,
    )
