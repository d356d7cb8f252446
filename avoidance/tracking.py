"""From radar scans to tracks: what is known, where it is, and whether it moves (Algorithm 2)."""

from __future__ import annotations

import math

import numpy as np

from avoidance import filters
from avoidance.current_scan import CurrentScan
from avoidance.parameters import Parameters
from avoidance.picture import Picture
from avoidance.types import Bools, Floats, Ints, Ownship, RadarScan

FLOOR = 0.2
"""Smallest standard deviation believed of a measured position [m]."""
GATE = 5.0
"""A contact belongs to a track within this many standard deviations ..."""
GATE_FLOOR = 30.0
"""... or this many metres."""
HINT = 0.2
"""The radar's identity counts as much as this part of the gate."""
SURE = 0.6
"""Within this part of the gate the track of the same identity is taken without a look at others."""
CONFIRMING_HITS = 2
"""A track is believed from this many sightings on."""
LASTING_HITS = 6
"""A track seen less often dies of being missed twice as often as it was seen ..."""
TENTATIVE_MISSES = 3
"""... but not before so many misses."""
COASTING_TIME = 15.0
"""A moving track dies when it has not been seen for this long [s]."""
RESTING_TIME = 5.0
"""What stands still and has not been seen for this long is expected where it was [s]."""
MOVING_SPEED, STILL_SPEED = 2.0, 1.0
"""Speeds above the first, and significant, move; below the second they stand [m/s]."""
MOVING_SIGMAS, STILL_SIGMAS = 4.0, 2.0
"""The same in standard deviations of the estimated speed."""
CLIMB_RATE = 1.0
"""Climb rates below this, or below four standard deviations, are none [m/s]."""


class Tracker:
    """Contacts in, tracks out.

    Parameters
    ----------
    parameters : Parameters
        Default safety radius, memory, and how accurate the radar is specified to be.

    Notes
    -----
    Nearest-neighbour association inside a gate, with the radar's identity as a hint; the Kalman filters of
    `avoidance.filters`, beside them the running mean for what stands still. Algorithm 2. Differs from the
    paper: E31, its range test misses receding, crossing and same-course traffic; here a track moves when
    its estimated speed is significant. With `memory` off the picture holds the current scan only, and
    Algorithm 2 decides as printed.
    """

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters
        self._printed = None if parameters.memory else CurrentScan()
        self._version = 0
        nothing = np.empty(0)
        self._tracks = filters.begin(
            nothing.astype(np.int64), np.empty((0, 3)), nothing, np.empty((0, 2, 2)), 0.0
        )
        self._last_ids: Ints = np.empty(0, dtype=np.int64)
        self._last_rows: Ints = np.empty(0, dtype=np.int64)
        self._settled = False  # nothing moves and every track lasts
        self._picture: Picture | None = None

    def update(self, scan: RadarScan, own: Ownship) -> Picture:
        """Take one scan and return the picture after it.

        Contacts whose position is not finite are refused; the rest of the scan is used.
        """
        scan = _usable(scan)
        if self._printed is not None:
            return self._printed.update(scan, own)
        tracks = self._tracks
        if self._picture is not None and self._undisturbed(scan):
            tracks.seen[self._last_rows] = tracks.time[self._last_rows] = scan.time
            return self._picture
        rows = self._repeated(scan)
        repeated = rows[rows >= 0]
        tracks.seen[repeated] = tracks.time[repeated] = scan.time
        changed = np.flatnonzero(rows < 0)
        idle = (~tracks.moving) & (scan.time - tracks.seen > RESTING_TIME)
        idle[repeated] = True
        filters.predict(tracks, np.flatnonzero(~idle), scan.time)
        noise = self._noise(scan.positions[changed], own)
        fresh = np.zeros(len(changed), dtype=np.bool_)
        if len(changed):
            rows[changed] = self._associate(scan, changed, noise, repeated)
            fresh = rows[changed] < 0
            self._correct(scan, changed[~fresh], rows, noise[~fresh])
        tracks.misses += 1
        tracks.misses[rows[rows >= 0]] = 0
        if fresh.any():
            new = changed[fresh]
            rows[new] = len(tracks) + np.arange(len(new))
            tracks.extend(
                filters.begin(scan.ids[new], scan.positions[new], scan.radii[new], noise[fresh], scan.time)
            )
        self._classify(rows[changed])
        self._last_ids, self._last_rows = scan.ids, rows
        self._forget(scan.time)
        return self._publish(scan.time)

    def _undisturbed(self, scan: RadarScan) -> bool:
        """True if the scan repeats exactly what is known: the same still obstacles at the same places."""
        rows = self._last_rows
        if not self._settled or len(rows) != len(scan.ids):
            return False
        return not len(rows) or (
            np.array_equal(scan.ids, self._last_ids)
            and np.array_equal(scan.positions, self._tracks.mean[rows])
        )

    def _repeated(self, scan: RadarScan) -> Ints:
        """Row of each contact that is exactly where a still obstacle of its identity stands; else -1."""
        tracks = self._tracks
        rows = np.full(len(scan.ids), -1, dtype=np.int64)
        if not len(scan.ids) or not (tracks.hits >= LASTING_HITS).any():
            return rows
        order = np.argsort(tracks.ids, kind="stable")
        place = np.minimum(np.searchsorted(tracks.ids[order], scan.ids), len(order) - 1)
        hinted = order[place]
        same = (tracks.ids[hinted] == scan.ids) & ~tracks.moving[hinted]
        same &= (tracks.hits[hinted] >= LASTING_HITS) & (tracks.mean[hinted] == scan.positions).all(axis=1)
        rows[same] = hinted[same]
        return rows

    def _noise(self, positions: Floats, own: Ownship) -> Floats:
        """Covariance of each measured position, shape (m, 2, 2) [m²]."""
        p = self._parameters
        north, east = positions[:, 0] - own.north, positions[:, 1] - own.east
        square = np.maximum(north**2 + east**2, 1.0)
        along, across = p.range_sigma**2 / square, np.full(len(positions), p.bearing_sigma**2)
        floor = FLOOR**2 + own.position_error**2
        noise = np.empty((len(positions), 2, 2))
        noise[:, 0, 0] = along * north**2 + across * east**2 + floor
        noise[:, 1, 1] = along * east**2 + across * north**2 + floor
        noise[:, 0, 1] = noise[:, 1, 0] = (along - across) * north * east
        return noise

    def _associate(self, scan: RadarScan, contacts: Ints, noise: Floats, taken: Ints) -> Ints:
        """Row of the track that each of some contacts belongs to, -1 for none; each track at most once."""
        tracks = self._tracks
        rows = np.full(len(contacts), -1, dtype=np.int64)
        if not len(tracks):
            return rows
        free = np.ones(len(tracks), dtype=np.bool_)
        free[taken] = False
        places, ids = scan.positions[contacts], scan.ids[contacts, None]
        measured = noise[:, 0, 0] + noise[:, 1, 1]
        contact, track = np.nonzero(ids == tracks.ids)
        sure = free[track] & (
            self._share_of_gate(places[contact], measured[contact], track, scan.time) < SURE
        )
        contact, track = contact[sure], track[sure]
        lonely = (np.bincount(contact)[contact] == 1) & (np.bincount(track)[track] == 1)
        rows[contact[lonely]] = track[lonely]
        rest = np.flatnonzero(rows < 0)
        if not len(rest):
            return rows
        free[rows[rows >= 0]] = False
        share = self._share_of_gate(places[rest, None], measured[rest, None], slice(None), scan.time)
        score = np.where((share <= 1.0) & free, share - HINT * (ids[rest] == tracks.ids), np.inf)
        while True:
            place, nearest = divmod(int(np.argmin(score)), score.shape[1])
            if not np.isfinite(score[place, nearest]):
                return rows
            rows[rest[place]] = nearest
            score[place, :] = np.inf
            score[:, nearest] = np.inf

    def _share_of_gate(self, places: Floats, measured: Floats, rows: Ints | slice, time: float) -> Floats:
        """How far some places, of variance `measured`, are from some tracks, in parts of their gates."""
        tracks = self._tracks
        resting = ~tracks.moving[rows] & (time - tracks.seen[rows] > RESTING_TIME)
        expected = np.where(resting[:, None], tracks.mean[rows, :2], tracks.state[rows, :2])
        variance = np.where(resting, 1.0 / tracks.weight[rows], filters.position_variance(tracks, rows))
        north, east = places[..., 0] - expected[:, 0], places[..., 1] - expected[:, 1]
        gate = np.maximum(GATE * np.sqrt(variance + measured), GATE_FLOOR)
        return np.asarray(np.sqrt(north**2 + east**2) / gate)

    def _correct(self, scan: RadarScan, contacts: Ints, rows: Ints, noise: Floats) -> None:
        if not len(contacts):
            return
        tracks, mine = self._tracks, rows[contacts]
        late = mine[tracks.time[mine] < scan.time]
        filters.predict(tracks, late, scan.time)
        filters.correct(tracks, mine, scan.positions[contacts], noise, scan.time)
        tracks.ids[mine] = scan.ids[contacts]
        tracks.radius[mine] = np.fmax(tracks.radius[mine], scan.radii[contacts])
        tracks.hits[mine] += 1
        tracks.seen[mine] = scan.time

    def _classify(self, rows: Ints) -> None:
        """Moving or still, by the significance of the estimated speed, with hysteresis; only what is seen."""
        if not len(rows):
            return
        tracks = self._tracks
        speed = np.hypot(tracks.state[rows, 2], tracks.state[rows, 3])
        sigma = filters.speed_sigma(tracks, rows)
        starts = (speed > np.maximum(MOVING_SPEED, MOVING_SIGMAS * sigma)) & (tracks.hits[rows] >= 2)
        stops = (speed < np.maximum(STILL_SPEED, STILL_SIGMAS * sigma)) & (sigma < MOVING_SPEED)
        before = tracks.moving[rows]
        tracks.moving[rows] = np.where(before, ~stops, starts)
        stopped = rows[before & stops]
        tracks.mean[stopped, :2] = tracks.state[stopped, :2]
        tracks.weight[stopped] = 1.0 / np.maximum(tracks.covariance[stopped, 0, 0], FLOOR**2)

    def _forget(self, time: float) -> None:
        tracks = self._tracks
        if not ((tracks.misses >= TENTATIVE_MISSES).any() or tracks.moving.any()):
            return
        fleeting = (tracks.hits < LASTING_HITS) & (
            tracks.misses >= np.maximum(TENTATIVE_MISSES, 2 * tracks.hits)
        )
        lost = tracks.moving & (time - tracks.seen > COASTING_TIME)
        keep = ~(fleeting | lost)
        if keep.all():
            return
        tracks.keep(keep)
        renumbered = np.cumsum(keep) - 1
        self._last_rows = renumbered[self._last_rows]  # what was seen just now is kept

    def _publish(self, time: float) -> Picture:
        tracks, before, moving = self._tracks, self._picture, self._tracks.moving
        confirmed = tracks.hits >= CONFIRMING_HITS
        traffic = bool(moving.any())
        self._settled = not traffic and bool((tracks.hits >= LASTING_HITS).all())
        positions, variance = tracks.mean.copy(), 1.0 / tracks.weight
        velocities, climbs = np.zeros((len(tracks), 2)), np.zeros(len(tracks))
        if traffic:
            positions[moving, :2], positions[moving, 2] = tracks.state[moving, :2], tracks.vertical[moving, 0]
            variance[moving] = filters.position_variance(tracks, moving)
            velocities[moving] = tracks.state[moving, 2:]
            rate, doubt = tracks.vertical[moving, 1], np.sqrt(tracks.vertical_covariance[moving, 1])
            climbs[moving] = np.where(np.abs(rate) > np.maximum(CLIMB_RATE, 4.0 * doubt), rate, 0.0)
        sigma = np.sqrt(variance)
        sigma[sigma <= 2.0 * FLOOR] = 0.0
        if before is not None and _same_still(before, tracks.ids, positions, moving, confirmed):
            positions[~moving] = before.positions[~moving]
        else:
            self._version += 1
        self._picture = Picture(
            ids=tracks.ids.copy(),
            positions=positions,
            velocities=velocities,
            climbs=climbs,
            radii=tracks.radius.copy(),
            sigma=sigma,
            speed_sigma=filters.speed_sigma(tracks),
            ages=time - tracks.steady_since,
            moving=moving.copy(),
            confirmed=confirmed,
            time=time,
            version=self._version,
        )
        return self._picture


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
    still = ~moving
    return bool((np.abs(positions[still, :2] - before.positions[still, :2]) < 1.0).all())
