"""The agent: one radar scan in, one decision out (Algorithm 1 as a state machine)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from avoidance.conflicts import first_conflict, to_be_avoided
from avoidance.contingency import first_trap
from avoidance.escape import Escape
from avoidance.geofence import OPEN, Geofence
from avoidance.holding import NoWay, Vigil, no_room_yet, skipped
from avoidance.known import Known, keep_what_can_be_kept, kept_margin, known_obstacles, within_fence
from avoidance.ladder import Way, way_round
from avoidance.orbits import orbit_on_arrival
from avoidance.parameters import DEFAULT, Parameters
from avoidance.passages import Gap, way_with_orbits
from avoidance.rally import Rally
from avoidance.replacement import Replacements
from avoidance.return_to_leg import ReturnToLeg
from avoidance.route_check import Blocked, first_blocked_leg
from avoidance.second_thoughts import SecondThoughts, second_words
from avoidance.sides import SMALL, Sides, end_words
from avoidance.tracking import Tracker
from avoidance.types import (
    Bools,
    Decision,
    Detour,
    Hold,
    Ints,
    Keep,
    Ownship,
    Performance,
    RadarScan,
    Resume,
    Route,
    Rung,
    Waypoint,
)
from avoidance.words import obstacles, threat_words

CLEAR = Keep(why="the route is clear")
RETRY = 3.0
"""While holding, or while a later leg is blocked, a way is looked for again after this time [s]."""
LATER = 2000.0
"""A later leg that is blocked further ahead than this does not stop the vehicle yet [m] ..."""
STEADY = 500.0
"""... and does not end a hold unless it is so much further, for its distance changes on an orbit [m]."""


class Agent:
    """Sense and avoid for one vehicle.

    Parameters
    ----------
    performance : Performance
        What the vehicle can fly.
    parameters : Parameters, optional
        A preset; see `avoidance.parameters.PRESETS`.
    rng : numpy.random.Generator, optional
        The planner's randomness; seed 0 unless given.
    way : callable, optional
        Finds the way round; another planner than the ladder of single waypoints.
    geofence : Geofence, optional
        Bounds every detour, route, stand-in and orbit.
    rally : sequence of Waypoint, optional
        Rally points: where to wait if no way is free, rather than on the spot.

    Notes
    -----
    Algorithm 1, one pass per scan: track, look at the route, and if it cannot be flown decide on one
    change. Mission waypoints that cannot be reached come first (Algorithm 4), then the first blocked leg,
    then intruders. Differs from the paper: E25, legs are sequenced by the vehicle alone, once; the whole
    remaining route is looked at, not only the current leg.
    """

    def __init__(
        self,
        performance: Performance,
        parameters: Parameters = DEFAULT,
        rng: np.random.Generator | None = None,
        way: Way = way_round,
        geofence: Geofence = OPEN,
        rally: Sequence[Waypoint] = (),
    ) -> None:
        parameters = replace(parameters, margin=kept_margin(parameters, performance))
        self._performance = performance
        self._parameters = parameters
        self._rng = np.random.default_rng(0) if rng is None else rng
        self._way = way
        self._geofence = geofence
        self._tracker = Tracker(parameters)
        self._traffic = ReturnToLeg(performance)
        self._escape = Escape(performance)
        self._replacements = Replacements(performance, parameters, geofence)
        self._second_thoughts = SecondThoughts()
        self._sides = Sides()
        self._vigil = Vigil(Rally(rally, performance, parameters))
        self._checked: int | None = None
        self._checked_route: Route | None = None
        self._avoiding: frozenset[int] = frozenset()
        self._version = 0
        self._retry_at = -math.inf
        self._no_way = NoWay()
        self._rest_version = -1
        self._rest_route: Route | None = None
        self._flown_clear_of: Ints = np.empty(0, dtype=np.int64)

    def decide(self, own: Ownship, route: Route, scan: RadarScan) -> Decision:
        """Decide about one scan.

        Parameters
        ----------
        own : Ownship
            State of the vehicle at the time of the scan.
        route : Route
            What it is to fly from here.
        scan : RadarScan
            What the radar saw.

        Returns
        -------
        Decision
            `Keep` nearly always.
        """
        picture = self._tracker.update(scan, own)
        self._sides.look(own, scan)
        if not route.waypoints:
            return CLEAR
        traffic = bool(picture.moving.any())
        self._vigil.look(route)
        self._version = picture.version
        unchanged = self._checked == picture.version and (
            self._vigil.under_way or self._checked_route is route
        )
        if unchanged and not traffic and own.time < self._retry_at:
            return CLEAR
        self._replacements.learn(route)
        known = known_obstacles(picture, own, route, self._performance, self._parameters)
        known = within_fence(known, self._geofence, own, self._parameters)
        at_rest = self._rest_version == picture.version and self._rest_route is route
        watching = traffic and at_rest and not self._vigil.under_way
        decision = self._watch(own, route, known) if watching else self._decide(own, route, known)
        self._second_thoughts.learn(decision, known)
        if decision is CLEAR:
            self._rest_version, self._rest_route = picture.version, route
        if decision is CLEAR or decision.route is not None:
            self._flown_clear_of = known.ids
        if isinstance(decision, Keep | Hold):
            self._checked_route, self._checked = route, picture.version
        if decision.route is not None:
            self._vigil.stop()  # a new route ends a hold
        return decision

    def _watch(self, own: Ownship, route: Route, known: Known) -> Decision:
        """As `_decide` where nothing has changed of what stands still and of the route: traffic alone."""
        blocked = first_conflict(own, route, known, self._performance)
        if blocked is None:
            return self._resume(own, route, known)
        return self._avoid(own, route, keep_what_can_be_kept(known, own, self._performance), blocked)

    def _decide(self, own: Ownship, route: Route, known: Known) -> Decision:
        self._retry_at = math.inf
        escape = self._escape.decide(own, route, known)
        if escape is not None:
            return escape
        replaced = self._replacements.decide(own, route, known, self._version)
        if replaced is not None:
            return replaced
        known = keep_what_can_be_kept(known, own, self._performance)
        slack = 0.0 if self._vigil.under_way else 1.0  # who circles would have to take the route up
        news = self._news(known)
        blocked = first_blocked_leg(own, route, known, self._performance, slack=slack, strict=news)
        uncut = route if blocked is None else replace(route, waypoints=route.waypoints[: blocked.leg])
        blocked = first_trap(own, uncut, known, self._performance, self._parameters) or blocked
        if blocked is None:
            blocked = first_conflict(own, route, known, self._performance)
        if blocked is not None:
            return self._avoid(own, route, known, blocked)
        again = self._choose_again(own, route, known) or self._round_the_end(own, route, known)
        return self._resume(own, route, known) if again is None else again

    def _news(self, known: Known) -> Bools:
        """What is new: there is no slack for it, which is for straying from a route found to be clear."""
        return np.isin(known.ids, self._flown_clear_of, invert=True)

    def _avoid(self, own: Ownship, route: Route, known: Known, blocked: Blocked) -> Decision:
        if blocked.threat.moving:
            known = to_be_avoided(own, route, known, self._performance)
        gap = Gap.of(own, route, known, blocked, self._performance, self._parameters)
        if not (blocked.threat.moving or self._vigil.under_way) and self._no_way.lasts(
            own, route, self._version
        ):
            return self._without_way(gap)
        still = self._parameters.memory and not blocked.threat.moving
        way = way_with_orbits(gap, self._sides.way(self._way) if still else self._way, self._rng)
        if way is not None:
            if still and way.route is not None:
                self._sides.chosen(gap.problem, blocked, gap.taken(way))
            self._avoiding = frozenset(blocked.threat.ids)
            self._traffic.avoiding(blocked.threat.ids)
            self._vigil.end()
            return way
        if gap.target.item is not None and not blocked.threat.moving:
            walled_in = self._move(gap, gap.end)
            if walled_in is not None:
                return walled_in
        self._no_way = self._no_way.again(own, route, self._version)
        return self._without_way(gap)

    def _without_way(self, gap: Gap) -> Decision:
        """What to do as long as no way round is known; it is thought over again after a while."""
        threat = gap.blocked.threat
        self._retry_at = gap.own.time + RETRY
        if self._vigil.under_way and self._vigil.cut_off(gap):
            return self._hold(gap)
        if not (threat.moving or self._can_fly_on(gap)):
            return self._wait(gap)
        words = f"{threat_words(threat)}; no way round is known yet"
        if threat.moving or not self._vigil.under_way:
            return Keep(why=words, threat=threat, rung=Rung.ORBIT)
        self._vigil.end()
        return Resume(why=words, threat=threat, rung=Rung.ORBIT, route=gap.route.waypoints)

    def _can_fly_on(self, gap: Gap) -> bool:
        """True if it is time enough to wait at the waypoint from where no way on is known.

        More may be seen from there, and a circle can be left in any direction.
        """
        before = gap.problem.before
        if before is None:
            return False
        later = LATER + STEADY if self._vigil.under_way else LATER
        waypoint = gap.route.waypoints[gap.begin - 1]
        return gap.blocked.threat.distance > later or orbit_on_arrival(
            before, waypoint, gap.known, self._performance
        )

    def _choose_again(self, own: Ownship, route: Route, known: Known) -> Decision | None:
        """Another waypoint that meets every constraint, where one put in no longer does."""
        doubt = self._second_thoughts.first(own, route, known)
        if doubt is None or self._vigil.under_way:
            return None
        gap = Gap.of(own, route, known, doubt, self._performance, self._parameters)
        way = way_with_orbits(gap, self._sides.way(self._way), self._rng)
        if not isinstance(way, Detour) or way.rung is not Rung.WAYPOINT:
            return None
        self._sides.chosen(gap.problem, doubt, gap.taken(way))
        self._avoiding |= frozenset(doubt.threat.ids)
        return replace(way, why=second_words(doubt.threat, way))

    def _round_the_end(self, own: Ownship, route: Route, known: Known) -> Decision | None:
        """A shorter way where more of a hill was expected than there is: its end has come into view."""
        hill = None if self._vigil.under_way else self._sides.expected(route, known)
        if hill is None:
            return None
        gap = Gap.of(own, route, known, hill, self._performance, self._parameters)
        left = self._sides.ends_left(gap.problem)
        if left != 0:  # an end comes into view by looking, whether or not anything is new
            self._retry_at = own.time + RETRY
        if left is None:
            return None
        planner = self._sides.way(self._way) if left else self._way
        way = way_with_orbits(gap, planner, self._rng)
        if way is None or way.route is None or gap.saving(way) < SMALL:
            return None
        self._sides.chosen(gap.problem, hill, gap.taken(way))
        return replace(way, why=end_words(hill.threat, way))

    def _move(self, gap: Gap, index: int) -> Decision | None:
        """Another stand-in for a waypoint that no way leads to, or out of."""
        altitude = gap.route.waypoints[index].altitude
        circles = gap.known.circles(altitude, altitude)
        return self._replacements.move(gap.own, gap.route, circles, index, ())

    def _wait(self, gap: Gap) -> Decision:
        """Hold in free space, or fly on until there is room to; after a while give the waypoint up."""
        if not self._vigil.under_way:
            return self._hold(gap)
        index = gap.begin - 1 if gap.begin else gap.end  # what nothing leads out of, or nothing into
        waypoint = gap.route.waypoints[index]
        if not self._vigil.tired(gap.own) or waypoint.item is None:
            return self._vigil.words(gap)
        self._vigil.end()
        moved = self._move(gap, index) if self._replacements.ask_for_wide_ways(waypoint) else None
        return skipped(gap.route, gap.blocked, index) if moved is None else moved

    def _hold(self, gap: Gap) -> Decision:
        """Wait at a rally point that can be reached, else here as soon as there is room to."""
        hold = self._vigil.begin(gap)
        if hold is None:
            self._retry_at = gap.own.time
            return no_room_yet(gap.blocked)
        return hold

    def _resume(self, own: Ownship, route: Route, known: Known) -> Decision:
        """End a hold, or undo a detour whose reason has gone: the intruder passed, a false track died."""
        if self._vigil.under_way:
            self._vigil.end()
            return Resume(why="the way is clear again", route=route.waypoints)
        direct = tuple(w for w in route.waypoints if w.item is not None)
        if direct == route.waypoints:
            self._avoiding = frozenset()
        if not direct or not self._avoiding or not self._avoiding.isdisjoint(known.ids.tolist()):
            return CLEAR
        self._retry_at = own.time  # ask again at the next scan, whether or not anything new is seen
        ahead = next(i for i, w in enumerate(route.waypoints) if w.item is not None)
        straight = Route(Waypoint(own.north, own.east, own.altitude), route.waypoints[ahead:])
        if ahead == 0 or not self._traffic.allows(own, straight, known, self._avoiding):
            return CLEAR
        blocked = first_blocked_leg(own, straight, known, self._performance, slack=0.0)
        if blocked or first_trap(own, straight, known, self._performance, self._parameters):
            return CLEAR
        who = obstacles(tuple(sorted(self._avoiding)))
        self._avoiding = frozenset()
        return Resume(why=f"{who} is no longer in the way", route=straight.waypoints)
