"""What a radar says of the world: range, and its faults where they are asked for."""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from avoidance.types import Bools, Floats, Ints, Ownship, RadarScan
from offboard.link import VehicleState
from scenarios.scenario import RadarSettings
from scenarios.world import FASTEST, Snapshot, World

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
    """

    def __init__(self, world: World, settings: RadarSettings, rng: np.random.Generator) -> None:
        self._world = world
        self._settings = settings
        self._rng = rng
        self._false_ids = FIRST_FALSE_ID
        self._delayed: deque[RadarScan] = deque()
        self._delivered: RadarScan | None = None
        self._empty_truth: Snapshot | None = None  # nothing of it comes into range before `_empty_until`
        self._empty_until = -math.inf
        s = settings
        self._faulty = s.range_noise > 0.0 or s.bearing_noise > 0.0 or s.detection_probability < 1.0
        self._faulty = self._faulty or s.false_tracks > 0.0
        self._nothing = _empty()

    def scan(self, state: VehicleState, now: float) -> RadarScan:
        """The sweep that is delivered at `now`: taken then, or `latency` seconds before.

        A late sweep carries the time at which it was taken. Until the first one arrives, sweeps are empty.
        """
        scan = self._sweep(state.ownship, now)
        if self._settings.latency <= 0.0:
            return scan
        self._delayed.append(scan)
        due = now - self._settings.latency
        while self._delayed and self._delayed[0].time <= due + 1e-9:
            self._delivered = self._delayed.popleft()
        return self._delivered or RadarScan(now - self._settings.latency, *self._nothing)

    def _sweep(self, own: Ownship, now: float) -> RadarScan:
        truth = self._world.snapshot()
        if truth is self._empty_truth and now < self._empty_until:
            return RadarScan(now, *self._nothing)
        away = truth.positions - (own.north, own.east, own.altitude)
        distances = np.sqrt(np.einsum("ij,ij->i", away, away))
        seen: Bools = distances <= self._settings.range
        if self._settings.field_of_view < 2.0 * math.pi:
            bearings = np.arctan2(away[:, 1], away[:, 0]) - own.heading
            off_nose = np.abs(np.remainder(bearings + math.pi, 2.0 * math.pi) - math.pi)
            seen &= off_nose <= 0.5 * self._settings.field_of_view
        if self._faulty:
            return self._with_faults(own, now, (truth.ids, truth.positions, truth.radii), seen)
        if not seen.any():
            self._empty_truth = truth
            gap = float(distances.min(initial=math.inf)) - self._settings.range
            self._empty_until = now + max(gap, 0.0) / FASTEST
            return RadarScan(now, *self._nothing)
        return _read_only(now, truth.ids[seen], truth.positions[seen], truth.radii[seen])

    def _with_faults(
        self, own: Ownship, now: float, truth: tuple[Ints, Floats, Floats], seen: Bools
    ) -> RadarScan:
        settings = self._settings
        if settings.detection_probability < 1.0:
            seen = seen & (self._rng.random(seen.size) < settings.detection_probability)
        ids, positions, radii = truth[0][seen], truth[1][seen], truth[2][seen]
        if settings.range_noise > 0.0 or settings.bearing_noise > 0.0:
            north, east = positions[:, 0] - own.north, positions[:, 1] - own.east
            ranges = np.hypot(north, east) + settings.range_noise * self._rng.standard_normal(ids.size)
            bearings = np.arctan2(east, north) + settings.bearing_noise * self._rng.standard_normal(ids.size)
            ranges = np.maximum(ranges, 0.0)
            positions[:, 0] = own.north + ranges * np.cos(bearings)
            positions[:, 1] = own.east + ranges * np.sin(bearings)
        extra = int(self._rng.poisson(settings.false_tracks)) if settings.false_tracks > 0.0 else 0
        if extra:
            false = self._false_positions(own, extra)
            ids = np.concatenate((ids, np.arange(self._false_ids, self._false_ids + extra, dtype=np.int64)))
            positions = np.concatenate((positions, false))
            radii = np.concatenate((radii, np.full(extra, math.nan)))
            self._false_ids += extra
        return _read_only(now, ids, positions, radii)

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


def _read_only(now: float, ids: Ints, positions: Floats, radii: Floats) -> RadarScan:
    for values in (ids, positions, radii):
        values.flags.writeable = False
    return RadarScan(now, ids, positions, radii)


def _empty() -> tuple[Ints, Floats, Floats]:
    scan = _read_only(0.0, np.empty(0, dtype=np.int64), np.empty((0, 3)), np.empty(0))
    return scan.ids, scan.positions, scan.radii
