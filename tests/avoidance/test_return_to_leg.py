"""A detour round traffic is undone when it has passed, or has been out of the way for a while, once."""

from __future__ import annotations

from dataclasses import replace

from avoidance.return_to_leg import PERSISTENT, ReturnToLeg
from tests.avoidance.test_conflicts import with_traffic
from tests.avoidance.worlds import PERFORMANCE, intruders, ownship, route

LEG = route((40_000.0, 0.0))
PASSED = intruders((-500.0, 1200.0, -15.0, 0.0))
STILL_AHEAD = intruders((6000.0, 1400.0, -15.0, 0.0))


def allowed(rule: ReturnToLeg, traffic, time: float) -> bool:
    own = ownship(time=time)
    return rule.allows(own, LEG, with_traffic(own, LEG, traffic), frozenset({7}))


def test_at_once_when_it_has_passed() -> None:
    assert allowed(ReturnToLeg(PERFORMANCE), PASSED, 0.0)


def test_what_is_still_ahead_must_have_been_clear_for_a_while() -> None:
    rule = ReturnToLeg(PERFORMANCE)
    answers = [allowed(rule, STILL_AHEAD, float(second)) for second in range(8)]
    assert answers.index(True) == PERSISTENT


def test_a_moment_of_doubt_begins_the_wait_anew() -> None:
    rule = ReturnToLeg(PERFORMANCE)
    near = intruders((6000.0, 1050.0, -15.0, 0.0))
    answers = [allowed(rule, near if second == 3 else STILL_AHEAD, float(second)) for second in range(12)]
    assert answers.index(True) == 4 + PERSISTENT


def test_a_return_that_was_regretted_is_not_repeated() -> None:
    """Others that give way as well: whoever goes back too early meets them again."""
    rule = ReturnToLeg(PERFORMANCE)
    rule.avoiding((7,))
    assert any(allowed(rule, STILL_AHEAD, float(second)) for second in range(8))
    rule.avoiding((7,))
    assert not any(allowed(rule, STILL_AHEAD, float(second)) for second in range(8, 40))
    assert allowed(rule, PASSED, 41.0)


def test_a_doubtful_prediction_does_not_let_it_return() -> None:
    unsure = replace(STILL_AHEAD, speed_sigma=STILL_AHEAD.speed_sigma + 3.0)
    rule = ReturnToLeg(PERFORMANCE)
    assert not any(allowed(rule, unsure, float(second)) for second in range(20))
