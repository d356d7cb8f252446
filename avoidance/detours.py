"""From a blocked leg to the search for a way round it, and from the way found to a decision."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from avoidance.clusters import cluster_of
from avoidance.conflicts import wind_estimate
from avoidance.known import Known
from avoidance.ladder import Plan
from avoidance.parameters import Parameters
from avoidance.problem import WaypointProblem
from avoidance.route_check import Blocked
from avoidance.types import (
    Decision,
    Detour,
    Keep,
    Ownship,
    Performance,
    Reroute,
    Resume,
    Route,
    Rung,
    Waypoint,
)
from avoidance.words import detour_words, threat_words


def search_problem(
    own: Ownship,
    route: Route,
    known: Known,
    blocked: Blocked,
    performance: Performance,
    parameters: Parameters,
) -> tuple[WaypointProblem, int, int]:
    """The search for a way round: between which waypoints of the route, and what is known.

    Returns
    -------
    problem : WaypointProblem
        The search.
    begin, end : int
        The part route.waypoints[begin:end] that the detour replaces; what lies there was put in by earlier
        detours.
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
    avoided = np.flatnonzero(circles.rows[:, None] == blocked.blockers[:1])
    if len(avoided):
        links = circles.centres, circles.keep, parameters.link_distance, parameters.all_obstacles
        avoided = cluster_of(int(avoided[0]), *links)
    flown = sum(math.dist(a, b) for a, b in pairwise(places[: begin + 1]))
    problem = WaypointProblem(
        start=places[begin],
        target=places[end + 1],
        course=own.course if begin == 0 else None,
        before=None if begin == 0 else places[begin - 1],
        centres=circles.centres,
        keep=circles.keep,
        keep_waypoint=circles.keep_waypoint,
        walls=known.walls,
        avoided=avoided,
        intruders=known.intruders,
        delay=flown / performance.airspeed,
        wind=wind_estimate(own, performance),
        performance=performance,
        parameters=parameters,
    )
    return problem, begin, end


def fly_round(route: Route, blocked: Blocked, plan: Plan, begin: int, end: int) -> Decision:
    """The decision to fly a plan in place of route.waypoints[begin:end]."""
    altitude = route.waypoints[end].altitude
    new = tuple(Waypoint(north, east, altitude) for north, east in plan.waypoints)
    waypoints = (*route.waypoints[:begin], *new, *route.waypoints[end:])
    why = detour_words(blocked.threat, plan)
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


def _straight_on(blocked: Blocked, waypoints: tuple[Waypoint, ...], was_straight: bool) -> Decision:
    """The vehicle is already inside the margin and the straight way leads out of it."""
    why = f"{threat_words(blocked.threat)}; flying straight on is the way out"
    if was_straight:
        return Keep(why=why, threat=blocked.threat, rung=Rung.ROUTE)
    return Resume(why=why, threat=blocked.threat, rung=Rung.ROUTE, route=waypoints)
