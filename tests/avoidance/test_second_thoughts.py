"""A waypoint is chosen again when something seen later lies too near to it (Sec. 5.3)."""

from __future__ import annotations

import math

import numpy as np

from avoidance.agent import Agent
from avoidance.parameters import DEFAULT
from avoidance.types import Decision, Detour, Route, Rung, Waypoint
from tests.avoidance.worlds import PERFORMANCE, ownship, route, scan

FIRST = (9000.0, 300.0)


def flight(later: tuple[float, float], scans: int = 6) -> list[Decision]:
    """Decisions on a leg of 70 km with one obstacle ahead, and another that comes into view at 3 s."""
    agent = Agent(PERFORMANCE, DEFAULT, np.random.default_rng(0))
    ahead, decisions = route((70_000.0, 0.0)), []
    for second in range(scans):
        own = ownship(north=15.0 * second, time=float(second))
        seen = [FIRST] if second < 3 else [FIRST, later]
        decision = agent.decide(own, ahead, scan(seen, time=float(second)))
        if decision.route is not None:
            ahead = Route(Waypoint(own.north, own.east, own.altitude), decision.route)
        decisions.append(decision)
    return decisions


def put_in(decisions: list[Decision]) -> list[Detour]:
    return [decision for decision in decisions if isinstance(decision, Detour)]


def test_a_waypoint_near_something_seen_later_is_chosen_again() -> None:
    (first,) = put_in(flight((40_000.0, 9000.0)))
    later = (first.waypoint.north + 900.0, first.waypoint.east + 1600.0)
    before, after = put_in(flight(later))
    assert before.waypoint == first.waypoint
    assert "has come into view 1836 m from the new waypoint, which is to keep 2000 m" in after.why
    for centre in (FIRST, later):
        assert math.dist((after.waypoint.north, after.waypoint.east), centre) >= 2000.0
    assert after.rung is Rung.WAYPOINT


def test_what_lies_far_enough_is_no_reason() -> None:
    (first,) = put_in(flight((40_000.0, 9000.0)))
    far = (first.waypoint.north + 900.0, first.waypoint.east + 1900.0)
    assert len(put_in(flight(far))) == 1


def test_a_reason_counts_once() -> None:
    """Between two obstacles 3.2 km apart no waypoint keeps 2 km from both: the one there is stays."""
    (first,) = put_in(flight((40_000.0, 9000.0)))
    beside = (FIRST[0] + 400.0, 2.0 * first.waypoint.east - FIRST[1] + 300.0)
    assert len(put_in(flight(beside, scans=12))) <= 2
