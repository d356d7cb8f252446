"""Ways round that lead into no passage too narrow to turn round in."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from avoidance.contingency import first_trap
from avoidance.detours import fly_round, search_problem
from avoidance.exact import exact_plan
from avoidance.exact_route import Corners
from avoidance.known import Known
from avoidance.ladder import Plan, Way, widest_way
from avoidance.orbits import BENDS, turning_room
from avoidance.parameters import Parameters
from avoidance.problem import WaypointProblem
from avoidance.route_check import Blocked
from avoidance.types import Bools, Decision, Floats, Ownship, Performance, Route, Waypoint


@dataclass(frozen=True, slots=True, eq=False)
class Gap:
    """A part of a route that cannot be flown, and all that is needed to find a way round it."""

    own: Ownship
    """The vehicle."""
    route: Route
    """What it is to fly."""
    known: Known
    """What stands still and what moves."""
    blocked: Blocked
    """What is wrong with the route."""
    performance: Performance
    """What the vehicle can fly."""
    parameters: Parameters
    """Preset."""
    problem: WaypointProblem
    """The search for a way round."""
    begin: int
    """First waypoint of the route that the way replaces, if any."""
    end: int
    """Waypoint to which the way must lead."""

    @classmethod
    def of(
        cls,
        own: Ownship,
        route: Route,
        known: Known,
        blocked: Blocked,
        performance: Performance,
        parameters: Parameters,
    ) -> Gap:
        """Where a blocked route must be left, and where it can be taken up again."""
        problem, begin, end = search_problem(own, route, known, blocked, performance, parameters)
        return cls(own, route, known, blocked, performance, parameters, problem, begin, end)

    @property
    def target(self) -> Waypoint:
        """The waypoint to which a way round must lead."""
        return self.route.waypoints[self.end]

    def way(self, plan: Plan) -> Decision:
        """The decision to fly a plan."""
        return fly_round(self.route, self.blocked, plan, self.begin, self.end)

    def taken(self, way: Decision) -> Corners:
        """What a decision puts in between, north and east [m]."""
        new = len(way.route or ()) - (len(self.route.waypoints) - (self.end - self.begin))
        return tuple((w.north, w.east) for w in (way.route or ())[self.begin : self.begin + new])

    def saving(self, way: Decision) -> float:
        """How much shorter the route gets by a decision [m]."""
        here, there = self.problem.start, self.problem.target
        old = [(w.north, w.east) for w in self.route.waypoints[self.begin : self.end]]
        lengths = [
            sum(math.dist(a, b) for a, b in pairwise((here, *corners, there)))
            for corners in (old, self.taken(way))
        ]
        return lengths[0] - lengths[1]

    def trap(self, way: Decision) -> Blocked | None:
        """The first stretch of a way round along which no orbit in free space can be begun for too long.

        Only up to the target: what lies behind it may still be blocked, and is then another gap.
        """
        here = Waypoint(self.own.north, self.own.east, self.own.altitude)
        ahead = way.route or self.route.waypoints
        planned = Route(here, ahead[: self.begin + len(self.taken(way)) + 1])
        return first_trap(self.own, planned, self.known, self.performance, self.parameters)


def way_with_orbits(gap: Gap, planner: Way, rng: np.random.Generator) -> Decision | None:
    """The way round along which an orbit in free space can always be begun, or None.

    Parameters
    ----------
    gap : Gap
        What to fly round.
    planner : Way
        Who finds a way round what is known.
    rng : numpy.random.Generator
        The planner's randomness.

    Notes
    -----
    The shortest way comes first (instead of a narrow passage, the exact planner's). If it leads into a narrow
    passage, so much is kept from what lies on one side of it that an orbit fits in there, then on the other
    side, then on both: work for the exact planner. An intruder is evaded even into a narrow passage.
    """
    problem = gap.problem
    passage = np.array([problem.start, problem.target])
    shortest: Decision | None = None
    if not gap.blocked.threat.narrow:
        plan = _plan(gap, problem, planner, rng)
        if plan is None:
            return None
        shortest = gap.way(plan)
        trap = gap.trap(shortest)
        if trap is None:
            return shortest
        corners = np.array([problem.start, *plan.waypoints, problem.target])
        passage = corners[: max(trap.leg - gap.begin, 0) + 2]
    rooms = list(_rooms(gap, passage))
    if shortest is None:
        rooms.insert(0, np.zeros(len(problem.keep)))
    for room in rooms:
        plan = exact_plan(problem, room)
        if plan is None:
            continue
        wide = gap.way(plan)
        if gap.trap(wide) is None:
            return wide
    return shortest if gap.blocked.threat.moving else None


def _rooms(gap: Gap, passage: Floats) -> Iterator[Floats]:
    """What to keep more from each obstacle, so that an orbit fits into a passage, least first [m]."""
    wide = max(turning_room(gap.performance) - gap.parameters.margin, 0.0)
    left = _left_of(passage, gap.problem.centres)
    corners = BENDS * gap.performance.turn_radius
    for room in (wide, wide + corners):
        yield np.where(left, room, 0.0)
        yield np.where(left, 0.0, room)
    yield np.full(len(left), wide + corners)
    yield np.full(len(left), 2.0 * wide + corners)


def _plan(gap: Gap, problem: WaypointProblem, planner: Way, rng: np.random.Generator) -> Plan | None:
    plan = planner(problem, rng)
    if plan is None and len(problem.intruders):
        flown = [(w.north, w.east) for w in gap.route.waypoints[gap.begin : gap.end]]
        plan = widest_way(problem, rng, problem.separation_shortfall(flown))
    return plan


def _left_of(line: Floats, points: Floats) -> Bools:
    """Which points, shape (n, 2), lie to the left of the piece of a line that is nearest to them."""
    nearest = np.full(len(points), np.inf)
    left = np.zeros(len(points), dtype=np.bool_)
    for begin, end in pairwise(line):
        step = end - begin
        share = np.clip((points - begin) @ step / max(float(step @ step), 1e-9), 0.0, 1.0)
        distance = np.hypot(*(points - begin - share[:, None] * step).T)
        across = step[0] * (points[:, 1] - begin[1]) - step[1] * (points[:, 0] - begin[0])
        closer = distance < nearest
        left[closer] = across[closer] < 0.0
        nearest = np.minimum(nearest, distance)
    return left


__all__ = ["Gap", "way_with_orbits"]
