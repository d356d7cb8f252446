"""Common tangents of two circles: they touch both, and turn the way they say."""

from __future__ import annotations

import math

import numpy as np
import pytest

from avoidance.tangents import common_tangents, unobstructed

PAIR = np.array([0]), np.array([1])


@pytest.mark.parametrize(
    ("radii", "count"),
    [
        pytest.param((1_000.0, 400.0), 4, id="apart"),
        pytest.param((3_000.0, 2_500.0), 2, id="overlapping"),
        pytest.param((6_000.0, 500.0), 0, id="one in the other"),
        pytest.param((0.0, 400.0), 2, id="point and disc"),
        pytest.param((0.0, 0.0), 1, id="two points"),
        pytest.param((4_000.0, 1_000.0), 4, id="touching"),
    ],
)
def test_number_of_tangents_and_what_they_touch(radii, count) -> None:
    centres, sizes = np.array([(300_000.0, -2_000.0), (303_000.0, 2_000.0)]), np.array(radii)

    tangents = common_tangents(*PAIR, centres, sizes)

    assert len(tangents) == count
    for point, disc, sense in (
        (tangents.point, tangents.i, tangents.sense_i),
        (tangents.end, tangents.j, tangents.sense_j),
    ):
        arm = point - centres[disc]
        assert np.hypot(*arm.T) == pytest.approx(sizes[disc], abs=1e-6)
        clockwise = arm[:, 0] * tangents.course[:, 1] - arm[:, 1] * tangents.course[:, 0]
        assert clockwise == pytest.approx(sense * sizes[disc], abs=1e-6)


def test_reversed_tangents_fly_the_same_lines_back() -> None:
    centres, sizes = np.array([(0.0, 0.0), (3_000.0, 4_000.0)]), np.array([1_000.0, 500.0])
    there = common_tangents(*PAIR, centres, sizes)

    back = there.reversed()

    np.testing.assert_allclose(back.end, there.point, atol=1e-9)
    np.testing.assert_allclose(back.reversed().ends, there.ends)
    assert back.angle_i.tolist() == there.angle_j.tolist()


def test_a_third_disc_obstructs_what_it_covers_and_no_more() -> None:
    centres = np.array([(0.0, 0.0), (10_000.0, 0.0), (5_000.0, 1_600.0)])
    sizes = np.array([1_000.0, 1_000.0, 700.0])
    tangents = common_tangents(*PAIR, centres, sizes)

    free = unobstructed(tangents, np.array([2]), centres[2:], sizes[2:])

    outer_right = (tangents.point[:, 1] > 0.0) & (tangents.end[:, 1] > 0.0)
    np.testing.assert_array_equal(free, ~outer_right)
    assert math.isclose(float(tangents.length[outer_right][0]), 10_000.0)
