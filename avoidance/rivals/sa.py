"""Simulated annealing with the paper's settings (Sec. 6)."""

from __future__ import annotations

import math

import numpy as np

from avoidance.ask_tell import AskTell
from avoidance.parameters import SwarmSettings
from avoidance.types import Floats

FIRST_TEMPERATURE = 100.0
"""T at the start: also the length of a step [m]."""
COOLING = 0.95
"""T shrinks by this factor in each iteration."""


class Sa(AskTell):
    """One point that walks, less and less wildly; parameters as in `AskTell`.

    Notes
    -----
    Sec. 6: 30 iterations, initial temperature 100, "Acceptance Function - simulannealbnd". Differs from the
    paper: E34, that is the name of a solver; we take its defaults, which are a step of length T in a random
    direction, T = 100 · 0.95^k, a worse point accepted with probability 1/(1 + exp(Δ/T)), and a coordinate
    out of bounds drawn again between the bound and where it was. The walk starts from the best seed.
    """

    def __init__(self, seeds: Floats, box: Floats, settings: SwarmSettings, rng: np.random.Generator) -> None:
        super().__init__(seeds, box, settings, rng)
        self._here = self._points[0]
        self._here_cost = np.inf

    def _move(self, costs: Floats, change: float) -> Floats:  # noqa: ARG002
        temperature = FIRST_TEMPERATURE * COOLING**self.iteration
        leader = int(np.argmin(costs))
        if self._accepted(float(costs[leader]) - self._here_cost, temperature):
            self._here, self._here_cost = self._points[leader], float(costs[leader])
        angle = self._rng.uniform(-math.pi, math.pi)
        there = self._here + temperature * np.array([math.cos(angle), math.sin(angle)])
        bound = np.clip(there, self._box[0], self._box[1])
        inside = np.clip(self._here, self._box[0], self._box[1])
        drawn = inside + self._rng.random(2) * (bound - inside)
        return np.asarray(np.where(there == bound, there, drawn))[None]

    def _accepted(self, worse: float, temperature: float) -> bool:
        if worse <= 0.0:
            return True
        return float(self._rng.random()) < 1.0 / (1.0 + math.exp(min(worse / temperature, 700.0)))
