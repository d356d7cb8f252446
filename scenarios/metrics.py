"""What a flight was worth: separation, violations, lengths. From tracks alone; knows no planner."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from avoidance.types import Floats
from scenarios.scenario import Obstacle
from scenarios.track import MovingTrack, Track


@dataclass(frozen=True, slots=True)
class Separation:
    """How near one flight came to one obstacle."""

    id: int
    """The obstacle."""
    distance: float
    """Least distance between the continuous track and its centre, in three dimensions [m]."""
    time: float
    """When that was [s]."""
    radius: float
    """Its violation radius [m]."""
    entries: int
    """How often its sphere was entered."""
    moving: bool = False
    """True for traffic."""

    @property
    def margin(self) -> float:
        """Distance less violation radius [m]; negative inside the sphere."""
        return self.distance - self.radius


def separations(
    track: Track, obstacles: Sequence[Obstacle], traffic: Sequence[MovingTrack] = ()
) -> list[Separation]:
    """Least distance to, and entries into, every sphere.

    Parameters
    ----------
    track : Track
        The flight; between two samples it is a straight line at constant speed.
    obstacles : sequence of Obstacle
        What stands still; each counts from the time it appears.
    traffic : sequence of MovingTrack
        What moves, at the times of the track.

    Returns
    -------
    list of Separation
        In the order given; those that never existed during the flight are left out.

    Notes
    -----
    Closed form on every segment: the least distance of a point from a line segment, of the relative motion
    where the obstacle moves. Nothing is sampled.
    """
    found = []
    blocks = _Blocks(track.positions)
    for obstacle in obstacles:
        part = _from_time(track, obstacle.appears_at)
        if part is None:
            continue
        times, positions = part
        pieces = blocks if positions is track.positions else _Blocks(positions)
        found.append(_from_still(obstacle, times, positions, pieces))
    for mover in traffic:
        relative = track.positions - mover.positions
        if np.isfinite(relative[:, 0]).any():
            found.append(_separation(mover.id, mover.radius, track.times, relative, moving=True))
    return found


def path_length(positions: Floats) -> float:
    """Horizontal length of a polyline, shape (m, 2 or 3) [m]."""
    steps = np.diff(positions[:, :2], axis=0)
    return float(np.hypot(steps[:, 0], steps[:, 1]).sum())


def first_pass(
    track: Track, point: tuple[float, float], radius: float, after: float = -math.inf
) -> float | None:
    """First time at or after `after` [s] when the track is within `radius` [m] of a point, seen from above.

    None if it never is. The time is that of the nearest point on the first segment that comes near enough.
    """
    part = _from_time(track, after)
    if part is None:
        return None
    times, positions = part
    distances, fractions = _segment_minima(positions[:, :2] - np.asarray(point))
    near = np.flatnonzero(distances <= radius)
    if not near.size:
        return None
    first = int(near[0])
    after_it = min(first + 1, len(times) - 1)
    return float(times[first] + fractions[first] * (times[after_it] - times[first]))


def nearest_pass(track: Track, point: tuple[float, float]) -> float:
    """Least horizontal distance of the continuous track from a point [m]."""
    distances, _ = _segment_minima(track.positions[:, :2] - np.asarray(point))
    return float(distances.min())


class _Blocks:
    """A track in pieces with a sphere about each, so that those far from an obstacle need no look."""

    LENGTH = 128

    def __init__(self, positions: Floats) -> None:
        last = max(len(positions) - 1, 1)
        self.begins = np.arange(0, last, self.LENGTH)
        self.ends = np.minimum(self.begins + self.LENGTH, len(positions) - 1)  # shared with the next piece
        self.centres = 0.5 * (positions[self.begins] + positions[self.ends])
        apart = positions - np.repeat(self.centres, np.diff(np.append(self.begins, len(positions))), axis=0)
        distances = np.sqrt(np.einsum("ij,ij->i", apart, apart))
        shared = positions[self.ends] - self.centres
        self.radii = np.maximum(
            np.maximum.reduceat(distances, self.begins), np.sqrt(np.einsum("ij,ij->i", shared, shared))
        )

    def worth_a_look(self, centre: Floats, radius: float) -> list[tuple[int, int]]:
        """First and last sample of each run of pieces that may be nearest, or inside a sphere."""
        away = self.centres - centre
        distances = np.sqrt(np.einsum("ij,ij->i", away, away))
        limit = max(float((distances + self.radii).min()), radius)
        kept = np.concatenate(([False], distances - self.radii <= limit, [False]))
        firsts = np.flatnonzero(kept[1:] & ~kept[:-1])
        lasts = np.flatnonzero(~kept[1:] & kept[:-1]) - 1
        return [(int(self.begins[a]), int(self.ends[b])) for a, b in zip(firsts, lasts, strict=True)]


def _from_still(obstacle: Obstacle, times: Floats, positions: Floats, blocks: _Blocks) -> Separation:
    """Separation from something that stands still: what is left out is outside its sphere and further."""
    centre = np.array([obstacle.north, obstacle.east, obstacle.altitude])
    radius = obstacle.safety_radius
    runs = [
        _separation(obstacle.id, radius, times[a : b + 1], positions[a : b + 1] - centre, moving=False)
        for a, b in blocks.worth_a_look(centre, radius)
    ]
    nearest = min(runs, key=lambda one: one.distance)
    return replace(nearest, entries=sum(one.entries for one in runs))


def _separation(identity: int, radius: float, times: Floats, relative: Floats, *, moving: bool) -> Separation:
    """From the obstacle-relative positions, shape (m, 3); rows of NaN are times without obstacle."""
    if len(relative) == 1:
        relative, times = np.repeat(relative, 2, axis=0), np.repeat(times, 2)
    distances, fractions = _segment_minima(relative)
    at_samples = np.sqrt(np.einsum("ij,ij->i", relative, relative))
    best = int(np.nanargmin(distances)) if np.isfinite(distances).any() else -1
    if best < 0:  # existed for a single sample
        sample = int(np.nanargmin(at_samples))
        least, when = float(at_samples[sample]), float(times[sample])
        return Separation(identity, least, when, radius, int(least < radius), moving)
    when = float(times[best] + fractions[best] * (times[best + 1] - times[best]))
    inside = at_samples < radius
    begins = np.isfinite(at_samples) & np.concatenate(([True], np.isnan(at_samples[:-1])))
    entries = int((begins & inside).sum()) + int(((distances < radius) & ~inside[:-1]).sum())
    return Separation(identity, float(distances[best]), when, radius, entries, moving)


def _segment_minima(relative: Floats) -> tuple[Floats, Floats]:
    """Least distance of the origin from each segment [m], and where on it (0 start, 1 end), shape (m-1,).

    A single point is a segment without length.
    """
    if len(relative) == 1:
        relative = np.repeat(relative, 2, axis=0)
    starts = relative[:-1]
    steps = np.diff(relative, axis=0)
    squares = np.einsum("ij,ij->i", steps, steps)
    along = -np.einsum("ij,ij->i", starts, steps)
    with np.errstate(invalid="ignore", divide="ignore"):
        fractions = np.clip(np.where(squares > 0.0, along / squares, 0.0), 0.0, 1.0)
    nearest = starts + fractions[:, None] * steps
    return np.sqrt(np.einsum("ij,ij->i", nearest, nearest)), fractions


def _from_time(track: Track, time: float) -> tuple[Floats, Floats] | None:
    """Times and positions from `time` on, beginning exactly there; None if the track ends before."""
    if time <= track.times[0]:
        return track.times, track.positions
    if time > track.times[-1]:
        return None
    first = int(np.searchsorted(track.times, time))
    begin = [np.interp(time, track.times, column) for column in track.positions.T]
    times = np.concatenate(([time], track.times[first:]))
    return times, np.concatenate(([begin], track.positions[first:]))
