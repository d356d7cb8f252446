"""Flying a mission: from leg to leg, without a word about protocols."""

from __future__ import annotations

import math
from collections.abc import Callable

from avoidance import Waypoint
from offboard.link import PlantState
from offboard.orbit import Orbit
from offboard.sequencer import Progress, advance, begin_leg, next_leg
from offboard.sitl.plan import Kind, Leg, Plan

TAKEOFF_TOLERANCE = 2.0
"""A climb is over this far below its altitude, which is approached ever more slowly [m]."""
GLIDE_SLOPE = math.radians(4.0)
"""Descent angle of an approach [rad]."""
AHEAD = 1000.0
"""How far ahead a line is drawn that is flown straight on [m]."""

Course = tuple[float, float, float, float, float, float]
"""A leg as a plant takes it: from and to (north, east) [m], altitude [m], airspeed [m/s]."""


class MissionFlight:
    """Which leg is flown, and what the plant must be told.

    Parameters
    ----------
    reached : callable
        Told the seq of each item that has been reached, at most once per visit.
    """

    def __init__(self, reached: Callable[[int], None]) -> None:
        self.plan = Plan()
        self._reached = reached
        self._progress = Progress(0, Waypoint(0.0, 0.0, 0.0))
        self._jumped: dict[int, int] = {}

    @property
    def leg(self) -> Leg | None:
        """The leg being flown; None if all have been."""
        index = self._progress.current
        return self.plan.legs[index] if index < len(self.plan.legs) else None

    @property
    def finished(self) -> bool:
        """True once the last leg has ended."""
        return bool(self.plan.legs) and self._progress.current >= len(self.plan.legs)

    @property
    def circling(self) -> bool:
        """True while the aircraft stays at a leg's end."""
        return self._progress.loiter_until is not None

    @property
    def stays(self) -> bool:
        """True at the end of a mission that ends in a circle."""
        leg = self.leg
        return leg is not None and leg.kind is Kind.CIRCLE and self.circling

    def begin(self, seq: int, state: PlantState) -> None:
        """Fly to item `seq`, or the next one that is flown, from here."""
        self._begin(self.plan.index_of(seq), state)

    def replace(self, plan: Plan, seq: int) -> None:
        """Another plan under way, in which the present leg, now item `seq`, goes on as it is."""
        self.plan = plan
        self._progress = Progress(plan.index_of(seq), self._progress.origin, self._progress.loiter_until)

    def step(self, state: PlantState) -> None:
        """Change legs if the present one has ended."""
        while (leg := self.leg) is not None:
            if leg.kind is Kind.TAKEOFF:
                if state.altitude < leg.target.waypoint.altitude - TAKEOFF_TOLERANCE:
                    return
                self._reached(leg.seq)
                if self._hop(state):
                    return
            else:
                before, last = self._progress, self._last_before_hop()
                after = advance(before, self.plan.targets[: last + 1], _place(state), state.time)
                if after is before:
                    return
                for index in range(before.current, after.current):
                    self._reached(self.plan.legs[index].seq)
                self._progress = after
                if after.current <= last:
                    return
                self._progress = Progress(last, after.origin)
                if self._hop(state):
                    return

    def landed(self) -> None:
        """The aircraft is on the ground: a landing has ended."""
        if (leg := self.leg) is not None and leg.kind is Kind.LAND:
            self._reached(leg.seq)
            self._progress = Progress(len(self.plan.legs), self._progress.origin)

    def command(self, state: PlantState) -> Course | Orbit | None:
        """What the plant is to fly; None if the mission has ended."""
        leg = self.leg
        if leg is None:
            return None
        end = leg.target.waypoint
        if leg.kind is Kind.LAND:
            line = self._line(leg)
            altitude = end.altitude + _left(line, state) * math.tan(GLIDE_SLOPE)
            return (*line, min(altitude, max(state.altitude, end.altitude)), leg.target.airspeed)
        if self.circling:
            return Orbit.about(end, leg.radius, leg.direction)
        return (*self._line(leg), end.altitude, leg.target.airspeed)

    def _line(self, leg: Leg) -> tuple[float, float, float, float]:
        origin, end = self._progress.origin, leg.target.waypoint
        return origin.north, origin.east, end.north, end.east

    def _begin(self, index: int, state: PlantState) -> None:
        """Fly to a leg's end from here."""
        self._progress = begin_leg(index, state.north, state.east, state.altitude)

    def _last_before_hop(self) -> int:
        """The leg up to which sequencing may go by itself: a jump follows, or a leg that ends otherwise."""
        legs, last = self.plan.legs, len(self.plan.legs) - 1
        return next(
            (
                index
                for index in range(self._progress.current, last)
                if index in self.plan.jumps or legs[index].kind is not Kind.POINT
            ),
            last,
        )

    def _hop(self, state: PlantState) -> bool:
        """Go on from a leg that has ended to the one behind it, or to where a jump leads.

        True after a jump: no more than one a step, for it may lead to where the aircraft is.
        """
        ended = self._progress.current
        following = ended + 1
        if ended in self.plan.jumps:
            seq, times = self.plan.jumps[ended]
            done = self._jumped.get(ended, 0)
            if times < 0 or done < times:
                self._jumped[ended] = done + 1
                self._begin(self.plan.index_of(max(seq, 0)), state)
                return True
        left = self.plan.legs[ended]
        if left.kind is Kind.TAKEOFF:
            self._begin(following, state)
        else:
            self._progress = next_leg(following, left.target.waypoint, self.plan.targets, _place(state))
        return False


def _place(state: PlantState) -> tuple[float, float, float]:
    return state.north, state.east, state.altitude


def _left(line: tuple[float, float, float, float], state: PlantState) -> float:
    """Distance still to go along a line [m]; negative beyond its end."""
    from_north, from_east, to_north, to_east = line
    course = math.atan2(to_east - from_east, to_north - from_north)
    return (to_north - state.north) * math.cos(course) + (to_east - state.east) * math.sin(course)
