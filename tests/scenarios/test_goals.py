"""Which waypoints can be reached, and where else: known cases, and a raster as an independent judge."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage

from scenarios.goals import ReplacementRule, goals, nearest_reachable, separated
from scenarios.scenario import Obstacle, Point

RULE = ReplacementRule(margin=50.0, needed=84.0, rooms=(84.0, 42.0))
START = Point(-20_000.0, 0.0, 200.0)


def obstacle(north: float, east: float, radius: float = 1000.0, altitude: float = 200.0) -> Obstacle:
    return Obstacle(1, north, east, altitude, radius)


def ring(radius: float, count: int) -> np.ndarray:
    angles = np.arange(count) * 2.0 * math.pi / count
    return radius * np.column_stack((np.cos(angles), np.sin(angles)))


def test_a_free_waypoint_is_its_own_goal():
    (_, goal) = goals([START, Point(0.0, 1134.5, 200.0)], [obstacle(0.0, 0.0)], RULE)
    assert (goal.point, goal.shift, goal.replaced) == ((0.0, 1134.5), 0.0, False)


def test_an_unsafe_waypoint_moves_radially_out():
    (_, goal) = goals([START, Point(0.0, 300.0, 200.0)], [obstacle(0.0, 0.0)], RULE)
    assert goal.point == pytest.approx((0.0, 1134.0))
    assert goal.shift == pytest.approx(834.0)
    assert goal.replaced


def test_two_spheres_leave_their_crossing():
    pair = [obstacle(0.0, -900.0), obstacle(0.0, 900.0)]
    (_, goal) = goals([START, Point(100.0, 0.0, 200.0)], pair, RULE)
    assert goal.point == pytest.approx((math.sqrt(1134.0**2 - 900.0**2), 0.0))


def test_an_obstacle_far_above_does_not_count():
    (_, goal) = goals([START, Point(0.0, 0.0, 200.0)], [obstacle(0.0, 0.0, altitude=1300.0)], RULE)
    assert not goal.replaced


@pytest.mark.parametrize("altitude", [1205.0, -805.0])
def test_an_obstacle_within_the_altitude_tolerance_counts(altitude: float):
    """1,005 m above or below: 15 m nearer it is a circle of √(1000² − 990²) m."""
    rule = replace(RULE, altitude_tolerance=15.0)
    mission = [START, Point(0.0, 50.0, 200.0), Point(0.0, 50.0, 201.0 if altitude < 0.0 else 199.0)]
    (_, goal, higher) = goals(mission, [obstacle(0.0, 0.0, altitude=altitude)], rule)
    assert math.hypot(*goal.point) == pytest.approx(math.sqrt(1000.0**2 - 990.0**2) + 134.0)
    assert math.hypot(*higher.point) == pytest.approx(math.sqrt(1000.0**2 - 991.0**2) + 134.0)
    (_, goal) = goals(mission[:2], [obstacle(0.0, 0.0, altitude=1215.0)], rule)
    assert not goal.replaced


def test_an_enclosed_waypoint_moves_outside_its_ring():
    wall = [obstacle(n, e) for n, e in ring(4000.0, 16)]
    (_, goal) = goals([START, Point(0.0, 0.0, 200.0)], wall, RULE)
    assert math.hypot(*goal.point) > 4000.0
    gap = [o for o in wall if o.north > -3900.0]  # one taken out on the side of the start
    (_, goal) = goals([START, Point(0.0, 0.0, 200.0)], gap, RULE)
    assert not goal.replaced


def test_nothing_can_be_reached_from_inside_a_ring():
    centres = ring(4000.0, 16)
    walls = np.full(16, 1050.0)
    assert separated((0.0, 0.0), (9000.0, 0.0), centres, walls)
    assert not separated((0.0, 0.0), (2000.0, 0.0), centres, walls)
    inside = nearest_reachable((9000.0, 0.0), (0.0, 0.0), centres, walls, walls + 50.0)
    assert inside is not None
    assert math.hypot(*inside) < 4000.0


def test_a_start_in_its_own_pocket_reaches_no_other_pocket():
    two = np.concatenate((ring(4000.0, 16), ring(4000.0, 16) + np.array((20_000.0, 0.0))))
    walls = np.full(len(two), 1050.0)
    assert separated((0.0, 0.0), (20_000.0, 0.0), two, walls)


def test_duplicates_and_lattices_do_no_harm():
    grid = np.array([(n, e) for n in range(-3, 4) for e in range(-3, 4)], dtype=float) * 1000.0
    grid = np.concatenate((grid, grid[:7]))
    walls = np.full(len(grid), 760.0)
    assert not separated((9000.0, 0.0), (-9000.0, 0.0), grid, walls)
    holes = np.full(len(grid), 700.0)  # now the middle of each cell is a pocket
    assert separated((500.0, 500.0), (9000.0, 0.0), grid, holes)
    assert separated((500.0, 500.0), (1500.0, 500.0), grid, holes)


@pytest.mark.parametrize("seed", range(6))
def test_separation_agrees_with_a_raster(seed: int):
    """Flood fill on a 25 m raster; pairs whose answer hangs on less than a cell are left out."""
    rng = np.random.default_rng(seed)
    centres = rng.uniform(-4000.0, 4000.0, (26, 2))
    radii = rng.uniform(500.0, 1300.0, 26)
    axis = np.arange(-7000.0, 7000.0, 25.0)
    north, east = np.meshgrid(axis, axis, indexing="ij")
    clearance = np.full(north.shape, np.inf)
    for (n, e), r in zip(centres, radii, strict=True):
        clearance = np.minimum(clearance, np.hypot(north - n, east - e) - r)
    tight, _ = ndimage.label(clearance > 36.0)
    loose, _ = ndimage.label(clearance > -36.0, structure=np.ones((3, 3)))
    free = np.argwhere(clearance > 40.0)
    judged = 0
    for i, j in rng.choice(free, (60, 2)):
        a, b = (axis[i[0]], axis[i[1]]), (axis[j[0]], axis[j[1]])
        connected = tight[tuple(i)] == tight[tuple(j)]
        if connected == (loose[tuple(i)] == loose[tuple(j)]):
            judged += 1
            assert separated(a, b, centres, radii) == (not connected)
    assert judged > 15


@pytest.mark.parametrize("seed", range(4))
def test_no_reachable_point_of_a_raster_is_nearer(seed: int):
    rng = np.random.default_rng(100 + seed)
    centres = rng.uniform(-3000.0, 3000.0, (12, 2))
    walls = rng.uniform(600.0, 1200.0, 12)
    found = nearest_reachable((0.0, 0.0), (-9000.0, 0.0), centres, walls, walls + 84.0)
    axis = np.arange(-6000.0, 6000.0, 30.0)
    north, east = np.meshgrid(axis, axis, indexing="ij")
    clearance = np.full(north.shape, np.inf)
    for (n, e), r in zip(centres, walls, strict=True):
        clearance = np.minimum(clearance, np.hypot(north - n, east - e) - r)
    labels, _ = ndimage.label(clearance > 0.0)
    reachable = (labels == labels[0, 0]) & (clearance >= 84.0)
    nearest = np.hypot(north[reachable], east[reachable]).min()
    assert nearest - 45.0 <= math.hypot(*found) <= nearest + 1e-6
