"""Geofences and rally points as items of MAVLink's mission protocol."""

from __future__ import annotations

from dataclasses import replace

import pytest

from offboard.area_items import fence_items, fence_of_items, rally_items, rally_of_items
from offboard.errors import LinkError
from offboard.geofence import FenceCircle, FencePolygon, FenceType, GeofenceData
from offboard.raw_mission import RawItem

TRIANGLE = FencePolygon(((14.3, 76.5), (14.5, 76.5), (14.5, 76.7)), FenceType.INCLUSION)
HOLE = FencePolygon(((14.40, 76.60), (14.41, 76.60), (14.41, 76.61)), FenceType.EXCLUSION)
DISC = FenceCircle((14.42, 76.62), 450.0, FenceType.EXCLUSION)
FENCE = GeofenceData((TRIANGLE, HOLE), (DISC, replace(DISC, fence_type=FenceType.INCLUSION)))


def test_there_and_back_it_is_the_same_fence():
    items = fence_items(FENCE)
    assert [item.command for item in items] == [5001] * 3 + [5002] * 3 + [5004, 5003]
    assert {item.params[0] for item in items[:6]} == {3.0}
    assert fence_of_items(items) == FENCE


def test_a_point_to_return_to_is_no_area():
    assert fence_of_items((RawItem(5000, 0, x=1, y=1), *fence_items(FENCE))) == FENCE


@pytest.mark.parametrize(
    ("items", "words"),
    [
        (fence_items(FENCE)[:2], "item 0 .* not whole"),
        ((*fence_items(FENCE)[:2], *fence_items(FENCE)[3:]), "item 0 .* not whole"),
        ((RawItem(5003, 0, (float("nan"), 0.0, 0.0, 0.0)),), "radius = nan"),
        ((RawItem(5001, 0, (float("nan"), 0.0, 0.0, 0.0)),), "not whole"),
        ((RawItem(16, 0),), "MAV_CMD 16 is no area"),
    ],
    ids=["cut off", "mixed", "no radius", "no count", "a waypoint"],
)
def test_an_area_that_is_not_understood_is_not_left_out(items, words):
    with pytest.raises(LinkError, match=words):
        fence_of_items(items)


def test_rally_points_are_above_home():
    points = ((14.4, 76.5, 80.0), (14.5, 76.6, 120.0))
    items = rally_items(points)
    assert rally_of_items(items, 600.0) == points
    above_sea = [replace(item, frame=0, z=item.z + 600.0) for item in items]
    assert rally_of_items(above_sea, 600.0) == points
    with pytest.raises(LinkError, match=r"item 1 .* MAV_FRAME 10"):
        rally_of_items([items[0], replace(items[1], frame=10)], 600.0)
