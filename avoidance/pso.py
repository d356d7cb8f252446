"""Particle swarm optimisation of one waypoint (Algorithms 9 and 10, Eqs. 28-30)."""

from __future__ import annotations

import numpy as np

from avoidance.ask_tell import AskTell
from avoidance.parameters import SwarmSettings
from avoidance.types import Floats


class Pso(AskTell):
    """A particle swarm behind ask and tell; parameters as in `AskTell`.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> box = np.array([[-1000.0, -1000.0], [1000.0, 1000.0]])
    >>> swarm = Pso(np.array([[900.0, 700.0]]), box, SwarmSettings(), rng)
    >>> while not swarm.finished:
    ...     points = swarm.ask()
    ...     swarm.tell((points**2).sum(axis=1))
    >>> bool(np.hypot(*swarm.best) < 900.0)
    True

    Notes
    -----
    Velocity, Eq. (28); position, Eq. (29); inertia, Eq. (30). Differs from the paper: E27 and E28, in the
    default settings a stable set of coefficients and a personal best per particle; with `shared_best` the
    personal best is the one best that Fig. 16 keeps, equal to the global one. E29: Algorithm 9 bounds the
    velocity only; the position is bounded by g2, not by the box.
    """

    def __init__(self, seeds: Floats, box: Floats, settings: SwarmSettings, rng: np.random.Generator) -> None:
        super().__init__(seeds, box, settings, rng)
        self._velocity = np.zeros_like(self._points)
        self._own_points = self._points.copy()
        self._own_costs = np.full(settings.particles, np.inf)

    def _move(self, costs: Floats, change: float) -> Floats:
        settings = self._settings
        better = costs < self._own_costs
        self._own_points[better] = self._points[better]
        self._own_costs[better] = costs[better]
        self._velocity = self._next_velocity(costs, change)
        np.minimum(self._velocity, settings.largest_step, out=self._velocity)
        np.maximum(self._velocity, -settings.largest_step, out=self._velocity)
        return self._points + self._velocity  # Eq. 29

    def _inertia(self) -> float:
        """w of Eq. (30)."""
        settings = self._settings
        share = min(self.iteration / settings.iterations, 1.0)
        return settings.inertia_start - (settings.inertia_start - settings.inertia_end) * share

    def _next_velocity(self, costs: Floats, change: float) -> Floats:  # noqa: ARG002 (variants need them)
        settings = self._settings
        attractor = self._best if settings.shared_best else self._own_points
        return np.asarray(  # Eq. 28
            self._inertia() * self._velocity
            + settings.cognitive * self._rng.random(self._points.shape) * (attractor - self._points)
            + settings.social * self._rng.random(self._points.shape) * (self._best - self._points)
        )
