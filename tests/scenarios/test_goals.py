"""Which waypoints can be reached, and where else: known cases, and a raster as an independent judge."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage

from scenarios.fence import FenceArea, allowed
from scenarios.goals import ReplacementRule, barred_by_fence, goals, nearest_reachable
from scenarios.scenario import Obstacle, Point
from scenarios.walled import Shapes, fence_shapes, separated

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


def test_behind_a_narrow_way_in_a_waypoint_moves_outside():
    """Of a ring with a gap 2.3 times 134 m wide: it counts as shut where 140 m are needed on both sides."""
    wall = [obstacle(n, e) for n, e in ring(4000.0, 16)]
    ajar = 2.0 * math.asin((1000.0 + 1.15 * 134.0) / 4000.0)
    pair = [obstacle(-4000.0 * math.cos(a), 4000.0 * math.sin(a)) for a in (-0.5 * ajar, 0.5 * ajar)]
    wall = [o for o in wall if o.north > -3000.0] + pair
    mission = [START, Point(0.0, 0.0, 200.0)]
    (_, goal) = goals(mission, wall, replace(RULE, passage=84.0))
    assert not goal.replaced
    (_, goal) = goals(mission, wall, replace(RULE, needed=120.0, rooms=(120.0,), passage=120.0))
    assert math.hypot(*goal.point) > 4000.0
    short = replace(RULE, needed=120.0, rooms=(120.0,), passage=120.0, stretch=600.0)
    (_, goal) = goals(mission, wall, short)  # 240 m wide within 250 m from the narrowest
    assert not goal.replaced


def test_a_start_behind_a_narrow_way_bars_nothing():
    rule = replace(RULE, passage=60.0)
    strip, field = ((-5400.0, -70.0), (-4900.0, 70.0)), ((-4950.0, -3000.0), (8000.0, 3000.0))
    fence = [FenceArea(True, ((s, w), (n, w), (n, e), (s, e))) for (s, w), (n, e) in (strip, field)]
    (_, goal) = goals([Point(-5200.0, 0.0, 200.0), Point(5000.0, 0.0, 200.0)], [], rule, fence)
    assert goal.point == (5000.0, 0.0)


def test_an_enclosed_waypoint_moves_outside_its_ring():
    wall = [obstacle(n, e) for n, e in ring(4000.0, 16)]
    (_, goal) = goals([START, Point(0.0, 0.0, 200.0)], wall, RULE)
    assert math.hypot(*goal.point) > 4000.0
    gap = [o for o in wall if o.north > -3900.0]  # one taken out on the side of the start
    (_, goal) = goals([START, Point(0.0, 0.0, 200.0)], gap, RULE)
    assert not goal.replaced


def test_nothing_can_be_reached_from_inside_a_ring():
    walls = Shapes.discs(ring(4000.0, 16), np.full(16, 1050.0))
    assert separated((0.0, 0.0), (9000.0, 0.0), walls)
    assert not separated((0.0, 0.0), (2000.0, 0.0), walls)
    inside = nearest_reachable((9000.0, 0.0), (0.0, 0.0), walls, 50.0)
    assert inside is not None
    assert math.hypot(*inside) < 4000.0


def test_a_start_in_its_own_pocket_reaches_no_other_pocket():
    two = np.concatenate((ring(4000.0, 16), ring(4000.0, 16) + np.array((20_000.0, 0.0))))
    assert separated((0.0, 0.0), (20_000.0, 0.0), Shapes.discs(two, np.full(len(two), 1050.0)))


def test_duplicates_and_lattices_do_no_harm():
    grid = np.array([(n, e) for n in range(-3, 4) for e in range(-3, 4)], dtype=float) * 1000.0
    grid = np.concatenate((grid, grid[:7]))
    walls = Shapes.discs(grid, np.full(len(grid), 760.0))
    assert not separated((9000.0, 0.0), (-9000.0, 0.0), walls)
    holes = Shapes.discs(grid, np.full(len(grid), 700.0))  # now the middle of each cell is a pocket
    assert separated((500.0, 500.0), (9000.0, 0.0), holes)
    assert separated((500.0, 500.0), (1500.0, 500.0), holes)


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
            assert separated(a, b, Shapes.discs(centres, radii)) == (not connected)
    assert judged > 15


@pytest.mark.parametrize("seed", range(4))
def test_no_reachable_point_of_a_raster_is_nearer(seed: int):
    rng = np.random.default_rng(100 + seed)
    centres = rng.uniform(-3000.0, 3000.0, (12, 2))
    walls = rng.uniform(600.0, 1200.0, 12)
    found = nearest_reachable((0.0, 0.0), (-9000.0, 0.0), Shapes.discs(centres, walls), 84.0)
    axis = np.arange(-6000.0, 6000.0, 30.0)
    north, east = np.meshgrid(axis, axis, indexing="ij")
    clearance = np.full(north.shape, np.inf)
    for (n, e), r in zip(centres, walls, strict=True):
        clearance = np.minimum(clearance, np.hypot(north - n, east - e) - r)
    labels, _ = ndimage.label(clearance > 0.0)
    reachable = (labels == labels[0, 0]) & (clearance >= 84.0)
    nearest = np.hypot(north[reachable], east[reachable]).min()
    assert nearest - 45.0 <= math.hypot(*found) <= nearest + 1e-6


def rectangle(south: float, west: float, north: float, east: float, *, include: bool = True) -> FenceArea:
    return FenceArea(include, ((south, west), (north, west), (north, east), (south, east)))


def moved(
    fence: list[FenceArea], place: tuple[float, float], obstacles: list[Obstacle]
) -> tuple[float, float]:
    (_, goal) = goals([Point(-8000.0, 0.0, 200.0), Point(*place, 200.0)], obstacles, RULE, fence)
    return goal.point


FIELD = [rectangle(-10_000.0, -3000.0, 10_000.0, 3000.0)]


@pytest.mark.parametrize(
    ("fence", "place", "expected"),
    [
        (FIELD, (0.0, 2866.0), (0.0, 2866.0)),
        (FIELD, (0.0, 2900.0), (0.0, 2866.0)),
        (FIELD, (0.0, 5000.0), (0.0, 2866.0)),
        (FIELD, (12_000.0, 5000.0), (9866.0, 2866.0)),
        ([FenceArea(False, centre=(0.0, 0.0), radius=500.0)], (100.0, 0.0), (634.0, 0.0)),
        ([rectangle(-500.0, -500.0, 500.0, 500.0, include=False)], (100.0, 0.0), (634.0, 0.0)),
    ],
    ids=["room enough", "near the edge", "outside", "beyond a corner", "forbidden circle", "forbidden box"],
)
def test_a_waypoint_outside_the_fence_or_near_its_edge_moves_in(
    fence: list[FenceArea], place: tuple[float, float], expected: tuple[float, float]
) -> None:
    assert moved(fence, place, []) == pytest.approx(expected)


def test_a_round_field_keeps_its_waypoints_within_half_a_metre() -> None:
    point = moved([FenceArea(True, centre=(0.0, 0.0), radius=9000.0)], (9500.0, 0.0), [])
    assert math.hypot(*point) == pytest.approx(9000.0 - 134.0, abs=0.51)


def test_a_round_field_of_any_size_has_walls_that_can_be_counted() -> None:
    """They leave the circle by no more than a hundred-thousandth of its radius."""
    field = [FenceArea(True, centre=(0.0, 0.0), radius=1e6)]
    assert len(fence_shapes(field, 50.0)) == 720
    assert math.hypot(*moved(field, (1e6 + 500.0, 0.0), [])) == pytest.approx(1e6 - 134.0, abs=10.0)


def test_what_rounding_cuts_off_an_edge_is_no_wall() -> None:
    """A corner of one area lies on a corner of the other, but for rounding."""
    halves = [rectangle(0.0, 0.0, 1000.0, 1000.0), rectangle(1e-10, -1000.0, 500.0, 500.0)]
    walls = fence_shapes(halves, 5.0)
    length = np.hypot(*(walls.ends - walls.starts).T)
    assert length.min() > 1.0
    assert length.sum() == pytest.approx(6500.0)


def test_areas_that_overlap_are_one_field() -> None:
    """The edge of one that runs inside another is no wall, nor where they share it."""
    for south in (-500.0, 0.0):
        halves = [rectangle(-10_000.0, -3000.0, 0.0, 3000.0), rectangle(south, -3000.0, 10_000.0, 3000.0)]
        assert moved(halves, (4000.0, 0.0), []) == (4000.0, 0.0)
        assert (
            barred_by_fence([Point(-8000.0, 0.0, 200.0), Point(4000.0, 0.0, 200.0)], [], RULE, halves) == []
        )


def test_a_way_that_only_leads_outside_the_fence_is_none() -> None:
    """Three spheres bar a field from edge to edge; one may go round them, but not within the fence."""
    across = [obstacle(0.0, east) for east in (-2090.0, 0.0, 2090.0)]
    mission = [Point(-8000.0, 0.0, 200.0), Point(5000.0, 0.0, 200.0), Point(-5000.0, 1000.0, 200.0)]
    (_, behind, before) = goals(mission, across, RULE, FIELD)
    assert behind.point[0] < 0.0
    assert math.hypot(behind.point[0], abs(behind.point[1]) - 1050.0) == pytest.approx(500.0, abs=500.0)
    assert not before.replaced
    assert barred_by_fence(mission, across, RULE, FIELD) == [1]
    assert barred_by_fence(mission, across, RULE, []) == []
    assert barred_by_fence(mission, across[:2], RULE, FIELD) == []


def test_a_gap_beside_the_fence_is_as_wide_as_its_margins_leave_it() -> None:
    """Between a sphere and a straight edge 50 m are kept from either."""
    for gap, barred in ((101.0, []), (99.0, [1])):
        across = [obstacle(0.0, -2000.0 + gap, 1000.0), obstacle(0.0, 1000.0, 2100.0)]
        mission = [Point(-8000.0, 0.0, 200.0), Point(8000.0, 0.0, 200.0)]
        assert barred_by_fence(mission, across, RULE, FIELD) == barred


@pytest.mark.parametrize("seed", range(6))
def test_goals_within_a_fence_agree_with_a_raster(seed: int) -> None:
    """The nearest goal, by flood fill on a 25 m raster of what fence and discs leave."""
    rng = np.random.default_rng(200 + seed)
    notch = float(rng.uniform(-2500.0, 2500.0))
    west = ((-4000.0, -4000.0), (0.0, -4000.0), (0.0, notch), (900.0, notch), (900.0, -4000.0))
    fence = [
        FenceArea(True, (*west, (4000.0, -4000.0), (4000.0, 1000.0), (-4000.0, 1000.0))),
        FenceArea(True, centre=(500.0, 1500.0), radius=2500.0),
        rectangle(-2500.0, -800.0, -1500.0, 3000.0, include=False),
        FenceArea(False, centre=(2500.0, -1500.0), radius=700.0),
    ]
    spheres = [obstacle(*rng.uniform(-3500.0, 3500.0, 2), rng.uniform(200.0, 700.0)) for _ in range(9)]
    start = (-3700.0, -3700.0)
    spheres = [
        o for o in spheres if math.hypot(o.north - start[0], o.east - start[1]) > o.safety_radius + 80.0
    ]
    axis = np.arange(-5000.0, 5000.0, 25.0)
    cells = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1)
    flat = cells.reshape(-1, 2)
    gap = ndimage.distance_transform_edt(allowed(fence, flat).reshape(cells.shape[:2])) * 25.0
    for o in spheres:
        gap = np.minimum(gap, np.hypot(cells[..., 0] - o.north, cells[..., 1] - o.east) - o.safety_radius)
    for place in rng.uniform(-4000.0, 4000.0, (6, 2)):
        mission = [Point(*start, 200.0), Point(*place, 200.0)]
        point = goals(mission, spheres, RULE, fence)[1].point
        away = np.hypot(*(cells - place).transpose(2, 0, 1))
        found = 0.0 if point is None else math.dist(point, place)
        tight, loose = _raster_goal(gap, away, start, 40.0), _raster_goal(gap, away, start, -40.0)
        assert loose - 60.0 <= found <= tight + 60.0


def _raster_goal(gap: np.ndarray, away: np.ndarray, start: tuple[float, float], slack: float) -> float:
    """Distance of the nearest cell with room to turn that is reached through cells beyond the margin [m]."""
    labels, _ = ndimage.label(gap > RULE.margin + slack)
    home = labels[round((start[0] + 5000.0) / 25.0), round((start[1] + 5000.0) / 25.0)]
    assert home
    return float(away[(labels == home) & (gap >= RULE.margin + RULE.rooms[0] + slack)].min())


def test_the_edges_of_a_fence_are_walls_only_where_they_part() -> None:
    halves = [rectangle(0.0, 0.0, 1000.0, 1000.0), rectangle(500.0, 200.0, 2000.0, 800.0)]
    walls = fence_shapes(halves, 5.0)
    length = np.hypot(*(walls.ends - walls.starts).T).sum()
    assert length == pytest.approx(3400.0 + 600.0 + 2000.0)
