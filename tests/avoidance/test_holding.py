"""How long it is believed that there is no way round."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from avoidance import Contact, Ownship, Performance, RadarScan, Route, Threat, Waypoint
from avoidance.agent import Agent
from avoidance.geofence import FenceArea, Geofence
from avoidance.holding import FIRST_WAIT, LONGEST_WAIT, NoWay, skipped
from avoidance.parameters import DEFAULT, PAPER
from avoidance.route_check import Blocked

ROUTE = Route(Waypoint(0.0, 0.0, 200.0), (Waypoint(9000.0, 0.0, 200.0, item=0),))


def at(time: float) -> Ownship:
    return Ownship(time, 15.0 * time, 0.0, 200.0, 15.0, 0.0, airspeed=15.0)


def test_a_search_in_vain_is_made_again_after_twice_as_long() -> None:
    no_way, waits, time = NoWay(), [], 0.0
    for _ in range(5):
        no_way = no_way.again(at(time), ROUTE, version=1)
        waits.append(no_way.until - time)
        assert no_way.lasts(at(no_way.until - 0.1), ROUTE, version=1)
        assert not no_way.lasts(at(no_way.until), ROUTE, version=1)
        time = no_way.until
    assert waits == [FIRST_WAIT, 2.0 * FIRST_WAIT, 4.0 * FIRST_WAIT, LONGEST_WAIT, LONGEST_WAIT]


def test_it_is_not_believed_of_another_route_nor_when_something_new_is_known() -> None:
    no_way = NoWay().again(at(0.0), ROUTE, version=1).again(at(3.0), ROUTE, version=1)
    other = Route(ROUTE.origin, ROUTE.waypoints)
    assert not no_way.lasts(at(4.0), ROUTE, version=2)
    assert not no_way.lasts(at(4.0), other, version=1)
    assert no_way.again(at(4.0), ROUTE, version=2).until == 4.0 + FIRST_WAIT


def test_a_dead_end_far_ahead_is_not_thought_over_at_every_scan() -> None:
    """Walls leave no room to hold in, their end shuts the leg 6 km ahead, and the planner knows no way."""
    walls = [(200.0 * k, side * 1050.0) for k in range(-12, 37) for side in (-1, 1)]
    contacts = [Contact(k, *place, 200.0) for k, place in enumerate([*walls, (7200.0, 0.0)])]
    performance = Performance(
        airspeed=15.0, max_bank=0.5236, roll_time=1.3, acceptance_radius=100.0, tracking_error=5.0
    )
    route = Route(ROUTE.origin, (Waypoint(40_000.0, 0.0, 200.0),))
    asked: list[object] = []
    agent = Agent(performance, PAPER, way=lambda problem, _: asked.append(problem))
    said = [agent.decide(at(t), route, RadarScan.of(t, contacts)) for t in map(float, range(60))]
    assert all(decision.name == "keep" and decision.threat for decision in said[-10:])
    assert 3 <= len(asked) <= 8


ALONE = Performance(
    airspeed=15.0, max_bank=0.5236, roll_time=1.3, acceptance_radius=100.0, tracking_error=5.0
)


def test_a_later_leg_far_ahead_does_not_stop_the_vehicle_while_it_is_not_thought_over() -> None:
    legs = (Waypoint(4000.0, 0.0, 200.0, item=0), Waypoint(40_000.0, 0.0, 200.0, item=1))
    route, ahead = Route(ROUTE.origin, legs), [Contact(1, 9000.0, 0.0, 200.0)]
    agent = Agent(ALONE, way=lambda problem, _: None)
    said = [agent.decide(at(t), route, RadarScan.of(t, ahead)) for t in map(float, range(60))]
    assert {decision.name for decision in said} == {"keep"}
    assert any("no way round is known yet" in decision.why for decision in said)


def test_whoever_comes_to_hold_later_than_no_way_was_found_asks_again() -> None:
    """Walls left no room to hold in when the search was made; behind them there is."""
    walls = [(200.0 * k, side * 1050.0) for k in range(-12, 5) for side in (-1, 1)]
    contacts = [Contact(k, *place, 200.0) for k, place in enumerate([*walls, (7200.0, 0.0)])]
    route = Route(ROUTE.origin, (Waypoint(40_000.0, 0.0, 200.0),))
    asked: list[float] = []
    rules = replace(DEFAULT, pop_up_room=None)  # else it would not be in there
    agent = Agent(ALONE, rules, way=lambda problem, _: asked.append(0.0))
    held, before = None, 0
    for t in map(float, range(200)):
        own = replace(at(t if held is None else held), time=t)
        if agent.decide(own, route, RadarScan.of(t, contacts)).name == "hold":
            held, before = t, len(asked)
    assert held is not None
    assert held > 20.0
    assert len(asked) > before + 5


@pytest.mark.parametrize(("index", "left"), [(1, [(9000.0, 0.0)]), (3, [(4000.0, 0.0)])])
def test_whoever_gives_up_a_waypoint_keeps_the_others(index: int, left: list[tuple[float, float]]) -> None:
    places = [(2000.0, None), (4000.0, 0), (6000.0, None), (9000.0, 1)]
    legs = tuple(Waypoint(north, 0.0, 200.0, item=item) for north, item in places)
    blocked = Blocked(Threat((7,), 3, 6000.0, 400.0, 300.0, 1025.0), 3, np.array([0]))
    decision = skipped(Route(ROUTE.origin, legs), blocked, index)
    kept = [(w.north, w.east) for w in decision.route or () if w.item is not None]
    assert kept == left
    assert ("no route on from waypoint 1" if index == 1 else "no route to waypoint 2") in decision.why


def test_with_room_for_a_circle_at_a_waypoint_the_vehicle_flies_there_though_nothing_leads_on() -> None:
    legs = (Waypoint(4000.0, 0.0, 200.0, item=0), Waypoint(40_000.0, 0.0, 200.0, item=1))
    route, ahead = Route(ROUTE.origin, legs), [Contact(1, 5500.0, 0.0, 200.0)]
    agent, passed = Agent(ALONE, way=lambda problem, _: None), Route(ROUTE.origin, legs[1:])
    for t in map(float, range(300)):
        decision = agent.decide(at(t), passed if 15.0 * t > 3900.0 else route, RadarScan.of(t, ahead))
        if decision.name == "hold":
            break
    assert 3900.0 < 15.0 * t < 4200.0


def test_a_hold_ends_when_only_a_later_leg_far_ahead_is_blocked() -> None:
    agent, seen = Agent(ALONE, way=lambda problem, _: None), [Contact(2, 300.0, 9000.0, 200.0)]
    ahead = Route(ROUTE.origin, (Waypoint(300.0, 40_000.0, 200.0, item=0),))
    legs = Waypoint(4000.0, 0.0, 200.0, item=0), Waypoint(-7100.0, 27_000.0, 200.0, item=1)
    around = Route(ROUTE.origin, legs)  # the second leg leads into the sphere
    said = []
    for t in map(float, range(900)):
        own = Ownship(t, 300.0, min(15.0 * t, 7000.0), 200.0, 0.0, 15.0, airspeed=15.0)
        route = ahead if "hold" not in said[:-5] else around
        decision = agent.decide(own, route, RadarScan.of(t, seen))
        said.append(decision.name)
        if said[-1] in ("resume", "replace"):
            break
    assert "hold" in said
    assert said[-1] == "resume"
    assert "no way round is known yet" in decision.why


@pytest.mark.parametrize(("aside", "held"), [(1008.0, False), (990.0, False), (900.0, True)])
def test_no_route_is_left_for_a_circle_that_enters_deeper(aside: float, held: bool) -> None:
    """Where a corridor without room to circle in ends between two spheres, nearer than is to be kept.

    The circle would enter by some 75 m.
    """
    places = [*((200.0 * k, 1040.0) for k in range(15, 35)), (7000.0, aside)]
    walls = [(north, side * east) for north, east in places for side in (-1, 1)]
    contacts = [Contact(k, *place, 200.0) for k, place in enumerate(walls)]
    route = Route(ROUTE.origin, (Waypoint(40_000.0, 0.0, 200.0),))
    agent = Agent(ALONE, replace(DEFAULT, pop_up_room=None), way=lambda problem, _: None)
    said = []
    for t in map(float, range(200)):
        own = Ownship(t, 15.0 * t + 4500.0, 0.0, 200.0, 15.0, 0.0, airspeed=15.0)
        said.append(agent.decide(own, route, RadarScan.of(t, contacts)).name)
        if said[-1] == "hold":
            break
    assert ("hold" in said) == held


NECK = ((9000.0, 4.0), (9001.0, 4.0), (9001.0, 3000.0), (15_000.0, 3000.0))


@pytest.mark.parametrize(("end", "held"), [(NECK, False), ((), True)], ids=["neck", "shut"])
def test_no_route_is_left_for_a_circle_that_crosses_the_fence(
    end: tuple[tuple[float, float], ...], held: bool
) -> None:
    """In a corridor too narrow to circle in, which ends in a neck narrower than is to be kept, or is shut."""
    half = ((8000.0, 60.0), (9000.0, 60.0), *end)
    edge = (*half, *((north, -east) for north, east in reversed(half)))
    route = Route(Waypoint(8900.0, 0.0, 200.0), (Waypoint(12_000.0, 0.0, 200.0),))
    agent = Agent(ALONE, way=lambda problem, _: None, geofence=Geofence([FenceArea(True, edge)]))
    own = Ownship(0.0, 8900.0, 0.0, 200.0, 15.0, 0.0, airspeed=15.0)
    assert (agent.decide(own, route, RadarScan.of(0.0, [])).name == "hold") == held
