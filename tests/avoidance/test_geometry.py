"""Closed-form geometry against brute force and textbook cases."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from avoidance.geometry import (
    circle_intersections,
    line_circle_intersections,
    segment_point_distance,
    segment_sphere_interval,
    segments_clearance,
    tangent_points,
)

coordinate = st.floats(-350_000.0, 350_000.0)
point = st.tuples(coordinate, coordinate)


def test_distance_counts_the_ends_of_the_segment_not_its_line() -> None:
    points = np.array([(5.0, 3.0), (-3.0, 4.0), (13.0, -4.0), (10.0, 0.0)])

    distances = segment_point_distance((0.0, 0.0), (10.0, 0.0), points)

    np.testing.assert_allclose(distances, [3.0, 5.0, 5.0, 0.0], rtol=0, atol=1e-12)


def test_distance_from_a_segment_without_length_is_that_from_a_point() -> None:
    points = np.array([(3.0, 4.0)])

    assert segment_point_distance((0.0, 0.0), (0.0, 0.0), points) == pytest.approx([5.0])
    assert segments_clearance(np.zeros((1, 2)), np.zeros((1, 2)), points) == pytest.approx(np.array([[5.0]]))


@given(point, point, point)
def test_distance_is_the_least_over_points_of_the_segment(a, b, p) -> None:
    t = np.linspace(0.0, 1.0, 2001)[:, None]
    sampled = np.hypot(*((1 - t) * np.array(a) + t * np.array(b) - np.array(p)).T).min()

    distance = segment_point_distance(a, b, np.array([p]))[0]

    assert distance <= sampled + 1e-6
    assert distance >= sampled - math.dist(a, b) / 2000.0 - 1e-6


def test_clearances_of_many_segments_equal_those_of_each() -> None:
    rng = np.random.default_rng(1)
    starts, ends, centres = (rng.uniform(-350e3, 350e3, (k, 2)) for k in (7, 7, 11))

    clearances = segments_clearance(starts, ends, centres)

    one_by_one = [segment_point_distance(a, b, centres) for a, b in zip(starts, ends, strict=True)]
    np.testing.assert_allclose(clearances, one_by_one, rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("start", "end", "centre", "radius", "expected"),
    [
        pytest.param((0, 0, 0), (10, 0, 0), (5, 0, 0), 2, (0.3, 0.7), id="through"),
        pytest.param((0, 0, 200), (10, 0, 200), (5, 3, 200), 3, (0.5, 0.5), id="touching"),
        pytest.param((0, 0, 0), (10, 0, 0), (5, 3, 1), 3, None, id="above"),
        pytest.param((0, 0, 0), (10, 0, 0), (15, 0, 0), 2, None, id="beyond the end (E17)"),
        pytest.param((0, 0, 0), (10, 0, 0), (-5, 0, 0), 2, None, id="behind the start (E17)"),
        pytest.param((0, 0, 0), (10, 0, 0), (12, 0, 0), 2, (1.0, 1.0), id="touching at the end"),
        pytest.param((5, 1, 0), (10, 0, 0), (5, 0, 0), 20, (0.0, 1.0), id="all inside"),
        pytest.param((5, 0, 0), (5, 0, 0), (5, 0, 1), 2, (0.0, 1.0), id="a point inside"),
        pytest.param((5, 0, 0), (5, 0, 0), (9, 0, 1), 2, None, id="a point outside"),
    ],
)
def test_segment_in_sphere(start, end, centre, radius, expected) -> None:
    interval = segment_sphere_interval(start, end, centre, radius)

    assert interval is None if expected is None else interval == pytest.approx(expected, abs=1e-12)


def test_leg_7_of_the_paper_does_not_meet_obstacle_1() -> None:
    """Erratum E17: the infinite line passes obstacle 1 at 0.0 m, 210 km beyond the leg's end."""
    interval = segment_sphere_interval(
        (300_000, 11_000, 200), (270_000, 10_500, 200), (60_000, 7_000, 200), 1_000
    )

    assert interval is None


@given(point, point, st.floats(1.0, 5_000.0))
def test_tangents_touch_the_circle_at_right_angles(p, centre, radius) -> None:
    if math.dist(p, centre) < 1.001 * radius:
        return

    touching = tangent_points(p, centre, radius)

    for spot in touching:
        arm, line = spot - np.array(centre), spot - np.array(p)
        assert math.hypot(*arm) == pytest.approx(radius, abs=1e-6)
        assert abs(arm @ line) <= 1e-6 * math.hypot(*line)
    along, right = np.array(centre) - np.array(p), touching[0] - np.array(p)
    assert along[0] * right[1] - along[1] * right[0] > 0.0, "the first tangent lies to the right"


def test_tangents_from_the_circle_itself_and_from_inside() -> None:
    np.testing.assert_allclose(tangent_points((3.0, 0.0), (0.0, 0.0), 3.0), [(3.0, 0.0)] * 2)
    with pytest.raises(ValueError, match="outside the circle"):
        tangent_points((2.9, 0.0), (0.0, 0.0), 3.0)


def test_circles_meet_in_two_points_one_or_none() -> None:
    two = circle_intersections((0.0, 0.0), 5.0, (6.0, 0.0), 5.0)

    np.testing.assert_allclose(two, [(3.0, 4.0), (3.0, -4.0)])
    np.testing.assert_allclose(circle_intersections((0.0, 0.0), 2.0, (5.0, 0.0), 3.0), [(2.0, 0.0)])
    np.testing.assert_allclose(circle_intersections((0.0, 0.0), 5.0, (2.0, 0.0), 3.0), [(5.0, 0.0)])
    for far in ((9.0, 0.0), (1.0, 0.0), (0.0, 0.0)):
        assert circle_intersections((0.0, 0.0), 5.0, far, 3.0 if far[0] else 5.0).shape == (0, 2)


@given(point, point, st.floats(1.0, 5_000.0), st.floats(0.2, 0.95), st.floats(0.2, 1.0))
def test_common_points_lie_on_both_circles(first, direction, radius, gap, share) -> None:
    other = share * radius
    distance = radius - other + gap * 2.0 * other
    bearing = math.atan2(direction[1], direction[0])
    second = (first[0] + distance * math.cos(bearing), first[1] + distance * math.sin(bearing))

    common = circle_intersections(first, radius, second, other)

    assert common.shape == (2, 2)
    for spot in common:
        assert math.dist(spot, first) == pytest.approx(radius, abs=1e-6)
        assert math.dist(spot, second) == pytest.approx(other, abs=1e-6)


def test_line_meets_circle_in_order_of_travel() -> None:
    crossing = line_circle_intersections((10.0, 3.0), (9.0, 3.0), (0.0, 0.0), 5.0)

    np.testing.assert_allclose(crossing, [(4.0, 3.0), (-4.0, 3.0)])
    np.testing.assert_allclose(line_circle_intersections((1, 5), (2, 5), (0, 0), 5.0), [(0.0, 5.0)])
    assert line_circle_intersections((1, 6), (2, 6), (0, 0), 5.0).shape == (0, 2)
    with pytest.raises(ValueError, match="must differ"):
        line_circle_intersections((1, 6), (1, 6), (0, 0), 5.0)
