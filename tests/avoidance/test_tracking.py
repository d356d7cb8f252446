"""Contacts to tracks: association, motion, memory, clusters."""

from __future__ import annotations

import math

import numpy as np
import pytest

from avoidance import Contact, RadarScan
from avoidance.clusters import cluster_of
from avoidance.known import known_obstacles
from avoidance.parameters import DEFAULT, PAPER, Parameters
from avoidance.picture import Picture
from avoidance.tracking import Tracker
from tests.avoidance.worlds import PERFORMANCE, ownship, route, scan


def watch(tracker: Tracker, path: list[tuple[float, float]], ids: list[int] | None = None) -> Picture:
    """Show one obstacle once a second along a path to a vehicle that flies north."""
    picture = None
    for second, (north, east) in enumerate(path):
        name = 1 if ids is None else ids[second]
        contact = Contact(name, north, east, 200.0)
        picture = tracker.update(RadarScan.of(float(second), [contact]), ownship(15.0 * second, time=second))
    assert picture is not None
    return picture


def test_what_stands_still_keeps_its_exact_place() -> None:
    picture = watch(Tracker(DEFAULT), [(8000.0, 400.0)] * 20)
    assert picture.positions[0].tolist() == [8000.0, 400.0, 200.0]
    assert not picture.moving[0]
    assert picture.confirmed[0]


@pytest.mark.parametrize(
    ("north", "east"),
    [(-15.0, 0.0), (15.0, 0.0), (0.0, 15.0), (10.6, 10.6)],
    ids=["head-on", "same course", "crossing", "receding"],
)
def test_traffic_on_any_course_moves(north: float, east: float) -> None:
    """Erratum E31: a change in range alone misses receding, crossing and same-course traffic."""
    path = [(6000.0 + north * t, 500.0 + east * t) for t in range(6)]
    picture = watch(Tracker(DEFAULT), path)
    assert picture.moving[0]
    assert picture.velocities[0].tolist() == pytest.approx([north, east], abs=1.0)


def test_a_changing_identity_does_not_make_a_second_track() -> None:
    picture = watch(Tracker(DEFAULT), [(8000.0, 400.0)] * 4, ids=[1, 7, 7, 3])
    assert picture.size == 1
    assert picture.ids.tolist() == [3]


def test_swapped_identities_do_no_harm() -> None:
    tracker = Tracker(DEFAULT)
    for second, order in enumerate(([1, 2], [2, 1], [1, 2])):
        contacts = [Contact(order[0], 5000.0, 0.0, 200.0), Contact(order[1], 9000.0, 0.0, 200.0)]
        picture = tracker.update(RadarScan.of(float(second), contacts), ownship())
    assert sorted(picture.positions[:, 0].tolist()) == [5000.0, 9000.0]
    assert not picture.moving.any()


def test_a_contact_without_position_is_refused_and_the_rest_used() -> None:
    contacts = [Contact(1, math.nan, 0.0, 200.0), Contact(2, 5000.0, 0.0, 200.0)]
    picture = Tracker(DEFAULT).update(RadarScan.of(0.0, contacts), ownship())
    assert picture.ids.tolist() == [2]


def test_obstacles_once_seen_stay_known() -> None:
    tracker = Tracker(DEFAULT)
    watch(tracker, [(8000.0, 400.0)] * 3)
    picture = tracker.update(RadarScan.of(3000.0, []), ownship(time=3000.0))
    assert picture.size == 1


def test_the_paper_knows_the_current_scan_only() -> None:
    tracker = Tracker(PAPER)
    watch(tracker, [(8000.0, 400.0)] * 3)
    assert tracker.update(RadarScan.of(3.0, []), ownship(time=3.0)).size == 0


def test_a_false_return_dies() -> None:
    tracker = Tracker(DEFAULT)
    tracker.update(scan([(8000.0, 0.0)], 0.0), ownship())
    for second in range(1, 5):
        picture = tracker.update(RadarScan.of(float(second), []), ownship(time=second))
    assert picture.size == 0


def test_moving_tracks_coast_and_die_at_last() -> None:
    tracker = Tracker(DEFAULT)
    watch(tracker, [(6000.0 - 15.0 * t, 500.0) for t in range(5)])
    coasting = tracker.update(RadarScan.of(8.0, []), ownship(time=8.0))
    assert coasting.positions[0, 0] == pytest.approx(5880.0, abs=3.0)
    for second in range(9, 40):
        picture = tracker.update(RadarScan.of(float(second), []), ownship(time=second))
    assert picture.size == 0


def test_a_still_scan_leaves_the_picture_as_it_is() -> None:
    tracker = Tracker(DEFAULT)
    pictures = [tracker.update(scan([(8000.0, 0.0)], float(t)), ownship(time=t)) for t in range(9)]
    assert pictures[7] is pictures[8]


def test_noise_does_not_make_obstacles_move() -> None:
    rng = np.random.default_rng(4)
    tracker = Tracker(Parameters(range_sigma=50.0, bearing_sigma=math.radians(1.0)))
    for second in range(120):
        place = np.array([8000.0, 0.0]) + rng.normal(0.0, (50.0, 140.0))
        contact = Contact(1, float(place[0]), float(place[1]), 200.0)
        picture = tracker.update(RadarScan.of(float(second), [contact]), ownship(time=second))
        assert not picture.moving.any()
    assert np.hypot(*(picture.positions[0, :2] - [8000.0, 0.0])) < 4.0 * picture.sigma[0]


def test_clusters_are_single_linkage() -> None:
    places = np.array([[0.0, 0.0], [900.0, 0.0], [1800.0, 0.0], [4000.0, 0.0]])
    links = places, np.full(4, 1000.0), 1000.0, False
    assert [cluster_of(one, *links).tolist() for one in range(4)] == [[0, 1, 2]] * 3 + [[3]]


def test_overlapping_spheres_leave_no_gap() -> None:
    """Erratum E36: centres 1.5 km apart are "scattered" but cannot be passed between."""
    places = np.array([[0.0, 0.0], [1500.0, 0.0]])
    apart = cluster_of(0, places, np.full(2, 1000.0), 1000.0, join_spheres=False)
    joined = cluster_of(0, places, np.full(2, 1000.0), 1000.0, join_spheres=True)
    assert apart.tolist() == [0]
    assert joined.tolist() == [0, 1]


def test_a_climb_is_shown_when_it_is_significant() -> None:
    tracker = Tracker(DEFAULT)
    for second in range(12):
        contact = Contact(1, 8000.0 - 20.0 * second, 0.0, 900.0 - 3.0 * second)
        level = Contact(2, 8000.0 - 20.0 * second, 3000.0, 300.0 + 0.3 * second)
        picture = tracker.update(RadarScan.of(float(second), [contact, level]), ownship(time=second))
    assert picture.climbs[0] == pytest.approx(-3.0, abs=0.3)
    assert picture.climbs[1] == 0.0


def test_swapped_identities_of_crossing_traffic_do_not_swap_the_tracks() -> None:
    tracker = Tracker(DEFAULT)
    for second in range(20):
        ids = (1, 2) if second < 10 else (2, 1)
        contacts = [
            Contact(ids[0], 8000.0 - 15.0 * second, 0.0, 200.0),
            Contact(ids[1], 8000.0, 200.0 - 15.0 * second, 200.0),
        ]
        picture = tracker.update(RadarScan.of(float(second), contacts), ownship(time=second))
    assert picture.size == 2
    for row, velocity in ((0, (-15.0, 0.0)), (1, (0.0, -15.0))):
        assert picture.velocities[row].tolist() == pytest.approx(velocity, abs=0.5)
    assert picture.ids.tolist() == [2, 1]


def test_two_false_returns_at_one_place_are_forgotten_as_well() -> None:
    tracker = Tracker(DEFAULT)
    for second in range(12):
        contacts = [Contact(9, 8000.0, 0.0, 200.0)] if second < 2 else []
        picture = tracker.update(RadarScan.of(float(second), contacts), ownship(time=second))
    assert picture.size == 0


def test_a_late_scan_is_extrapolated_to_now() -> None:
    tracker = Tracker(DEFAULT)
    picture = watch(tracker, [(8000.0 - 15.0 * t, 0.0) for t in range(10)])
    own = ownship(time=12.0)
    known = known_obstacles(picture, own, route((40_000.0, 0.0)), PERFORMANCE, DEFAULT)
    assert known.intruders.positions[0, 0] == pytest.approx(8000.0 - 15.0 * 12.0, abs=1.0)


def test_a_slow_intruder_in_noise_is_not_taken_for_an_obstacle_first() -> None:
    """At 5.5 m/s it takes a while to see that it moves; until then it is neither."""
    rng = np.random.default_rng(4)
    parameters = Parameters(range_sigma=50.0, bearing_sigma=math.radians(1.0))
    tracker, stood = Tracker(parameters), 0
    for second in range(150):
        place = np.array([9000.0 - 5.5 * second, 300.0]) + rng.normal(0.0, (50.0, 150.0))
        contact = Contact(1, float(place[0]), float(place[1]), 200.0)
        own = ownship(time=second)
        picture = tracker.update(RadarScan.of(float(second), [contact]), own)
        stood += len(known_obstacles(picture, own, route((40_000.0, 0.0)), PERFORMANCE, parameters).ids)
    assert picture.moving[0]
    assert stood == 0


def test_an_unconfirmed_return_is_believed_only_where_it_cannot_wait() -> None:
    for north, believed in ((1200.0, 1), (2500.0, 0)):
        picture = Tracker(DEFAULT).update(scan([(north, 0.0)]), ownship())
        known = known_obstacles(picture, ownship(), route((40_000.0, 0.0)), PERFORMANCE, DEFAULT)
        assert len(known.ids) == believed


def test_what_turns_goes_on_moving() -> None:
    """The turn makes its velocity doubtful for a moment; that is no reason to think that it stands."""
    tracker = Tracker(DEFAULT)
    path = [(8000.0 - 15.0 * t, 0.0) for t in range(30)]
    path += [(path[-1][0], 15.0 * (t + 1)) for t in range(5)]
    for second, (north, east) in enumerate(path):
        contact = Contact(1, north, east, 200.0)
        picture = tracker.update(RadarScan.of(float(second), [contact]), ownship(time=second))
        assert picture.moving[0] or second == 0
    assert picture.ages[0] < 6.0
