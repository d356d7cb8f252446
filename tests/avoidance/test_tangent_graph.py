"""The exact planner against published figures, an independent method and its own symmetries."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from avoidance.path import Path
from avoidance.tangent_graph import clear, shortest_path

# The paper's mission (Sec. 5.1, misprints corrected by Table 3's sum) and the obstacles of Table 4 [m].
MISSION = [
    *((0, 0), (20_000, 1_000), (70_000, 6_500), (100_000, 11_000)),
    *((200_000, 15_000), (350_000, 20_000), (300_000, 11_000), (270_000, 10_500)),
]
OBSTACLES = np.array(
    [(60_000, 7_000), (135_000, 12_000), (290_400, 17_300), (290_200, 17_400), (290_000, 17_500)], dtype=float
)
START, GOAL = (-15_000.0, 0.0), (15_000.0, 0.0)


def table_4(radius: float) -> list[Path | None]:
    return [shortest_path(a, b, OBSTACLES, np.full(5, radius)) for a, b in pairwise(MISSION)]


# Exact optima of the Table 4 case, found by an independent prototype (optimum_table4.json): total [m], and
# what each leg adds to its straight length [m].
@pytest.mark.parametrize(
    ("radius", "total", "added"),
    [
        (0.0, 431_633.18523533623, {}),
        (1_000.0, 431_644.57553395606, {4: 7.916, 5: 3.474}),
        (2_000.0, 431_731.2788795411, {2: 10.582, 4: 56.268, 5: 31.244}),
    ],
)
def test_table_4_optimum(radius, total, added) -> None:
    legs = table_4(radius)

    lengths = [leg.length for leg in legs]
    straight = [math.dist(a, b) for a, b in pairwise(MISSION)]
    assert sum(lengths) == pytest.approx(total, abs=1e-6)
    for leg, (flown, direct) in enumerate(zip(lengths, straight, strict=True), start=1):
        assert flown - direct == pytest.approx(added.get(leg, 0.0), abs=6e-4)


def test_table_4_tangent_points() -> None:
    """Leg 2 at 2 km touches its disc where the prototype does (optimum_table4.json, to 0.1 m)."""
    path = table_4(2_000.0)[1]

    expected = [(20_000, 1_000), (60_198.5, 5_009.9), (60_301.1, 5_022.8), (70_000, 6_500)]
    np.testing.assert_allclose(path.points, expected, atol=0.06)
    assert path.discs.tolist() == [-1, 0, -1]


def test_one_disc_on_the_line_has_the_textbook_length() -> None:
    """Two tangents √(d² − r²) and the arc r (π − 2 acos(r/d)); both sides are equally long."""
    path = shortest_path((-5_000.0, 0.0), (5_000.0, 0.0), np.zeros((1, 2)), np.array([3_000.0]))

    assert path.length == pytest.approx(8_000.0 + 3_000.0 * (math.pi - 2.0 * math.acos(0.6)), abs=1e-9)


def test_arc_over_the_north_of_a_disc() -> None:
    """From west to east round a disc whose north side is the shorter one."""
    centres, radii = np.array([(-100.0, 0.0), (4_000.0, 300.0)]), np.array([1_000.0, 500.0])

    path = shortest_path((0.0, -5_000.0), (0.0, 5_000.0), centres, radii)

    span = math.hypot(5_000.0, 100.0)
    tangent = math.sqrt(span**2 - 1_000.0**2)
    turned = 2.0 * (math.atan2(5_000.0, 100.0) - math.acos(1_000.0 / span))
    assert path.length == pytest.approx(2.0 * tangent + 1_000.0 * turned, abs=1e-9)
    assert path.sweeps[1] == pytest.approx(turned)


@pytest.mark.parametrize("angle_deg", [0.0, 90.0, 180.0, 270.0])
def test_arc_over_north_past_the_start_of_another_tangent(angle_deg) -> None:
    """Over one disc and under the next: the tangent to the top of the next begins before north."""
    angle = math.radians(angle_deg)
    turn = np.array([(math.cos(angle), math.sin(angle)), (-math.sin(angle), math.cos(angle))])
    centres, radii = np.array([(-100.0, 0.0), (600.0, 3_000.0)]), np.array([1_000.0, 500.0])
    start, goal = np.array([(0.0, -5_000.0), (0.0, 5_000.0)]) @ turn

    path = shortest_path(start, goal, centres @ turn, radii)

    assert path.discs.tolist() == [-1, 0, -1, 1, -1]
    assert path.sweeps[1] > 0.0 > path.sweeps[3]
    assert path.length == pytest.approx(shortest_path(goal, start, centres @ turn, radii).length, abs=1e-9)


def test_no_discs_and_no_distance() -> None:
    none = np.empty((0, 2)), np.empty(0)

    assert shortest_path((0.0, 0.0), (3.0, 4.0), *none).length == pytest.approx(5.0)
    assert shortest_path((3.0, 4.0), (3.0, 4.0), *none).length == 0.0
    on_circle = shortest_path((0.0, 10.0), (0.0, 10.0), np.zeros((1, 2)), np.array([10.0]))
    assert on_circle.length == 0.0


def test_from_circle_to_circle_runs_along_the_arc() -> None:
    """Start and goal on one disc a quarter turn apart: the path is the arc and nothing else."""
    path = shortest_path((1_000.0, 0.0), (0.0, 1_000.0), np.zeros((1, 2)), np.array([1_000.0]))

    assert path.length == pytest.approx(500.0 * math.pi, abs=1e-6)
    assert path.discs.tolist() == [0]
    assert path.sweeps == pytest.approx([math.pi / 2])


def test_arc_of_more_than_half_a_turn_where_a_neighbour_blocks_the_short_way() -> None:
    """From one side of a large disc to the other, round the small one that overlaps it."""
    centres, radii = np.array([(0.0, 0.0), (5_500.0, 0.0)]), np.array([1_000.0, 5_000.0])
    angle = 1.07  # the circles meet at acos((5.5² + 1² − 5²) / 11) = 0.967 rad
    start, goal = [(1_000.0 * math.cos(a), 1_000.0 * math.sin(a)) for a in (angle, -angle)]

    path = shortest_path(start, goal, centres, radii)

    assert path.length == pytest.approx(1_000.0 * (math.tau - 2.0 * angle), abs=1e-6)
    assert path.discs.tolist() == [0]
    assert abs(path.sweeps[0]) > math.pi
    assert_outside(path, centres, radii)


def test_start_and_goal_a_hair_inside_are_taken_as_on_the_circle() -> None:
    centres, radii = np.zeros((1, 2)), np.array([1_000.0])

    path = shortest_path((-1_000.0 + 0.0009, 0.0), (5_000.0, 0.0), centres, radii)

    assert path.length == pytest.approx(
        shortest_path((-1_000.0, 0.0), (5_000.0, 0.0), centres, radii).length, abs=0.01
    )


@pytest.mark.parametrize(
    ("start", "goal", "message"),
    [
        ((-999.0, 0.0), (5_000.0, 0.0), "start .* inside disc 1"),
        ((-5_000.0, 0.0), (0.0, 998.0), "goal .* inside disc 1"),
        ((math.nan, 0.0), (5_000.0, 0.0), "start must be finite"),
    ],
)
def test_ends_inside_a_disc_are_refused_by_name(start, goal, message) -> None:
    with pytest.raises(ValueError, match=message):
        shortest_path(start, goal, np.array([(9_000.0, 0.0), (0.0, 0.0)]), np.full(2, 1_000.0))


@pytest.mark.parametrize(
    ("centres", "radii", "message"),
    [
        (np.zeros((2, 2)), np.ones(1), "as many"),
        (np.zeros((1, 2)), np.array([-1.0]), "negative"),
        (np.array([(math.inf, 0.0)]), np.ones(1), "finite"),
    ],
)
def test_discs_that_make_no_sense_are_refused(centres, radii, message) -> None:
    with pytest.raises(ValueError, match=message):
        shortest_path((100.0, 0.0), (200.0, 0.0), centres, radii)


def ring(count: int, radius: float, size: float) -> tuple[np.ndarray, np.ndarray]:
    angles = np.arange(count) * math.tau / count
    return radius * np.column_stack([np.cos(angles), np.sin(angles)]), np.full(count, size)


def test_closed_ring_leaves_no_way_and_an_open_one_does() -> None:
    centres, radii = ring(12, 4_000.0, 1_100.0)

    assert shortest_path((0.0, 0.0), (9_000.0, 0.0), centres, radii) is None
    assert shortest_path((9_000.0, 0.0), (0.0, 0.0), centres, radii) is None
    assert shortest_path((0.0, 0.0), (9_000.0, 0.0), centres[:-1], radii[:-1]).length > 9_000.0


def test_corridor_with_a_dead_end_is_left_by_its_mouth() -> None:
    """Two parallel walls of overlapping discs, closed at the goal's end: out, round and back."""
    along = np.arange(0.0, 14_001.0, 1_000.0)
    walls = [np.column_stack([along, np.full(15, side)]) for side in (-2_000.0, 2_000.0)]
    end = np.column_stack([np.full(5, 14_500.0), np.linspace(-1_600.0, 1_600.0, 5)])
    centres, radii = np.concatenate([*walls, end]), np.full(35, 900.0)

    path = shortest_path((12_000.0, 0.0), (18_000.0, 0.0), centres, radii)

    assert path.points[:, 0].min() < 0.0
    assert path.length > 2 * 12_000.0
    assert_outside(path, centres, radii)


def test_discs_that_touch_leave_a_way_and_overlapping_ones_none() -> None:
    wall = np.column_stack([np.zeros(41), np.arange(-20, 21) * 2_000.0])

    through = shortest_path((-5_000.0, 300.0), (5_000.0, 300.0), wall, np.full(41, 1_000.0))
    around = shortest_path((-5_000.0, 300.0), (5_000.0, 300.0), wall, np.full(41, 1_000.01))

    assert through.length < 12_000.0
    assert around.length > 80_000.0


def test_squeezed_lattice_of_equal_discs() -> None:
    """On a square lattice with aligned tangents and equal discs the path still keeps out."""
    grid = np.arange(-3, 4) * 2_500.0
    centres = np.array([(n, e) for n in grid for e in grid])
    radii = np.full(len(centres), 1_000.0)

    path = shortest_path((-12_000.0, 0.0), (12_000.0, 0.0), centres, radii)

    assert_outside(path, centres, radii)
    assert path.length < 24_000.0 * 1.03


def assert_outside(path: Path, centres: np.ndarray, radii: np.ndarray) -> None:
    """Points of the path, sampled along segments and arcs alike, lie outside; the length adds up."""
    total = 0.0
    for k, disc in enumerate(path.discs):
        a, b = path.points[k], path.points[k + 1]
        t = np.linspace(0.0, 1.0, 101)[:, None]
        if disc < 0:
            spots, piece = a + t * (b - a), math.dist(a, b)
        else:
            arm = a - centres[disc]
            turn = np.exp(1j * float(path.sweeps[k]) * t[:, 0]) * complex(arm[0], arm[1])
            spots = centres[disc] + np.column_stack([turn.real, turn.imag])
            np.testing.assert_allclose(spots[-1], b, atol=1e-5)
            piece = radii[disc] * abs(path.sweeps[k])
        total += piece
        distance = np.hypot(spots[:, 0, None] - centres[:, 0], spots[:, 1, None] - centres[:, 1])
        assert (distance >= radii * (1.0 - 2e-6)).all()
    assert path.length == pytest.approx(total, rel=1e-9, abs=1e-6)


def polygon_graph_length(start, goal, centres, radii, corners: int) -> float:
    """Dijkstra over corners of polygons drawn round the discs: converges to the optimum from above."""
    angles = (np.arange(corners) + 0.5) * math.tau / corners
    circle = np.column_stack([np.cos(angles), np.sin(angles)]) / math.cos(math.pi / corners)
    corner = (centres[:, None] + radii[:, None, None] * circle).reshape(-1, 2)
    spots = np.concatenate([np.array([start, goal]), corner])
    outside = np.hypot(spots[:, 0, None] - centres[:, 0], spots[:, 1, None] - centres[:, 1]) >= radii
    spots = spots[outside.all(axis=1)]
    one, other = np.triu_indices(len(spots), 1)
    a, b = spots[one], spots[other]
    free = np.ones(len(a), dtype=bool)
    for centre, radius in zip(centres, radii, strict=True):
        t = np.einsum("ij,ij->i", centre - a, b - a) / np.maximum(np.einsum("ij,ij->i", b - a, b - a), 1e-9)
        nearest = a + np.clip(t, 0.0, 1.0)[:, None] * (b - a)
        free &= np.hypot(*(nearest - centre).T) >= radius - 1e-6
    lengths = np.hypot(*(b - a).T)[free]
    graph = csr_array((lengths, (one[free], other[free])), shape=(len(spots), len(spots)))
    return float(dijkstra(graph, directed=False, indices=0)[1])


@pytest.mark.parametrize("seed", range(12))
def test_agrees_with_a_polygon_graph(seed) -> None:
    """Lies between the optimum among the discs and that among slightly larger ones: a bound without slack."""
    rng = np.random.default_rng(seed)
    count, corners = 3 + seed, 40
    centres = rng.uniform((-9_000.0, -2_500.0), (9_000.0, 2_500.0), (count, 2))
    radii = rng.uniform(500.0, 2_000.0, count)
    start, goal = (-13_000.0, 0.0), (13_000.0, 0.0)

    exact = shortest_path(start, goal, centres, radii).length
    wide = shortest_path(start, goal, centres, radii / math.cos(math.pi / corners)).length
    other = polygon_graph_length(start, goal, centres, radii, corners)

    assert exact - 1e-3 <= other <= wide + 1e-6
    assert other <= exact * 1.002


disc = st.tuples(st.floats(-10_000.0, 10_000.0), st.floats(-6_000.0, 6_000.0), st.floats(50.0, 3_000.0))
rounded = st.tuples(
    *(st.integers(-10, 10).map(lambda k: 1_000.0 * k), st.integers(-6, 6).map(lambda k: 1_000.0 * k)),
    st.sampled_from([500.0, 1_000.0, math.sqrt(0.5) * 1_000.0, 2_000.0]),
)
worlds = st.one_of(
    st.lists(disc, max_size=12),
    st.lists(rounded, max_size=16),
    st.lists(st.one_of(disc, rounded), max_size=12),
)


def arrays(world) -> tuple[np.ndarray, np.ndarray]:
    table = np.array(world, dtype=float).reshape(-1, 3)
    return table[:, :2], table[:, 2]


@settings(max_examples=80, deadline=None)
@given(worlds)
def test_path_keeps_out_of_every_disc_and_is_no_shorter_than_straight(world) -> None:
    centres, radii = arrays(world)

    path = shortest_path(START, GOAL, centres, radii)

    assume(path is not None)
    assert path.length >= math.dist(START, GOAL) - 1e-9
    assert_outside(path, centres, radii)
    assert (path.clearance(centres) >= radii * (1.0 - 2e-9)).all()


@settings(max_examples=50, deadline=None)
@given(worlds, st.floats(-math.pi, math.pi), st.floats(-3e5, 3e5), st.floats(-3e5, 3e5), st.booleans())
def test_length_does_not_depend_on_how_the_world_is_laid(world, angle, north, east, mirrored) -> None:
    centres, radii = arrays(world)
    turn = np.array([(math.cos(angle), math.sin(angle)), (-math.sin(angle), math.cos(angle))])
    if mirrored:
        turn = np.diag([1.0, -1.0]) @ turn

    def moved(points):
        return np.asarray(points) @ turn + (north, east)

    # Discs that exactly touch leave a way, which rounding must not close: shrink all by a hair.
    first = shortest_path(START, GOAL, centres, radii * (1.0 - 1e-7))
    second = shortest_path(moved(START), moved(GOAL), moved(centres), radii * (1.0 - 1e-7))

    assert (first is None) == (second is None)
    if first is not None:
        assert second.length == pytest.approx(first.length, rel=1e-7)


def test_turning_the_world_step_by_step_leaves_the_length() -> None:
    """Discs apart from one another: arcs come to lie over north, where angles begin again."""
    rng = np.random.default_rng(8)
    grid = np.stack(np.meshgrid(*[np.arange(-3, 4) * 2_000.0] * 2), axis=-1).reshape(-1, 2)
    centres = grid + rng.uniform(-250.0, 250.0, grid.shape)
    radii = rng.uniform(550.0, 740.0, len(grid))
    north = 0

    lengths = []
    for angle in np.radians(np.arange(0.0, 360.0, 2.5)):
        turn = np.array([(math.cos(angle), math.sin(angle)), (-math.sin(angle), math.cos(angle))])
        start, goal = np.array([(-9_000.0, 300.0), (9_000.0, -200.0)]) @ turn
        path = shortest_path(start, goal, centres @ turn, radii)
        lengths.append(path.length)
        arms = path.points[:-1] - (centres @ turn)[path.discs]
        last = np.arctan2(arms[:, 1], arms[:, 0]) + path.sweeps
        north += int(
            ((path.discs >= 0) & (np.sign(last) != np.sign(last - path.sweeps)) & (abs(last) < 1)).sum()
        )

    np.testing.assert_allclose(lengths, lengths[0], rtol=1e-10)
    assert north > 5, "some arcs must have passed over north"


@settings(max_examples=50, deadline=None)
@given(worlds, disc)
def test_another_disc_never_shortens_the_way(world, extra) -> None:
    few = shortest_path(START, GOAL, *arrays(world))
    many = shortest_path(START, GOAL, *arrays([*world, extra]))

    if few is None:
        assert many is None
    if many is not None:
        assert many.length >= few.length * (1.0 - 1e-9)


@settings(max_examples=40, deadline=None)
@given(worlds)
def test_the_way_back_is_as_long(world) -> None:
    centres, radii = arrays(world)

    there, back = shortest_path(START, GOAL, centres, radii), shortest_path(GOAL, START, centres, radii)

    assert (there is None) == (back is None)
    if there is not None:
        assert there.length == pytest.approx(back.length, rel=1e-9)


@settings(max_examples=40, deadline=None)
@given(worlds, st.floats(0.0, 1.0))
def test_from_any_point_of_the_path_the_rest_is_the_rest(world, share) -> None:
    """A vehicle on an arc asks again: start on a circle, often where two circles meet."""
    centres, radii = arrays(world)
    path = shortest_path(START, GOAL, centres, radii)
    assume(path is not None)
    steps = np.where(path.discs < 0, np.hypot(*np.diff(path.points, axis=0).T), 0.0)
    steps[path.discs >= 0] = radii[path.discs[path.discs >= 0]] * np.abs(path.sweeps[path.discs >= 0])
    k = int(share * (len(steps) - 1e-9))
    part = share * len(steps) - k
    here = path.points[k] + part * (path.points[k + 1] - path.points[k])
    if path.discs[k] >= 0:
        arm = path.points[k] - centres[path.discs[k]]
        turn = np.exp(1j * part * path.sweeps[k]) * complex(arm[0], arm[1])
        here = centres[path.discs[k]] + (turn.real, turn.imag)

    rest = shortest_path(here, GOAL, centres, radii)

    flown = steps[:k].sum() + part * steps[k]
    assert rest.length + flown == pytest.approx(path.length, rel=1e-7)


def test_the_same_question_has_the_same_answer_bit_for_bit() -> None:
    rng = np.random.default_rng(3)
    centres, radii = rng.uniform(-8_000.0, 8_000.0, (60, 2)), np.full(60, 1_000.0)

    first, second = (shortest_path(START, GOAL, centres, radii) for _ in range(2))

    assert first.points.tobytes() == second.points.tobytes()
    assert first.length == second.length


def test_a_segment_may_touch_a_disc_but_not_enter_it() -> None:
    centres, radii = np.array([(5_000.0, 1_000.0)]), np.array([1_000.0])

    assert clear((0.0, 0.0), (10_000.0, 0.0), centres, radii)
    assert not clear((0.0, 0.001), (10_000.0, 0.001), centres, radii)
    assert clear((0.0, 0.001), (4_000.0, 0.001), centres, radii)
