"""The agent: one radar scan in, one decision out (Algorithm 1 as a state machine)."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np

from avoidance.free_space import nearest_free
from avoidance.known import Known, known_obstacles, within_reach
from avoidance.ladder import Plan, way_round
from avoidance.parameters import DEFAULT, Parameters
from avoidance.problem import WaypointProblem
from avoidance.route_check import Blocked, first_blocked_leg, first_conflict
from avoidance.tracking import Tracker, clusters
from avoidance.types import (
    Decision,
    Detour,
    Floats,
    Hold,
    Keep,
    Ownship,
    Performance,
    RadarScan,
    Replace,
    Reroute,
    Resume,
    Route,
    Rung,
    Waypoint,
)
from avoidance.words import detour_words, replace_words, threat_words

CLEAR = Keep(why="the route is clear")
HOLD_RADII = 1.5
"""Radius of a holding orbit in turn radii."""
PATIENCE = 8
"""A mission item that no route leads to is skipped after so many attempts from a holding orbit."""
RETRY = 5.0
"""While holding, or while a later leg is blocked, a way is looked for again after this time [s]."""


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
    ) -> None:
        self._performance = performance
        self._parameters = parameters
        self._rng = np.random.default_rng(0) if rng is None else rng
        self._tracker = Tracker(parameters)
        self._mission: dict[int, Waypoint] = {}
        self._checked: int | None = None
        self._failures = 0
        self._checked_route: Route | None = None
        self._avoiding_intruder = False
        self._holding = False
        self._retry_at = -math.inf

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
        if not route.waypoints:
            return CLEAR
        traffic = bool(picture.moving.any()) or self._avoiding_intruder
        unchanged = self._checked == picture.version and (self._holding or self._checked_route is route)
        if unchanged and not traffic and own.time < self._retry_at:
            return CLEAR
        self._learn(route)
        known = known_obstacles(picture, own, route, self._performance, self._parameters)
        decision = self._decide(own, route, known)
        if isinstance(decision, Keep | Hold):
            self._checked_route, self._checked = route, picture.version
        return decision

    def _decide(self, own: Ownship, route: Route, known: Known) -> Decision:
        self._retry_at = math.inf
        replaced = self._replace_waypoint(own, route, known)
        if replaced is not None:
            return replaced
        reachable = within_reach(known, own, self._performance)
        blocked = first_blocked_leg(own, route, reachable, self._performance)
        if blocked is None:
            blocked = first_conflict(own, route, reachable)
        if blocked is not None:
            return self._avoid(own, route, reachable, blocked)
        return self._resume(own, route, reachable)

    # --- mission waypoints that cannot be reached -----------------------------------------------------

    def _learn(self, route: Route) -> None:
        """Remember where the mission's own waypoints are, as uploaded."""
        for waypoint in route.waypoints:
            if waypoint.item is not None and not waypoint.moved:
                self._mission.setdefault(waypoint.item, waypoint)

    def _replace_waypoint(self, own: Ownship, route: Route, known: Known) -> Decision | None:
        """Move the first mission waypoint that is unsafe (Algorithm 4), or put one back."""
        if not len(known.keep):
            return None
        items = [(i, w) for i, w in enumerate(route.waypoints) if w.item is not None]
        room = self._waypoint_room()
        points = np.array([(w.north, w.east) for _, w in items])
        offset = points[:, None] - known.centres[None]
        distance = np.hypot(offset[..., 0], offset[..., 1])
        unsafe = distance < (known.keep + room - 1.0)[None]
        for row in np.flatnonzero(unsafe.any(axis=1)):
            index, waypoint = items[int(row)]
            if index == 0 and self._arriving(own, waypoint):
                continue
            near = np.flatnonzero(unsafe[row])
            near = near[np.argsort(distance[row, near])]
            return self._move(own, route, known, index, tuple(int(i) for i in known.ids[near]))
        return None

    def _waypoint_room(self) -> float:
        """Room beyond `keep` that a mission waypoint needs, so that it can be left again."""
        return self._performance.turn_room if self._parameters.all_obstacles else 0.0

    def _arriving(self, own: Ownship, waypoint: Waypoint) -> bool:
        """True if the waypoint is reached within the next two seconds anyway."""
        distance = math.hypot(waypoint.north - own.north, waypoint.east - own.east)
        return distance < self._performance.acceptance_radius + 2.0 * own.ground_speed

    def _move(
        self, own: Ownship, route: Route, known: Known, index: int, ids: tuple[int, ...]
    ) -> Decision | None:
        """Decide on the stand-in for a mission waypoint: the nearest safe point that can be reached."""
        waypoint = route.waypoints[index]
        original = self._mission.get(waypoint.item if waypoint.item is not None else -1, waypoint)
        here = (own.north, own.east)
        passing = np.minimum(known.keep, _distances(known, here) - 1.0)
        point = None
        for room in self._rooms():
            point = nearest_free(
                (original.north, original.east),
                here,
                known.centres,
                known.keep + room,
                np.maximum(passing, 0.0),
            )
            if point is not None:
                break
        before = route.waypoints[:index]
        while before and before[-1].item is None:
            before = before[:-1]  # a detour towards the old place has lost its purpose
        after = route.waypoints[index + 1 :]
        if point is None:
            return Replace(
                why=replace_words(original, None, ids),
                route=before + after,
                waypoint=None,
                rung=Rung.WAYPOINT,
            )
        chosen = replace(original, north=point[0], east=point[1], moved=True)
        if math.hypot(chosen.north - waypoint.north, chosen.east - waypoint.east) < 1.0:
            return None
        return Replace(
            why=replace_words(original, chosen, ids),
            route=(*before, chosen, *after),
            waypoint=chosen,
            rung=Rung.WAYPOINT,
        )

    def _rooms(self) -> tuple[float, ...]:
        """Room beyond `keep` that a stand-in is given, most wanted first."""
        turn = self._performance.turn_room
        if self._parameters.all_obstacles:
            return (turn, 0.5 * turn)
        return (self._parameters.tolerance - self._parameters.margin, turn)

    # --- blocked legs ---------------------------------------------------------------------------------

    def _avoid(self, own: Ownship, route: Route, known: Known, blocked: Blocked) -> Decision:
        problem, begin, end = self._problem(own, route, known, blocked)
        plan = way_round(problem, self._rng)
        if plan is None and blocked.threat.moving and len(known.intruders.required):
            plan = way_round(_least_separation(problem, self._parameters.moving_radius), self._rng)
        if plan is not None:
            return self._fly_round(route, blocked, plan, begin, end)
        if route.waypoints[end].item is not None and not blocked.threat.moving:
            walled_in = self._move(own, route, known, end, ())
            if walled_in is not None:
                return walled_in
        self._retry_at = own.time + RETRY
        if begin > 0 or blocked.threat.moving:
            words = f"{threat_words(blocked.threat)}; no way round is known yet"
            return Keep(why=words, threat=blocked.threat, rung=Rung.ORBIT)
        self._failures += 1
        if self._failures > PATIENCE and route.waypoints[end].item is not None:
            return self._skip(route, blocked, end)
        return self._hold(own, known, blocked)

    def _problem(
        self, own: Ownship, route: Route, known: Known, blocked: Blocked
    ) -> tuple[WaypointProblem, int, int]:
        """The search for a way round: between which waypoints of the route, and what is known.

        Returns the problem and the part route.waypoints[begin:end] that the detour replaces; what lies
        there was put in by earlier detours.
        """
        waypoints = route.waypoints
        end = blocked.leg
        while waypoints[end].item is None and end + 1 < len(waypoints):
            end += 1
        begin = blocked.leg
        while begin > 0 and waypoints[begin - 1].item is None:
            begin -= 1
        here = (own.north, own.east)
        places = [here, *((w.north, w.east) for w in waypoints)]
        labels = clusters(
            known.centres, known.keep, self._parameters.link_distance, self._parameters.all_obstacles
        )
        avoided = (
            np.flatnonzero(labels == labels[blocked.blockers[0]])
            if len(blocked.blockers)
            else np.empty(0, dtype=np.int64)
        )
        flown = sum(math.dist(a, b) for a, b in pairwise(places[: begin + 1]))
        problem = WaypointProblem(
            start=places[begin],
            target=places[end + 1],
            course=own.course if begin == 0 else None,
            before=None if begin == 0 else places[begin - 1],
            centres=known.centres,
            keep=known.keep,
            keep_waypoint=known.keep_waypoint,
            avoided=avoided,
            intruders=known.intruders,
            delay=flown / self._performance.airspeed,
            performance=self._performance,
            parameters=self._parameters,
        )
        return problem, begin, end

    def _fly_round(self, route: Route, blocked: Blocked, plan: Plan, begin: int, end: int) -> Decision:
        altitude = route.waypoints[end].altitude
        new = tuple(Waypoint(north, east, altitude) for north, east in plan.waypoints)
        waypoints = (*route.waypoints[:begin], *new, *route.waypoints[end:])
        why = detour_words(blocked.threat, plan)
        self._avoiding_intruder = blocked.threat.moving
        self._holding = False
        self._failures = 0
        if not new:
            return _straight_on(blocked, waypoints, was_straight=begin == end)
        if len(new) == 1:
            return Detour(
                why=why,
                threat=blocked.threat,
                rung=plan.rung,
                route=waypoints,
                search=plan.search,
                waypoint=new[0],
            )
        return Reroute(
            why=why, threat=blocked.threat, rung=plan.rung, route=waypoints, search=plan.search, waypoints=new
        )

    def _skip(self, route: Route, blocked: Blocked, end: int) -> Decision:
        """Give up a mission item that no route leads to."""
        self._failures = 0
        self._holding = False
        return Replace(
            why=f"{threat_words(blocked.threat)}; no route to waypoint "
            f"{(route.waypoints[end].item or 0) + 1} can be flown, so it is skipped",
            threat=blocked.threat,
            rung=Rung.ORBIT,
            route=route.waypoints[end + 1 :],
            waypoint=None,
        )

    # --- waiting, and going on --------------------------------------------------------------------------

    def _hold(self, own: Ownship, known: Known, blocked: Blocked) -> Decision:
        """Orbit on the side with more room."""
        words = f"{threat_words(blocked.threat)}; no way round is known, hold here"
        if self._holding:
            return Keep(why=words, threat=blocked.threat, rung=Rung.ORBIT)
        self._holding = True
        radius = HOLD_RADII * self._performance.turn_radius
        centre, direction, most = (own.north, own.east), 1, -math.inf
        for side in (1, -1):
            angle = own.course + side * 0.5 * math.pi
            point = (own.north + radius * math.cos(angle), own.east + radius * math.sin(angle))
            room = float((_distances(known, point) - known.keep).min(initial=math.inf))
            if room > most:
                centre, direction, most = point, side, room
        return Hold(
            why=words,
            threat=blocked.threat,
            rung=Rung.ORBIT,
            centre=Waypoint(centre[0], centre[1], own.altitude),
            radius=radius,
            direction=direction,
        )

    def _resume(self, own: Ownship, route: Route, known: Known) -> Decision:
        """End a hold, or undo a detour round an intruder that has passed."""
        if self._holding:
            self._holding = False
            self._failures = 0
            return Resume(why="the way is clear again", route=route.waypoints)
        if not self._avoiding_intruder:
            return CLEAR
        ahead = 0
        while ahead < len(route.waypoints) and route.waypoints[ahead].item is None:
            ahead += 1
        if ahead == 0:
            self._avoiding_intruder = False
            return CLEAR
        here = Waypoint(own.north, own.east, own.altitude)
        direct = Route(origin=here, waypoints=route.waypoints[ahead:])
        if first_blocked_leg(own, direct, known, self._performance, 0.0) is not None:
            return CLEAR
        if first_conflict(own, direct, known, resuming=True) is not None:
            return CLEAR
        self._avoiding_intruder = False
        return Resume(why="the intruder has passed", route=direct.waypoints)


def _straight_on(blocked: Blocked, waypoints: tuple[Waypoint, ...], was_straight: bool) -> Decision:
    """The vehicle is already inside the margin and the straight way leads out of it."""
    why = f"{threat_words(blocked.threat)}; flying straight on is the way out"
    if was_straight:
        return Keep(why=why, threat=blocked.threat, rung=Rung.ROUTE)
    return Resume(why=why, threat=blocked.threat, rung=Rung.ROUTE, route=waypoints)


def _distances(known: Known, point: tuple[float, float]) -> Floats:
    return np.hypot(known.centres[:, 0] - point[0], known.centres[:, 1] - point[1])


def _least_separation(problem: WaypointProblem, radius: float) -> WaypointProblem:
    """The same search, content with the violation radius instead of d + h."""
    intruders = problem.intruders
    required = np.minimum(intruders.required, radius + 50.0)
    return replace(problem, intruders=replace(intruders, required=required))
