from __future__ import annotations

import math

from hypothesis import given, settings
from hypothesis import strategies as st

from avoidance import Waypoint
from offboard.sequencer import Progress, Target, advance, begin_leg
from tests.offboard.fake_plant import FakePlant


def targets_at(*places: tuple[float, float], radius: float = 100.0, loiter: float = 0.0) -> list[Target]:
    return [Target(Waypoint(n, e, 200.0, i), radius, 15.0, loiter) for i, (n, e) in enumerate(places)]


def test_nothing_changes_on_the_way() -> None:
    targets = targets_at((0, 0), (1000, 0))
    progress = Progress(1, targets[0].waypoint)

    assert advance(progress, targets, (500.0, 30.0, 200.0), 33.0) is progress


def test_a_waypoint_is_reached_within_its_own_acceptance_radius() -> None:
    targets = targets_at((0, 0), (1000, 0), (1000, 5000), radius=250.0)
    progress = Progress(1, targets[0].waypoint)

    assert advance(progress, targets, (749.0, 0.0, 200.0), 0.0) is progress
    after = advance(progress, targets, (751.0, 0.0, 200.0), 0.0)
    assert (after.current, after.origin) == (2, targets[1].waypoint)


def test_a_waypoint_passed_abeam_is_reached() -> None:
    targets = targets_at((0, 0), (1000, 0), (9000, 0))
    progress = Progress(1, targets[0].waypoint)

    assert advance(progress, targets, (999.0, 600.0, 200.0), 0.0) is progress
    assert advance(progress, targets, (1001.0, 600.0, 200.0), 0.0).current == 2


def test_after_a_course_reversal_the_next_waypoint_does_not_count_as_passed() -> None:
    targets = targets_at((0, 0), (350_000, 20_000), (300_000, 11_000), radius=1000.0)
    progress = Progress(1, targets[0].waypoint)

    after = advance(progress, targets, (349_100.0, 19_950.0, 200.0), 0.0)

    assert after.current == 2
    assert advance(after, targets, (349_100.0, 19_950.0, 200.0), 1.0) is after


def test_a_leg_whose_end_is_already_behind_begins_at_the_vehicle() -> None:
    # Passes the first abeam at 2 km; the second lies 1 km from the first, to the side of the vehicle.
    targets = targets_at((1000, 0), (1000, 1000), (9000, 0))
    progress = Progress(0, Waypoint(0.0, 0.0, 200.0))

    after = advance(progress, targets, (1001.0, 2000.0, 200.0), 0.0)

    assert after.current == 1
    assert (after.origin.north, after.origin.east) == (1001.0, 2000.0)


def test_several_waypoints_can_end_at_once_and_the_last_finishes() -> None:
    targets = targets_at((0, 0), (50, 0), (50, 0), (90, 10))

    assert advance(begin_leg(0, 0.0, 0.0, 200.0), targets, (0.0, 0.0, 200.0), 0.0).current == 4


def test_loiter_time_is_orbited_away_before_the_next_leg() -> None:
    targets = targets_at((1000, 0), (2000, 0), loiter=60.0)
    progress = begin_leg(0, 0.0, 0.0, 200.0)

    there = advance(progress, targets, (950.0, 0.0, 200.0), 100.0)
    assert (there.current, there.loiter_until) == (0, 160.0)
    assert advance(there, targets, (1100.0, 200.0, 200.0), 159.0) is there
    after = advance(there, targets, (1040.0, 0.0, 200.0), 160.0)
    assert (after.current, after.origin, after.loiter_until) == (1, targets[0].waypoint, None)


PLACE = st.tuples(st.floats(-4000.0, 4000.0), st.floats(-4000.0, 4000.0))


@settings(max_examples=40, deadline=None)
@given(st.lists(PLACE, min_size=1, max_size=6), st.sampled_from([20.0, 100.0, 1000.0]), st.floats(0.0, 6.3))
def test_a_vehicle_that_follows_the_legs_always_finishes(
    places: list[tuple[float, float]], radius: float, heading: float
) -> None:
    targets = targets_at(*places, radius=radius)
    plant = FakePlant(heading=heading)
    progress = advance(begin_leg(0, 0.0, 0.0, 200.0), targets, (0.0, 0.0, 200.0), 0.0)
    length = sum(math.dist(a, b) for a, b in zip([(0.0, 0.0), *places], places, strict=False))
    limit = 2.0 * length / 15.0 + 120.0 * len(places)

    while progress.current < len(targets) and plant.state.time < limit:
        end, origin = targets[progress.current].waypoint, progress.origin
        plant.fly_leg(origin.north, origin.east, end.north, end.east, 200.0, 15.0)
        plant.step(1.0)
        state = plant.state
        progress = advance(progress, targets, (state.north, state.east, state.altitude), state.time)

    assert progress.current == len(targets)
