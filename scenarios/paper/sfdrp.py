"""The statistical front-dominance ranking of Table 5: which planner's runs dominate which."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from avoidance.types import Floats, Ints

ALPHA = 0.05
"""Level of the rank-sum test."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """One cell of the matrix: the planner of the row against that of the column."""

    word: str
    """"better" (less dominated), "equivalent" (no significant difference) or "worse" (more dominated)."""
    p_value: float
    """Two-sided; 1 where all ranks are equal."""


def dominance_ranks(objectives: Floats) -> Ints:
    """In which front each solution lies: 0 if nothing dominates it.

    Parameters
    ----------
    objectives : array, shape (n, k)
        Smaller is better in each.

    Returns
    -------
    array, shape (n,)
        Fronts are peeled off one after the other (Deb 2002).
    """
    no_worse = (objectives[:, None] <= objectives[None]).all(axis=2)
    better = (objectives[:, None] < objectives[None]).any(axis=2)
    dominates = no_worse & better
    ranks = np.full(len(objectives), -1, dtype=np.int64)
    front = 0
    while (ranks < 0).any():
        left = ranks < 0
        free = left & ~(dominates & left[:, None]).any(axis=0)
        ranks[free] = front
        front += 1
    return ranks


def ranking(objectives: Mapping[str, Sequence[Sequence[float]]]) -> dict[tuple[str, str], Verdict]:
    """Every planner against every other.

    Parameters
    ----------
    objectives : mapping
        For each planner the objectives of each run, smaller is better; all runs are pooled.

    Returns
    -------
    dict
        Verdict of (row, column).

    Notes
    -----
    The procedure of the paper's [3] and [37]: rank the pooled solutions by dominance, then compare the
    ranks of two planners by a rank-sum test (Mann and Whitney 1947, with ties) at 5 %.
    """
    names = list(objectives)
    pooled = np.array([run for name in names for run in objectives[name]], dtype=np.float64)
    ranks = dominance_ranks(pooled)
    edges = np.cumsum([0, *(len(objectives[name]) for name in names)])
    own = {name: ranks[a:b] for name, a, b in zip(names, edges, edges[1:], strict=False)}
    return {(a, b): _compare(own[a], own[b]) for a in names for b in names if a != b}


def _compare(first: Ints, second: Ints) -> Verdict:
    from scipy.stats import mannwhitneyu  # noqa: PLC0415

    if np.ptp(np.concatenate([first, second])) == 0:
        return Verdict("equivalent", 1.0)
    p_value = float(mannwhitneyu(first, second, alternative="two-sided", method="asymptotic").pvalue)
    if not p_value < ALPHA:
        return Verdict("equivalent", p_value)
    return Verdict("better" if first.mean() < second.mean() else "worse", p_value)
