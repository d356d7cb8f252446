"""Intervals against published figures."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from scenarios.statistics import paired_ratio, wilson


def test_wilson_against_newcombe_1998():
    # Newcombe (1998), Table I, method 3: 81 of 263, 15 of 148, 0 of 20
    for successes, runs, low, high in (
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0.0, 0.1611),
    ):
        interval = wilson(successes, runs)
        assert (interval.low, interval.high) == (pytest.approx(low, abs=5e-5), pytest.approx(high, abs=5e-5))


@given(st.integers(1, 500).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n))))
def test_wilson_holds_the_share_and_stays_a_proportion(counts):
    interval = wilson(*counts)
    assert 0.0 <= interval.low <= interval.value <= interval.high <= 1.0


def test_nothing_is_said_of_no_runs_and_impossible_counts_are_refused():
    assert wilson(0, 0).value is None
    with pytest.raises(ValueError, match="3 of 2"):
        wilson(3, 2)
    with pytest.raises(ValueError, match="same"):
        paired_ratio([True], [True, False])


def pairs(both, first, second, neither):
    a = [True] * (both + first) + [False] * (second + neither)
    b = [True] * both + [False] * first + [True] * second + [False] * neither
    return a, b


def test_paired_ratio_against_fagerland_2014():
    # Fagerland, Lydersen and Laake (2014), airway hyper-responsiveness: 1, 1, 7, 12 -> 0.25 (0.068 to 0.923)
    ratio = paired_ratio(*pairs(1, 1, 7, 12))
    assert ratio.value == 0.25
    assert (ratio.low, ratio.high) == (pytest.approx(0.068, abs=5e-4), pytest.approx(0.923, abs=5e-4))


def test_paired_ratio_says_something_when_nothing_happened():
    ratio = paired_ratio([False] * 1000, [True] * 1000)
    assert (ratio.value, ratio.low) == (0.0, 0.0)
    assert 0.0 < ratio.high < 0.005
    assert paired_ratio([False, True], [False, False]).value is None
