"""Phase-angle-coded fruit flies with mutation: our reading of θ-MAFOA (Sec. 6)."""

from __future__ import annotations

import numpy as np

from avoidance.ask_tell import AskTell
from avoidance.parameters import SwarmSettings
from avoidance.types import Floats

MUTATION = 0.8
"""Probability that a fly searches about the best place rather than its own (Sec. 6)."""
FIRST_STEP = 0.5
"""Standard deviation of a step of the phase angle at the start [rad]."""
LAST_STEP = 0.01
"""The same at the end [rad]."""


class ThetaMafoa(AskTell):
    """Flies that search by smell and gather by sight, in phase angles; parameters as in `AskTell`.

    Notes
    -----
    Our reading: the paper of the algorithm (its [21]) could not be had. What is known of it is the coding
    x = ½ [(max - min) sin θ + max + min] and a mutation rate of 0.8. By smell, each fly tries a place near
    the swarm's best (with probability 0.8) or near its own, at a distance that shrinks geometrically; by
    sight, it stays where it was unless the new place is better.
    """

    def __init__(self, seeds: Floats, box: Floats, settings: SwarmSettings, rng: np.random.Generator) -> None:
        super().__init__(seeds, box, settings, rng)
        self._tried = self._angles(self._points)
        self._home = self._tried.copy()
        self._home_costs = np.full(len(self._points), np.inf)

    def _move(self, costs: Floats, change: float) -> Floats:  # noqa: ARG002
        better = costs < self._home_costs
        self._home[better], self._home_costs[better] = self._tried[better], costs[better]
        share = min(self.iteration / self._settings.iterations, 1.0)
        step = FIRST_STEP * (LAST_STEP / FIRST_STEP) ** share
        best = self._home[int(np.argmin(self._home_costs))]
        mutated = self._rng.random(len(self._home)) < MUTATION
        centre = np.where(mutated[:, None], best, self._home)
        tried = centre + step * self._rng.standard_normal(centre.shape)
        self._tried = np.clip(tried, -0.5 * np.pi, 0.5 * np.pi)
        low, high = self._box
        return np.asarray(0.5 * ((high - low) * np.sin(self._tried) + high + low))

    def _angles(self, points: Floats) -> Floats:
        low, high = self._box
        return np.asarray(np.arcsin(np.clip((2.0 * points - high - low) / (high - low), -1.0, 1.0)))
