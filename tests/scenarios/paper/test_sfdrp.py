"""Dominance ranks and the verdicts of Table 5."""

from __future__ import annotations

import numpy as np

from scenarios.paper.sfdrp import dominance_ranks, ranking


def test_fronts_are_peeled_off_one_after_the_other():
    points = np.array([[0.0, 3.0], [1.0, 1.0], [2.0, 2.0], [3.0, 0.0], [3.0, 3.0], [1.0, 1.0]])
    assert dominance_ranks(points).tolist() == [0, 0, 1, 0, 2, 0]


def test_who_is_dominated_less_is_better():
    good = [(0.0, 1.0 + 0.001 * i) for i in range(10)]
    bad = [(1.0, 1.1 + 0.001 * i) for i in range(10)]
    verdicts = ranking({"a": good, "b": bad})
    assert (verdicts["a", "b"].word, verdicts["b", "a"].word) == ("better", "worse")
    assert verdicts["a", "b"].p_value == verdicts["b", "a"].p_value < 0.001


def test_equal_outcomes_are_equivalent_with_certainty():
    runs = [(0.0, 1.0)] * 10
    verdict = ranking({"a": runs, "b": runs})["a", "b"]
    assert (verdict.word, verdict.p_value) == ("equivalent", 1.0)


def test_a_small_difference_among_few_runs_is_not_significant():
    first = [(0.0, value) for value in (1.0, 2.0, 3.0, 4.0)]
    second = [(0.0, value) for value in (1.5, 2.5, 3.5, 4.5)]
    verdict = ranking({"a": first, "b": second})["a", "b"]
    assert verdict.word == "equivalent"
    assert verdict.p_value > 0.05
