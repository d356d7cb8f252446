"""Which side of a hill to pass that is seen piece by piece: no dance between left and right.

A long hill comes into view a little at a time, and the shorter way round what is known of it changes sides
again and again. Two rules end that, as in the search for the end of a wall of unknown length (Baeza-Yates,
Culberson and Rawlins 1993): a side once chosen is left only for one that is much shorter, so that each change
at least doubles what it is weighed against; and an end of a hill that lies where the radar has not looked yet
is taken to go on as far again, so that the route is changed each time the hill has doubled, and not at every
piece of it.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np

from avoidance.exact_route import Corners
from avoidance.geofence import Walls
from avoidance.geometry import distances
from avoidance.known import Known
from avoidance.ladder import Plan, Way
from avoidance.problem import WaypointProblem
from avoidance.route_check import Blocked
from avoidance.types import Decision, Floats, Ownship, RadarScan, Route, Threat
from avoidance.words import obstacles

LONG = 6000.0
"""A hill shorter than this is taken to end where nothing more of it is seen, and either side is taken [m]."""
ONWARD = 1.0
"""How much further an unseen end of a hill is taken to go on, in lengths of what is known of it."""
FURTHEST = 20_000.0
"""It is never taken to go on further than this [m]."""
RELUCTANCE = 2.0
"""The side is changed where staying would cost more than so many times as much as changing ..."""
SMALL = 300.0
"""... and this besides [m]."""
FOOTSTEP = 500.0
"""Where the radar has looked is remembered at this spacing [m]."""
BEYOND = 100_000.0
"""Length of the barrier that keeps a search on one side of a hill [m]."""
SAME_PLACE = 100.0
"""Two measurements of one obstacle differ by less than this [m]."""


class Sides:
    """Remembers on which side a hill is being passed, and where the radar has looked."""

    def __init__(self) -> None:
        self._looked: list[tuple[float, float]] = []
        self._reach = 0.0
        self._ends: tuple[tuple[float, float] | None, tuple[float, float]] | None = None
        self._hill: Floats = np.empty((0, 2))
        self._side = 0.0
        self._expected: Blocked | None = None
        self._open = 0
        self._put_in: Corners = ()

    def look(self, own: Ownship, scan: RadarScan) -> None:
        """Note where the radar has looked, and how far it sees: as far as anything was ever reported."""
        here = (own.north, own.east)
        if len(scan.ids):
            away = np.hypot(scan.positions[:, 0] - here[0], scan.positions[:, 1] - here[1])
            self._reach = max(self._reach, float(np.fmax.reduce(away, initial=0.0)))
        if not self._looked or math.dist(self._looked[-1], here) > FOOTSTEP:
            self._looked.append(here)

    def way(self, planner: Way) -> Way:
        """The planner, keeping to the side chosen before and allowing for what is not seen yet."""

        def on_one_side(problem: WaypointProblem, rng: np.random.Generator) -> Plan | None:
            longer = self.extended(problem)
            plan = planner(longer, rng)
            if plan is None:
                return None if longer is problem else planner(problem, rng)
            if self._passing(problem) and side_of(problem, plan.waypoints) * self._side < 0.0:
                same = planner(barred(longer, -self._side), rng)
                enough = RELUCTANCE * _excess(problem, plan.waypoints) + SMALL
                plan = plan if same is None or _excess(problem, same.waypoints) > enough else same
            return plan if longer is problem else _told_of(plan, problem)

        return on_one_side

    def chosen(self, problem: WaypointProblem, blocked: Blocked, waypoints: Corners) -> None:
        """Note which way was taken round what blocked the route."""
        self._ends = (_fixed_start(problem), problem.target)
        self._hill = problem.centres[problem.avoided]
        self._side = side_of(problem, waypoints)
        self._put_in = waypoints
        self._open = len(self._open_ends(problem))
        self._expected = blocked if self._open else None

    def expected(self, route: Route, known: Known) -> Blocked | None:
        """What the route goes round in the belief that there is more of it, at either end, than is known."""
        if self._expected is None or len(known.intruders):
            return None
        for leg, waypoint in enumerate(route.waypoints):
            if waypoint.item is None and (waypoint.north, waypoint.east) in self._put_in:
                near = (distances(known.centres, self._hill) < SAME_PLACE).any(axis=1)
                return Blocked(replace(self._expected.threat, leg=leg), leg, np.flatnonzero(near))
        self._expected = None
        return None

    def ends_left(self, problem: WaypointProblem) -> int | None:
        """How many ends of the hill still lie where nobody has looked; None if as many as when asked last.

        Nothing more is expected once none is left.
        """
        left = len(self._open_ends(problem))
        if left >= self._open:
            return None
        self._open = left
        if not left:
            self._expected = None
        return left

    def extended(self, problem: WaypointProblem) -> WaypointProblem:
        """The search with both ends of the hill avoided going on where nobody has looked; itself if none."""
        found = self._open_ends(problem)
        if not found:
            return problem
        rows = np.array([row for row, places in found for _ in places])
        new = np.concatenate([places for _, places in found])
        ends = np.array([problem.start, problem.target])
        clear = (distances(new, ends) > problem.keep_waypoint[rows][:, None]).all(axis=1)
        if not clear.any():
            return problem
        rows = rows[clear]
        return replace(
            problem,
            centres=np.concatenate([problem.centres, new[clear]]),
            keep=np.concatenate([problem.keep, problem.keep[rows]]),
            keep_waypoint=np.concatenate([problem.keep_waypoint, problem.keep_waypoint[rows]]),
        )

    def _open_ends(self, problem: WaypointProblem) -> list[tuple[int, Floats]]:
        """Ends of the hill avoided, as rows of the problem, with the centres expected behind each."""
        hill = problem.centres[problem.avoided]
        if len(hill) < 3 or len(problem.intruders):
            return []
        between = distances(hill, hill)
        one, other = np.unravel_index(int(between.argmax()), between.shape)
        length = float(between[one, other])
        if length < LONG:
            return []
        rows = problem.avoided
        ends = (int(one), int(other))
        found = [
            (int(rows[k]), self._beyond(hill, between[k], k, length, float(problem.keep[rows[k]])))
            for k in ends
        ]
        return [(row, places) for row, places in found if len(places)]

    def _beyond(self, hill: Floats, away: Floats, end: int, length: float, keep: float) -> Floats:
        """Centres of what is expected behind an end of a hill, shape (n, 2) [m]; none where that is known."""
        near = hill[(away > 0.0) & (away <= 0.5 * length)]
        if not len(near):
            return np.empty((0, 2))
        ahead = hill[end] - near.mean(axis=0)
        ahead /= max(float(np.hypot(*ahead)), 1e-9)
        steps = np.arange(keep, min(ONWARD * length, FURTHEST), keep)
        places = hill[end] + steps[:, None] * ahead
        seen = (distances(places[:1], np.array(self._looked)) < self._reach - keep).any()
        return np.empty((0, 2)) if seen else places

    def _passing(self, problem: WaypointProblem) -> bool:
        """True if the hill is a long one and the one that is being passed already."""
        if self._ends is None or self._side == 0.0 or not len(self._hill) or len(problem.intruders):
            return False
        then, now = self._ends[0], _fixed_start(problem)
        moved = then is not None and now is not None and math.dist(then, now) > SAME_PLACE
        if moved or math.dist(problem.target, self._ends[1]) > SAME_PLACE:
            return False
        hill = problem.centres[problem.avoided]
        if not len(hill) or float(distances(hill, hill).max()) < LONG:
            return False
        return bool((distances(hill, self._hill) < SAME_PLACE).any())


def end_words(threat: Threat, decision: Decision) -> str:
    """Why a way is made shorter: there is less of a hill than was expected."""
    how = decision.why.partition("; ")[2]
    return f"the end of the hill at {obstacles(threat.ids)} has come into view; {how}"


def side_of(problem: WaypointProblem, waypoints: Corners) -> float:
    """+1 for a way to the right of what is avoided, -1 to the left, 0 for none."""
    if not waypoints or not len(problem.avoided):
        return 0.0
    across = [_across(problem, np.array(corner) - np.array(problem.start)) for corner in waypoints]
    return math.copysign(1.0, max(across, key=abs))


def _across(problem: WaypointProblem, step: Floats) -> float:
    """How far a step leads to the right of the straight way, times the length of that [m²]."""
    north, east = problem.target[0] - problem.start[0], problem.target[1] - problem.start[1]
    return float(north * step[1] - east * step[0])


def barred(problem: WaypointProblem, side: float) -> WaypointProblem:
    """The search with no way on one side of the hill: +1 the right, -1 the left."""
    hill = problem.centres[problem.avoided]
    start = np.array(problem.start)
    along = np.array(problem.target) - start
    along /= max(float(np.hypot(*along)), 1e-9)
    across = side * np.array([-along[1], along[0]])
    root = hill[int(np.argmin(np.abs((hill - start) @ np.array([-along[1], along[0]]))))]
    barrier = np.array([[root, root + BEYOND * across]])
    walls = Walls(np.concatenate([problem.walls.segments, barrier]), max(problem.walls.room, 1.0))
    return replace(problem, walls=walls)


def _fixed_start(problem: WaypointProblem) -> tuple[float, float] | None:
    """Where a detour begins that lies behind a waypoint; None if it begins at the vehicle."""
    return None if problem.before is None else problem.start


def _told_of(plan: Plan, problem: WaypointProblem) -> Plan:
    """The plan, whose search tells of what is known alone: what is expected besides is no disc known then."""
    known = replace(plan.search, centres=problem.centres, radii=problem.keep)
    return replace(plan, search=known, expecting=True)


def _excess(problem: WaypointProblem, waypoints: Corners) -> float:
    """How much longer a way is than the straight one [m]."""
    corners = (problem.start, *waypoints, problem.target)
    return sum(math.dist(a, b) for a, b in pairwise(corners)) - math.dist(problem.start, problem.target)


__all__ = ["SMALL", "Sides", "barred", "end_words", "side_of"]
