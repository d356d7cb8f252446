"""Which leg an intruder makes unsafe, when, and how sure that must be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from avoidance import Contact, Ownship, RadarScan, Route
from avoidance.conflicts import first_conflict, to_be_avoided, wind_estimate
from avoidance.known import Known, known_obstacles
from avoidance.parameters import DEFAULT
from avoidance.prediction import Intruders
from avoidance.tracking import Tracker
from tests.avoidance.worlds import PERFORMANCE, intruders, ownship, route


def with_traffic(own: Ownship, way: Route, traffic: Intruders) -> Known:
    """What a vehicle knows that sees these intruders and nothing else."""
    empty = Tracker(DEFAULT).update(RadarScan.of(0.0, []), own)
    known = known_obstacles(empty, own, way, PERFORMANCE, DEFAULT)
    return replace(known, intruder_ids=np.arange(7, 7 + len(traffic)), intruders=traffic)


def test_a_conflict_names_time_and_distance() -> None:
    own, way = ownship(), route((40_000.0, 0.0))
    blocked = first_conflict(
        own, way, with_traffic(own, way, intruders((9000.0, 200.0, -15.0, 0.0))), PERFORMANCE
    )
    assert blocked is not None
    assert blocked.threat.moving
    assert blocked.threat.ids == (7,)
    assert blocked.threat.time == pytest.approx(300.0)
    assert blocked.threat.distance == pytest.approx(4500.0)
    assert blocked.threat.clearance == pytest.approx(200.0)
    assert blocked.threat.required == pytest.approx(1100.0)


def test_the_leg_is_named_on_which_it_happens() -> None:
    own, way = ownship(), route((3000.0, 0.0), (3000.0, 30_000.0))
    blocked = first_conflict(
        own, way, with_traffic(own, way, intruders((3200.0, 12_000.0, 0.0, -15.0))), PERFORMANCE
    )
    assert blocked is not None
    assert blocked.leg == 1


def test_a_doubtful_conflict_is_no_reason_to_leave_a_route_but_one_not_to_take_it_up() -> None:
    own, way = ownship(), route((40_000.0, 0.0))
    passing = intruders((9000.0, 900.0, -15.0, 0.0))
    assert first_conflict(own, way, with_traffic(own, way, passing), PERFORMANCE) is not None
    unsure = with_traffic(own, way, replace(passing, speed_sigma=np.array([1.0])))
    assert first_conflict(own, way, unsure, PERFORMANCE) is None
    assert first_conflict(own, way, unsure, PERFORMANCE, resuming=True) is not None


def test_in_the_last_minute_doubt_asks_for_more_room_and_before_it_excuses_a_route() -> None:
    own, way = ownship(), route((40_000.0, 0.0))

    def conflict(north: float, sigma: float) -> bool:
        traffic = replace(intruders((north, 1010.0, -15.0, 0.0), margin=0.0), speed_sigma=np.array([sigma]))
        return first_conflict(own, way, with_traffic(own, way, traffic), PERFORMANCE) is not None

    assert not conflict(1200.0, 0.1)  # 40 s: 4 m of doubt
    assert conflict(1200.0, 0.5)
    assert not conflict(9000.0, 0.5)


def test_nobody_is_asked_to_keep_what_cannot_be_kept_any_more() -> None:
    """Side by side at less than d + h, and as fast: nothing to be done; another far ahead is as ever."""
    tracker, way = Tracker(DEFAULT), route((40_000.0, 0.0))
    for second in range(12):
        north = 15.0 * second
        own = ownship(north=north, time=float(second))
        places = (north, 1010.0, 200.0), (9000.0 - north, 3000.0, 200.0)
        contacts = [Contact(id=7 + i, north=n, east=e, altitude=h) for i, (n, e, h) in enumerate(places)]
        picture = tracker.update(RadarScan.of(float(second), contacts), own)
    known = known_obstacles(picture, own, way, PERFORMANCE, DEFAULT)
    beside, ahead = known.intruders.most
    assert 1000.0 < beside < 1010.0
    assert ahead == np.inf
    assert known.intruders.needed(np.zeros(2))[1] == pytest.approx(1000.0 + DEFAULT.moving_margin)
    assert first_conflict(own, way, known, PERFORMANCE) is None


def test_wind_changes_where_two_meet() -> None:
    """Into a wind of 5 m/s the crossing intruder has passed when the vehicle gets there."""
    windy = replace(PERFORMANCE, wind_bound=5.0)
    calm = ownship()
    into = replace(calm, velocity_north=10.0)
    way = route((40_000.0, 0.0))
    crossing = intruders((6000.0, 6000.0, 0.0, -15.0))
    assert wind_estimate(into, windy) == pytest.approx((-5.0, 0.0))
    assert wind_estimate(replace(into, heading=2.0), windy) == (0.0, 0.0)
    assert first_conflict(calm, way, with_traffic(calm, way, crossing), windy) is not None
    assert first_conflict(into, way, with_traffic(into, way, crossing), windy) is None


def test_what_has_flown_straight_for_a_moment_only_is_watched_first() -> None:
    own, way = ownship(), route((40_000.0, 0.0))
    fresh = replace(intruders((9000.0, 0.0, -15.0, 0.0)), ages=np.array([5.0]))
    assert first_conflict(own, way, with_traffic(own, way, fresh), PERFORMANCE) is None
    old = replace(fresh, ages=np.array([16.0]))
    assert first_conflict(own, way, with_traffic(own, way, old), PERFORMANCE) is not None
    near = replace(intruders((1500.0, 0.0, -15.0, 0.0)), ages=np.array([1.0]))
    assert first_conflict(own, way, with_traffic(own, way, near), PERFORMANCE) is not None


def test_who_must_give_way_is_given_the_time_to() -> None:
    """From the left, 283 s away: it acts after 15 s, the own vehicle not before 29."""
    own, way = ownship(), route((40_000.0, 0.0))
    from_left = replace(intruders((6000.0, -6000.0, 0.0, 15.0)), ages=np.array([25.0]))
    known = with_traffic(own, way, from_left)
    assert first_conflict(own, way, known, PERFORMANCE) is None
    assert not len(to_be_avoided(own, way, known, PERFORMANCE).intruders)
    patient = with_traffic(own, way, replace(from_left, ages=np.array([45.0])))
    assert first_conflict(own, way, patient, PERFORMANCE) is not None
    assert len(to_be_avoided(own, way, patient, PERFORMANCE).intruders) == 1
