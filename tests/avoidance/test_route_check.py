"""Which leg is blocked first, and by what."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from avoidance import Ownship, RadarScan, Route
from avoidance.known import Known, keep_what_can_be_kept, kept_margin, known_obstacles
from avoidance.parameters import DEFAULT
from avoidance.route_check import first_blocked_leg
from avoidance.tracking import Tracker
from tests.avoidance.worlds import PERFORMANCE, ownship, route, scan


def known(obstacles: list[tuple[float, float]], own: Ownship, way: Route, altitude: float = 200.0) -> Known:
    tracker = Tracker(DEFAULT)
    for second in range(2):
        seen: RadarScan = scan(obstacles, float(second), altitude=altitude)
        picture = tracker.update(seen, own)
    return known_obstacles(picture, own, way, PERFORMANCE, DEFAULT)


def test_what_lies_behind_the_vehicle_blocks_nothing() -> None:
    """Erratum E17: an infinite line flags obstacles already passed."""
    own, way = ownship(5000.0), route((40_000.0, 0.0))
    assert first_blocked_leg(own, way, known([(2000.0, 0.0)], own, way), PERFORMANCE) is None


def test_what_lies_beyond_the_end_of_the_leg_blocks_nothing() -> None:
    own, way = ownship(), route((10_000.0, 0.0), (10_000.0, 30_000.0))
    assert first_blocked_leg(own, way, known([(12_000.0, 0.0)], own, way), PERFORMANCE) is None


def test_a_later_leg_is_found_too() -> None:
    own, way = ownship(), route((6000.0, 0.0), (6000.0, 30_000.0))
    blocked = first_blocked_leg(own, way, known([(6400.0, 5000.0)], own, way), PERFORMANCE)
    assert blocked is not None
    assert blocked.leg == 1
    assert blocked.threat.clearance == pytest.approx(400.0)
    assert 6000.0 + 3900.0 < blocked.threat.distance < 6000.0 + 4100.0


def test_the_nearest_blocker_comes_first() -> None:
    own, way = ownship(), route((40_000.0, 0.0))
    blocked = first_blocked_leg(
        own, way, known([(9000.0, 0.0), (5000.0, 300.0)], own, way), PERFORMANCE, 10.0
    )
    assert blocked is not None
    assert blocked.threat.ids == (2, 1)


def test_the_inside_of_a_corner_counts() -> None:
    """The legs keep clear of it, the turn between them would not."""
    own, way = ownship(), route((6000.0, 0.0), (12_000.0, 6000.0))
    beside = np.array([6000.0, 0.0]) + 1055.0 * np.array([-np.sin(np.pi / 8), np.cos(np.pi / 8)])
    blocked = first_blocked_leg(own, way, known([(beside[0], beside[1])], own, way), PERFORMANCE, slack=0.0)
    assert blocked is not None


def test_slack_is_refused_to_some_also_where_others_are_above_the_flight() -> None:
    """1,010 m beside the leg: within the slack of 10 m that a route has which is being flown."""
    own, way = ownship(), route((40_000.0, 0.0))
    around = known([(5000.0, 0.0), (9000.0, 1010.0)], own, way)
    around = replace(around, altitudes=np.array([5000.0, 200.0]))
    assert len(around.circles(200.0, 200.0).rows) == 1
    strict = [
        first_blocked_leg(own, way, around, PERFORMANCE, strict=np.array(rows))
        for rows in ([False, False], [True, False], [False, True])
    ]
    assert strict[0] is None
    assert strict[1] is None
    assert strict[2] is not None
    assert strict[2].threat.ids == (2,)


def test_spheres_are_cut_at_flight_altitude() -> None:
    own, way = ownship(), route((40_000.0, 0.0))
    circle = known([(5000.0, 0.0)], own, way, altitude=815.0).circles(200.0, 200.0)  # 600 m above the band
    assert circle.keep[0] == pytest.approx(800.0 + kept_margin(DEFAULT, PERFORMANCE))


def test_the_cut_depends_on_both_altitudes_of_a_leg() -> None:
    own, way = ownship(), route((40_000.0, 0.0))
    around = known([(9000.0, 0.0)], own, way, altitude=1000.0)
    cuts = [float(around.circles(200.0, high).hard[0]) for high in (200.0, 600.0, 1000.0, 200.0)]
    assert cuts[0] < cuts[1] < cuts[2] == pytest.approx(1000.0)
    assert cuts[3] == cuts[0]


def test_circles_shrink_where_the_margin_cannot_be_kept_any_more() -> None:
    own, way = ownship(), route((40_000.0, 0.0))
    near = keep_what_can_be_kept(known([(0.0, 1010.0)], own, way), own, PERFORMANCE).circles(200.0, 200.0)
    assert near.keep[0] == pytest.approx(1009.0)


@pytest.mark.parametrize(
    ("error", "wind", "kept"),
    [(5.0, 0.0, 0.4 * 39.73), (7.0, 0.0, 17.0), (10.0, 12.0, 0.4 * 128.7), (30.0, 0.0, 40.0)],
)
def test_the_margin_grows_with_turn_radius_and_tracking_error(error: float, wind: float, kept: float) -> None:
    vehicle = replace(PERFORMANCE, tracking_error=error, wind_bound=wind)
    assert kept_margin(DEFAULT, vehicle) == pytest.approx(kept, abs=0.1)
