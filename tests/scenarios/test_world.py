"""Time, appearances, traffic and how finely a flight is recorded."""

from __future__ import annotations

import math

import numpy as np
import pytest

from scenarios.movers import FlownMover, PointMover
from scenarios.scenario import Obstacle, Point, Traffic
from scenarios.world import World
from tests.scenarios.flyers import StraightFlyer


def obstacle(north: float, **fields) -> Obstacle:
    return Obstacle(
        **{"id": 1, "east": 0.0, "altitude": 200.0, "safety_radius": 1000.0, **fields}, north=north
    )


def flight(world: World, seconds: int) -> None:
    for _ in range(seconds):
        world.advance(1.0)


def test_time_advances_exactly_whatever_the_steps():
    world = World([obstacle(0.0)], {"own": StraightFlyer()})
    flight(world, 400)
    assert world.now == 400.0
    assert world.tracks()[0].times[-1] == 400.0


def test_track_is_10_hz_within_3_km_and_1_hz_elsewhere():
    world = World([obstacle(10_000.0, east=500.0)], {"own": StraightFlyer(speed=20.0)})
    flight(world, 1000)
    track = world.tracks()[0]
    distance = np.hypot(track.positions[:, 0] - 10_000.0, track.positions[:, 1] - 500.0)
    gaps = np.diff(track.times)
    near = np.minimum(distance[:-1], distance[1:]) < 3000.0
    assert gaps[near].max() == pytest.approx(0.1)
    assert gaps.max() == pytest.approx(1.0)
    assert gaps[distance[:-1] > 3100.0].min() == pytest.approx(1.0)


def test_fine_steps_begin_before_a_pop_up_and_with_large_spheres():
    later = World([obstacle(0.0, appears_at=1e5)], {"own": StraightFlyer()})
    large = World([obstacle(6000.0, safety_radius=5000.0)], {"own": StraightFlyer()})
    for world in (later, large):
        world.advance(1.0)
        assert len(world.tracks()[0].times) == 11


def test_other_periods_are_kept():
    for period, steps in ((0.1, 1), (0.25, 3), (2.0, 20)):
        flyer = StraightFlyer()
        world = World([obstacle(0.0)], {"own": flyer})
        world.advance(period)
        assert len(flyer.steps) == steps
        assert sum(flyer.steps) == pytest.approx(period)


def test_a_flight_that_ends_is_not_flown_on():
    flyer = StraightFlyer(length=29.9)
    world = World([obstacle(0.0)], {"own": flyer})
    flight(world, 3)
    assert world.tracks()[0].times[-1] == pytest.approx(2.0)


def test_obstacles_appear_at_their_time():
    world = World([obstacle(50_000.0), obstacle(60_000.0, id=2, appears_at=2.0)], {"own": StraightFlyer()})
    seen = []
    for _ in range(4):
        seen.append(world.snapshot().ids.tolist())
        world.advance(1.0)
    assert seen == [[1], [1], [1, 2], [1, 2]]


def test_snapshot_is_read_only():
    snapshot = World([obstacle(9e4)], {"own": StraightFlyer()}).snapshot()
    with pytest.raises(ValueError, match="read-only"):
        snapshot.positions[0, 0] = 0.0


def plan(**fields) -> Traffic:
    points = (Point(0.0, 0.0, 100.0), Point(300.0, 400.0, 200.0), Point(300.0, 500.0, 200.0))
    return Traffic(**{"id": 9, "waypoints": points, "speed": 50.0, "motion": "point", **fields})


def test_point_traffic_flies_its_waypoints_at_its_speed():
    mover = PointMover(plan(starts_at=5.0))
    assert mover.position() is None
    positions = {}
    for second in range(20):
        mover.advance(float(second), 1.0)
        positions[second + 1] = mover.position()
    assert positions[4] is None
    assert positions[5] == (0.0, 0.0, 100.0)
    assert positions[10] == pytest.approx((150.0, 200.0, 150.0))
    assert positions[17] == pytest.approx((300.0, 500.0, 200.0))
    assert positions[18] is None


def test_flown_traffic_starts_late_and_goes_at_its_end():
    mover = FlownMover(plan(starts_at=2.0, violation_radius=700.0), StraightFlyer(length=45.0))
    positions = []
    for second in range(6):
        positions.append(mover.position())
        mover.advance(float(second), 1.0)
    assert [p is not None for p in positions] == [False, False, True, True, True, False]
    assert positions[3][0] == pytest.approx(15.0)
    assert (mover.radius, mover.shown_radius) == (700.0, 700.0)


def test_traffic_is_in_the_snapshot_and_recorded_in_step():
    mover = PointMover(plan(waypoints=(Point(2000.0, 0.0, 200.0), Point(0.0, 0.0, 200.0)), speed=100.0))
    world = World([obstacle(80_000.0)], {"own": StraightFlyer()}, [mover])
    assert world.snapshot().ids.tolist() == [1, 9]
    assert math.isnan(world.snapshot().radii[1])
    flight(world, 25)
    track, moving = world.tracks()[0], world.moving_tracks()[0]
    assert moving.positions.shape == track.positions.shape
    there = np.isfinite(moving.positions[:, 0])
    assert track.times[there][-1] == pytest.approx(20.0)
    assert moving.radius == 1000.0
    assert world.snapshot().ids.tolist() == [1]
