"""What is done where an edit cannot be made: circle at its first waypoint, and try again from there."""

from __future__ import annotations

import math
from dataclasses import dataclass

from avoidance import Waypoint
from offboard.live.aboard import Aboard
from offboard.live.autopilots import Mode
from offboard.live.edit_run import Wanted
from offboard.live.messages import Ask, Reply
from offboard.live.watch import Watch
from offboard.mission_list import MissionList
from offboard.orbit import Orbit

ORBIT_TURN_RADII = 1.5
"""Radius of a circle of our own choice, in turn radii at the bank limit."""
COME_BACK = 5.0
"""The mission is sent again so often [s, wall clock]."""
SHOWN_WITHIN = 2.0
"""Within this time after its mode a vehicle shows where it goes [s, wall clock]."""
ELSEWHERE = 30.0
"""A target this far from the place that we sent the vehicle to is another one [m]."""


@dataclass(frozen=True, slots=True)
class Deferred:
    """An edit that waits until the mission is tried again."""

    mission: MissionList
    current: int
    """Entry that is flown to first."""
    hold: Orbit | None
    """Circled first."""


class Fallback:
    """Sends the vehicle to a place outside its mission, and knows whether it is still there on our word.

    On PX4 the mode of it is Hold, which a human may choose as well. Whose Hold it is, our own command tells:
    it was taken, and leads to our place. Hold chosen while the vehicle is there already changes nothing that
    could be seen (MAVSDK does not hand on answers to others): the alarm says that other modes take over.

    Parameters
    ----------
    aboard : Aboard
        The vehicle.
    watch : Watch
        Told of the mode that we ask for.
    """

    def __init__(self, aboard: Aboard, watch: Watch) -> None:
        self.count = 0
        """How often it was needed."""
        self.deferred: Deferred | None = None
        """What is to be flown when the mission is tried again."""
        self._aboard = aboard
        self._watch = watch
        self._back_at = math.inf
        self._sent = math.inf
        self._token = -1
        self._refused = False
        self._seen = False
        self._since = math.inf
        self._place = Waypoint(0.0, 0.0, 0.0)

    @property
    def active(self) -> bool:
        """True until the mission is flown again, or somebody else flies."""
        return self._back_at < math.inf

    @property
    def due(self) -> bool:
        """True when the mission is to be tried again."""
        return self._aboard.session.wall() >= self._back_at and not self._open

    def begin(self, wanted: Wanted, words: str) -> None:
        """Circle where an edit would have led to; `words` say what became of it."""
        aboard, place = self._aboard, wanted.target
        self.count += 1
        mode = aboard.rules.goto_mode
        hint = "; any mode but Hold takes over" if mode is Mode.HOLD else ""
        aboard.tell(
            "alarm",
            f"the vehicle {words} an edit of its mission; it is sent to the new waypoint instead{hint}",
        )
        self.deferred = Deferred(wanted.mission, wanted.current, wanted.hold)
        self._sent = aboard.session.wall()
        self._back_at = self._sent + COME_BACK
        self._place, self._since, self._seen, self._refused = place, math.inf, False, False
        radius = ORBIT_TURN_RADII * aboard.performance.turn_radius
        if wanted.hold is not None:
            radius = wanted.hold.radius * wanted.hold.direction
        self._watch.expect(mode, aboard.mode)
        where = aboard.frame.to_geodetic(place.north, place.east)
        absolute = place.altitude + aboard.home.altitude_m
        self._token = aboard.session.ask(Ask.GOTO, *where, absolute, radius)

    def end(self) -> None:
        """The mission is flown again, or somebody else flies."""
        self._back_at, self.deferred = math.inf, None

    def on_reply(self, reply: Reply) -> None:
        """Take over the vehicle's answer."""
        if reply.token != self._token or reply.ok:
            return
        self._refused = True
        self._aboard.tell(
            "alarm", f"the vehicle refused to go to a safe place as well ({reply.why}); take over"
        )

    def taken(self) -> str | None:
        """Who else flies it, in the mode that we asked for; None if it is there on our word."""
        aboard, target = self._aboard, self._aboard.telemetry.target
        if aboard.mode is not aboard.rules.goto_mode:
            self._since = math.inf
            return None
        self._since = min(self._since, aboard.session.wall())
        if target is None or target.arrived <= self._sent:
            return "someone else holds the vehicle" if self._refused and not self._open else None
        north, east = aboard.frame.to_map(target.latitude_deg, target.longitude_deg)
        there = math.hypot(north - self._place.north, east - self._place.east) <= ELSEWHERE
        self._seen = self._seen or there
        if there or (not self._seen and target.arrived <= self._since + SHOWN_WITHIN):
            return None
        return "someone else has sent the vehicle to another place than we did"

    @property
    def _open(self) -> bool:
        """True while it may still turn out that the vehicle is in that mode for somebody else."""
        return not self._seen and 0.0 <= self._aboard.session.wall() - self._since <= SHOWN_WITHIN
