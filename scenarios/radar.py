"""What a radar says of the world: range, and its faults where they are asked for."""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from avoidance.types import Floats, Ints, Ownship, RadarScan
from offboard.link import VehicleState
from scenarios.scenario import OWN, RadarSettings
from scenarios.snapshot import Neighbourhood, Snapshot
from scenarios.world import World, place

FIRST_FALSE_ID = 1_000_000_000
"""False tracks count from here; no real obstacle does."""


class SimulatedRadar:
    """A radar on one vehicle that sees what exists within its range.

    Parameters
    ----------
    world : World
        The truth.
    settings : RadarSettings
        Range and faults.
    rng : Generator
        For the faults alone: with all of them off it is never used.
    vehicle : str
        Name of the vehicle that carries it, which it does not see.
    """

    def __init__(
        self, world: World, settings: RadarSettings, rng: np.random.Generator, vehicle: str = OWN
    ) -> None:
        self._world = world
        self._settings = settings
        self._rng = rng
        self._vehicle = vehicle
        self._false_ids = FIRST_FALSE_ID
        self._delayed: deque[RadarScan] = deque()
        self._delivered: RadarScan | None = None
        self._around = Neighbourhood(world.standing(), settings.range)
        self._shown_ids: dict[int, int] = {}  # true identity: the one that has been swapped for it
        s = settings
        self._faulty = s.range_noise > 0.0 or s.bearing_noise > 0.0 or s.detection_probability < 1.0
        self._faulty = self._faulty or s.false_tracks > 0.0 or s.id_swaps > 0.0
        self._nothing = _empty()

    def scan(self, state: VehicleState, now: float) -> RadarScan:
        """The sweep that is delivered at `now`: taken then, or `latency` seconds before.

        A radar measures from where the vehicle truly is, and its returns are put on the map from where the
        vehicle believes to be, `state`. A late sweep carries the time at which it was taken. Until the first
        one arrives, sweeps are empty.
        """
        scan = self._sweep(state.ownship, now)
        if self._settings.latency <= 0.0:
            return scan
        self._delayed.append(scan)
        due = now - self._settings.latency
        while self._delayed and self._delayed[0].time <= due + 1e-9:
            self._delivered = self._delayed.popleft()
        return self._delivered or RadarScan(now - self._settings.latency, *self._nothing)

    def _sweep(self, believed: Ownship, now: float) -> RadarScan:
        own = self._world.state(self._vehicle)
        truth = self._truth(own)
        if not truth.ids.size and not self._faulty:
            return RadarScan(now, *self._nothing)
        seen = self._seen(own, truth.positions)
        if self._settings.detection_probability < 1.0:
            seen = seen[self._rng.random(seen.size) < self._settings.detection_probability]
        if not seen.size and not self._faulty:
            return RadarScan(now, *self._nothing)
        ids, positions, radii = truth.ids[seen], truth.positions[seen], truth.radii[seen]
        if self._faulty:
            ids, positions, radii = self._with_faults(own, ids, positions, radii)
        if believed.position_error > 0.0:
            positions[:, 0] += believed.north - own.north
            positions[:, 1] += believed.east - own.east
        for values in (ids, positions, radii):
            values.flags.writeable = False
        return RadarScan(now, ids, positions, radii)

    def _truth(self, own: Ownship) -> Snapshot:
        """What exists about the vehicle."""
        standing = self._world.standing()
        if standing is not self._around.whole:
            self._around = Neighbourhood(standing, self._settings.range)
        near = self._around.around(place(own))
        moving = self._world.moving(self._vehicle)
        return near if moving is None else near.joined(moving)

    def _seen(self, own: Ownship, positions: Floats) -> Ints:
        """Rows of what is in range and in the field of view."""
        away = positions - place(own)
        seen = np.einsum("ij,ij->i", away, away) <= self._settings.range**2
        if self._settings.field_of_view < 2.0 * math.pi:
            bearings = np.arctan2(away[:, 1], away[:, 0]) - own.heading
            off_nose = np.abs(np.remainder(bearings + math.pi, 2.0 * math.pi) - math.pi)
            seen &= off_nose <= 0.5 * self._settings.field_of_view
        return np.flatnonzero(seen)

    def _with_faults(
        self, own: Ownship, ids: Ints, positions: Floats, radii: Floats
    ) -> tuple[Ints, Floats, Floats]:
        settings = self._settings
        if settings.range_noise > 0.0 or settings.bearing_noise > 0.0:
            north, east = positions[:, 0] - own.north, positions[:, 1] - own.east
            ranges = np.hypot(north, east) + settings.range_noise * self._rng.standard_normal(ids.size)
            bearings = np.arctan2(east, north) + settings.bearing_noise * self._rng.standard_normal(ids.size)
            ranges = np.maximum(ranges, 0.0)
            positions[:, 0] = own.north + ranges * np.cos(bearings)
            positions[:, 1] = own.east + ranges * np.sin(bearings)
        if settings.id_swaps > 0.0:
            ids = self._swapped(ids)
        extra = int(self._rng.poisson(settings.false_tracks)) if settings.false_tracks > 0.0 else 0
        if extra:
            false = self._false_positions(own, extra)
            ids = np.concatenate((ids, np.arange(self._false_ids, self._false_ids + extra, dtype=np.int64)))
            positions = np.concatenate((positions, false))
            radii = np.concatenate((radii, np.full(extra, math.nan)))
            self._false_ids += extra
        return ids, positions, radii

    def _swapped(self, ids: Ints) -> Ints:
        """Identities as shown: now and then two that are seen are exchanged, and stay so."""
        shown = self._shown_ids
        if ids.size > 1 and self._rng.random() < self._settings.id_swaps:
            a, b = (int(i) for i in self._rng.choice(ids, size=2, replace=False))
            shown[a], shown[b] = shown.get(b, b), shown.get(a, a)
        return np.array([shown.get(i, i) for i in ids.tolist()], dtype=np.int64)

    def _false_positions(self, own: Ownship, count: int) -> Floats:
        """Uniform over the disc, or the sector, that the radar looks at."""
        settings = self._settings
        ranges = settings.range * np.sqrt(self._rng.random(count))
        bearings = own.heading + settings.field_of_view * (self._rng.random(count) - 0.5)
        return np.column_stack(
            (
                own.north + ranges * np.cos(bearings),
                own.east + ranges * np.sin(bearings),
                np.full(count, own.altitude),
            )
        )


def _empty() -> tuple[Ints, Floats, Floats]:
    nothing = (np.empty(0, dtype=np.int64), np.empty((0, 3)), np.empty(0))
    for values in nothing:
        values.flags.writeable = False
    return nothing
