"""Truth: obstacles, traffic, the vehicles in it, and time. The simulation's `Clock`."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations

import numpy as np

from avoidance.types import Bools, Ownship
from scenarios.movers import Flyer, Mover
from scenarios.scenario import NEAR, TRAFFIC_VIOLATION_RADIUS, Obstacle
from scenarios.snapshot import Neighbourhood, Snapshot, snapshot_of
from scenarios.track import MovingLog, MovingTrack, Track, TrackLog

FINE_STEP = 0.1
"""Time step near anything that could be hit [s]."""
FASTEST = 60.0
"""No vehicle under test is faster over ground than this [m/s]."""
OUTLOOK = 10_000.0
"""Obstacles are looked through again for those near a vehicle at least every so often [m]."""

Place = tuple[float, float, float]


class World:
    """Obstacles, traffic and vehicles, and the time they share.

    Parameters
    ----------
    obstacles : sequence of Obstacle
        Everything that stands still, also what appears later.
    vehicles : mapping of name to vehicle
        The vehicles under test; each exists and is recorded until it has finished.
    traffic : sequence of Mover
        Moving obstacles.
    ids : mapping of name to int, optional
        Under which identity the others see a vehicle; needed where there are several.
    """

    def __init__(
        self,
        obstacles: Sequence[Obstacle],
        vehicles: Mapping[str, Flyer],
        traffic: Sequence[Mover] = (),
        ids: Mapping[str, int] | None = None,
    ) -> None:
        self._now = 0.0
        self._vehicles = dict(vehicles)
        self._ids = dict(ids or dict.fromkeys(vehicles, -1))
        self._traffic = tuple(traffic)
        self._all = Snapshot(
            np.array([o.id for o in obstacles], dtype=np.int64),
            np.array([(o.north, o.east, o.altitude) for o in obstacles]).reshape(-1, 3),
            np.array([o.safety_radius for o in obstacles], dtype=np.float64),
        )
        self._appears = np.array([o.appears_at for o in obstacles], dtype=np.float64)
        widest = float(self._all.radii.max(initial=0.0))
        self._around = {
            name: Neighbourhood(self._all, NEAR + max(widest - 1000.0, 0.0) + OUTLOOK) for name in vehicles
        }
        self._far_until = -math.inf
        self._next_change = -math.inf
        self._standing = self._stand()
        self._logs = {name: TrackLog(name) for name in self._vehicles}
        self._moving_logs = [MovingLog(mover.id, mover.radius) for mover in self._traffic]
        self._states: dict[str, Ownship] = {}
        self._record(self._vehicles)

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
            flying = [name for name, vehicle in self._vehicles.items() if not vehicle.finished]
            if not flying:
                return
            self._step(flying, begin + period * step / steps)

    def state(self, name: str) -> Ownship:
        """The true state of a vehicle."""
        return self._states[name]

    def standing(self) -> Snapshot:
        """What stands still and exists now; the same object until that changes."""
        if self._now >= self._next_change:
            self._standing = self._stand()
        return self._standing

    def moving(self, observer: str | None = None) -> Snapshot | None:
        """What moves and exists now, the observer's own vehicle left out; None if nothing does."""
        seen = [(m.id, p, m.shown_radius) for m in self._traffic if (p := m.position()) is not None]
        seen += [
            (self._ids[name], place(self._states[name]), math.nan)
            for name, vehicle in self._vehicles.items()
            if name != observer and self._ids[name] >= 0 and not vehicle.finished
        ]
        return snapshot_of(seen) if seen else None

    def snapshot(self, observer: str | None = None) -> Snapshot:
        """Everything that exists now, the observer's own vehicle left out."""
        standing, moving = self.standing(), self.moving(observer)
        return standing if moving is None else standing.joined(moving)

    def tracks(self) -> list[Track]:
        """What each vehicle has flown so far; they begin together and end when each has finished."""
        return [log.track() for log in self._logs.values()]

    def moving_tracks(self) -> list[MovingTrack]:
        """What each moving obstacle has flown so far, at the times of the longest track."""
        return [log.track() for log in self._moving_logs]

    def others(self, observer: str) -> list[MovingTrack]:
        """What moved beside one vehicle, the other vehicles included, at the times of its own track."""
        count = len(self._logs[observer])
        moved = [MovingTrack(t.id, t.radius, t.positions[:count]) for t in self.moving_tracks()]
        for name, log in self._logs.items():
            if name != observer and self._ids[name] >= 0:
                there = np.full((count, 3), math.nan)
                known = log.track().positions[:count]
                there[: len(known)] = known
                moved.append(MovingTrack(self._ids[name], TRAFFIC_VIOLATION_RADIUS, there))
        return moved

    def _step(self, flying: Iterable[str], until: float) -> None:
        now, duration = self._now, until - self._now
        for mover in self._traffic:
            mover.advance(now, duration)
        for name in flying:
            self._vehicles[name].advance(duration)
        self._now = until
        self._record(flying)

    def _record(self, flying: Iterable[str]) -> None:
        for name in flying:
            state = self._vehicles[name].state().ownship
            self._states[name] = state
            self._logs[name].append(self._now, state)
        for log, mover in zip(self._moving_logs, self._traffic, strict=True):
            log.append(mover.position())

    def _stand(self) -> Snapshot:
        exists: Bools = self._appears <= self._now
        later = self._appears[~exists]
        self._next_change = float(later.min()) if later.size else math.inf
        return self._all.chosen(exists)

    def _anything_near(self, period: float) -> bool:
        places = {n: place(self._states[n]) for n, vehicle in self._vehicles.items() if not vehicle.finished}
        if self._now + period > self._far_until:
            away = min((self._least_gap(name, here) for name, here in places.items()), default=math.inf)
            if away < FASTEST * period:
                return True
            self._far_until = self._now + away / FASTEST
        for mover in self._traffic:
            there = mover.position()
            reach = NEAR + (FASTEST + mover.speed) * period
            if there is not None and any(math.dist(here, there) < reach for here in places.values()):
                return True
        if len(places) < 2:
            return False
        reach = NEAR + 2.0 * FASTEST * period
        return any(math.dist(a, b) < reach for a, b in combinations(places.values(), 2))

    def _least_gap(self, name: str, here: Place) -> float:
        """How far a place is from where the track must be fine, over all obstacles, now or later [m].

        At most `OUTLOOK`: what lies beyond is not looked at.
        """
        close = self._around[name].around(here)
        if not close.ids.size:
            return OUTLOOK
        away = close.positions - here
        near = NEAR + np.maximum(close.radii - 1000.0, 0.0)
        return min(float((np.sqrt(np.einsum("ij,ij->i", away, away)) - near).min()), OUTLOOK)


def place(state: Ownship) -> Place:
    """North, east, altitude of a vehicle [m]."""
    return state.north, state.east, state.altitude
