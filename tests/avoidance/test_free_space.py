"""Free components and nearest free points, against the tangent graph and brute force."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from avoidance.free_space import FreeSpace, connected, enclosed, free_candidates, nearest_free
from avoidance.tangent_graph import shortest_path

FAR = (50_000.0, 0.0)


def ring(count: int, radius: float, size: float) -> tuple[np.ndarray, np.ndarray]:
    angles = np.arange(count) * math.tau / count
    return radius * np.column_stack([np.cos(angles), np.sin(angles)]), np.full(count, size)


def test_without_discs_all_is_one_component() -> None:
    none = np.empty((0, 2)), np.empty(0)

    assert connected((0.0, 0.0), FAR, *none)
    assert not enclosed((0.0, 0.0), *none)


@pytest.mark.parametrize("count", [3, 4, 8, 12])
def test_a_closed_ring_encloses_and_an_open_one_does_not(count) -> None:
    centres, radii = ring(count, 4_000.0, 4_000.0 * math.sin(math.pi / count) * 1.05)
    assert (np.hypot(*centres.T) > radii).all()

    assert enclosed((0.0, 0.0), centres, radii)
    assert not connected((0.0, 0.0), FAR, centres, radii)
    assert not enclosed(FAR, centres, radii)
    assert not enclosed((0.0, 0.0), centres[1:], radii[1:])
    assert connected((0.0, 0.0), FAR, centres[1:], radii[1:])


def test_a_ring_of_discs_that_only_touch_has_gaps() -> None:
    centres, radii = ring(6, 4_000.0, 2_000.0)

    assert connected((0.0, 0.0), FAR, centres, radii)
    assert not connected((0.0, 0.0), FAR, centres, radii * 1.0001)


def test_ring_in_a_ring_has_three_components() -> None:
    inner, outer = ring(8, 4_000.0, 1_700.0), ring(16, 12_000.0, 2_500.0)
    world = np.concatenate([inner[0], outer[0]]), np.concatenate([inner[1], outer[1]])
    places = [(0.0, 0.0), (7_500.0, 0.0), FAR]

    for k, a in enumerate(places):
        assert [connected(a, b, *world) for b in places] == [k == m for m in range(3)]
    assert connected((7_500.0, 0.0), (-7_500.0, 0.0), *world)
    assert [enclosed(p, *world) for p in places] == [True, True, False]


def test_two_pockets_of_one_cluster_are_apart() -> None:
    left, right = ring(8, 4_000.0, 1_700.0), ring(8, 4_000.0, 1_700.0)
    centres = np.concatenate([left[0], right[0] + (8_000.0, 0.0)])
    radii = np.concatenate([left[1], right[1]])

    assert not connected((0.0, 0.0), (8_000.0, 0.0), centres, radii)


@pytest.mark.parametrize("spacing", [1_000.0, 1_500.0, 1_000.0 * math.sqrt(2.0) * 1.3])
def test_each_hole_of_a_lattice_is_a_pocket(spacing) -> None:
    """Square lattice, every disc twice; radii just too small to close the cells' middles."""
    grid = np.array([(n, e) for n in range(5) for e in range(5)], dtype=float) * spacing
    centres = np.concatenate([grid, grid])
    radii = np.full(50, spacing * 0.7)
    holes = [((n + 0.5) * spacing, (e + 0.5) * spacing) for n in range(4) for e in range(4)]

    space = FreeSpace.of(centres, radii)

    assert all(enclosed(hole, centres, radii) for hole in holes)
    assert len({space.component(hole) for hole in [*holes, FAR]}) == 17


@pytest.mark.parametrize("seed", range(8))
def test_within_a_hole_of_repeated_discs_all_points_are_connected(seed) -> None:
    """Discs three times each in any order: whichever of the equal ones faces a point, the hole is one."""
    grid = np.array([(n, e) for n in range(4) for e in range(4)], dtype=float) * 1_000.0
    centres = np.random.default_rng(seed).permutation(np.concatenate([grid, grid, grid]))
    radii = np.full(48, 650.0)
    sides = [(20.0, 20.0), (20.0, -20.0), (-20.0, 20.0), (-20.0, -20.0), (0.0, 0.0)]

    space = FreeSpace.of(centres, radii)

    names = {
        hole: {space.component((500.0 + hole * 1_000.0 + n, 1_500.0 + e)) for n, e in sides}
        for hole in range(3)
    }
    assert all(len(name) == 1 for name in names.values())
    assert len(set.union(*names.values(), {space.component(FAR)})) == 4


@pytest.mark.parametrize("seed", range(10))
def test_three_circles_through_each_corner_of_a_pocket(seed) -> None:
    """Rounding says at random which of two discs a gap ends at; the pocket must stay one all the same."""
    half, turn = math.pi / 8, 0.1 * seed
    centres, _ = ring(8, 4_000.0, 1_700.0)
    corner = 4_000.0 * math.cos(half) - math.sqrt(1_700.0**2 - (4_000.0 * math.sin(half)) ** 2)
    extra, _ = ring(8, corner + 1_700.0, 1_700.0)
    extra = extra @ np.array([(math.cos(half), math.sin(half)), (-math.sin(half), math.cos(half))])
    order = np.random.default_rng(seed).permutation(16)
    rotation = np.array([(math.cos(turn), math.sin(turn)), (-math.sin(turn), math.cos(turn))])
    world = (np.concatenate([centres, extra]) @ rotation)[order], np.full(16, 1_700.0)
    inside = ring(24, 2_200.0, 0.0)[0] @ rotation

    space = FreeSpace.of(*world)

    assert len({space.component(spot) for spot in inside}) == 1
    assert not any(space.unbounded(spot) for spot in inside)
    assert space.unbounded(FAR)


@pytest.mark.parametrize("seed", range(6))
def test_every_loop_closes_where_circles_coincide_and_meet_in_points(seed) -> None:
    """Where disc j lets go of circle i a gap begins on i and one ends on j: each start has its end."""
    rng = np.random.default_rng(seed)
    centres = rng.integers(0, 6, (40, 2)) * 1_000.0
    cosine, sine = math.cos(0.7 * seed), math.sin(0.7 * seed)
    repeated = np.concatenate([centres, centres]) @ np.array([(cosine, sine), (-sine, cosine)])

    space = FreeSpace.of(repeated, np.full(80, 1_000.0 * math.sqrt(0.5)))

    arcs, following = space.arcs, space.arcs.following
    gaps = space.loops >= 0
    starts = list(zip(arcs.closer[gaps].tolist(), arcs.disc[gaps].tolist(), strict=True))
    ends = list(zip(arcs.disc[gaps].tolist(), arcs.opener[following[gaps]].tolist(), strict=True))
    assert len(starts) > 20
    assert sorted(starts) == sorted(ends)


def test_points_on_a_circle_or_on_a_corner_count_as_free() -> None:
    centres, radii = ring(8, 4_000.0, 1_700.0)
    corner_distance = 4_000.0 * math.cos(math.pi / 8) - math.sqrt(
        1_700.0**2 - (4_000.0 * math.sin(math.pi / 8)) ** 2
    )
    corner = (corner_distance * math.cos(math.pi / 8), corner_distance * math.sin(math.pi / 8))

    for inside in ((2_300.0, 0.0), corner):
        assert connected((0.0, 0.0), inside, centres, radii)
        assert not connected(FAR, inside, centres, radii)
        assert enclosed(inside, centres, radii)


def test_points_inside_a_disc_are_refused_by_name() -> None:
    world = np.zeros((1, 2)), np.array([1_000.0])

    with pytest.raises(ValueError, match=r"b .* inside disc 0"):
        connected(FAR, (0.0, 900.0), *world)
    with pytest.raises(ValueError, match=r"point .* inside disc 0"):
        enclosed((0.0, 900.0), *world)


free_disc = st.tuples(st.floats(-5e3, 5e3), st.floats(-5e3, 5e3), st.floats(300.0, 2_500.0))
lattice_disc = st.tuples(
    *(st.integers(-5, 5).map(lambda k: 1_000.0 * k) for _ in range(2)),
    st.sampled_from([500.0, 700.0, 1_000.0, math.sqrt(0.5) * 1_000.0]),
)
worlds = st.one_of(
    st.lists(free_disc, min_size=3, max_size=25), st.lists(lattice_disc, min_size=3, max_size=60)
)
place = st.tuples(st.floats(-6e3, 6e3), st.floats(-6e3, 6e3))


def pocket_points(centres: np.ndarray, radii: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Random free points and the corners between discs, where pockets are found most easily."""
    corners = free_candidates((0.0, 0.0), centres, radii)
    spots = np.concatenate([corners, rng.uniform(-6e3, 6e3, (20, 2)), [FAR]])
    distance = np.hypot(spots[:, 0, None] - centres[:, 0], spots[:, 1, None] - centres[:, 1])
    return spots[(distance >= radii).all(axis=1)]


@settings(max_examples=60, deadline=None)
@given(worlds, st.integers(0, 2**32 - 1))
def test_connected_means_that_the_exact_planner_finds_a_way(world, seed) -> None:
    """Shrunk by a hair for the planner, as `connected` does: what touches exactly is open for both."""
    table = np.array(world)
    centres, radii = table[:, :2], table[:, 2]
    rng = np.random.default_rng(seed)
    spots = rng.permutation(pocket_points(centres, radii, rng))[:3]

    for a, b in pairwise(spots):
        way = shortest_path(a, b, centres, radii * (1.0 - 1.5e-8))
        assert connected(a, b, centres, radii) == (way is not None)


def test_many_pockets_agree_with_the_exact_planner() -> None:
    """Dense random heaps: 200 pairs of which a good part is parted."""
    rng = np.random.default_rng(11)
    parted = 0
    for _ in range(20):
        centres, radii = rng.uniform(-5e3, 5e3, (70, 2)), rng.uniform(400.0, 1_000.0, 70)
        spots = rng.permutation(pocket_points(centres, radii, rng))[:11]
        for a, b in pairwise(spots):
            way = shortest_path(a, b, centres, radii * (1.0 - 1.5e-8))
            assert connected(a, b, centres, radii) == (way is not None)
            parted += way is None
    assert parted > 30


def test_candidates_are_free_and_come_nearest_first() -> None:
    rng = np.random.default_rng(2)
    centres, radii = rng.uniform(-5e3, 5e3, (40, 2)), rng.uniform(400.0, 1_200.0, 40)

    spots = free_candidates((100.0, 200.0), centres, radii)

    distance = np.hypot(spots[:, 0, None] - centres[:, 0], spots[:, 1, None] - centres[:, 1])
    assert (distance >= radii).all(), "not even rounding may put one inside"
    order = np.hypot(spots[:, 0] - 100.0, spots[:, 1] - 200.0)
    assert (np.diff(order) >= 0.0).all()


@settings(max_examples=40, deadline=None)
@given(worlds, place)
def test_nearest_free_point_is_as_near_as_any_sampled_one(world, target) -> None:
    """Brute force: points at 1° on every circle, and a grid."""
    table = np.array(world)
    centres, radii = table[:, :2], table[:, 2]
    angles = np.radians(np.arange(360.0))
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    rims = (centres[:, None] + radii[:, None, None] * circle * (1.0 + 1e-6)).reshape(-1, 2)
    grid = np.stack(np.meshgrid(*[np.linspace(-6e3, 6e3, 41)] * 2), axis=-1).reshape(-1, 2)
    spots = np.concatenate([rims, grid])
    distance = np.hypot(spots[:, 0, None] - centres[:, 0], spots[:, 1, None] - centres[:, 1])
    free = spots[(distance >= radii).all(axis=1)]

    found = free_candidates(target, centres, radii)

    assert len(found) > 0
    sampled = np.hypot(free[:, 0] - target[0], free[:, 1] - target[1])
    assert math.dist(found[0], target) <= sampled.min(initial=math.inf) + 1e-3


def test_a_free_target_is_its_own_nearest_point() -> None:
    centres, radii = np.zeros((1, 2)), np.array([1_000.0])

    assert nearest_free((2_000.0, 0.0), FAR, centres, radii + 84.0, radii) == (2_000.0, 0.0)


def test_target_in_one_disc_moves_to_its_rim() -> None:
    centres, radii = np.zeros((1, 2)), np.array([1_000.0])

    assert nearest_free((300.0, 0.0), FAR, centres, radii + 84.0, radii) == pytest.approx((1_084.0, 0.0))
    north, east = nearest_free((0.0, 0.0), FAR, centres, radii + 84.0, radii)
    assert math.hypot(north, east) == pytest.approx(1_084.0)


def test_nearest_point_in_a_pocket_is_passed_over_unless_one_is_in_it() -> None:
    centres, radii = ring(8, 4_000.0, 1_700.0)
    target = (2_350.0, 0.0)  # inside the disc at (4000, 0), close to the pocket

    outside = nearest_free(target, FAR, centres, radii, radii)
    inside = nearest_free(target, (0.0, 0.0), centres, radii, radii)

    assert inside == pytest.approx((2_300.0, 0.0), abs=1e-3)
    half = math.pi / 8  # the outer corner of two neighbours
    expected = 4_000.0 * math.cos(half) + math.sqrt(1_700.0**2 - (4_000.0 * math.sin(half)) ** 2)
    assert math.hypot(*outside) == pytest.approx(expected, abs=1e-3)
    assert not enclosed(outside, centres, radii)


def test_no_room_in_the_pocket_gives_none() -> None:
    centres, radii = ring(8, 4_000.0, 1_700.0)

    assert nearest_free((0.0, 0.0), (0.0, 0.0), centres, radii + 2_400.0, radii) is None


def test_a_disc_that_holds_the_vehicle_is_shrunk_to_it() -> None:
    centres, radii = np.zeros((1, 2)), np.array([1_000.0])

    assert nearest_free((900.0, 0.0), (990.0, 0.0), centres, radii + 84.0, radii) == pytest.approx(
        (1_084.0, 0)
    )


def test_passing_wider_than_safe_is_refused() -> None:
    with pytest.raises(ValueError, match="must not exceed"):
        nearest_free((0.0, 0.0), FAR, np.zeros((1, 2)), np.array([1_000.0]), np.array([1_001.0]))
