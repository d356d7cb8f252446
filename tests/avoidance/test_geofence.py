"""Areas to stay in and out of, and the walls they make."""

from __future__ import annotations

import numpy as np
import pytest

from avoidance.geofence import FenceArea, Geofence, Walls

SQUARE = FenceArea(True, ((0.0, 0.0), (1000.0, 0.0), (1000.0, 1000.0), (0.0, 1000.0)))
NEXT_DOOR = FenceArea(True, ((1000.0, 0.0), (2000.0, 0.0), (2000.0, 1000.0), (1000.0, 1000.0)))
HOLE = FenceArea(False, ((400.0, 400.0), (600.0, 400.0), (600.0, 600.0), (400.0, 600.0)))


def length(walls: np.ndarray) -> float:
    return float(np.hypot(*(walls[:, 1] - walls[:, 0]).T).sum())


def test_inside_one_area_to_stay_in_and_outside_all_others() -> None:
    fence = Geofence([SQUARE, HOLE, FenceArea(False, centre=(900.0, 900.0), radius=50.0)])
    points = np.array([(100.0, 100.0), (500.0, 500.0), (900.0, 900.0), (1500.0, 500.0)])
    assert fence.allows(points).tolist() == [True, False, False, False]


def test_no_areas_allow_everything() -> None:
    fence = Geofence()
    assert fence.allows(np.array([(1e6, 1e6)])).all()
    assert not len(fence.walls)


def test_an_edge_that_two_areas_share_is_no_wall() -> None:
    assert length(Geofence([SQUARE, NEXT_DOOR]).walls) == pytest.approx(6000.0)


def test_areas_that_overlap_have_walls_only_round_the_outside() -> None:
    other = FenceArea(True, ((500.0, 500.0), (1500.0, 500.0), (1500.0, 1500.0), (500.0, 1500.0)))
    fence = Geofence([SQUARE, other])
    assert length(fence.walls) == pytest.approx(6000.0)
    assert sorted(map(tuple, fence.posts.tolist())) == [(500.0, 1000.0), (1000.0, 500.0)]


def test_only_corners_that_point_inwards_can_be_bent_round() -> None:
    assert not len(Geofence([SQUARE]).posts)
    assert len(Geofence([SQUARE, HOLE]).posts) == 4


def test_a_circle_to_stay_in_is_a_polygon_within_it_by_no_more_than_a_metre() -> None:
    circle = FenceArea(True, centre=(0.0, 0.0), radius=20_000.0)
    away = np.hypot(*circle.outline().T)
    middles = np.hypot(*((circle.outline() + np.roll(circle.outline(), -1, axis=0)) / 2.0).T)
    assert away.max() <= 20_000.0 + 1e-6
    assert 19_999.0 <= middles.min() < 20_000.0
    assert not len(Geofence([circle]).posts)


def test_a_circle_to_stay_out_of_is_a_disc() -> None:
    fence = Geofence([FenceArea(False, centre=(10.0, 20.0), radius=300.0)])
    assert fence.discs.tolist() == [[10.0, 20.0, 300.0]]
    assert not len(fence.walls)


def test_a_circle_to_stay_out_of_hides_no_part_of_an_edge() -> None:
    fence = Geofence([SQUARE, FenceArea(False, centre=(1000.0, 500.0), radius=200.0)])
    assert length(fence.walls) == pytest.approx(4000.0)


def test_distance_of_segments_from_walls() -> None:
    walls = Walls(np.array([[(0.0, 0.0), (0.0, 100.0)]]), room=10.0)
    starts = np.array([(-5.0, 50.0), (20.0, 0.0), (30.0, 140.0)])
    ends = np.array([(5.0, 50.0), (40.0, 100.0), (30.0, 140.0)])
    assert walls.clearance(starts, ends) == pytest.approx([0.0, 20.0, 50.0])


@pytest.mark.parametrize(
    "values",
    [{}, {"corners": ((0.0, 0.0), (1.0, 1.0))}, {"centre": (0.0, 0.0), "radius": -1.0}, {"radius": 3.0}],
)
def test_what_is_no_area_is_refused(values: dict[str, object]) -> None:
    with pytest.raises(ValueError, match=r"area|radius|corners"):
        FenceArea(True, **values)  # type: ignore[arg-type]
