"""Kalman filters for many tracks at once: constant velocity in the plane, constant climb rate in height.

Bar-Shalom, Li & Kirubarajan (2001), 6.3: white accelerations of a given power density.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from avoidance.types import Bools, Floats, Ints

FIRST_SPEED = 30.0
"""Standard deviation of the speed of something seen once [m/s]."""
FIRST_CLIMB = 5.0
"""Standard deviation of the climb rate of something seen once [m/s]."""
WANDER = 0.0005
"""Power density of the accelerations of something that flies straight on [m²/s³]."""
WANDER_UP = 0.01
"""The same in height: aircraft hunt about their altitude [m²/s³]."""
ALTITUDE_SIGMA = 1.0
"""Standard deviation of a measured altitude [m]."""
TURNED = 12.0
"""Standard deviation that a manoeuvre adds to each component of the velocity [m/s]."""
SURPRISE = 13.8
"""A normalised innovation squared beyond this (0.1 % of a chi-square of 2 degrees) means a manoeuvre."""


@dataclass(slots=True, eq=False)
class Tracks:
    """The state of all tracks; arrays of one row each."""

    ids: Ints
    """Identity the radar last gave, shape (n,)."""
    state: Floats
    """North, east, and their rates [m, m/s], shape (n, 4)."""
    covariance: Floats
    """Of the state, shape (n, 4, 4)."""
    vertical: Floats
    """Altitude and climb rate [m, m/s], shape (n, 2)."""
    vertical_covariance: Floats
    """Variances of both and their covariance, shape (n, 3)."""
    mean: Floats
    """Running mean of the measured positions, for what stands still [m], shape (n, 3)."""
    weight: Floats
    """Sum of the weights of that mean, 1/variance [1/m²], shape (n,)."""
    radius: Floats
    """Safety radius that the sensor gave [m], NaN if none, shape (n,)."""
    hits: Ints
    """Sightings, shape (n,)."""
    misses: Ints
    """Scans without one since the last, shape (n,)."""
    time: Floats
    """Time of the state [s], shape (n,)."""
    seen: Floats
    """Time of the last sighting [s], shape (n,)."""
    steady_since: Floats
    """Time since which it has flown straight on, or been known [s], shape (n,)."""
    moving: Bools
    """True for what moves, shape (n,)."""

    def __len__(self) -> int:
        return len(self.ids)

    def extend(self, more: Tracks) -> None:
        """Append other tracks."""
        for column in fields(self):
            joined = np.concatenate([getattr(self, column.name), getattr(more, column.name)])
            setattr(self, column.name, joined)

    def keep(self, chosen: Bools) -> None:
        """Forget the others."""
        for column in fields(self):
            setattr(self, column.name, getattr(self, column.name)[chosen])


def begin(ids: Ints, positions: Floats, radii: Floats, noise: Floats, time: float) -> Tracks:
    """Tracks of what is seen for the first time.

    Parameters
    ----------
    ids, positions, radii
        Of the contacts: shapes (m,), (m, 3) and (m,).
    noise : array, shape (m, 2, 2)
        Covariance of each measured position [m²].
    time : float
        Of the scan [s].
    """
    count = len(ids)
    state, covariance = np.zeros((count, 4)), np.zeros((count, 4, 4))
    state[:, :2] = positions[:, :2]
    covariance[:, :2, :2] = noise
    covariance[:, 2, 2] = covariance[:, 3, 3] = FIRST_SPEED**2
    vertical, vertical_covariance = np.zeros((count, 2)), np.zeros((count, 3))
    vertical[:, 0] = positions[:, 2]
    vertical_covariance[:] = ALTITUDE_SIGMA**2, FIRST_CLIMB**2, 0.0
    return Tracks(
        ids=ids.copy(),
        state=state,
        covariance=covariance,
        vertical=vertical,
        vertical_covariance=vertical_covariance,
        mean=positions.copy(),
        weight=1.0 / np.maximum(noise[:, 0, 0], noise[:, 1, 1]),
        radius=radii.copy(),
        hits=np.ones(count, dtype=np.int64),
        misses=np.zeros(count, dtype=np.int64),
        time=np.full(count, time),
        seen=np.full(count, time),
        steady_since=np.full(count, time),
        moving=np.zeros(count, dtype=np.bool_),
    )


def predict(tracks: Tracks, rows: Ints, time: float) -> None:
    """Extrapolate the tracks `rows` to a time [s]."""
    if not len(rows):
        return
    chosen = _rows(tracks, rows)
    step = time - tracks.time[chosen]
    long = step[:, None, None]
    state, covariance = tracks.state[chosen], tracks.covariance[chosen]
    state[:, :2] += step[:, None] * state[:, 2:]
    covariance[:, :2] += long * covariance[:, 2:]
    covariance[:, :, :2] += long * covariance[:, :, 2:]
    square, cube = step**2, step**3
    both, place, speed = WANDER * square / 2.0, WANDER * cube / 3.0, WANDER * step
    for axis in (0, 1):
        covariance[:, axis, axis] += place
        covariance[:, axis, axis + 2] += both
        covariance[:, axis + 2, axis] += both
        covariance[:, axis + 2, axis + 2] += speed
    tracks.state[chosen], tracks.covariance[chosen] = state, covariance
    vertical, up = tracks.vertical[chosen], tracks.vertical_covariance[chosen]
    vertical[:, 0] += step * vertical[:, 1]
    up[:, 0] += 2.0 * step * up[:, 2] + square * up[:, 1] + WANDER_UP * cube / 3.0
    up[:, 2] += step * up[:, 1] + WANDER_UP * square / 2.0
    up[:, 1] += WANDER_UP * step
    tracks.vertical[chosen], tracks.vertical_covariance[chosen] = vertical, up
    tracks.time[chosen] = time


def correct(tracks: Tracks, rows: Ints, positions: Floats, noise: Floats, time: float) -> None:
    """Take measured positions, shape (m, 3), of the tracks `rows`, shape (m,); `noise` as of `begin`.

    Notes
    -----
    An innovation too large for straight flight widens the covariance first: a manoeuvre.
    """
    chosen = _rows(tracks, rows)
    innovation = positions[:, :2] - tracks.state[chosen, :2]
    covariance = tracks.covariance[chosen]
    inverse = _inverse(covariance[:, :2, :2] + noise)
    surprise = (innovation[:, None] @ inverse @ innovation[:, :, None])[:, 0, 0]
    turning = (surprise > SURPRISE) & tracks.moving[chosen]
    if turning.any():
        covariance[turning, :2, :2] += noise[turning]  # it has left the old course some time ago
        covariance[turning, 2, 2] += TURNED**2
        covariance[turning, 3, 3] += TURNED**2
        inverse = _inverse(covariance[:, :2, :2] + noise)
        tracks.steady_since[rows[turning]] = time
    gain = covariance[:, :, :2] @ inverse
    tracks.state[chosen] += (gain @ innovation[:, :, None])[:, :, 0]
    tracks.covariance[chosen] = covariance - gain @ covariance[:, :2, :]
    _correct_height(tracks, chosen, positions[:, 2])
    variance = np.maximum(noise[:, 0, 0], noise[:, 1, 1])
    tracks.weight[chosen] += 1.0 / variance
    shift = positions - tracks.mean[chosen]
    tracks.mean[chosen] += shift / (variance * tracks.weight[chosen])[:, None]


def _rows(tracks: Tracks, rows: Ints) -> Ints | slice:
    """Some rows; a slice where they are all there are, in order, for that is worked on in place."""
    whole = len(rows) == len(tracks) and bool((rows[1:] > rows[:-1]).all())
    return slice(None) if whole else rows


def _correct_height(tracks: Tracks, rows: Ints | slice, altitudes: Floats) -> None:
    up = tracks.vertical_covariance[rows]
    total = up[:, 0] + ALTITUDE_SIGMA**2
    first, second = up[:, 0] / total, up[:, 2] / total
    innovation = altitudes - tracks.vertical[rows, 0]
    tracks.vertical[rows, 0] += first * innovation
    tracks.vertical[rows, 1] += second * innovation
    left = 1.0 - first
    up[:, 1] -= second * up[:, 2]
    up[:, 0] *= left
    up[:, 2] *= left
    tracks.vertical_covariance[rows] = up


def speed_sigma(tracks: Tracks, rows: Ints | slice = slice(None)) -> Floats:
    """Standard deviation of the speed of each track, or of some, shape (n,) [m/s]."""
    return np.sqrt(np.maximum(tracks.covariance[rows, 2, 2], tracks.covariance[rows, 3, 3]))


def position_variance(tracks: Tracks, rows: Ints | Bools | slice = slice(None)) -> Floats:
    """Variance of the position of each track, or of some, the larger of both axes, shape (n,) [m²]."""
    return np.maximum(tracks.covariance[rows, 0, 0], tracks.covariance[rows, 1, 1])


def _inverse(matrices: Floats) -> Floats:
    """Inverses of symmetric matrices, shape (m, 2, 2)."""
    a, b, d = matrices[:, 0, 0], matrices[:, 0, 1], matrices[:, 1, 1]
    scale = 1.0 / (a * d - b * b)
    inverse = np.empty_like(matrices)
    inverse[:, 0, 0], inverse[:, 1, 1] = d * scale, a * scale
    inverse[:, 0, 1] = inverse[:, 1, 0] = -b * scale
    return inverse
