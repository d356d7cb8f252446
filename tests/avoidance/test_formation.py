"""Several vehicles, each with its own agent and nothing agreed but the rule of the road."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest

from avoidance import Ownship, RadarScan, Route, Waypoint
from avoidance.agent import Agent
from tests.avoidance.worlds import PERFORMANCE

SPEED = 15.0
TURN_RATE = SPEED / PERFORMANCE.turn_radius


class Flier:
    """A point that turns towards its next waypoint as fast as it can."""

    def __init__(self, start: tuple[float, float], goal: tuple[float, float]) -> None:
        self.place, self.course = np.array(start), math.atan2(goal[1] - start[1], goal[0] - start[0])
        self.route = Route(Waypoint(*start, 200.0), (Waypoint(*goal, 200.0, item=0),))
        self.agent = Agent(PERFORMANCE)
        self.flown, self.changes = 0.0, 0

    def step(self, time: float, seen: list[tuple[int, np.ndarray]]) -> None:
        """Look, decide, fly on for a second."""
        velocity = SPEED * np.array([math.cos(self.course), math.sin(self.course)])
        own = Ownship(time, *self.place, 200.0, *velocity, airspeed=SPEED, heading=self.course)
        table = np.array([(*place, 200.0) for _, place in seen]).reshape(-1, 3)
        ids = np.array([identity for identity, _ in seen], dtype=np.int64)
        decision = self.agent.decide(
            own, self.route, RadarScan(time, ids, table, np.full(len(ids), math.nan))
        )
        if decision.route is not None:
            self.route = Route(Waypoint(*self.place, 200.0), decision.route)
            self.changes += 1
        first = self.route.waypoints[0]
        if len(self.route.waypoints) > 1 and math.dist(self.place, (first.north, first.east)) < 100.0:
            self.route = Route(first, self.route.waypoints[1:])
            first = self.route.waypoints[0]
        wanted = math.atan2(first.east - self.place[1], first.north - self.place[0])
        turn = math.remainder(wanted - self.course, math.tau)
        self.course += min(max(turn, -TURN_RATE), TURN_RATE)
        self.place = self.place + SPEED * np.array([math.cos(self.course), math.sin(self.course)])
        self.flown += SPEED


def fly(fliers: list[Flier], seconds: int, reach: float = 10_000.0) -> float:
    """Fly all of them; the least separation."""
    least = math.inf
    for second in range(seconds):
        places = [flier.place for flier in fliers]
        for me, flier in enumerate(fliers):
            seen = [
                (i, place)
                for i, place in enumerate(places)
                if i != me and math.dist(place, places[me]) < reach
            ]
            flier.step(float(second), seen)
        least = min(least, *(math.dist(a.place, b.place) for a, b in combinations(fliers, 2)))
    return least


@pytest.mark.parametrize("count", [2, 3, 4])
def test_all_to_their_antipodes_make_a_roundabout(count: int) -> None:
    """They would all meet in the middle: each turns right, once or twice, and nobody dances."""
    radius = 7000.0
    angles = 2.0 * math.pi * np.arange(count) / count
    rays = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    starts, goals = (radius * rays).tolist(), (-2.0 * radius * rays).tolist()
    fliers = [Flier((a[0], a[1]), (b[0], b[1])) for a, b in zip(starts, goals, strict=True)]
    least = fly(fliers, 700)
    assert least > 1000.0
    for flier, angle, goal in zip(fliers, angles, goals, strict=True):
        assert flier.changes <= 6
        assert flier.flown + math.dist(flier.place, goal) < 1.03 * 3.0 * radius
        right = np.array([math.sin(angle), -math.cos(angle)])  # of the way from one side to the other
        assert float((flier.place) @ right) > 0.0


def test_line_abreast_disturbs_nobody() -> None:
    fliers = [Flier((0.0, 3000.0 * k), (40_000.0, 3000.0 * k)) for k in range(3)]
    fly(fliers, 200)
    assert [flier.changes for flier in fliers] == [0, 0, 0]
