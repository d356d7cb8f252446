"""The fate of waypoints, and the rule by which they are replaced."""

from __future__ import annotations

import numpy as np
import pytest

from avoidance import Performance
from avoidance.parameters import PAPER, PRESETS
from scenarios.goals import Goal
from scenarios.load import parse
from scenarios.score import replacement_rule, waypoint_fates
from scenarios.track import Track
from tests.scenarios.flights import ON_A_WAYPOINT, flown


def track(*points: tuple[float, float]) -> Track:
    positions = np.array([(north, east, 200.0) for north, east in points])
    zeros = np.zeros(len(points))
    return Track("own", np.arange(len(points), dtype=float), positions, zeros, zeros, zeros)


ON_THE_WAYPOINT = Goal(1, 0.0, 0.0, (1134.0, 0.0), 1134.0)
"""An obstacle stands on the waypoint; the judge picked the point to the north."""


@pytest.mark.parametrize("side", [(-1200.0, 0.0), (0.0, 1234.0), (1134.0, 0.0), (0.0, 0.0)])
def test_every_point_as_near_as_the_goal_meets_a_replaced_waypoint(side):
    (fate,) = waypoint_fates(track((-9000.0, -9000.0), side), [ON_THE_WAYPOINT], 100.0)
    assert fate.met
    assert fate.missed_by <= 100.0


def test_a_replaced_waypoint_is_missed_beyond_its_shift_and_the_acceptance_radius():
    (fate,) = waypoint_fates(track((-9000.0, 0.0), (-1235.0, 0.0)), [ON_THE_WAYPOINT], 100.0)
    assert not fate.met
    assert fate.missed_by == pytest.approx(101.0)


def test_waypoints_are_met_in_order():
    goals = [Goal(1, 8000.0, 0.0, (8000.0, 0.0), 0.0), ON_THE_WAYPOINT]
    there = track((-2000.0, 0.0), (8000.0, 0.0))
    assert [fate.met for fate in waypoint_fates(there, goals, 100.0)] == [True, False]
    and_back = track((-2000.0, 0.0), (8000.0, 0.0), (1100.0, 0.0))
    assert [fate.met for fate in waypoint_fates(and_back, goals, 100.0)] == [True, True]


def test_a_waypoint_that_nothing_stands_for_is_skipped():
    (fate,) = waypoint_fates(track((0.0, 0.0), (5.0, 0.0)), [Goal(1, 9e4, 0.0, None, 0.0)], 100.0)
    assert (fate.met, fate.passed_at, fate.missed_by) == (True, None, None)


@pytest.mark.parametrize("name", PRESETS)
def test_the_judge_and_the_planner_agree_on_what_counts_at_an_altitude(name):
    """A sphere whose lowest point is 5 m above the last waypoint."""
    above = ON_A_WAYPOINT.replace("east_m = 0.0}]\nvehicle", "east_m = 0.0, altitude_m = 1205.0}]\nvehicle")
    _, score = flown(parse(above), preset_name=name)
    assert score.fates[1].goal.replaced
    assert score.summary["waypoints_replaced"] == 1
    assert score.safe


def test_a_mission_that_ends_on_an_obstacle_is_completed():
    result, score = flown(parse(ON_A_WAYPOINT))
    assert result.ending == "finished"
    assert score.safe
    assert score.summary["optimum_length_m"] <= score.summary["path_length_m"] + 100.0


@pytest.mark.parametrize("error", [5.0, 60.0])
def test_by_the_papers_rules_a_stand_in_keeps_rs_and_the_tolerance_whatever_the_margin(error):
    vehicle = Performance(
        airspeed=15.0, max_bank=0.5236, roll_time=1.3, acceptance_radius=100.0, tracking_error=error
    )
    rule = replacement_rule(PAPER, vehicle)
    assert rule.margin == max(PAPER.margin, error + PAPER.hysteresis)
    assert rule.margin + rule.rooms[0] == PAPER.tolerance
