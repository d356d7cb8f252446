"""Particle swarm optimisation of one waypoint (Algorithms 9 and 10, Eqs. 28-30)."""

from __future__ import annotations

import numpy as np

from avoidance.parameters import SwarmSettings
from avoidance.types import Floats


class Pso:
    """A particle swarm behind ask and tell.

    Parameters
    ----------
    seeds : array, shape (m, 2)
        Points to start from, best guesses first [m]; fewer than the swarm are repeated with a scatter.
    settings : SwarmSettings
        Coefficients.
    rng : numpy.random.Generator
        Source of randomness.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> swarm = Pso(np.array([[900.0, 700.0]]), SwarmSettings(), rng)
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
    velocity only; the position is bounded by g2.
    """

    def __init__(self, seeds: Floats, settings: SwarmSettings, rng: np.random.Generator) -> None:
        if not len(seeds):
            raise ValueError("seeds: at least one point is needed, got none")
        self._settings = settings
        self._rng = rng
        self._points = _fill(seeds, settings.particles, rng)
        self._velocity = np.zeros_like(self._points)
        self._own_points = self._points.copy()
        self._own_costs = np.full(settings.particles, np.inf)
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
        """Take the costs of the points asked, shape (n,), and move the swarm."""
        settings = self._settings
        better = costs < self._own_costs
        self._own_points[better] = self._points[better]
        self._own_costs[better] = costs[better]
        leader = int(np.argmin(costs))
        change = self._best_cost - float(costs[leader])
        if change > 0.0:
            self._best, self._best_cost = self._points[leader].copy(), float(costs[leader])
        self._unchanged = self._unchanged + 1 if change < settings.stop_change else 0
        attractor = self._best if settings.shared_best else self._own_points
        share = min(self.iteration / settings.iterations, 1.0)
        inertia = settings.inertia_start - (settings.inertia_start - settings.inertia_end) * share  # Eq. 30
        self._velocity = (  # Eq. 28
            inertia * self._velocity
            + settings.cognitive * self._rng.random(self._points.shape) * (attractor - self._points)
            + settings.social * self._rng.random(self._points.shape) * (self._best - self._points)
        )
        np.clip(self._velocity, -settings.largest_step, settings.largest_step, out=self._velocity)
        self._points = self._points + self._velocity  # Eq. 29
        self.iteration += 1


def _fill(seeds: Floats, particles: int, rng: np.random.Generator) -> Floats:
    """The first `particles` seeds; missing ones scatter about the given ones."""
    missing = particles - len(seeds)
    if missing <= 0:
        return np.array(seeds[:particles], dtype=np.float64)
    scatter = seeds[np.arange(missing) % len(seeds)] + rng.normal(0.0, 200.0, (missing, 2))
    return np.concatenate([seeds, scatter])
