"""From radar scans to tracks: what is known, where it is, and whether it moves (Algorithms 2 and 3)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from avoidance.parameters import Parameters
from avoidance.types import Bools, Floats, Ints, Ownship, RadarScan

FLOOR = 0.2
"""Smallest standard deviation believed of a measured position [m]."""
FIRST_SPEED = 30.0
"""Standard deviation of the speed of something seen once [m/s]."""
WANDER = 0.01
"""Power density of the accelerations of something that flies straight on [m²/s³]."""
MANOEUVRE = 5.0
"""Acceleration of something that turns [m/s²]."""
SURPRISE = 13.8
"""A normalised innovation squared beyond this (0.1 % of a chi-square of 2 degrees) means a manoeuvre."""
GATE = 5.0
"""A contact belongs to a track within this many standard deviations ..."""
GATE_FLOOR = 30.0
"""... or this many metres."""
CONFIRMING_HITS = 2
"""A track is believed from this many sightings on."""
TENTATIVE_MISSES = 3
"""An unconfirmed track dies after this many scans without a sighting."""
COASTING_TIME = 15.0
"""A moving track dies when it has not been seen for this long [s]."""
RESTING_TIME = 5.0
"""What stands still and has not been seen for this long is expected where it was [s]."""
MOVING_SPEED, STILL_SPEED = 2.0, 1.0
"""Speeds above the first, and significant, move; below the second they stand [m/s]."""
MOVING_SIGMAS, STILL_SIGMAS = 4.0, 2.0
"""The same in standard deviations of the estimated speed."""


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """Everything known of the obstacles after a scan; arrays of one row per track."""

    ids: Ints
    """Identity the radar last gave, shape (n,)."""
    positions: Floats
    """North, east, altitude [m], shape (n, 3)."""
    velocities: Floats
    """North, east over ground [m/s], 0 for what stands still, shape (n, 2)."""
    climbs: Floats
    """Climb rate [m/s], 0 unless significant, shape (n,)."""
    radii: Floats
    """Safety radius RS that the sensor gave [m], NaN where it gave none, shape (n,)."""
    sigma: Floats
    """Standard deviation of the horizontal position [m], shape (n,)."""
    speed_sigma: Floats
    """Standard deviation of the estimated speed, also of what is taken to stand [m/s], shape (n,)."""
    moving: Bools
    """True for what moves, shape (n,)."""
    confirmed: Bools
    """Seen often enough to be believed, shape (n,)."""
    version: int
    """Changes whenever what stands still has changed: a new, lost or shifted obstacle."""

    @property
    def size(self) -> int:
        """How many tracks there are."""
        return len(self.ids)


class Tracker:
    """Contacts in, tracks out.

    Parameters
    ----------
    parameters : Parameters
        Default safety radius, memory, and how accurate the radar is specified to be.

    Notes
    -----
    Nearest-neighbour association inside a gate, with the radar's identity as a hint; a constant-velocity
    Kalman filter per track (Bar-Shalom, Li & Kirubarajan 2001, 6.3) whose covariance is widened when an
    innovation is too large for straight flight; beside it the running mean for what stands still.
    Algorithm 2. Differs from the paper: E31, its range test misses receding, crossing and same-course
    traffic; here a track moves when its estimated speed is significant. With `memory` off the picture holds
    the current scan only, and Algorithm 2 decides as printed.
    """

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters
        self._time = 0.0
        self._version = 0
        self._last_ids: Ints = np.empty(0, dtype=np.int64)
        self._last_rows: Ints = np.empty(0, dtype=np.int64)
        self._last_own: tuple[float, float] | None = None
        self._last_range: dict[int, float] = {}
        self._ids = np.empty(0, dtype=np.int64)
        self._state = np.empty((0, 4))  # Kalman estimate: north, east, and their rates
        self._covariance = np.empty((0, 4, 4))
        self._altitude = np.empty(0)
        self._mean = np.empty((0, 3))  # running mean, for what stands still
        self._weight = np.empty(0)
        self._radius = np.empty(0)
        self._hits = np.empty(0, dtype=np.int64)
        self._misses = np.empty(0, dtype=np.int64)
        self._seen = np.empty(0)
        self._moving = np.empty(0, dtype=np.bool_)
        self._settled = False  # nothing moves and every track is confirmed
        self._picture: Picture | None = None

    def update(self, scan: RadarScan, own: Ownship) -> Picture:
        """Take one scan and return the picture after it.

        Contacts whose position is not finite are refused; the rest of the scan is used.
        """
        scan = _usable(scan)
        if not self._parameters.memory:
            return self._current_scan(scan, own)
        step = scan.time - self._time
        self._time = scan.time
        if self._picture is not None and self._undisturbed(scan):
            if len(scan.ids):
                self._seen[self._last_rows] = scan.time
            return self._picture
        self._predict(step)
        rows = self._associate(scan, own)
        self._correct(scan, rows, own)
        self._classify(rows)
        self._forget(rows)
        return self._publish()

    def _undisturbed(self, scan: RadarScan) -> bool:
        """True if the scan repeats exactly what is known: the same still obstacles at the same places."""
        rows = self._last_rows
        if not self._settled or len(rows) != len(scan.ids):
            return False
        return not len(rows) or (
            np.array_equal(scan.ids, self._last_ids) and np.array_equal(scan.positions, self._mean[rows])
        )

    def _predict(self, step: float) -> None:
        transition = np.eye(4)
        transition[0, 2] = transition[1, 3] = step
        self._state = self._state @ transition.T
        unit = np.array([[step**3 / 3.0, step**2 / 2.0], [step**2 / 2.0, step]])
        noise = WANDER * np.kron(unit, np.eye(2))
        self._covariance = transition @ self._covariance @ transition.T + noise

    def _noise(self, positions: Floats, own: Ownship) -> Floats:
        """Covariance of each measured position, shape (m, 2, 2) [m²]."""
        p = self._parameters
        sight = positions[:, :2] - np.array([own.north, own.east])
        distance = np.maximum(np.hypot(sight[:, 0], sight[:, 1]), 1.0)
        along = sight / distance[:, None]
        across = np.stack([-along[:, 1], along[:, 0]], axis=1)
        cross = (p.bearing_sigma * distance) ** 2
        floor = FLOOR**2 + own.position_error**2
        return np.asarray(
            p.range_sigma**2 * along[:, :, None] * along[:, None, :]
            + cross[:, None, None] * across[:, :, None] * across[:, None, :]
            + floor * np.eye(2)
        )

    def _associate(self, scan: RadarScan, own: Ownship) -> Ints:
        """Row of the track that each contact belongs to; new rows are added for the others."""
        rows = np.full(len(scan.ids), -1, dtype=np.int64)
        if len(self._ids) and len(scan.ids):
            resting = ~self._moving & (self._time - self._seen > RESTING_TIME)
            expected = np.where(resting[:, None], self._mean[:, :2], self._state[:, :2])
            variance = np.maximum(self._covariance[:, 0, 0], self._covariance[:, 1, 1])
            variance = np.where(resting, 1.0 / np.maximum(self._weight, 1e-12), variance)
            offset = scan.positions[:, None, :2] - expected[None, :, :2]
            distance = np.hypot(offset[..., 0], offset[..., 1])
            measured = np.trace(self._noise(scan.positions, own), axis1=1, axis2=2)
            gate = np.maximum(GATE * np.sqrt(variance[None] + measured[:, None]), GATE_FLOOR)
            hinted = scan.ids[:, None] == self._ids[None]
            score = np.where(distance <= gate, distance - np.where(hinted, 1e6, 0.0), np.inf)
            while True:
                best = int(np.argmin(score))
                contact, track = divmod(best, score.shape[1])
                if not np.isfinite(score[contact, track]):
                    break
                rows[contact] = track
                score[contact, :] = np.inf
                score[:, track] = np.inf
        new = np.flatnonzero(rows < 0)
        rows[new] = len(self._ids) + np.arange(len(new))
        self._add(scan, new, own)
        return rows

    def _add(self, scan: RadarScan, new: Ints, own: Ownship) -> None:
        if not len(new):
            return
        count = len(new)
        radii = scan.radii[new]
        self._ids = np.concatenate([self._ids, scan.ids[new]])
        state = np.concatenate([scan.positions[new, :2], np.zeros((count, 2))], axis=1)
        covariance = np.tile(np.diag([0.0, 0.0, FIRST_SPEED**2, FIRST_SPEED**2]), (count, 1, 1))
        covariance[:, :2, :2] = 1e3 * self._noise(scan.positions[new], own)
        self._state = np.concatenate([self._state, state])
        self._covariance = np.concatenate([self._covariance, covariance])
        self._altitude = np.concatenate([self._altitude, scan.positions[new, 2]])
        self._mean = np.concatenate([self._mean, scan.positions[new]])
        self._weight = np.concatenate([self._weight, np.zeros(count)])
        self._radius = np.concatenate([self._radius, radii])
        self._hits = np.concatenate([self._hits, np.zeros(count, dtype=np.int64)])
        self._misses = np.concatenate([self._misses, np.zeros(count, dtype=np.int64)])
        self._seen = np.concatenate([self._seen, np.full(count, scan.time)])
        self._moving = np.concatenate([self._moving, np.zeros(count, dtype=np.bool_)])

    def _correct(self, scan: RadarScan, rows: Ints, own: Ownship) -> None:
        noise = self._noise(scan.positions, own)
        innovation = scan.positions[:, :2] - self._state[rows, :2]
        covariance = self._covariance[rows]
        inverse = np.linalg.inv(covariance[:, :2, :2] + noise)
        surprise = np.einsum("mi,mij,mj->m", innovation, inverse, innovation)
        turning = (surprise > SURPRISE) & self._moving[rows]
        if turning.any():
            covariance[turning] += np.diag([1.0, 1.0, 4.0, 4.0]) * (0.5 * MANOEUVRE) ** 2
            inverse = np.linalg.inv(covariance[:, :2, :2] + noise)
        gain = covariance[:, :, :2] @ inverse
        self._state[rows] += np.einsum("mij,mj->mi", gain, innovation)
        self._covariance[rows] = covariance - gain @ covariance[:, :2, :]
        self._altitude[rows] = scan.positions[:, 2]
        variance = np.maximum(noise[:, 0, 0], noise[:, 1, 1])
        self._weight[rows] += 1.0 / variance
        shift = scan.positions - self._mean[rows]
        self._mean[rows] += shift / (variance * self._weight[rows])[:, None]
        self._ids[rows] = scan.ids
        known = ~np.isnan(scan.radii)
        self._radius[rows[known]] = np.fmax(self._radius[rows[known]], scan.radii[known])
        self._hits[rows] += 1
        self._misses += 1
        self._misses[rows] = 0
        self._seen[rows] = scan.time
        self._last_ids, self._last_rows = scan.ids, rows

    def _classify(self, rows: Ints) -> None:
        """Moving or still, by the significance of the estimated speed, with hysteresis; only what is seen."""
        speed = np.hypot(self._state[:, 2], self._state[:, 3])
        sigma = self._speed_sigma()
        starts = (speed > np.maximum(MOVING_SPEED, MOVING_SIGMAS * sigma)) & (self._hits >= 2)
        stops = speed < np.maximum(STILL_SPEED, STILL_SIGMAS * sigma)
        moving = self._moving.copy()
        moving[rows] = np.where(self._moving, ~stops, starts)[rows]
        stopped = self._moving & ~moving
        self._mean[stopped, :2] = self._state[stopped, :2]
        self._weight[stopped] = 1.0 / np.maximum(self._covariance[stopped, 0, 0], FLOOR**2)
        self._moving = moving

    def _speed_sigma(self) -> Floats:
        return np.sqrt(np.maximum(self._covariance[:, 2, 2], self._covariance[:, 3, 3]))

    def _forget(self, rows: Ints) -> None:
        tentative = (self._hits < CONFIRMING_HITS) & (self._misses >= TENTATIVE_MISSES)
        lost = self._moving & (self._time - self._seen > COASTING_TIME)
        keep = ~(tentative | lost)
        if keep.all():
            return
        for name in ("ids", "state", "covariance", "altitude", "mean", "weight", "radius"):
            setattr(self, f"_{name}", getattr(self, f"_{name}")[keep])
        for name in ("hits", "misses", "seen", "moving"):
            setattr(self, f"_{name}", getattr(self, f"_{name}")[keep])
        renumbered = np.cumsum(keep) - 1
        self._last_rows = np.where(keep[rows], renumbered[rows], -1)

    def _publish(self) -> Picture:
        before = self._picture
        moving = self._moving
        self._settled = not moving.any() and bool((self._hits >= CONFIRMING_HITS).all())
        tracked = np.column_stack([self._state[:, :2], self._altitude])
        positions = np.where(moving[:, None], tracked, self._mean)
        confirmed = self._hits >= CONFIRMING_HITS
        variance = np.maximum(self._covariance[:, 0, 0], self._covariance[:, 1, 1])
        sigma = np.sqrt(np.where(moving, variance, 1.0 / np.maximum(self._weight, 1e-12)))
        sigma = np.where(sigma <= 2.0 * FLOOR, 0.0, sigma)
        if before is not None and _same_still(before, self._ids, positions, moving, confirmed):
            positions = np.where(moving[:, None], positions, before.positions)
        else:
            self._version += 1
        self._picture = Picture(
            ids=self._ids.copy(),
            positions=positions,
            velocities=np.where(moving[:, None], self._state[:, 2:], 0.0),
            climbs=np.zeros(len(moving)),
            radii=self._radius.copy(),
            sigma=sigma,
            speed_sigma=self._speed_sigma(),
            moving=moving.copy(),
            confirmed=confirmed,
            version=self._version,
        )
        return self._picture

    def _current_scan(self, scan: RadarScan, own: Ownship) -> Picture:
        """The picture of the current scan alone, moving decided by Algorithm 2 as printed."""
        distance = np.hypot(scan.positions[:, 0] - own.north, scan.positions[:, 1] - own.east)
        last = self._last_own
        travelled = 0.0 if last is None else float(np.hypot(own.north - last[0], own.east - last[1]))
        keys = scan.ids.tolist()
        before = np.array([self._last_range.get(key, np.nan) for key in keys], dtype=np.float64)
        change = np.abs(distance - before)
        moving = np.where(np.isnan(before), False, change > 1.02 * travelled + 0.5)
        self._last_own = (own.north, own.east)
        self._last_range = dict(zip(keys, distance.tolist(), strict=True))
        shown = self._picture
        if shown is None or not (
            np.array_equal(shown.ids, scan.ids)
            and np.array_equal(shown.positions, scan.positions)
            and np.array_equal(shown.moving, moving)
        ):
            self._version += 1
        count = len(keys)
        self._picture = Picture(
            ids=scan.ids,
            positions=scan.positions,
            velocities=np.zeros((count, 2)),
            climbs=np.zeros(count),
            radii=scan.radii,
            sigma=np.zeros(count),
            speed_sigma=np.zeros(count),
            moving=moving.astype(np.bool_),
            confirmed=np.ones(count, dtype=np.bool_),
            version=self._version,
        )
        return self._picture


def clusters(positions: Floats, radii: Floats, link_distance: float, join_spheres: bool) -> Ints:
    """Group obstacles that belong together: hills.

    Parameters
    ----------
    positions : array, shape (n, 2)
        Obstacles [m].
    radii : array, shape (n,)
        What must be kept from each [m].
    link_distance : float
        Two obstacles nearer than this are one hill [m].
    join_spheres : bool
        Also join two whose circles overlap, since nothing can pass between them.

    Returns
    -------
    array, shape (n,)
        Label of the group that each belongs to.

    Notes
    -----
    Algorithm 3, single linkage. Differs from the paper: E36, spheres of 1 km leave no gap although their
    centres are 1 to 2 km apart; with `join_spheres` what cannot be passed is treated as one.
    """
    count = len(positions)
    if count == 0:
        return np.empty(0, dtype=np.int64)
    offset = positions[:, None] - positions[None]
    distance = np.hypot(offset[..., 0], offset[..., 1])
    linked = distance < link_distance
    if join_spheres:
        linked |= distance < radii[:, None] + radii[None]
    np.fill_diagonal(linked, val=True)
    labels = np.arange(count)
    while True:  # each obstacle takes the least label among its neighbours until nothing changes
        least = np.where(linked, labels[None], count).min(axis=1)
        least = least[least]
        if np.array_equal(least, labels):
            return np.asarray(labels, dtype=np.int64)
        labels = least


def _usable(scan: RadarScan) -> RadarScan:
    """The contacts of a scan whose position is finite."""
    if not len(scan.ids) or math.isfinite(float(scan.positions.sum())):
        return scan
    good = np.isfinite(scan.positions).all(axis=1)
    return RadarScan(scan.time, scan.ids[good], scan.positions[good], scan.radii[good])


def _same_still(before: Picture, ids: Ints, positions: Floats, moving: Bools, confirmed: Bools) -> bool:
    """True if what stands still is where it was, within a metre."""
    if len(before.ids) != len(ids) or not np.array_equal(before.moving, moving):
        return False
    if not np.array_equal(before.confirmed, confirmed):
        return False
    shift = np.abs(positions[:, :2] - before.positions[:, :2]).max(axis=1, initial=0.0)
    return bool((shift[~moving] < 1.0).all())
