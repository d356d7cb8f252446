"""Separation, entries and lengths against cases that can be worked out by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from scenarios.metrics import first_pass, nearest_pass, path_length, separations
from scenarios.scenario import Obstacle
from scenarios.track import MovingTrack, Track


def track(times, positions) -> Track:
    zeros = np.zeros(len(times))
    return Track("own", np.array(times, float), np.array(positions, float), zeros, zeros, zeros)


def obstacle(**fields) -> Obstacle:
    usual = {"id": 1, "north": 0.0, "east": 0.0, "altitude": 200.0, "safety_radius": 1000.0}
    return Obstacle(**{**usual, **fields})


STRAIGHT = track([0.0, 100.0], [(-5000.0, 600.0, 200.0), (5000.0, 600.0, 200.0)])


def test_least_distance_lies_between_samples():
    (near,) = separations(STRAIGHT, [obstacle()])
    assert near.distance == pytest.approx(600.0)
    assert near.time == pytest.approx(50.0)
    assert (near.entries, near.radius, near.margin) == (1, 1000.0, pytest.approx(-400.0))


def test_separation_is_three_dimensional():
    (above,) = separations(STRAIGHT, [obstacle(altitude=1000.0)])
    assert above.distance == pytest.approx(1000.0)
    assert above.entries == 0  # touching is not entering


def test_every_entry_counts_once():
    zigzag = [(-3000.0, 0.0, 200.0), (3000.0, 0.0, 200.0), (3000.0, 900.0, 200.0), (-3000.0, 900.0, 200.0)]
    (twice,) = separations(track([0, 1, 2, 3], zigzag), [obstacle()])
    assert twice.entries == 2
    inside = [(-3000.0, 0.0, 200.0), (-500.0, 0.0, 200.0), (500.0, 0.0, 200.0), (3000.0, 0.0, 200.0)]
    (once,) = separations(track([0, 1, 2, 3], inside), [obstacle()])
    assert once.entries == 1


def test_a_corner_outside_parts_two_entries():
    corner = [(-1500.0, 500.0, 200.0), (0.0, 1001.0, 200.0), (0.0, 0.0, 200.0)]
    (near,) = separations(track([0, 1, 2], corner), [obstacle()])
    assert near.entries == 2


def test_obstacles_count_from_their_appearance():
    (late,) = separations(STRAIGHT, [obstacle(appears_at=80.0)])
    assert late.distance == pytest.approx(math.hypot(3000.0, 600.0))
    assert late.time == pytest.approx(80.0)
    (on_top,) = separations(STRAIGHT, [obstacle(appears_at=50.0)])
    assert (on_top.distance, on_top.entries) == (pytest.approx(600.0), 1)
    assert separations(STRAIGHT, [obstacle(appears_at=101.0)]) == []
    (at_the_end,) = separations(STRAIGHT, [obstacle(appears_at=100.0)])
    assert at_the_end.distance == pytest.approx(math.hypot(5000.0, 600.0))


def test_traffic_is_measured_by_relative_motion():
    """Two aircraft cross between samples: neither track's samples are near the other's."""
    own = track([0, 10], [(0.0, 0.0, 200.0), (1000.0, 0.0, 200.0)])
    other = MovingTrack(9, 50.0, np.array([(500.0, -500.0, 200.0), (500.0, 500.0, 200.0)]))
    (near,) = separations(own, [], [other])
    assert near.distance == pytest.approx(0.0, abs=1e-9)
    assert (near.time, near.entries, near.moving) == (pytest.approx(5.0), 1, True)


def test_traffic_counts_only_while_it_exists():
    own = track([0, 1, 2, 3], [(0, 0, 0), (100, 0, 0), (200, 0, 0), (300, 0, 0)])
    nan = (math.nan,) * 3
    brief = MovingTrack(9, 50.0, np.array([nan, (500.0, 0, 0), (500.0, 0, 0), nan]))
    (near,) = separations(own, [], [brief])
    assert (near.distance, near.time) == (pytest.approx(300.0), pytest.approx(2.0))
    single = MovingTrack(9, 500.0, np.array([nan, (500.0, 0, 0), nan, nan]))
    (point,) = separations(own, [], [single])
    assert (point.distance, point.time, point.entries) == (pytest.approx(400.0), 1.0, 1)
    assert separations(own, [], [MovingTrack(9, 50.0, np.array([nan] * 4))]) == []


def test_lengths_and_passes_are_horizontal():
    climb = [(0.0, 0.0, 0.0), (3000.0, 4000.0, 5000.0), (3000.0, 5000.0, 0.0)]
    assert path_length(np.array(climb)) == pytest.approx(6000.0)
    flown = track([0, 500, 600], climb)
    assert nearest_pass(flown, (3000.0, 4500.0)) == pytest.approx(0.0, abs=1e-9)
    assert first_pass(flown, (1500.0, 2000.0), 10.0) == pytest.approx(250.0)
    assert first_pass(flown, (1500.0, 2000.0), 10.0, after=501.0) is None


def test_a_track_of_one_sample_is_a_point():
    here = track([7.0], [(300.0, 400.0, 200.0)])
    assert nearest_pass(here, (0.0, 0.0)) == pytest.approx(500.0)
    assert first_pass(here, (0.0, 0.0), 500.0) == pytest.approx(7.0)
    assert first_pass(here, (0.0, 0.0), 499.0) is None
    assert first_pass(here, (0.0, 0.0), 500.0, after=8.0) is None
    other = MovingTrack(9, 50.0, np.array([(300.0, 0.0, 200.0)]))
    still, moving = separations(here, [obstacle()], [other])
    assert (still.distance, still.entries) == (pytest.approx(500.0), 1)
    assert (moving.distance, moving.entries) == (pytest.approx(400.0), 0)
    assert path_length(here.positions) == 0.0


def test_a_pass_is_never_before_the_time_asked_for():
    there = track([0.0, 10.0], [(-5000.0, 0.0, 200.0), (5000.0, 0.0, 200.0)])
    assert first_pass(there, (0.0, 0.0), 600.0, after=5.5) == pytest.approx(5.5)
    assert first_pass(there, (0.0, 0.0), 600.0, after=6.0) is None


coordinate = st.floats(-5000.0, 5000.0)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=2, max_size=6), st.data())
def test_no_sampled_point_is_nearer_than_the_separation(points, data):
    flown = track(range(len(points)), points)
    centre = obstacle(north=data.draw(coordinate), east=data.draw(coordinate), altitude=data.draw(coordinate))
    (near,) = separations(flown, [centre])
    fine = np.linspace(0.0, len(points) - 1, 501)
    sampled = np.column_stack([np.interp(fine, flown.times, column) for column in flown.positions.T])
    distances = np.linalg.norm(sampled - (centre.north, centre.east, centre.altitude), axis=1)
    spacing = np.linalg.norm(np.diff(sampled, axis=0), axis=1).max()
    assert distances.min() - spacing - 1e-6 <= near.distance <= distances.min() + 1e-6
    inside = distances < near.radius
    sampled_entries = int(inside[0]) + int((inside[1:] & ~inside[:-1]).sum())
    assert near.entries >= sampled_entries


@given(st.integers(0, 2**32 - 1), st.integers(2, 700))
def test_leaving_out_far_pieces_changes_nothing(seed, samples):
    rng = np.random.default_rng(seed)
    steps = rng.normal(0.0, 60.0, (samples, 3)) + np.array((5.0, 0.0, 0.0))
    positions = np.cumsum(steps, axis=0)
    still = np.zeros(samples)
    track = Track("own", np.arange(float(samples)), positions, still, still, still)
    north, east, altitude = positions[rng.integers(samples)] + rng.normal(0.0, 300.0, 3)
    (found,) = separations(track, [Obstacle(1, north, east, altitude, 250.0)])
    whole = MovingTrack(1, 250.0, np.tile((north, east, altitude), (samples, 1)))
    (expected,) = separations(track, [], [whole])
    assert found == replace(expected, moving=False)
