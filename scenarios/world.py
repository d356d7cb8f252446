"""Truth: obstacles, traffic, the vehicles in it, and time. The simulation's `Clock`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from avoidance.types import Bools, Floats, Ints
from offboard.link import VehicleState
from scenarios.scenario import NEAR, Obstacle, Traffic
from scenarios.track import MovingLog, MovingTrack, Track, TrackLog

FINE_STEP = 0.1
"""Time step near anything that could be hit [s]."""
FASTEST = 60.0
"""No vehicle under test is faster over ground than this [m/s]."""


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
        self._points = np.array([(p.north, p.east, p.altitude) for p in plan.waypoints])
        legs = np.hypot(*np.diff(self._points[:, :2], axis=0).T)
        self._arrivals = np.concatenate(([0.0], np.cumsum(legs))) / plan.speed
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
        north, east, altitude = (np.interp(flown, self._arrivals, column) for column in self._points.T)
        return float(north), float(east), float(altitude)


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


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot:
    """Everything that exists at one instant, as read-only arrays."""

    ids: Ints
    """Identities, shape (n,)."""
    positions: Floats
    """North, east, altitude [m], shape (n, 3)."""
    radii: Floats
    """Safety radius of each [m], NaN where it is not known to a radar, shape (n,)."""


class World:
    """Obstacles, traffic and vehicles, and the time they share.

    Parameters
    ----------
    obstacles : sequence of Obstacle
        Everything that stands still, also what appears later.
    vehicles : mapping of name to vehicle
        The vehicles under test; each is recorded until it has finished.
    traffic : sequence of Mover
        Moving obstacles.
    """

    def __init__(
        self, obstacles: Sequence[Obstacle], vehicles: dict[str, Flyer], traffic: Sequence[Mover] = ()
    ) -> None:
        self._now = 0.0
        self._vehicles = dict(vehicles)
        self._traffic = tuple(traffic)
        self._ids = np.array([o.id for o in obstacles], dtype=np.int64)
        self._positions = np.array([(o.north, o.east, o.altitude) for o in obstacles]).reshape(-1, 3)
        self._radii = np.array([o.safety_radius for o in obstacles], dtype=np.float64)
        self._appears = np.array([o.appears_at for o in obstacles], dtype=np.float64)
        self._near = NEAR + np.maximum(self._radii - 1000.0, 0.0)
        self._far_until = -math.inf
        self._next_change = -math.inf
        self._standing = self._stand()
        self._logs = {name: TrackLog(name) for name in self._vehicles}
        self._moving_logs = [MovingLog(mover.id, mover.radius) for mover in self._traffic]
        self._record()

    @property
    def now(self) -> float:
        """Seconds since the start."""
        return self._now

    def advance(self, period: float) -> None:
        """Let `period` seconds pass: 10 Hz near anything that could be hit, else in one step.

        The step is chosen once a period, early enough for everything that can come near within it. Time
        stops when all vehicles have finished.
        """
        steps = math.ceil(period / FINE_STEP - 1e-9) if self._anything_near(period) else 1
        begin = self._now
        for step in range(1, steps + 1):
            if all(vehicle.finished for vehicle in self._vehicles.values()):
                return
            self._step(begin + period * step / steps)

    def snapshot(self) -> Snapshot:
        """What exists now."""
        if self._now >= self._next_change:
            self._standing = self._stand()
        if not self._traffic:
            return self._standing
        seen = [(m, p) for m in self._traffic if (p := m.position()) is not None]
        if not seen:
            return self._standing
        standing = self._standing
        return Snapshot(
            np.concatenate((standing.ids, np.array([m.id for m, _ in seen], dtype=np.int64))),
            np.concatenate((standing.positions, np.array([p for _, p in seen]))),
            np.concatenate((standing.radii, np.array([m.shown_radius for m, _ in seen]))),
        )

    def tracks(self) -> list[Track]:
        """What each vehicle has flown so far."""
        return [log.track() for log in self._logs.values()]

    def moving_tracks(self) -> list[MovingTrack]:
        """What each moving obstacle has flown so far, at the same times."""
        return [log.track() for log in self._moving_logs]

    def _step(self, until: float) -> None:
        now, duration = self._now, until - self._now
        for mover in self._traffic:
            mover.advance(now, duration)
        for vehicle in self._vehicles.values():
            vehicle.advance(duration)
        self._now = until
        self._record()

    def _record(self) -> None:
        for name, vehicle in self._vehicles.items():
            self._logs[name].append(self._now, vehicle.state().ownship)
        for log, mover in zip(self._moving_logs, self._traffic, strict=True):
            log.append(mover.position())

    def _stand(self) -> Snapshot:
        exists: Bools = self._appears <= self._now
        later = self._appears[~exists]
        self._next_change = float(later.min()) if later.size else math.inf
        snapshot = Snapshot(self._ids[exists], self._positions[exists], self._radii[exists])
        for values in (snapshot.ids, snapshot.positions, snapshot.radii):
            values.flags.writeable = False
        return snapshot

    def _anything_near(self, period: float) -> bool:
        places = [self._place(vehicle) for vehicle in self._vehicles.values()]
        if self._now + period > self._far_until:
            away = min((self._least_gap(place) for place in places), default=math.inf)
            if away < FASTEST * period:
                return True
            self._far_until = self._now + away / FASTEST
        for mover in self._traffic:
            there = mover.position()
            reach_moving = NEAR + (FASTEST + mover.speed) * period
            if there is not None and any(math.dist(place, there) < reach_moving for place in places):
                return True
        return any(
            math.dist(a, b) < NEAR + 2.0 * FASTEST * period
            for k, a in enumerate(places)
            for b in places[k + 1 :]
        )

    def _least_gap(self, place: tuple[float, float, float]) -> float:
        """How far a place is from where the track must be fine, over all obstacles, now or later [m]."""
        if not self._ids.size:
            return math.inf
        away = self._positions - place
        return float((np.sqrt(np.einsum("ij,ij->i", away, away)) - self._near).min())

    @staticmethod
    def _place(vehicle: Flyer) -> tuple[float, float, float]:
        state = vehicle.state().ownship
        return state.north, state.east, state.altitude
