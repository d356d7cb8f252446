"""What every planner of single waypoints shares: it asks for costs, is told them, and knows its best."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from avoidance.parameters import SwarmSettings
from avoidance.types import Floats

SCATTER = 200.0
"""Points that are missing to a population lie about the seeds with this standard deviation [m]."""


class AskTell(ABC):
    """A planner behind ask and tell: the best so far and the stop rule are the same for all.

    A planner adds `_move`, which turns the points whose costs it was told into the next ones.

    Parameters
    ----------
    seeds : array, shape (m, 2)
        Points to start from, best guesses first [m]; fewer than the population are repeated with a scatter.
    box : array, shape (2, 2)
        Least and largest north and east of the search space [m].
    settings : SwarmSettings
        Population, iterations and stop rule; a swarm's coefficients as well.
    rng : numpy.random.Generator
        Source of randomness.

    Raises
    ------
    ValueError
        If there is no seed.

    Notes
    -----
    Table 2: stop after I iterations, or when the best changes too little in several iterations running. The
    evaluation of the seeds is not counted as an iteration.
    """

    def __init__(self, seeds: Floats, box: Floats, settings: SwarmSettings, rng: np.random.Generator) -> None:
        if not len(seeds):
            raise ValueError("seeds: at least one point is needed, got none")
        self._settings = settings
        self._rng = rng
        self._box = np.asarray(box, dtype=np.float64)
        self._points = _fill(seeds, settings.particles, rng)
        self._best = self._points[0]
        self._best_cost = np.inf
        self._unchanged = 0
        self.iteration = 0
        """Iterations told so far."""

    @property
    def best(self) -> Floats:
        """Best point so far, shape (2,) [m]."""
        return np.asarray(self._best)

    @property
    def best_cost(self) -> float:
        """Its cost; infinite before the first `tell`."""
        return self._best_cost

    @property
    def finished(self) -> bool:
        """True when the iterations are used up or the stop rule of Table 2 holds."""
        return self.iteration > self._settings.iterations or self._unchanged >= self._settings.stop_iterations

    def ask(self) -> Floats:
        """Points to be evaluated next, shape (n, 2) [m]."""
        return self._points

    def tell(self, costs: Floats) -> None:
        """Take the costs of the points asked, shape (n,), and move on."""
        leader = int(np.argmin(costs))
        change = self._best_cost - float(costs[leader])
        if change > 0.0:
            self._best, self._best_cost = self._points[leader].copy(), float(costs[leader])
        self._unchanged = self._unchanged + 1 if change < self._settings.stop_change else 0
        self._points = self._move(costs, change)
        self.iteration += 1

    @abstractmethod
    def _move(self, costs: Floats, change: float) -> Floats:
        """The next points, shape (n, 2) [m], from the costs of the present ones; the best is up to date.

        `change` is by how much the best of them is better than the best before, negative if it is worse.
        """


def _fill(seeds: Floats, particles: int, rng: np.random.Generator) -> Floats:
    """The first `particles` seeds; missing ones scatter about the given ones."""
    missing = particles - len(seeds)
    if missing <= 0:
        return np.array(seeds[:particles], dtype=np.float64)
    scatter = seeds[np.arange(missing) % len(seeds)] + rng.normal(0.0, SCATTER, (missing, 2))
    return np.concatenate([seeds, scatter])
