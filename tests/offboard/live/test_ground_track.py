"""The ground track after an edit, against the line of that edit."""

from __future__ import annotations

import math

import pytest

from avoidance import Ownship, Performance, Waypoint
from offboard.live.ground_track import SETTLE, Fit, TrackCheck

PERFORMANCE = Performance(
    airspeed=15.0, max_bank=math.radians(30.0), roll_time=1.0, acceptance_radius=100.0, tracking_error=15.0
)
EASTWARDS = Waypoint(0.0, 3000.0, 200.0)


def flying(course_deg, time=0.0, north=0.0, east=0.0):
    course = math.radians(course_deg)
    return Ownship(
        time,
        north,
        east,
        200.0,
        15.0 * math.cos(course),
        15.0 * math.sin(course),
        airspeed=15.0,
        heading=course,
    )


@pytest.mark.parametrize(
    ("course_deg", "fit"), [(90.0, Fit.ON), (70.0, Fit.ON), (114.0, Fit.ON), (60.0, Fit.OPEN)]
)
def test_a_course_towards_the_target_fits(course_deg, fit):
    check = TrackCheck.begin(flying(0.0), EASTWARDS, PERFORMANCE)
    assert check.look(flying(course_deg, 1.0)) is fit


def test_one_that_never_turns_is_off_after_the_turn_and_a_while():
    check = TrackCheck.begin(flying(0.0), EASTWARDS, PERFORMANCE)
    quarter = 0.5 * math.pi * PERFORMANCE.turn_radius / PERFORMANCE.airspeed
    assert check.deadline == pytest.approx(1.0 + 1.5 * quarter + SETTLE)
    assert check.look(flying(0.0, check.deadline - 0.1)) is Fit.OPEN
    assert check.look(flying(0.0, check.deadline + 0.1)) is Fit.OFF


def test_a_longer_turn_has_more_time():
    slight = TrackCheck.begin(flying(60.0), EASTWARDS, PERFORMANCE)
    back = TrackCheck.begin(flying(270.0), EASTWARDS, PERFORMANCE)
    assert back.deadline > slight.deadline + 5.0


def test_across_north_the_angle_is_the_short_one():
    check = TrackCheck.begin(flying(0.0), Waypoint(3000.0, -100.0, 200.0), PERFORMANCE)
    assert check.look(flying(10.0)) is Fit.ON
    assert check.look(flying(350.0)) is Fit.ON


def test_near_the_target_nothing_can_be_said():
    check = TrackCheck.begin(flying(0.0), EASTWARDS, PERFORMANCE)
    assert check.look(flying(270.0, check.deadline + 1.0, east=2900.0)) is Fit.ON
