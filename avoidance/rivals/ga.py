"""Genetic algorithm with the paper's settings (Sec. 6)."""

from __future__ import annotations

import numpy as np

from avoidance.ask_tell import AskTell
from avoidance.types import Floats, Ints

BITS = 16
"""Bits per coordinate."""
LEVELS = (1 << BITS) - 1
"""Largest value of a coordinate."""
CROSSOVER = 0.75
"""Probability that a pair of parents is crossed."""
MUTATION = 0.008
"""Probability that a bit flips."""


class Ga(AskTell):
    """Roulette wheel, single-point crossover, bit flips, one elite; parameters as in `AskTell`.

    Notes
    -----
    Sec. 6: crossover 0.75, mutation 0.008, roulette wheel, single-point crossover, 30 generations. The paper
    gives no coding: ours has 16 bits per coordinate over the search box, and the best point so far is the
    first of each generation. Seeds are evaluated where they lie; what is bred from them lies on the grid.
    """

    def _move(self, costs: Floats, change: float) -> Floats:  # noqa: ARG002
        parents = self._encode(self._points)[self._wheel(costs)]
        children = self._flip(self._cross(parents))
        points = self._decode(children)
        points[0] = self._best
        return points

    def _wheel(self, costs: Floats) -> Ints:
        """Parents by roulette on f_max - f."""
        slots = costs.max() - costs
        total = float(slots.sum())
        count = len(costs)
        shares = slots / total if total > 0.0 else np.full(count, 1.0 / count)
        return np.asarray(self._rng.choice(count, size=count, p=shares), dtype=np.int64)

    def _cross(self, parents: Ints) -> Ints:
        """Swap the tails of neighbouring pairs at a random bit."""
        first, second = parents[:-1:2], parents[1::2]
        crossed = self._rng.random(len(second)) < CROSSOVER
        cut = self._rng.integers(1, 2 * BITS, len(second))
        tail = np.where(crossed, (1 << cut) - 1, 0)
        children = parents.copy()
        children[: 2 * len(second) : 2] = (first & ~tail) | (second & tail)
        children[1::2] = (second & ~tail) | (first & tail)
        return children

    def _flip(self, strings: Ints) -> Ints:
        """Flip each bit with the mutation rate."""
        flips = self._rng.random((len(strings), 2 * BITS)) < MUTATION
        return np.asarray(strings ^ (flips @ (1 << np.arange(2 * BITS, dtype=np.int64))))

    def _encode(self, points: Floats) -> Ints:
        share = np.clip((points - self._box[0]) / (self._box[1] - self._box[0]), 0.0, 1.0)
        whole = np.rint(share * LEVELS).astype(np.int64)
        return np.asarray((whole[:, 0] << BITS) | whole[:, 1])

    def _decode(self, strings: Ints) -> Floats:
        whole = np.stack([strings >> BITS, strings & LEVELS], axis=1)
        return np.asarray(self._box[0] + whole / LEVELS * (self._box[1] - self._box[0]))
