"""Whoever moves in a world: traffic that flies its own waypoints, and what a world needs of vehicles."""

from __future__ import annotations

import math
from bisect import bisect_right
from itertools import accumulate, pairwise
from typing import Protocol

from offboard.link import VehicleState
from scenarios.scenario import Traffic


class Flyer(Protocol):
    """What the world needs of a vehicle (`offboard.simulated.SimulatedVehicle`)."""

    @property
    def finished(self) -> bool:
        """True once the last mission item has been reached."""

    def state(self) -> VehicleState:
        """The latest state."""

    def advance(self, duration: float) -> None:
        """Fly on for `duration` seconds."""


class Mover(Protocol):
    """A moving obstacle."""

    @property
    def id(self) -> int:
        """Identity."""

    @property
    def radius(self) -> float:
        """Violation radius [m]."""

    @property
    def shown_radius(self) -> float:
        """Radius that the radar reports [m]; NaN if it reports none."""

    @property
    def speed(self) -> float:
        """Largest speed over ground [m/s]."""

    def position(self) -> tuple[float, float, float] | None:
        """North, east, altitude [m]; None while it does not exist."""

    def advance(self, now: float, duration: float) -> None:
        """Move on from `now` by `duration` seconds."""


class PointMover:
    """Moving obstacle at constant speed over ground along its waypoints, straight and exact."""

    def __init__(self, plan: Traffic) -> None:
        self.id = plan.id
        self.radius = plan.radius
        self.shown_radius = math.nan if plan.violation_radius is None else plan.violation_radius
        self.speed = plan.speed
        self._starts_at = plan.starts_at
        self._points = [(p.north, p.east, p.altitude) for p in plan.waypoints]
        legs = [math.dist(a[:2], b[:2]) for a, b in pairwise(self._points)]
        self._arrivals = [0.0, *(length / plan.speed for length in accumulate(legs))]
        self._position = self._at(0.0)

    def position(self) -> tuple[float, float, float] | None:
        """North, east, altitude [m]; None before it starts and after its last waypoint."""
        return self._position

    def advance(self, now: float, duration: float) -> None:
        """Move on from `now` by `duration` seconds."""
        self._position = self._at(now + duration)

    def _at(self, time: float) -> tuple[float, float, float] | None:
        flown = time - self._starts_at
        if not 0.0 <= flown <= self._arrivals[-1]:
            return None
        leg = min(bisect_right(self._arrivals, flown), len(self._arrivals) - 1)
        begin, end = self._arrivals[leg - 1], self._arrivals[leg]
        share = (flown - begin) / (end - begin)
        (n0, e0, h0), (n1, e1, h1) = self._points[leg - 1], self._points[leg]
        return n0 + share * (n1 - n0), e0 + share * (e1 - e0), h0 + share * (h1 - h0)


class FlownMover:
    """Moving obstacle that is an aircraft of its own: flies its waypoints, gone after the last."""

    def __init__(self, plan: Traffic, vehicle: Flyer, wind_speed: float = 0.0) -> None:
        self.id = plan.id
        self.radius = plan.radius
        self.shown_radius = math.nan if plan.violation_radius is None else plan.violation_radius
        self.speed = plan.speed + wind_speed
        self._starts_at = plan.starts_at
        self._exists = plan.starts_at <= 0.0
        self._vehicle = vehicle

    def position(self) -> tuple[float, float, float] | None:
        """North, east, altitude [m]; None before it starts and after its last waypoint."""
        if not self._exists or self._vehicle.finished:
            return None
        state = self._vehicle.state().ownship
        return state.north, state.east, state.altitude

    def advance(self, now: float, duration: float) -> None:
        """Fly on; a start within this step begins at the step's end."""
        if self._exists and not self._vehicle.finished:
            self._vehicle.advance(duration)
        self._exists = self._exists or now + duration >= self._starts_at
