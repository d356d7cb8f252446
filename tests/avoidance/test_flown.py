"""The segments that enclose the flown curve."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from avoidance.flown import flown_segments, turn_angle
from tests.avoidance.worlds import PERFORMANCE


def test_a_straight_route_is_its_own_hull() -> None:
    starts, ends, extra = flown_segments(np.array([[[0.0, 0.0], [1000.0, 0.0]]]), 0.0, PERFORMANCE)
    assert extra.max() == 0.0
    assert starts[..., 1].max() == ends[..., 1].max() == 0.0


def test_a_gentle_corner_adds_its_chord() -> None:
    route = np.array([[[0.0, 0.0], [1000.0, 0.0], [2000.0, 500.0]]])
    starts, ends, extra = flown_segments(route, None, PERFORMANCE)
    assert starts.shape == (1, 4, 2)
    assert starts[0, 2].tolist() == [885.0, 0.0]  # acceptance radius and one second before the waypoint
    assert ends[0, 2, 1] > 0.0
    assert extra.max() == 0.0
    assert starts[0, 3].tolist() == [1000.0, 0.0]  # the turn begins in time: nothing is overshot


def test_corners_nearer_than_the_acceptance_radius_are_passed_in_one_turn() -> None:
    """Three of 50 degrees, 40 m apart: the vehicle may leave for the last leg 115 m before its corner."""
    course = np.radians([0.0, 50.0, 100.0, 150.0])
    lengths = np.array([1000.0, 40.0, 40.0, 1000.0])
    steps = lengths[:, None] * np.column_stack([np.cos(course), np.sin(course)])
    route = np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])[None]
    starts, _, extra = flown_segments(route, None, PERFORMANCE)
    radius, roll = PERFORMANCE.turn_radius, 15.0 * PERFORMANCE.roll_time
    assert starts[0, 4].tolist() == [885.0, 0.0]
    # by 100 and by 150 degrees, 75 and 35 m before them all
    assert starts[0, 5].tolist() == pytest.approx([925.0 + roll, radius])
    assert starts[0, 6].tolist() == pytest.approx([965.0 + roll, radius])
    assert extra[0, 4:7].tolist() == pytest.approx([0.0, radius, radius])
    alone, _, _ = flown_segments(route[:, :3], None, PERFORMANCE)
    assert alone[0, 2].tolist() == starts[0, 4].tolist()  # earlier corners are as they are without


def test_a_turn_that_begins_late_overshoots_the_new_leg() -> None:
    late = replace(PERFORMANCE, acceptance_radius=20.0, wind_bound=8.0)
    route = np.array([[[0.0, 0.0], [1000.0, 0.0], [1000.0, 1000.0]]])  # north, then a right angle to the east
    starts, ends, extra = flown_segments(route, None, late)
    begin = 1000.0 - 20.0 + 1.5 * 23.0  # one second late, and half the time to roll
    assert starts[0, 3].tolist() == pytest.approx([begin + late.turn_radius, 0.0])
    angle = np.linspace(0.0, math.pi / 2, 20)
    turn = np.stack(
        [begin + late.turn_radius * np.sin(angle), late.turn_radius * (1 - np.cos(angle))], axis=1
    )
    along = (ends[0, 3] - starts[0, 3]) / np.hypot(*(ends[0, 3] - starts[0, 3]))
    outside = (turn - starts[0, 3]) @ np.array([along[1], -along[0]])  # positive to the north of the line
    assert outside.max() <= extra[0, 3]


def test_a_reversal_needs_two_turn_radii_to_the_side() -> None:
    route = np.array([[[0.0, 0.0], [1000.0, 0.0], [0.0, 1.0]]])
    _, _, extra = flown_segments(route, None, PERFORMANCE)
    assert extra[0, 2] == pytest.approx(2 * PERFORMANCE.turn_radius)


def test_a_turn_from_the_present_course_runs_on_first() -> None:
    route = np.array([[[0.0, 0.0], [0.0, 5000.0]]])  # to the east, flying north
    starts, ends, _ = flown_segments(route, 0.0, PERFORMANCE)
    ahead = PERFORMANCE.turn_radius * math.tan(math.pi / 4) + 30.0
    assert ends[0, 1].tolist() == pytest.approx([ahead, 0.0])
    assert starts[0, 2].tolist() == pytest.approx([ahead, 0.0])


def test_turn_angle_is_unsigned() -> None:
    north, west = np.array([3.0 + 0.0j]), np.array([-0.5j])
    assert turn_angle(north, west)[0] == pytest.approx(math.pi / 2)
    assert turn_angle(west, north)[0] == pytest.approx(math.pi / 2)
    assert turn_angle(north, np.zeros(1, dtype=np.complex128))[0] == 0.0


def test_a_turn_that_has_begun_is_not_put_off() -> None:
    """By the second that a vehicle may take to notice a waypoint, or the time of an edit."""
    route, slow = np.array([[[0.0, 0.0], [500.0, 500.0]]]), replace(PERFORMANCE, edit_time=2.0)
    (later, _, _), (now, _, _) = (flown_segments(route, 0.0, slow, begun=begun) for begun in (False, True))
    assert later[0, -1, 0] - now[0, -1, 0] == pytest.approx(2.0 * PERFORMANCE.airspeed)
