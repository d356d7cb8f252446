"""Guaranteed-convergence particle swarm: the best particle searches about the best point (Table 7)."""

from __future__ import annotations

import numpy as np

from avoidance.parameters import SwarmSettings
from avoidance.pso import Pso
from avoidance.types import Floats

FIRST_RADIUS = 800.0
"""ρ at the start [m]: the largest step of the swarm."""
SUCCESSES = 15
"""Improvements running after which ρ doubles."""
FAILURES = 5
"""Iterations without one after which ρ halves."""


class Gcpso(Pso):
    """A swarm whose best particle cannot stagnate; parameters as in `AskTell`.

    Notes
    -----
    van den Bergh and Engelbrecht (2002), the paper's [46]: the best particle's velocity is
    -x + ĝ + w v + ρ (1 - 2 r), with ρ adapted to success and failure; all others move by Eq. (28).
    """

    def __init__(self, seeds: Floats, box: Floats, settings: SwarmSettings, rng: np.random.Generator) -> None:
        super().__init__(seeds, box, settings, rng)
        self._leader = 0
        self._radius = FIRST_RADIUS
        self._successes = self._failures = 0

    def _next_velocity(self, costs: Floats, change: float) -> Floats:
        if change > 0.0:
            self._leader = int(np.argmin(costs))
        self._adapt(change > 0.0)
        velocity = super()._next_velocity(costs, change)
        leader = self._leader
        velocity[leader] = (
            self._best
            - self._points[leader]
            + self._inertia() * self._velocity[leader]
            + self._radius * (1.0 - 2.0 * self._rng.random(2))
        )
        return velocity

    def _adapt(self, success: bool) -> None:
        """Count, and change ρ when there were enough of a kind running."""
        self._successes = self._successes + 1 if success else 0
        self._failures = 0 if success else self._failures + 1
        if self._successes > SUCCESSES:
            self._radius *= 2.0
            self._successes = 0
        elif self._failures > FAILURES:
            self._radius *= 0.5
            self._failures = 0
