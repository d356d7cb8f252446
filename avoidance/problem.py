"""One waypoint search: what is asked of a planner, and the points it may start from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from avoidance.constraints import (
    feasible_segments,
    flyable_turn,
    safe_waypoint,
    search_space,
    turning_angle,
)
from avoidance.cost import path_length, risk
from avoidance.flown import flown_segments
from avoidance.parameters import Parameters
from avoidance.prediction import route_separation
from avoidance.types import Floats, Ints, Performance

INFEASIBLE = 1e9
"""Added to the violation of an infeasible candidate, so that every feasible one ranks before it."""


def _no_points() -> Floats:
    return np.empty((0, 2))


@dataclass(frozen=True, slots=True, eq=False)
class Intruders:
    """Moving obstacles as the search sees them."""

    positions: Floats = field(default_factory=_no_points)
    """North and east now [m], shape (q, 2)."""
    velocities: Floats = field(default_factory=_no_points)
    """Over ground [m/s], shape (q, 2)."""
    required: Floats = field(default_factory=lambda: np.empty(0))
    """What a new route keeps from each: d + h and the doubt about its path [m], shape (q,)."""
    conflict: Floats = field(default_factory=lambda: np.empty(0))
    """A route is left alone until it comes nearer than this [m], shape (q,)."""
    radii: Floats = field(default_factory=lambda: np.empty(0))
    """Distance that is a violation: d, or the radius that the sensor gave [m], shape (q,)."""


@dataclass(frozen=True, slots=True, eq=False)
class WaypointProblem:
    """Find the waypoint that leads from `start` to `target` at least cost (Eq. 1).

    Every planner is given the same cost, the same constraints and the same order of candidates: feasible
    before infeasible, then smaller violation, then smaller cost (Deb 2000).
    """

    start: tuple[float, float]
    """Where the detour begins, north and east [m]."""
    target: tuple[float, float]
    """The waypoint it must lead to [m]."""
    course: float | None
    """Direction of travel at the start [rad]; None if the vehicle turns there from the leg `before`."""
    before: tuple[float, float] | None
    """Beginning of the leg that leads to the start [m]; None if the vehicle is at the start now."""
    centres: Floats
    """Known stationary obstacles, shape (d, 2) [m]."""
    keep: Floats
    """What the flown curve keeps from each (RS + margin), shape (d,) [m]."""
    keep_waypoint: Floats
    """What the waypoint keeps from each (RS + tolerance), shape (d,) [m]."""
    avoided: Ints
    """Indices of the obstacles or cluster being avoided, shape (c,)."""
    intruders: Intruders
    """Moving obstacles."""
    delay: float
    """Time until the vehicle is at the start [s]."""
    performance: Performance
    """What the vehicle can fly."""
    parameters: Parameters
    """Weights, limits and seeds."""
    relaxed: frozenset[str] = frozenset()
    """Constraints given up on this rung of the ladder: any of "g4", "g2", "g1"."""

    def cost(self, points: Floats) -> Floats:
        """f of Eq. (6) for candidates of shape (n, 2): W_t f1 + W_o f2, shape (n,)."""
        p = self.parameters
        length = path_length(points, self.start, self.target)
        danger = risk(points, self.centres, p.risk_distance, p.risk_squared_metres)
        return p.path_weight * length + p.risk_weight * danger

    def constraints(self, points: Floats) -> dict[str, Floats]:
        """How far each candidate of shape (n, 2) breaks each constraint [m], shape (n,) each."""
        p = self.parameters
        active = {"g1": self._safe_waypoint(points)}
        if "g2" not in self.relaxed:
            active["g2"] = search_space(points, self.centres[self.avoided], p.search_limit)
        active["g3"] = self._feasible_route(points)
        if "g4" not in self.relaxed:
            if p.turn_limit is not None:
                active["g4"] = turning_angle(points, self.start, self.target, p.turn_limit)
            else:
                active["g4"] = flyable_turn(
                    points, self.start, self.target, self.course, self.performance.turn_radius
                )
        if len(self.intruders.required):
            active["g5"] = self._separated(points)
        return active

    def waypoint_violation(self, points: Floats) -> Floats:
        """How far candidates of shape (n, 2) break g1 and g2, which need no route [m], shape (n,)."""
        total = self._safe_waypoint(points)
        if "g2" not in self.relaxed:
            total = total + search_space(points, self.centres[self.avoided], self.parameters.search_limit)
        return total

    def violation(self, points: Floats) -> Floats:
        """Sum of the violations of candidates of shape (n, 2) [m], shape (n,); 0 where feasible."""
        total = np.zeros(len(points))
        for shortfall in self.constraints(points).values():
            total += shortfall
        return total

    def rank(self, points: Floats) -> Floats:
        """One number per candidate of shape (n, 2) by which every planner orders them, smaller is better."""
        violation = self.violation(points)
        return np.where(violation > 0.0, INFEASIBLE + violation, self.cost(points))

    def _safe_waypoint(self, points: Floats) -> Floats:
        required = self.keep if "g1" in self.relaxed else self.keep_waypoint
        if self.parameters.all_obstacles or "g1" in self.relaxed:
            return safe_waypoint(points, self.centres, required)
        return safe_waypoint(points, self.centres[self.avoided], required[self.avoided])

    def _feasible_route(self, points: Floats) -> Floats:
        if not len(self.centres):
            return np.zeros(len(points))
        corners = [self.start, None, self.target] if self.before is None else [self.before, self.start, None]
        if self.before is not None:
            corners.append(self.target)
        route = np.empty((len(points), len(corners), 2))
        for i, corner in enumerate(corners):
            route[:, i] = points if corner is None else corner
        starts, ends, extra = flown_segments(route, self.course, self.performance)
        skip = 0 if self.before is None else 1  # the leg that leads to the start is another search's
        return feasible_segments(starts[:, skip:], ends[:, skip:], extra[:, skip:], self.centres, self.keep)

    def separation_shortfall(self, waypoints: Sequence[Sequence[float]]) -> float:
        """How much is missing to what is to be kept from intruders on a route by these waypoints [m]."""
        if not len(self.intruders.required):
            return 0.0
        route = np.array([self.start, *waypoints, self.target], dtype=np.float64)[None]
        moved = self.intruders.positions + self.delay * self.intruders.velocities
        separation = route_separation(route, self.performance.airspeed, moved, self.intruders.velocities)
        return float(max((self.intruders.required - separation).max(), 0.0))

    def _separated(self, points: Floats) -> Floats:
        route = np.empty((len(points), 3, 2))
        route[:, 0], route[:, 1], route[:, 2] = self.start, points, self.target
        moved = self.intruders.positions + self.delay * self.intruders.velocities
        separation = route_separation(route, self.performance.airspeed, moved, self.intruders.velocities)
        return np.asarray(np.maximum((self.intruders.required - separation).max(axis=1), 0.0))


def straight_cost(problem: WaypointProblem) -> float:
    """Cost of flying straight on without risk: the zero of `search_gap`."""
    return problem.parameters.path_weight * math.dist(problem.start, problem.target)


def search_box(problem: WaypointProblem) -> Floats:
    """Least and largest north and east of the points worth a look, shape (2, 2) [m].

    What g2 allows about the obstacles avoided; where it does not hold, all about the leg.
    """
    if len(problem.avoided) and "g2" not in problem.relaxed:
        ends, reach = problem.centres[problem.avoided], problem.parameters.search_limit
    else:
        ends = np.array([problem.start, problem.target])
        reach = 2.0 * problem.parameters.search_limit
    return np.array([ends.min(axis=0) - reach, ends.max(axis=0) + reach])
