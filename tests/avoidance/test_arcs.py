"""Covered arcs against points tested one by one."""

from __future__ import annotations

import math

import numpy as np
import pytest

from avoidance.arcs import admit, covered_arcs


def test_two_discs_cover_the_textbook_angle_of_each_other() -> None:
    """Equal radii r at a distance r: half of the covered angle is acos(1/2) = 60°."""
    arcs = covered_arcs(np.array([(0.0, 0.0), (0.0, 1.0)]), np.ones(2), np.ones(2))

    assert arcs.disc.tolist() == [0, 1]
    assert np.degrees(arcs.begin) == pytest.approx([30.0, 210.0])
    assert np.degrees(arcs.end) == pytest.approx([150.0, 330.0])
    assert arcs.opener.tolist() == arcs.closer.tolist() == [1, 0]


def test_an_arc_over_north_is_split_there_and_leaves_one_gap() -> None:
    arcs = covered_arcs(np.array([(0.0, 0.0), (1.0, 0.0)]), np.ones(2), np.array([0.0, 1.0]))

    assert np.degrees(arcs.begin) == pytest.approx([0.0, 300.0])
    assert np.degrees(arcs.end) == pytest.approx([60.0, 360.0])
    around = np.radians([61.0, 180.0, 299.0])
    assert len(set(arcs.gap(np.zeros(3, dtype=np.int64), around).tolist())) == 1


def test_circle_without_covered_arcs_has_a_gap_of_its_own() -> None:
    centres = np.array([(0.0, 0.0), (0.0, 1.0), (9.0, 0.0)])
    arcs = covered_arcs(centres, np.ones(3), np.ones(3))

    assert arcs.gap(np.array([2, 2]), np.array([0.1, 6.0])).tolist() == [4, 4]
    assert arcs.gap(np.array([0, 1]), np.array([0.0, 0.0])).tolist() == [0, 1]


@pytest.mark.parametrize("seed", range(5))
def test_covered_means_inside_another_disc(seed) -> None:
    rng = np.random.default_rng(seed)
    centres, radii = rng.uniform(-3e3, 3e3, (15, 2)), rng.uniform(200.0, 1_800.0, 15)
    arcs = covered_arcs(centres, radii, radii)
    disc = np.repeat(np.arange(15), 90)
    angle = np.tile(np.radians(np.arange(90) * 4.0 + 1.7), 15)
    spots = centres[disc] + radii[disc, None] * np.column_stack([np.cos(angle), np.sin(angle)])

    covered = arcs.covers(disc, angle)

    inside = np.hypot(spots[:, 0, None] - centres[:, 0], spots[:, 1, None] - centres[:, 1]) < radii
    inside[np.arange(len(disc)), disc] = False
    np.testing.assert_array_equal(covered, inside.any(axis=1))


def test_admit_shrinks_within_the_tolerance_only() -> None:
    centres, radii = np.zeros((1, 2)), np.array([1_000.0])

    assert admit({"start": (999.9995, 0.0)}, centres, radii) == pytest.approx([999.9995])
    assert admit({"start": (1_000.5, 0.0)}, centres, radii) is radii
    assert admit({"start": (10.0, 0.0)}, centres, radii, tolerance=1.0) == pytest.approx([10.0])
    with pytest.raises(ValueError, match=r"start .* disc 0: 999.000 m .* radius 1000.000 m"):
        admit({"start": (math.sqrt(999.0**2), 0.0)}, centres, radii)
