"""Rally points: where to wait if no way is free."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from avoidance import Decision, Detour, Hold, Keep, RadarScan, Replace, Waypoint
from avoidance.agent import Agent
from avoidance.known import Known, keep_what_can_be_kept
from avoidance.ladder import Plan, way_round
from avoidance.parameters import DEFAULT
from avoidance.problem import WaypointProblem
from avoidance.rally import Rally
from tests.avoidance.test_route_check import known
from tests.avoidance.worlds import PERFORMANCE, ownship, route

NEAR, FAR = Waypoint(-1500.0, 0.0, 150.0), Waypoint(-200.0, 4000.0, 150.0)


def seen(*obstacles: tuple[float, float]) -> Known:
    own = ownship()
    return keep_what_can_be_kept(known(list(obstacles), own, route((40_000.0, 0.0))), own, PERFORMANCE)


def nearest(points: list[Waypoint], *obstacles: tuple[float, float]) -> Waypoint | None:
    return Rally(points, PERFORMANCE, DEFAULT).nearest(ownship(), seen(*obstacles))


def test_the_nearest_is_taken() -> None:
    assert nearest([FAR, NEAR], (9000.0, 0.0)) == NEAR
    assert nearest([]) is None


@pytest.mark.parametrize(
    ("obstacle", "free"), [((-1500.0, 0.0), False), ((-1500.0, 1120.0), False), ((-1500.0, 1300.0), True)]
)
def test_one_whose_circle_is_not_free_is_passed_over(obstacle: tuple[float, float], free: bool) -> None:
    assert (nearest([FAR, NEAR], obstacle) == NEAR) == free


def test_one_whose_way_is_not_free_is_passed_over() -> None:
    beyond = Waypoint(0.0, -8000.0, 200.0)
    assert nearest([beyond], (0.0, 9000.0)) == beyond
    assert nearest([beyond], (0.0, -4000.0)) is None


@pytest.mark.parametrize(("aside", "free"), [(1095.0, False), (1130.0, True)])
def test_beside_the_way_there_is_room_for_turning_round(aside: float, free: bool) -> None:
    behind = Waypoint(-6000.0, 0.0, 200.0)
    assert (nearest([behind], (-1500.0, aside)) == behind) == free


class Lost:
    """A planner that finds no way until it is told to."""

    def __init__(self) -> None:
        self.found = False

    def __call__(self, problem: WaypointProblem, rng: np.random.Generator) -> Plan | None:
        return way_round(problem, rng) if self.found else None


AHEAD = (3000.0, 0.0)


def flight(*rally: Waypoint) -> tuple[Agent, Lost]:
    planner = Lost()
    return Agent(PERFORMANCE, DEFAULT, way=planner, rally=rally), planner


def decided(
    agent: Agent,
    begin: int,
    end: int,
    *obstacles: tuple[float, float, float],
    north: float = 0.0,
    east: float = 0.0,
    held: bool | None = None,
) -> list[Decision]:
    """What is decided in some seconds, on the spot: no `Keep`, the route is the mission's."""
    rows = [(*AHEAD, 1000.0), *obstacles]
    found = []
    for second in range(begin, end):
        table = np.array([(north, east, 200.0) for north, east, _ in rows])
        sweep = RadarScan(
            float(second), np.arange(1, len(rows) + 1), table, np.array([radius for *_, radius in rows])
        )
        own, ahead = ownship(north, east, time=float(second)), replace(route((20_000.0, 0.0)), held=held)
        found.append(agent.decide(own, ahead, sweep))
    return [decision for decision in found if not isinstance(decision, Keep)]


def test_where_no_way_is_free_the_vehicle_waits_at_a_rally_point() -> None:
    agent, _ = flight(Waypoint(8000.0, 0.0, 180.0), NEAR)
    (hold,) = decided(agent, 0, 20)
    assert isinstance(hold, Hold)
    assert hold.centre == NEAR
    assert "wait at rally point 2, 1.5 km from here" in hold.why


def test_without_one_that_is_free_it_waits_on_the_spot() -> None:
    agent, _ = flight(Waypoint(8000.0, 0.0, 180.0))
    (hold,) = decided(agent, 0, 20)
    assert isinstance(hold, Hold)
    assert math.hypot(hold.centre.north, hold.centre.east) < 200.0
    assert "hold here" in hold.why


def test_what_comes_into_the_way_sends_it_to_the_next() -> None:
    agent, _ = flight(FAR, NEAR)
    decided(agent, 0, 10)
    (again,) = decided(agent, 10, 20, (NEAR.north, NEAR.east, 300.0))
    assert isinstance(again, Hold)
    assert again.centre == FAR


def test_cut_off_where_there_is_no_room_to_wait_it_waits_as_soon_as_there_is() -> None:
    agent, _ = flight(NEAR)
    decided(agent, 0, 10)
    shut = (NEAR.north, NEAR.east, 300.0), (30.0, 160.0, 100.0), (30.0, -160.0, 100.0)
    assert decided(agent, 10, 20, *shut) == []
    (hold,) = decided(agent, 20, 30, *shut, east=500.0)
    assert isinstance(hold, Hold)
    assert hold.centre.north == pytest.approx(0.0, abs=100.0)


def test_what_comes_elsewhere_does_not() -> None:
    agent, _ = flight(FAR, NEAR)
    decided(agent, 0, 10)
    assert decided(agent, 10, 20, (FAR.north, FAR.east, 300.0)) == []


def test_a_way_out_ends_the_wait() -> None:
    agent, planner = flight(NEAR)
    decided(agent, 0, 10)
    planner.found = True
    way, *_ = decided(agent, 10, 14)
    assert isinstance(way, Detour)


def test_the_waypoint_is_given_up_at_the_rally_point_not_on_the_way_to_it() -> None:
    agent, _ = flight(NEAR)
    (hold,) = decided(agent, 0, 200)
    assert isinstance(hold, Hold)
    assert decided(agent, 200, 240, north=NEAR.north + 60.0) == []
    given_up, *_ = decided(agent, 240, 300, north=NEAR.north + 60.0)
    assert isinstance(given_up, Replace)
    assert given_up.waypoint is None


def test_a_hold_that_somebody_else_has_ended_is_decided_again() -> None:
    """A vehicle that flies its route does not hold: nothing else would keep it off what is ahead."""
    agent, _ = flight(NEAR)
    assert len(decided(agent, 0, 20)) == 1
    assert decided(agent, 20, 30, held=True) == []
    again = decided(agent, 30, 33, held=False)
    assert {decision.name for decision in again} == {"hold"}
