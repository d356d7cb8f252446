"""What the simulated radar shows, with and without its faults."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from scenarios.movers import PointMover
from scenarios.radar import FIRST_FALSE_ID, SimulatedRadar
from scenarios.scenario import Obstacle, Point, RadarSettings, Traffic
from scenarios.world import World
from tests.scenarios.flyers import StraightFlyer


def radar_and_state(places, flyer=None, **settings):
    obstacles = [Obstacle(k, n, e, 200.0, 1000.0 + k) for k, (n, e) in enumerate(places, start=1)]
    flyer = flyer or StraightFlyer()
    world = World(obstacles, {"own": flyer})
    return SimulatedRadar(world, RadarSettings(**settings), np.random.default_rng(1)), flyer, world


def test_sees_what_is_in_range_and_exactly_there():
    radar, flyer, _ = radar_and_state([(9_999.0, 0.0), (10_001.0, 0.0), (-6000.0, 8000.0)])
    scan = radar.scan(flyer.state(), 0.0)
    assert scan.ids.tolist() == [1, 3]
    assert scan.positions.tolist() == [[9999.0, 0.0, 200.0], [-6000.0, 8000.0, 200.0]]
    assert scan.radii.tolist() == [1001.0, 1003.0]


def test_an_empty_sky_is_an_empty_scan():
    radar, flyer, _ = radar_and_state([(90_000.0, 0.0)])
    scan = radar.scan(flyer.state(), 3.0)
    assert (scan.time, scan.ids.shape, scan.positions.shape) == (3.0, (0,), (0, 3))


def test_without_faults_no_random_number_is_drawn():
    radar, flyer, _ = radar_and_state([(5000.0, 0.0)])
    before = radar._rng.bit_generator.state
    radar.scan(flyer.state(), 0.0)
    assert radar._rng.bit_generator.state == before


def test_field_of_view_is_about_the_nose():
    flyer = StraightFlyer(heading=math.radians(170.0))
    places = [(-5000.0, 0.0), (5000.0, 0.0), (0.0, 5000.0), (0.0, -5000.0)]
    radar, flyer, _ = radar_and_state(places, flyer, field_of_view=math.radians(40.0))
    assert radar.scan(flyer.state(), 0.0).ids.tolist() == [1]


def test_noise_has_the_stated_size():
    radar, flyer, _ = radar_and_state([(6000.0, 0.0)], range_noise=50.0, bearing_noise=0.01)
    seen = np.array([radar.scan(flyer.state(), 0.0).positions[0] for _ in range(4000)])
    assert seen[:, 0].std() == pytest.approx(50.0, rel=0.06)
    assert seen[:, 1].std() == pytest.approx(60.0, rel=0.06)
    assert np.abs(seen.mean(axis=0) - (6000.0, 0.0, 200.0)).max() < 5.0


def test_detection_probability():
    radar, flyer, _ = radar_and_state([(6000.0, 0.0)], detection_probability=0.7)
    seen = sum(radar.scan(flyer.state(), 0.0).ids.size for _ in range(2000))
    assert seen == pytest.approx(1400, abs=100)


def test_false_tracks_are_in_range_and_never_named_alike():
    radar, flyer, _ = radar_and_state([(6000.0, 0.0)], false_tracks=2.0, range=8000.0)
    scans = [radar.scan(flyer.state(), 0.0) for _ in range(500)]
    false = [i for scan in scans for i in scan.ids.tolist() if i >= FIRST_FALSE_ID]
    assert len(false) == len(set(false)) == pytest.approx(1000, abs=150)
    assert all(np.hypot(s.positions[:, 0], s.positions[:, 1]).max() <= 8000.0 for s in scans)
    assert all(math.isnan(s.radii[-1]) for s in scans if s.ids[-1] >= FIRST_FALSE_ID)


def test_latency_delivers_old_sweeps_with_their_time():
    radar, flyer, world = radar_and_state([(6000.0, 0.0)], latency=2.0)
    scans = []
    for _ in range(5):
        scans.append(radar.scan(flyer.state(), world.now))
        world.advance(1.0)
    assert [scan.time for scan in scans] == [-2.0, -1.0, 0.0, 1.0, 2.0]
    assert [scan.ids.size for scan in scans] == [0, 0, 1, 1, 1]


def test_scans_are_read_only():
    radar, flyer, _ = radar_and_state([(6000.0, 0.0)], range_noise=1.0)
    with pytest.raises(ValueError, match="read-only"):
        radar.scan(flyer.state(), 0.0).positions[0, 0] = 0.0


def test_what_comes_into_range_is_seen_on_the_first_scan_that_can():
    radar, flyer, world = radar_and_state([(12_000.0, 50.0), (30_000.0, 0.0)])
    while world.now < 1500.0:
        in_range = np.hypot(np.array([12_000.0, 30_000.0]) - flyer.north, (50.0, 0.0)) <= 10_000.0
        assert radar.scan(flyer.state(), world.now).ids.tolist() == (np.flatnonzero(in_range) + 1).tolist()
        world.advance(1.0)


def test_swapped_identities_stay_swapped_and_none_is_lost():
    radar, flyer, _ = radar_and_state([(5000.0, 0.0), (6000.0, 0.0), (7000.0, 0.0)], id_swaps=0.2)
    scans = [radar.scan(flyer.state(), 0.0) for _ in range(200)]
    shown = [tuple(scan.ids.tolist()) for scan in scans]
    changes = sum(a != b for a, b in pairwise(shown))
    assert all(sorted(ids) == [1, 2, 3] for ids in shown)
    assert changes == pytest.approx(40, abs=15)
    assert all(scan.positions[:, 0].tolist() == [5000.0, 6000.0, 7000.0] for scan in scans)


def test_returns_are_placed_from_where_the_vehicle_believes_to_be():
    radar, flyer, _ = radar_and_state([(5000.0, 0.0), (10_010.0, 0.0)])
    state = flyer.state()
    own = replace(state.ownship, north=30.0, east=-20.0, position_error=25.0)
    scan = radar.scan(replace(state, ownship=own), 0.0)
    assert scan.ids.tolist() == [1]  # what is in range is decided by the truth
    assert scan.positions.tolist() == [[5030.0, -20.0, 200.0]]


def test_traffic_and_other_vehicles_are_seen_and_the_own_one_is_not():
    plan = Traffic(9, (Point(0.0, 3000.0, 200.0), Point(9e4, 3000.0, 200.0)), motion="point")
    flyers = {"a": StraightFlyer(), "b": StraightFlyer(east=2000.0, length=50.0)}
    world = World([Obstacle(1, 4000.0, 0.0, 200.0, 800.0)], flyers, [PointMover(plan)], {"a": 11, "b": 12})
    radar = SimulatedRadar(world, RadarSettings(), np.random.default_rng(0), "a")
    scan = radar.scan(flyers["a"].state(), 0.0)
    assert scan.ids.tolist() == [1, 9, 12]
    assert scan.positions[2].tolist() == [0.0, 2000.0, 200.0]
    assert math.isnan(scan.radii[2])
    for _ in range(5):
        world.advance(1.0)
    assert radar.scan(flyers["a"].state(), 5.0).ids.tolist() == [1, 9]  # b has finished


def test_a_hundred_thousand_obstacles_far_away_change_nothing():
    rng = np.random.default_rng(0)
    far = rng.uniform(50_000.0, 900_000.0, (100_000, 2)).tolist()
    crowded, flyer, world = radar_and_state([(9000.0, 100.0), *far])
    lonely, other, _ = radar_and_state([(9000.0, 100.0)])
    for _ in range(400):
        assert (
            crowded.scan(flyer.state(), world.now).ids.tolist()
            == lonely.scan(other.state(), world.now).ids.tolist()
        )
        world.advance(1.0)
        other.advance(1.0)
