"""Multi-start particle swarm: a swarm that stands still is drawn anew (Table 7)."""

from __future__ import annotations

import numpy as np

from avoidance.parameters import SwarmSettings
from avoidance.pso import Pso
from avoidance.types import Floats

PATIENCE = 5
"""Iterations without change after which the swarm is drawn anew."""
NO_CHANGE = 1e-6
"""A relative change of the best cost below this is none."""


class Mpso(Pso):
    """A swarm that starts again where it has come to rest; parameters as in `AskTell`.

    Notes
    -----
    van den Bergh and Engelbrecht (2002), the paper's [46], with the paper's rule: "whenever the change in
    fitness value remains constant continuously for 5 iterations". The best point is kept. What ends the
    others starts this one again, so only the number of iterations stops it.
    """

    def __init__(self, seeds: Floats, box: Floats, settings: SwarmSettings, rng: np.random.Generator) -> None:
        super().__init__(seeds, box, settings, rng)
        self._still = 0
        self.restarts = 0
        """How often the swarm was drawn anew."""

    @property
    def finished(self) -> bool:
        """True when the iterations are used up."""
        return self.iteration > self._settings.iterations

    def _move(self, costs: Floats, change: float) -> Floats:
        moved = super()._move(costs, change)
        stands = change < NO_CHANGE * max(abs(self._best_cost), 1.0)
        self._still = self._still + 1 if stands else 0
        if self._still < PATIENCE:
            return moved
        self._still = 0
        self.restarts += 1
        self._velocity = np.zeros_like(moved)
        self._own_costs = np.full(len(moved), np.inf)
        return np.asarray(self._rng.uniform(self._box[0], self._box[1], moved.shape))
