"""One waypoint search: what is asked of a planner, and the points it may start from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from avoidance.constraints import (
    feasible_segments,
    flyable_turn,
    line_shortfall,
    safe_waypoint,
    search_space,
    turning_angle,
)
from avoidance.cost import path_length, risk
from avoidance.flown import SEQUENCING_DELAY, as_complex, as_pairs, flown_lines
from avoidance.geofence import Walls
from avoidance.geometry import FEW
from avoidance.parameters import Parameters
from avoidance.prediction import Intruders, ground_speeds, separation_shortfall
from avoidance.right_of_way import gives_way, wrong_side
from avoidance.types import Bools, Complexes, Floats, Ints, Performance

INFEASIBLE = 1e9
"""Added to the violation of an infeasible candidate, so that every feasible one ranks before it."""


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
    walls: Walls = field(default_factory=Walls)
    """Edges of the geofence."""
    relaxed: frozenset[str] = frozenset()
    """Constraints given up on this rung of the ladder: any of "g4", "g2", "g1"."""
    wind: tuple[float, float] = (0.0, 0.0)
    """Steady wind, towards north and east [m/s]."""
    longest: float = math.inf
    """Ways that are no shorter than this are of no use: where seeds find none, the search ends [m]."""
    rays: list[tuple[Complexes, Complexes]] = field(default_factory=list, init=False, repr=False)
    """Tangents from the start and from the target, once worked out: they outlast giving up constraints."""

    def relaxing(self, given_up: frozenset[str], longest: float = math.inf) -> WaypointProblem:
        """The same search with some constraints given up, for ways shorter than `longest` [m]."""
        relaxed = replace(self, relaxed=given_up, longest=longest)
        object.__setattr__(relaxed, "rays", self.rays)  # shared: what either works out serves the other
        return relaxed

    @property
    def alone(self) -> bool:
        """True if nothing moves."""
        return not len(self.intruders)

    def cost(self, points: Floats) -> Floats:
        """f of Eq. (6) for candidates of shape (n, 2): W_t f1 + W_o f2, shape (n,)."""
        p = self.parameters
        length = path_length(points, self.start, self.target)
        danger = risk(points, self.centres, p.risk_distance, p.risk_squared_metres)
        return p.path_weight * (length + self._manners(points)) + p.risk_weight * danger

    def constraints(self, points: Floats) -> dict[str, Floats]:
        """How far each candidate of shape (n, 2) breaks each constraint [m], shape (n,) each."""
        active = {"g1": self._safe_waypoint(points)}
        if "g2" not in self.relaxed:
            limit = self.parameters.search_limit
            active["g2"] = search_space(points, self.centres[self.avoided], limit)
        return active | self._on_the_way(points)

    def _on_the_way(self, points: Floats) -> dict[str, Floats]:
        """Those of the constraints that look at the way, not at the waypoint's own place."""
        active = {"g3": self._feasible_route(points)}
        if "g4" not in self.relaxed:
            limit = self.parameters.turn_limit
            if limit is not None:
                active["g4"] = turning_angle(points, self.start, self.target, limit)
            else:
                active["g4"] = flyable_turn(
                    points, self.start, self.target, self.course, self.performance.turn_radius
                )
        if len(self.intruders):
            active["g5"] = self._separated(points)
        return active

    def waypoint_violation(self, points: Floats) -> Floats:
        """How far candidates of shape (n, 2) break g1 and g2, which need no route [m], shape (n,)."""
        total = self._safe_waypoint(points)
        if "g2" not in self.relaxed:
            total = total + search_space(points, self.centres[self.avoided], self.parameters.search_limit)
        return total

    def leg_violation(self, points: Floats) -> Floats:
        """The least by which candidates of shape (n, 2) break g3, by their straight legs [m], shape (n,)."""
        if not len(self.centres) or not len(points):
            return np.zeros(len(points))
        onward = np.empty((len(points), 3), dtype=np.complex128)
        onward[:, 0], onward[:, 1], onward[:, 2] = (
            complex(*self.start),
            as_complex(points),
            complex(*self.target),
        )
        return self.line_shortfall(onward[:, :-1], onward[:, 1:], np.zeros((len(points), 2)))

    def violation(self, points: Floats) -> Floats:
        """Sum of the violations of candidates of shape (n, 2) [m], shape (n,); 0 where feasible."""
        total = np.zeros(len(points))
        for shortfall in self.constraints(points).values():
            total += shortfall
        return total

    def rank(self, points: Floats) -> Floats:
        """One number per candidate of shape (n, 2) by which every planner orders them, smaller is better."""
        violation = self.violation(points)
        broken = violation > 0.0
        if broken.all():
            return INFEASIBLE + violation
        return np.where(broken, INFEASIBLE + violation, self.cost(points))

    def rank_placed(self, points: Floats, cost: Floats) -> Floats:
        """As `rank`, of points that are known to meet g1 and g2, at a known cost of shape (n,)."""
        violation: Floats = sum(self._on_the_way(points).values(), np.zeros(len(points)))
        return np.where(violation > 0.0, INFEASIBLE + violation, cost)

    def _safe_waypoint(self, points: Floats) -> Floats:
        required = self.keep if "g1" in self.relaxed else self.keep_waypoint
        if self.parameters.all_obstacles or "g1" in self.relaxed:
            return safe_waypoint(points, self.centres, required)
        return safe_waypoint(points, self.centres[self.avoided], required[self.avoided])

    def _feasible_route(self, points: Floats) -> Floats:
        onward = np.empty((len(points), 2), dtype=np.complex128)
        onward[:, 0], onward[:, 1] = as_complex(points), complex(*self.target)
        return self.route_shortfall(onward)

    def route_shortfall(self, onward: Complexes) -> Floats:
        """By how much ways from the start, flown with their turns, come too near to anything [m], shape (n,).

        `onward` are their waypoints, as complex numbers of shape (n, k) [m].
        """
        if not len(self.centres) and not len(self.walls):
            return np.zeros(len(onward))
        before = [] if self.before is None else [complex(*self.before)]
        known = [*before, complex(*self.start)]
        route = np.empty((len(onward), len(known) + onward.shape[1]), dtype=np.complex128)
        route[:, : len(known)], route[:, len(known) :] = known, onward
        starts, ends, extra = flown_lines(route, self.course, self.performance)
        skip = len(before)  # the leg that leads to the start is another search's
        starts, ends, extra = starts[:, skip:], ends[:, skip:], extra[:, skip:]
        shortfall = np.zeros(len(onward))
        if len(self.centres) and len(onward):
            shortfall = self.line_shortfall(starts, ends, extra)
        if len(self.walls):
            shortfall = np.maximum(shortfall, self.walls.shortfall(as_pairs(starts), as_pairs(ends), extra))
        return shortfall

    def line_shortfall(self, starts: Complexes, ends: Complexes, extra: Floats) -> Floats:
        """Largest shortfall of lines, ends of shape (n, m), to what is kept from spheres, shape (n,) [m]."""
        if len(self.centres) > FEW:
            pairs = as_pairs(starts), as_pairs(ends)
            return feasible_segments(*pairs, extra, self.centres, self.keep)
        return line_shortfall(starts, ends, extra, as_complex(self.centres), self.keep)

    def separation_shortfall(self, waypoints: Sequence[Sequence[float]]) -> float:
        """How much is missing to what is to be kept from intruders on a route by these waypoints [m]."""
        if not len(self.intruders):
            return 0.0
        route = self.after_run(np.array([*waypoints, self.target], dtype=np.float64)[None])
        return float(separation_shortfall(route, self.speeds(route), self.intruders.after(self.delay))[0])

    def traffic_rank(self, points: Floats) -> Floats:
        """As `rank`, as if nothing stood still: length and separation alone, shape (n,)."""
        shortfall = self._separated(points)
        length = path_length(points, self.start, self.target) + self._manners(points)
        return np.where(shortfall > 0.0, INFEASIBLE + shortfall, self.parameters.path_weight * length)

    def _separated(self, points: Floats) -> Floats:
        route = self._by(points)
        return separation_shortfall(route, self.speeds(route), self.intruders.after(self.delay))

    def _manners(self, points: Floats) -> Floats | float:
        """Length that passing on the wrong side is counted as [m], shape (n,)."""
        intruders = self.intruders
        yielding = self._yielding if len(intruders) else None
        if yielding is None or not yielding.any():
            return 0.0
        route = self._by(points)
        wrong = wrong_side(route, self.speeds(route), intruders.after(self.delay), yielding)
        return self.parameters.wrong_side * wrong

    @property
    def _yielding(self) -> Bools:
        """Those of the intruders that the own vehicle gives way to."""
        north, east = self.target[0] - self.start[0], self.target[1] - self.start[1]
        return gives_way(math.atan2(east, north), self.start, self.intruders.after(self.delay))

    def _by(self, points: Floats) -> Floats:
        """The routes by each of some points to the target, shape (n, k, 2)."""
        onward = np.empty((len(points), 2, 2))
        onward[:, 0], onward[:, 1] = points, self.target
        return self.after_run(onward)

    def after_run(self, onward: Floats) -> Floats:
        """What is flown first: straight on until the turn has begun; then `onward`, shape (n, k, 2)."""
        first = [self.start]
        if self.course is not None:
            run = self.performance.airspeed * (SEQUENCING_DELAY + 0.5 * self.performance.roll_time)
            ahead = (run * math.cos(self.course), run * math.sin(self.course))
            first.append((self.start[0] + ahead[0], self.start[1] + ahead[1]))
        route = np.empty((len(onward), len(first) + onward.shape[1], 2))
        route[:, : len(first)], route[:, len(first) :] = first, onward
        return route

    def speeds(self, route: Floats) -> Floats | float:
        """Ground speed on the legs of routes of shape (n, k, 2), shape (n, k - 1) [m/s]."""
        return ground_speeds(route[:, 1:] - route[:, :-1], self.performance.airspeed, self.wind)


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
