"""Waiting at a rally point some way off, on both autopilots: flown to, circled about, told and judged."""

from __future__ import annotations

import contextlib
import math
from dataclasses import replace

import pytest

from avoidance import Hold, Keep, Waypoint
from avoidance.agent import Agent
from avoidance.ladder import way_round
from avoidance.parameters import DEFAULT
from offboard.link import EditStatus
from offboard.sitl.modes import Task
from scenarios.live_flight import LiveFlight, Source, scenario_of
from scenarios.scenario import Point
from scenarios.watched import TimedRadar, WatchedAgent
from tests.offboard.live.kit import SMALL, flying

BOTH = pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
RALLY = Waypoint(-1500.0, 60.0, 150.0)
"""Behind the vehicle: two kilometres and more than two minutes from where it learns of the obstacle."""


class Lost:
    """A planner that finds no way until it is told to."""

    found = False

    def __call__(self, problem, rng):
        return way_round(problem, rng) if self.found else None


@contextlib.contextmanager
def lost(autopilot, scenario=SMALL):
    """A vehicle whose agent knows a rally point and no way round."""
    with flying(autopilot, scenario) as flight:
        planner = Lost()
        flight.agent = Agent(flight.vehicle.performance, DEFAULT, way=planner, rally=(RALLY,))
        yield flight, planner


def away(own):
    return math.hypot(own.north - RALLY.north, own.east - RALLY.east)


@BOTH
def test_it_flies_there_circles_there_and_goes_on_when_there_is_a_way(autopilot):
    with lost(autopilot) as (flight, planner):
        frames = flight.fly(235.0)
        (hold,) = [s.decision for f in frames for s in f.steps if not isinstance(s.decision, Keep)]
        assert isinstance(hold, Hold)
        circle = [frame.steps[0].state.ownship for frame in frames[-30:]]
        assert [away(own) for own in circle] == pytest.approx([hold.radius] * 30, abs=15.0)
        assert [own.altitude for own in circle] == pytest.approx([RALLY.altitude] * 30, abs=5.0)
        assert "no way round is known, wait at rally point 1, 2.1 km from here" in flight.said("warning")
        assert flight.vehicle.holding
        assert not flight.vehicle.editor.busy  # its ground track was seen to lead there
        planner.found = True
        flight.fly_until(lambda: not flight.vehicle.holding, 10.0)
        flight.fly(60.0)
        assert flight.vehicle.aboard.ownship().north > RALLY.north + 500.0
    assert {record.status for record in flight.vehicle.editor.records} == {EditStatus.CONFIRMED}
    assert flight.said("alarm") == ""


@BOTH
def test_a_hold_that_a_human_ends_by_flying_on_is_begun_again(autopilot):
    with lost(autopilot) as (flight, _):
        flight.fly_until(lambda: flight.vehicle.holding, 60.0)
        flight.fly(10.0)
        flight.simulation.set_mode(Task.PILOT)
        flight.fly(10.0)
        assert flight.vehicle.watch.human
        flight.simulation.set_current(3 + (autopilot == "ardupilot"))  # behind the circle
        flight.simulation.set_mode(Task.MISSION)
        flight.fly(10.0)
        assert "someone else has ended the hold" in flight.said("warning")
        assert flight.said("warning").count("wait at rally point 1") == 2
        assert flight.vehicle.editor.latest.hold is not None
        before = away(flight.vehicle.aboard.ownship())
        flight.fly(30.0)
        assert away(flight.vehicle.aboard.ownship()) < before - 300.0


@BOTH
def test_a_hold_decided_on_while_a_human_flies_is_begun_when_the_mission_is_given_back(autopilot):
    with lost(autopilot) as (flight, _):
        flight.fly(30.0)
        flight.simulation.set_mode(Task.PILOT)
        flight.fly(30.0)
        assert "wait at rally point 1" in flight.said("alarm")
        assert flight.vehicle.editor.records == []
        flight.simulation.set_mode(Task.MISSION)
        flight.fly(10.0)
    assert flight.vehicle.editor.latest.hold is not None
    assert [record.status for record in flight.vehicle.editor.records] == [EditStatus.CONFIRMED]


@BOTH
def test_the_judge_sees_the_way_to_the_rally_point(autopilot):
    """An obstacle on the way there that nobody was told of: the record has the violation."""
    with lost(autopilot) as (flight, _):
        hidden = replace(SMALL.obstacles[0], id=9, north=-300.0, east=40.0)
        points = (Point(RALLY.north, RALLY.east, RALLY.altitude),)
        known = replace(SMALL, obstacles=(*SMALL.obstacles, hidden), rally=points)
        scenario = scenario_of(flight.vehicle, known, "small")
        with contextlib.closing(LiveFlight(scenario, flight.vehicle, Source("test"), DEFAULT)) as live:
            live._agent = WatchedAgent(flight.agent)  # its own would find a way
            live._radar = TimedRadar(flight.radar)  # its own would see what is hidden
            for frame in live:
                if frame.time > 150.0:
                    break
            flown = live.result()
            summary = live.judged(flown).summary
    assert "wait at rally point 1" in next(d.decision.why for d in flown.vehicles[0].decisions)
    assert summary["violations"] == 1
    assert summary["closest_obstacle"] == 9
    assert not summary["completed"]
