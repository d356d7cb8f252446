"""From a blocked leg to a way round it: one waypoint if there is one, else the exact planner's route.

Constraints are given up in a fixed, reported order: the turn limit (g4), the search limit (g2), the
tolerance (g1); never RS. Then comes a route of several waypoints, then none: the caller must hold. A
waypoint that keeps the tolerance but costs much more than one without, or than the exact route, gives way
to it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from avoidance.exact_route import Corners, exact_route, flyable, length_by
from avoidance.geometry import point_distances, segment_point_distance
from avoidance.problem import WaypointProblem
from avoidance.search import search_waypoint
from avoidance.tangent_graph import shortest_path
from avoidance.traffic_route import two_waypoints
from avoidance.types import Rung, Search

RUNGS: tuple[tuple[Rung, frozenset[str]], ...] = (
    (Rung.WAYPOINT, frozenset()),
    (Rung.WIDE_TURN, frozenset({"g4"})),
    (Rung.FAR, frozenset({"g4", "g2"})),
    (Rung.CLOSE, frozenset({"g4", "g2", "g1"})),
)
"""Single-waypoint rungs and the constraints given up on each."""

ROOM_LEFT = 50.0
"""A separation from an intruder is worth a change of route if it is better by this [m]."""

IN_TRAFFIC = 150.0
"""With intruders about, no plan gives way to one that is shorter by less than this [m]."""
LONG_WAY = 600.0
"""Round several intruders, two waypoints are tried as well where one is longer than the straight way by more
than this [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """A way round."""

    rung: Rung
    """How far down the ladder it was found."""
    waypoints: Corners
    """New waypoints in order, north and east [m]."""
    search: Search
    """The waypoint search made first (with every constraint), or the one that found the waypoint."""
    saved: float = 0.0
    """How much longer the way on an earlier rung is that it was preferred to [m]; 0 if there was none."""
    expecting: bool = False
    """True if what it goes round is expected to go on where nobody has looked."""


Way = Callable[[WaypointProblem, np.random.Generator], Plan | None]
"""Whatever finds a way round, or None; draws from the generator."""


def way_round(problem: WaypointProblem, rng: np.random.Generator) -> Plan | None:
    """The first rung on which there is a way, or None.

    Parameters
    ----------
    problem : WaypointProblem
        The search with every constraint.
    rng : numpy.random.Generator
        The planner's randomness.
    """
    search = None
    for rung, relaxed in RUNGS if len(problem.centres) else RUNGS[:2]:
        search = search_waypoint(problem.relaxing(relaxed), rng)
        if search.found is not None:
            return _cheapest(problem, Plan(rung, (search.found,), search), rng)
        if rung is RUNGS[0][0] and not _any_way(problem):
            return None
    route = _kept_from_intruders(problem, exact_route(problem))
    if route is None and len(problem.intruders):
        route, lacking = _through_traffic(problem, rng)
        route = route if lacking <= 0.0 else None
    return None if route is None or search is None else Plan(Rung.ROUTE, route, search)


def _cheapest(problem: WaypointProblem, plan: Plan, rng: np.random.Generator) -> Plan:
    """The plan, or one further down the ladder if that is much shorter."""
    relaxing, several = _worth(problem)
    length = length_by(problem, plan.waypoints)
    straight = math.dist(problem.start, problem.target)
    if length - straight < relaxing:
        return plan
    if len(problem.intruders) > 1 and length - straight > LONG_WAY:
        route, lacking = _through_traffic(problem, rng)
        if route is not None and lacking <= 0.0 and length_by(problem, route) < length - several:
            return Plan(Rung.ROUTE, route, plan.search, length - length_by(problem, route))
    first, least = length, _at_least(problem)
    if plan.rung is not Rung.CLOSE and length - least >= relaxing:
        close = problem.relaxing(RUNGS[-1][1], longest=length - relaxing)
        search = search_waypoint(close, rng)
        if search.found is not None and length_by(problem, (search.found,)) < close.longest:
            length = length_by(problem, (search.found,))
            plan = Plan(Rung.CLOSE, (search.found,), search, first - length)
    if length - least < several:
        return plan
    route = _kept_from_intruders(problem, exact_route(problem, length - several))
    return plan if not route else Plan(Rung.ROUTE, route, plan.search, first - length_by(problem, route))


def _at_least(problem: WaypointProblem) -> float:
    """Length that no way can fall below: the way round one circle alone, whichever needs the longest [m].

    Two tangents and the arc between them, on the side on which it is shorter; radii as `exact_route` has.
    """
    away, off = (
        point_distances(problem.centres, problem.start),
        point_distances(problem.centres, problem.target),
    )
    straight = math.dist(problem.start, problem.target)
    radii = np.minimum(np.minimum(problem.keep, away - 0.5), off - 0.5)
    cut = segment_point_distance(problem.start, problem.target, problem.centres) < radii
    away, off, radii = away[cut], off[cut], radii[cut]
    between = np.arccos(np.clip((away**2 + off**2 - straight**2) / (2.0 * away * off), -1.0, 1.0))
    arc = between - np.arccos(radii / away) - np.arccos(radii / off)
    round_it = np.sqrt(away**2 - radii**2) + np.sqrt(off**2 - radii**2) + radii * arc
    return float(round_it.max(initial=straight))


def _worth(problem: WaypointProblem) -> tuple[float, float]:
    """By how much a nearer waypoint, and a route of several, must be shorter to be preferred [m]."""
    p = problem.parameters
    if not len(problem.intruders):
        return p.worth_relaxing, p.worth_route
    return max(p.worth_relaxing, IN_TRAFFIC), max(p.worth_route, IN_TRAFFIC)


def widest_way(problem: WaypointProblem, rng: np.random.Generator, lacking: float = math.inf) -> Plan | None:
    """The way that keeps furthest from intruders where d + h cannot be kept from all of them.

    Parameters
    ----------
    problem : WaypointProblem
        The search with every constraint.
    rng : numpy.random.Generator
        The planner's randomness.
    lacking : float
        What the route that is being flown lacks [m]: another must lack less by `ROOM_LEFT`.

    Notes
    -----
    First with the present estimate taken as sure, without the doubt about it; then the least violating way of
    one or of two waypoints that is clear of all that stands still.
    """
    intruders = problem.intruders
    surely = np.zeros(len(intruders))
    sure = replace(intruders, sigma=surely, speed_sigma=surely)
    plan = way_round(replace(problem, intruders=sure), rng)
    if plan is not None:
        return plan
    search = search_waypoint(problem.relaxing(RUNGS[-1][1]), rng)
    single: Corners = (search.least_violating,)
    found = [(problem.separation_shortfall(single), single)]
    route, short = _through_traffic(problem, rng)
    if route is not None:
        found.append((short, route))
    for short, route in sorted(found, key=lambda pair: pair[0]):
        if short < min(lacking, problem.separation_shortfall(())) - ROOM_LEFT and _clear(problem, route):
            return Plan(Rung.CLOSE if len(route) == 1 else Rung.ROUTE, route, search)
    return None


def _through_traffic(problem: WaypointProblem, rng: np.random.Generator) -> tuple[Corners | None, float]:
    """The best way by two waypoints that is clear of what stands still, and what it lacks to d + h [m]."""
    pairs, _ = two_waypoints(problem, rng)
    for pair in pairs.tolist():
        route = ((pair[0][0], pair[0][1]), (pair[1][0], pair[1][1]))
        if _clear(problem, route):
            return route, problem.separation_shortfall(route)
    return None, math.inf


def _clear(problem: WaypointProblem, route: Corners) -> bool:
    return flyable(problem, np.array([problem.start, *route, problem.target]))


def _kept_from_intruders(problem: WaypointProblem, route: Corners | None) -> Corners | None:
    """The route, if it keeps from intruders what is to be kept."""
    if route is None or problem.separation_shortfall(route) > 0.0:
        return None
    return route


def _any_way(problem: WaypointProblem) -> bool:
    """Whether a point could get to the target, however sharply it turned: if not, no waypoint helps."""
    free_start = point_distances(problem.centres, problem.start) - 0.5
    free_target = point_distances(problem.centres, problem.target) - 0.5
    radii = np.maximum(np.minimum(np.minimum(problem.keep, free_start), free_target), 0.0)
    return shortest_path(problem.start, problem.target, problem.centres, radii, problem.walls) is not None
