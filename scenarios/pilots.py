"""Pilots with the faults of a real one: they do not know exactly where they are, and need time to think."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from avoidance import Decision, Hold, Keep
from offboard.link import Vehicle, VehicleState
from offboard.pilot import Pilot, Step

CORRELATION_TIME = 60.0
"""An error of the own position is forgotten after about this time [s]."""


class Navigation:
    """What a vehicle believes about its position: the truth with a slowly changing error.

    Parameters
    ----------
    sigma : float
        Standard deviation of the horizontal position [m]; that of each axis is smaller by √2.
    rng : Generator
        Never used if sigma is 0.

    Notes
    -----
    A first-order Gauss-Markov process on each axis, as is usual for satellite navigation.
    """

    def __init__(self, sigma: float, rng: np.random.Generator) -> None:
        self._sigma = sigma
        self._axis = sigma / math.sqrt(2.0)
        self._rng = rng
        self._error = self._axis * rng.standard_normal(2) if sigma > 0.0 else np.zeros(2)
        self._time = 0.0

    def reported(self, state: VehicleState) -> VehicleState:
        """A true state as the vehicle reports it."""
        if self._sigma <= 0.0:
            return state
        own = state.ownship
        kept = math.exp(-max(own.time - self._time, 0.0) / CORRELATION_TIME)
        if kept < 1.0:
            fresh = self._axis * math.sqrt(1.0 - kept**2) * self._rng.standard_normal(2)
            self._error = kept * self._error + fresh
            self._time = own.time
        north, east = own.north + float(self._error[0]), own.east + float(self._error[1])
        return replace(state, ownship=replace(own, north=north, east=east, position_error=self._sigma))


class Desk:
    """Holds a decision until its time has come."""

    def __init__(self, latency: float) -> None:
        self._latency = latency
        self._due = math.inf
        self._decision: Decision | None = None

    @property
    def busy(self) -> bool:
        """True while something is being thought about."""
        return self._decision is not None

    def put(self, decision: Decision, now: float) -> Decision:
        """A decision taken about the scan of `now` [s]: what is done about it at once."""
        changes = decision.route is not None or isinstance(decision, Hold)
        if self._latency <= 0.0 or not changes:
            return decision
        self._decision, self._due = decision, now + self._latency
        return Keep(why=f"thinking for {self._latency:g} s", threat=decision.threat)

    def take(self, now: float, vehicle: Vehicle) -> Decision:
        """The decision, once its time has come; waypoints that were reached meanwhile are left out."""
        decision = self._decision
        if decision is None or now < self._due - 1e-9:
            return Keep(why="still thinking")
        self._decision = None
        if decision.route is None:
            return decision
        ahead = {w.item for w in vehicle.route().waypoints}
        route = tuple(w for w in decision.route if w.item is None or w.item in ahead)
        return replace(decision, route=route) if route else Keep(why="overtaken by events")


@dataclass(frozen=True, slots=True)
class FaultyPilot(Pilot):
    """A pilot that errs about its position and decides late."""

    navigation: Navigation
    """Where the vehicle believes to be."""
    desk: Desk = field(default_factory=lambda: Desk(0.0))
    """What is being thought about."""

    def step(self, now: float) -> Step:
        """Look once, decide once unless still thinking, start at most one mission edit."""
        state = self.navigation.reported(self.vehicle.state())
        scan = self.radar.scan(state, now)
        if self.vehicle.finished:
            return Step(state, scan, Keep(why="The mission is finished."))
        if self.desk.busy:
            decision = self.desk.take(now, self.vehicle)
        else:
            decision = self.desk.put(self.agent.decide(state.ownship, self.vehicle.route(), scan), now)
        self.vehicle.begin(decision)
        return Step(state, scan, decision)
