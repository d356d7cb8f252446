"""Pilots that err about their position and decide late."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from avoidance import Detour, Keep, Ownship, Route, Waypoint
from offboard.link import VehicleState
from scenarios.load import parse
from scenarios.pilots import Desk, Navigation
from tests.scenarios.flights import ENCOUNTER, flown


def states(count):
    return [VehicleState(Ownship(float(t), 15.0 * t, 0.0, 200.0, 15.0, 0.0)) for t in range(count)]


def test_the_error_has_its_size_and_changes_slowly():
    navigation = Navigation(20.0, np.random.default_rng(0))
    told = [navigation.reported(state).ownship for state in states(60_000)]
    off = np.array([(own.north - 15.0 * own.time, own.east) for own in told])
    assert np.hypot(*off.T).std() < np.sqrt((off**2).sum(axis=1).mean()) == pytest.approx(20.0, rel=0.1)
    assert np.abs(np.diff(off, axis=0)).max() < 15.0
    assert {own.position_error for own in told} == {20.0}


def test_without_error_the_state_is_the_true_one():
    navigation = Navigation(0.0, np.random.default_rng(0))
    (state,) = states(1)
    assert navigation.reported(state) is state


class Vehicle:
    """Flies to item 1 and 2; the first is reached when told."""

    def __init__(self):
        self.ahead = (Waypoint(1e4, 0.0, 200.0, item=1), Waypoint(2e4, 0.0, 200.0, item=2))

    def route(self):
        return Route(Waypoint(0.0, 0.0, 200.0), self.ahead)


def test_a_decision_waits_and_forgets_what_was_reached_meanwhile():
    vehicle, desk = Vehicle(), Desk(28.0)
    new = Waypoint(5e3, 2e3, 200.0)
    detour = Detour(why="there", route=(new, *vehicle.ahead), waypoint=new)
    assert isinstance(desk.put(detour, 10.0), Keep)
    vehicle.ahead = vehicle.ahead[1:]
    assert isinstance(desk.take(37.0, vehicle), Keep)
    assert desk.busy
    assert desk.take(38.0, vehicle).route == (new, vehicle.ahead[0])
    assert not desk.busy


def test_what_changes_nothing_and_no_latency_are_not_waited_for():
    keep = Keep(why="clear")
    detour = Detour(why="there", route=Vehicle().ahead, waypoint=Vehicle().ahead[0])
    assert Desk(28.0).put(keep, 0.0) is keep
    assert Desk(0.0).put(detour, 0.0) is detour


def test_a_flight_with_both_faults_is_recorded_by_its_true_track():
    scenario = parse(ENCOUNTER)
    faulty = replace(scenario.vehicle, position_error=10.0, decision_latency=28.0)
    result, judged = flown(replace(scenario, vehicle=faulty))
    first = next(d for d in result.decisions if d.decision.route is not None)
    turned = result.track.times[np.abs(result.track.banks_deg) > 2.0][0]
    assert turned >= first.state.time + 28.0
    assert first.state.position_error == 10.0
    assert judged.summary["violations"] == 0
