"""Intervals for what is counted: proportions, and ratios of paired proportions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

Z95 = 1.959963984540054
"""Normal quantile of a two-sided 95 % interval."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """A figure with its interval."""

    value: float | None
    """The figure; None where it has no meaning."""
    low: float | None
    """Lower end."""
    high: float | None
    """Upper end; None if unbounded."""


def wilson(successes: int, runs: int, z: float = Z95) -> Estimate:
    """Proportion with its Wilson score interval.

    Parameters
    ----------
    successes, runs : int
        How often it was seen, in how many trials.
    z : float
        Normal quantile; 1.96 gives 95 %.

    Raises
    ------
    ValueError
        If the counts are impossible.

    Notes
    -----
    Wilson (1927), Eq. for the score interval. Stays inside 0 to 1, and says something also at 0 and at all.
    """
    if not 0 <= successes <= runs:
        raise ValueError(f"successes = {successes} of {runs} runs: must be between 0 and the runs")
    if runs == 0:
        return Estimate(None, None, None)
    share = successes / runs
    weight = 1.0 + z**2 / runs
    centre = (share + z**2 / (2.0 * runs)) / weight
    half = z / weight * math.sqrt(share * (1.0 - share) / runs + z**2 / (4.0 * runs**2))
    low = 0.0 if successes == 0 else max(centre - half, 0.0)
    high = 1.0 if successes == runs else min(centre + half, 1.0)
    return Estimate(share, low, high)


def paired_ratio(treated: Sequence[bool], untreated: Sequence[bool], z: float = Z95) -> Estimate:
    """Ratio of two proportions on the same trials, such as a risk with and without avoidance.

    Parameters
    ----------
    treated, untreated : sequence of bool
        Whether the event happened in each trial, with and without treatment; same length, same order.
    z : float
        Normal quantile; 1.96 gives 95 %.

    Returns
    -------
    Estimate
        All None if the event happens in no trial at all without treatment.

    Raises
    ------
    ValueError
        If the two differ in length.

    Notes
    -----
    Hybrid Wilson score interval of Bonett and Price (2006), which Fagerland, Lydersen and Laake (2014)
    recommend for paired proportions; it holds where one of the counts is 0.
    """
    if len(treated) != len(untreated):
        raise ValueError(f"{len(treated)} trials with and {len(untreated)} without: must be the same ones")
    with_, without = sum(map(bool, treated)), sum(map(bool, untreated))
    if without == 0:
        return Estimate(None, None, None)
    pairs = list(zip(treated, untreated, strict=True))
    discordant = sum(a != b for a, b in pairs)
    informative = sum(a or b for a, b in pairs)
    spread = math.sqrt((discordant + 2.0) / ((with_ + 1.0) * (without + 1.0)))
    shares = [(count + 1.0) / (informative + 2.0) for count in (with_, without)]
    single = [
        math.sqrt((1.0 - share) / (count + 1.0))
        for share, count in zip(shares, (with_, without), strict=True)
    ]
    inner = z * spread / sum(single)
    low_with, high_with = _score_limits(with_, informative, inner)
    low_without, high_without = _score_limits(without, informative, inner)
    high = None if low_without == 0.0 else high_with / low_without
    return Estimate(with_ / without, low_with / high_without, high)


def _score_limits(count: int, trials: int, z: float) -> tuple[float, float]:
    square = z * z
    half = z * math.sqrt(square + 4.0 * count * (1.0 - count / trials))
    low, high = (2.0 * count + square - half), (2.0 * count + square + half)
    scale = 2.0 * (trials + square)
    return max(low, 0.0) / scale, high / scale
