"""From a blocked leg to a way round it."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from avoidance import Rung
from avoidance.constraints import feasible_segments
from avoidance.exact_route import exact_route, flyable
from avoidance.flown import flown_segments
from avoidance.geometry import segments_clearance
from avoidance.ladder import way_round
from tests.avoidance.worlds import PERFORMANCE, problem

AGILE = replace(PERFORMANCE, acceptance_radius=20.0, tracking_error=2.5)
WALLS = [(6000.0, float(e)) for e in range(-60_000, 3000, 1500)]
WALLS += [(11_000.0, float(e)) for e in range(-3000, 60_000, 1500)]


def test_one_waypoint_is_preferred() -> None:
    plan = way_round(problem([(9000.0, 300.0)]), np.random.default_rng(0))
    assert plan is not None
    assert plan.rung is Rung.WAYPOINT


def test_the_exact_route_is_clear_as_flown() -> None:
    question = problem(WALLS, target=(17_000.0, 0.0))
    route = exact_route(question)
    assert route is not None
    corners = np.array([question.start, *route, question.target])[None]
    starts, ends, extra = flown_segments(corners, 0.0, PERFORMANCE)
    keep = np.full(len(WALLS), 1000.0 + PERFORMANCE.tracking_error)
    assert feasible_segments(starts, ends, extra, question.centres, keep)[0] == 0.0


def test_a_gap_that_leaves_hardly_any_room_is_found() -> None:
    """Wider circles shut it, and the way about both is too long: then narrower ones are tried."""
    gap, shut = (problem([(9000.0, -aside), (9000.0, aside)]) for aside in (1017.5, 1015.0))
    longest = math.dist(gap.start, gap.target) + 50.0
    assert exact_route(gap, longest) == ()
    assert exact_route(shut, longest) is None


def test_only_what_the_turns_come_near_to_is_kept_further_from() -> None:
    """Just ahead of the vehicle a wide turn needs room; at the other circles there is no reason for it."""
    question = problem([(1150.0, 100.0), (9000.0, -1500.0), (9000.0, 300.0)], target=(16_000.0, 0.0))
    route = exact_route(question)
    assert route is not None
    corners = np.array([question.start, *route, question.target])
    near, *far = (segments_clearance(corners[:-1], corners[1:], question.centres) - question.keep).min(axis=0)
    assert near > 20.0 > min(far)


def test_after_a_sharp_turn_the_way_comes_back_to_the_circle_it_goes_round() -> None:
    """Beside a sphere the turn needs room; a first leg to one side gives it, the rest keeps none."""
    question = replace(problem([(-1100.0, -300.0)], target=(-20_000.0, -1500.0)), performance=AGILE)
    route = exact_route(question)
    assert route is not None
    corners = np.array([question.start, *route, question.target])
    assert flyable(question, corners)
    clear = segments_clearance(corners[:-1], corners[1:], question.centres)[:, 0] - question.keep[0]
    assert clear[0] > 60.0  # so much the turn needs
    assert clear[2:].min() < 5.0


def test_the_way_after_a_sharp_turn_is_not_longer_than_was_allowed() -> None:
    question = replace(problem([(-1100.0, -300.0)], target=(-20_000.0, -1500.0)), performance=AGILE)
    route = exact_route(question)
    assert route is not None
    corners = (question.start, *route, question.target)
    length = sum(math.dist(a, b) for a, b in pairwise(corners))
    assert exact_route(question, length + 1.0) == route
    assert exact_route(question, length - 1.0) is None


def test_a_short_route_beats_a_single_waypoint_far_away() -> None:
    plan = way_round(problem(WALLS, target=(17_000.0, 0.0)), np.random.default_rng(0))
    assert plan is not None
    assert plan.rung is Rung.ROUTE


@pytest.mark.parametrize("radius", [1500.0, 2500.0])
def test_no_way_is_none(radius: float) -> None:
    angles = np.linspace(0.0, 2 * math.pi, 14, endpoint=False)
    ring = [(20_000 + radius * math.cos(a), radius * math.sin(a)) for a in angles]
    assert way_round(problem(ring, target=(20_000.0, 0.0)), np.random.default_rng(0)) is None
