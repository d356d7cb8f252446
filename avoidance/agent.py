"""The agent: one radar scan in, one decision out (Algorithm 1 as a state machine)."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np

from avoidance.free_space import free_candidates, nearest_free
from avoidance.geometry import segments_clearance
from avoidance.known import Circles, Known, keep_what_can_be_kept, known_obstacles
from avoidance.ladder import Plan, way_round, widest_way
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
    Threat,
    Waypoint,
)
from avoidance.words import detour_words, obstacles, replace_words, threat_words

CLEAR = Keep(why="the route is clear")
HOLD_RADII = 1.5
"""Radius of a holding orbit in turn radii."""
PATIENCE = 8
"""A mission item that no route leads to is skipped after so many attempts from a holding orbit."""
MOST_WAYS_OUT = 200
"""Points looked at for a way out of a sphere."""
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
        self._avoiding: frozenset[int] = frozenset()
        self._escaping = False
        self._version = 0
        self._reconsidered = 0
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
        traffic = bool(picture.moving.any())
        self._version = picture.version
        unchanged = self._checked == picture.version and (self._holding or self._checked_route is route)
        if unchanged and not traffic and own.time < self._retry_at:
            return CLEAR
        self._learn(route)
        known = known_obstacles(picture, own, route, self._performance, self._parameters)
        decision = self._decide(own, route, known)
        if isinstance(decision, Keep | Hold):
            self._checked_route, self._checked = route, picture.version
        if decision.route is not None:
            self._holding = False  # a new route ends a hold
        return decision

    def _decide(self, own: Ownship, route: Route, known: Known) -> Decision:
        self._retry_at = math.inf
        escape = self._escape(own, route, known)
        if escape is not None:
            return escape
        replaced = self._replace_waypoint(own, route, known)
        if replaced is not None:
            return replaced
        known = keep_what_can_be_kept(known, own, self._performance)
        blocked = first_blocked_leg(own, route, known, self._performance)
        if blocked is None:
            blocked = first_conflict(own, route, known)
        if blocked is not None:
            return self._avoid(own, route, known, blocked)
        return self._resume(own, route, known)

    # --- inside a sphere ------------------------------------------------------------------------------

    def _escape(self, own: Ownship, route: Route, known: Known) -> Decision | None:
        """Leave a sphere that appeared round the vehicle by the shortest way."""
        circles = known.circles(own.altitude, own.altitude)
        here = np.array([own.north, own.east])
        offset = here - circles.centres
        distance = np.hypot(offset[:, 0], offset[:, 1])
        depth = circles.keep - known.margin[circles.rows] - distance
        if not (depth > 0.0).any():
            self._escaping = False
            return None
        if self._escaping and route.waypoints[0].item is None:
            return CLEAR
        self._escaping = True
        deepest = int(np.argmax(depth))
        point = self._way_out((own.north, own.east), circles)
        if point is None:
            return None
        threat = Threat(
            ids=(int(known.ids[circles.rows[deepest]]),),
            leg=0,
            distance=0.0,
            time=0.0,
            clearance=float(distance[deepest]),
            required=float(circles.keep[deepest]),
        )
        waypoint = Waypoint(point[0], point[1], own.altitude)
        own_items = tuple(w for w in route.waypoints if w.item is not None)
        return Detour(
            why=f"{obstacles(threat.ids)} appeared round the vehicle; leave by the shortest way",
            threat=threat,
            rung=Rung.CLOSE,
            route=(waypoint, *own_items),
            waypoint=waypoint,
        )

    def _way_out(self, here: tuple[float, float], circles: Circles) -> tuple[float, float] | None:
        """The nearest point, with room to turn if there is one, reached straight without going deeper."""
        present = np.minimum(circles.keep, _distances(circles.centres, here)) - 1.0
        for room in (self._performance.turn_room, 0.0):
            points = free_candidates(here, circles.centres, circles.keep + room)[:MOST_WAYS_OUT]
            starts = np.broadcast_to(np.array(here), points.shape)
            deeper = segments_clearance(starts, points, circles.centres) < present
            straight = np.flatnonzero(~deeper.any(axis=1))
            if len(straight):
                return float(points[straight[0], 0]), float(points[straight[0], 1])
        return None

    # --- mission waypoints that cannot be reached -----------------------------------------------------

    def _learn(self, route: Route) -> None:
        """Remember where the mission's own waypoints are, as uploaded last."""
        for waypoint in route.waypoints:
            if waypoint.item is not None and not waypoint.moved:
                self._mission[waypoint.item] = waypoint

    def _replace_waypoint(self, own: Ownship, route: Route, known: Known) -> Decision | None:
        """Move the first mission waypoint that is unsafe (Algorithm 4), or put back one that is not."""
        if not len(known.ids) and not any(w.moved for w in route.waypoints):
            return None
        room = self._waypoint_room()
        circles: dict[float, Circles] = {}
        for index, waypoint in enumerate(route.waypoints):
            if waypoint.item is None or (index == 0 and self._arriving(own, waypoint)):
                continue
            height = waypoint.altitude
            if height not in circles:
                circles[height] = known.circles(height, height)
            near = circles[height]
            distance = _distances(near.centres, (waypoint.north, waypoint.east))
            unsafe = np.flatnonzero(distance < near.keep + room - 1.0)
            unsafe = unsafe[np.argsort(distance[unsafe], kind="stable")]
            reconsider = waypoint.moved and self._reconsidered != self._version
            if not len(unsafe) and not reconsider:
                continue
            ids = tuple(dict.fromkeys(known.ids[near.rows[unsafe]].tolist()))
            decision = self._move(own, route, near, index, ids)
            if decision is not None:
                return decision
        self._reconsidered = self._version
        return None

    def _waypoint_room(self) -> float:
        """Room beyond `keep` that a mission waypoint needs, so that it can be left again."""
        return self._performance.turn_room if self._parameters.all_obstacles else 0.0

    def _arriving(self, own: Ownship, waypoint: Waypoint) -> bool:
        """True if the waypoint is reached within the next two seconds anyway."""
        distance = math.hypot(waypoint.north - own.north, waypoint.east - own.east)
        return distance < self._performance.acceptance_radius + 2.0 * own.ground_speed

    def _move(
        self, own: Ownship, route: Route, circles: Circles, index: int, ids: tuple[int, ...]
    ) -> Decision | None:
        """Decide on the stand-in for a mission waypoint: the nearest safe point that can be reached."""
        waypoint = route.waypoints[index]
        original = self._mission.get(-1 if waypoint.item is None else waypoint.item, waypoint)
        here = (own.north, own.east)
        passing = np.maximum(np.minimum(circles.keep, _distances(circles.centres, here) - 1.0), 0.0)
        place = (original.north, original.east)
        point = None
        for room in self._rooms():
            point = nearest_free(place, here, circles.centres, circles.keep + room, passing)
            if point is not None:
                break
        if point is None or math.dist(point, (waypoint.north, waypoint.east)) < 1.0:
            return None
        before = route.waypoints[:index]
        while before and before[-1].item is None:
            before = before[:-1]  # a detour towards the old place has lost its purpose
        back = math.dist(point, place) < 1e-6
        chosen = original if back else replace(original, north=point[0], east=point[1], moved=True)
        return Replace(
            why=replace_words(original, chosen, ids),
            route=(*before, chosen, *route.waypoints[index + 1 :]),
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
        if plan is None and len(known.intruders.required):
            plan = widest_way(problem, self._rng)
        if plan is not None:
            return self._fly_round(route, blocked, plan, begin, end)
        if route.waypoints[end].item is not None and not blocked.threat.moving:
            height = route.waypoints[end].altitude
            walled_in = self._move(own, route, known.circles(height, height), end, ())
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
        places = [(own.north, own.east), *((w.north, w.east) for w in waypoints)]
        heights = (waypoints[begin - 1].altitude if begin else own.altitude, waypoints[end].altitude)
        circles = known.circles(min(heights), max(heights))
        labels = clusters(
            circles.centres, circles.keep, self._parameters.link_distance, self._parameters.all_obstacles
        )
        nearest = np.flatnonzero(np.isin(circles.rows, blocked.blockers[:1]))
        avoided = np.flatnonzero(labels == labels[nearest[0]]) if len(nearest) else nearest
        flown = sum(math.dist(a, b) for a, b in pairwise(places[: begin + 1]))
        problem = WaypointProblem(
            start=places[begin],
            target=places[end + 1],
            course=own.course if begin == 0 else None,
            before=None if begin == 0 else places[begin - 1],
            centres=circles.centres,
            keep=circles.keep,
            keep_waypoint=circles.keep_waypoint,
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
        self._avoiding = frozenset(blocked.threat.ids)
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
        circles = known.circles(own.altitude, own.altitude)
        for side in (1, -1):
            angle = own.course + side * 0.5 * math.pi
            point = (own.north + radius * math.cos(angle), own.east + radius * math.sin(angle))
            room = float((_distances(circles.centres, point) - circles.keep).min(initial=math.inf))
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
        """End a hold, or undo a detour whose reason has gone: the intruder passed, a false track died."""
        if self._holding:
            self._holding = False
            self._failures = 0
            return Resume(why="the way is clear again", route=route.waypoints)
        direct = tuple(w for w in route.waypoints if w.item is not None)
        if direct == route.waypoints:
            self._avoiding = frozenset()
        if not direct or not self._avoiding or not self._avoiding.isdisjoint(known.ids.tolist()):
            return CLEAR
        self._retry_at = own.time  # ask again at the next scan, whether or not anything new is seen
        ahead = next(i for i, w in enumerate(route.waypoints) if w.item is not None)
        straight = Route(Waypoint(own.north, own.east, own.altitude), route.waypoints[ahead:])
        blocked = first_blocked_leg(own, straight, known, self._performance, slack=0.0)
        if ahead == 0 or blocked or first_conflict(own, straight, known, resuming=True):
            return CLEAR
        who = obstacles(tuple(sorted(self._avoiding)))
        self._avoiding = frozenset()
        return Resume(why=f"{who} is no longer in the way", route=straight.waypoints)


def _straight_on(blocked: Blocked, waypoints: tuple[Waypoint, ...], was_straight: bool) -> Decision:
    """The vehicle is already inside the margin and the straight way leads out of it."""
    why = f"{threat_words(blocked.threat)}; flying straight on is the way out"
    if was_straight:
        return Keep(why=why, threat=blocked.threat, rung=Rung.ROUTE)
    return Resume(why=why, threat=blocked.threat, rung=Rung.ROUTE, route=waypoints)


def _distances(centres: Floats, point: tuple[float, float]) -> Floats:
    return np.hypot(centres[:, 0] - point[0], centres[:, 1] - point[1])
