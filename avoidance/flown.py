"""The curve that will really be flown along a route, enclosed by straight segments.

A vehicle that follows legs leaves them at every corner: it turns before the waypoint (acceptance radius),
needs room for the turn, and captures the next leg some distance later. The curve stays inside the hull of
the segments returned here, widened by `extra`; testing these segments against discs therefore tests the
flight, continuously and in closed form.
"""

from __future__ import annotations

import math

import numpy as np

from avoidance.types import Complexes, Floats, Performance

EITHER_SIDE = math.radians(10.0)
"""Within this of a reversal a turn may go either way [rad]."""
STRAIGHT = 1e-3
"""A change of course that is none [rad]."""
SEQUENCING_DELAY = 1.0
"""A vehicle notices that it has reached a waypoint within this time [s]."""


def flown_segments(
    points: Floats, course: float | None, performance: Performance, *, begun: bool = False
) -> tuple[Floats, Floats, Floats]:
    """Segments whose hull contains the flown curve of each polyline.

    Parameters
    ----------
    points : array, shape (n, k, 2)
        n polylines of k >= 2 points, north and east [m]; the first is where the vehicle is (or where the
        first leg begins).
    course : float or None
        Direction of travel at the first point [rad]; None if the vehicle comes along the first leg.
    performance : Performance
        Turn radius, roll time, acceptance radius and capture distance.
    begun : bool
        True for what is being flown already: the first turn begins at once.

    Returns
    -------
    starts, ends : array, shape (n, m, 2)
        End points of the segments [m].
    extra : array, shape (n, m)
        How far the curve may leave each segment beyond the tracking error [m].

    Notes
    -----
    At a corner of up to 90 degrees the vehicle turns inside the triangle of entry point, waypoint and exit
    point, so the chord is added to the two legs; if it reaches the waypoint too late for that, it overshoots
    the new leg and comes back to it from outside. At a sharper one it flies the turning circle beside the
    end of the incoming leg, and from there to the exit point. After a change of target the turn begins
    where the vehicle is: it runs on by R tan(dchi/2) plus the roll distance and joins the leg from outside.
    Corners nearer to one another than the vehicle turns before them are passed at once, in one turn.
    """
    starts, ends, extra = flown_lines(as_complex(points), course, performance, begun=begun)
    return as_pairs(starts), as_pairs(ends), extra


def flown_lines(
    corners: Complexes, course: float | None, performance: Performance, *, begun: bool = False
) -> tuple[Complexes, Complexes, Floats]:
    """As `flown_segments`, of corners of shape (n, k) as complex numbers, with ends of shape (n, m) [m]."""
    legs = corners[:, 1:] - corners[:, :-1]
    lengths = np.abs(legs)
    units = legs / np.maximum(lengths, 1e-9)
    count, many = lengths.shape
    bends = slice(many, 2 * many - 1), slice(2 * many - 1, 3 * many - 2)
    shape = (count, 3 * many - 2 + (0 if course is None else 2))
    starts, ends = np.empty(shape, dtype=np.complex128), np.empty(shape, dtype=np.complex128)
    extra = np.zeros(shape)
    starts[:, :many], ends[:, :many] = corners[:, :-1], corners[:, 1:]
    if many > 1:
        bend, before, after = corners[:, 1:-1], units[:, :-1], units[:, 1:]
        run = early_turn(performance)
        product = np.conj(before) * after
        entry, ahead, turned = bend - np.minimum(run, lengths[:, :-1]) * before, before, product
        if many > 2 and (lengths[:, 1:-1] < run).any():
            entry, ahead = _far_entries(corners, units, lengths, run, entry)
            turned = np.conj(ahead) * after
        starts[:, bends[0]], extra[:, bends[0]] = _turn(entry, ahead, turned, performance)
        capture = np.minimum(performance.capture_distance, lengths[:, 1:])
        ends[:, bends[0]] = ends[:, bends[1]] = bend + capture * after
        starts[:, bends[1]], extra[:, bends[1]] = _overshoot(bend, before, product, capture, performance)
    if course is not None:
        delay = 0.0 if begun else max(SEQUENCING_DELAY, performance.edit_time) * performance.airspeed
        first = _first_turn(corners[:, 0], units[:, 0], lengths[:, 0], course, delay, performance)
        starts[:, -2], ends[:, -2] = corners[:, 0], first[0]
        starts[:, -1], ends[:, -1], extra[:, -1] = first[1:]
    return starts, ends, extra


def _far_entries(
    corners: Complexes, units: Complexes, lengths: Floats, run: float, entry: Complexes
) -> tuple[Complexes, Complexes]:
    """Where turns begin that pass several corners at once, and on what course, both of shape (n, k - 2).

    `entry` is where they begin if the leg before is long enough.
    """
    along = np.zeros((len(corners), lengths.shape[1] + 1))
    np.cumsum(lengths, axis=1, out=along[:, 1:])
    at = np.maximum(along[:, 1:-1] - run, 0.0)
    leg = (at[:, :, None] >= along[:, None, 1:-1]).sum(axis=2)
    row = np.arange(len(corners))[:, None]
    far = corners[row, leg] + (at - along[row, leg]) * units[row, leg]
    short = lengths[:, :-1] < run
    return np.where(short, far, entry), np.where(short, units[row, leg], units[:, :-1])


def early_turn(performance: Performance) -> float:
    """How far before a corner the vehicle may turn [m]; several corners within that are passed at once."""
    return performance.acceptance_radius + SEQUENCING_DELAY * performance.airspeed


def late_turn(turn: Floats, performance: Performance) -> Floats:
    """How far behind a waypoint the new leg's course is taken, for the latest turn there may be [m].

    Parameters
    ----------
    turn : array
        Change of course at the waypoint, up to 90 degrees [rad].
    performance : Performance
        Acceptance radius, turn radius and roll time.

    Returns
    -------
    array
        Where the tangents at both ends of the turn meet, beyond the waypoint along the old leg; 0 if before.
    """
    return _late(turn, performance.turn_radius * np.tan(0.5 * turn), performance)


def _late(turn: Floats, lead: Floats, performance: Performance) -> Floats:
    """As `late_turn`, of turns that begin `lead` before their tangents meet [m]."""
    return np.asarray(np.where(turn > STRAIGHT, np.maximum(_latest_begin(performance) + lead, 0.0), 0.0))


def _latest_begin(performance: Performance) -> float:
    """How far behind a waypoint a turn begins at the latest, negative before it [m]."""
    speed = performance.airspeed + performance.wind_bound
    return speed * (SEQUENCING_DELAY + 0.5 * performance.roll_time) - performance.acceptance_radius


def _overshoot(
    corners: Complexes, before: Complexes, product: Complexes, capture: Floats, performance: Performance
) -> tuple[Complexes, Floats | float]:
    """Where the tangents of the latest turn at each corner meet, and the room about the way back to the leg.

    The turn touches the line from there that is parallel to the new leg, and at most so far along it as it
    is wide; then the vehicle is led back to the leg.
    """
    if _latest_begin(performance) + performance.turn_radius <= 0.0:
        return corners, 0.0  # not even a turn of 90 degrees is late
    turn = np.abs(np.arctan2(product.imag, product.real))
    turn = np.where(turn <= 0.5 * math.pi, turn, 0.0)  # sharper corners have a room of their own
    lead = performance.turn_radius * np.tan(0.5 * turn)
    late = _late(turn, lead, performance)
    aside = late * np.sin(turn)
    return corners + late * before, np.minimum(lead * aside / np.maximum(capture, 1.0), aside)


def as_complex(points: Floats) -> Complexes:
    """Points of shape (..., 2) as north + i east, shape (...).

    The dot and the cross product of a and b are the real and the imaginary part of conj(a) b.
    """
    return np.ascontiguousarray(points).view(np.complex128)[..., 0]


def as_pairs(values: Complexes) -> Floats:
    """The reverse of `as_complex`."""
    return np.ascontiguousarray(values)[..., None].view(np.float64)


def turn_angle(before: Complexes | complex, after: Complexes) -> Floats:
    """Unsigned angle between directions of any length, same shape [rad]; 0 where one has none."""
    product = np.conj(before) * after
    return np.asarray(np.abs(np.arctan2(product.imag, product.real)))


def _turn(
    entry: Complexes, ahead: Complexes | complex, product: Complexes, performance: Performance
) -> tuple[Complexes, Floats | float]:
    """Where the segment that encloses a turn begins, and the room about it.

    `product` is the new direction's with the conjugate of the old one, `ahead`.

    Up to 90 degrees that is the entry point. Beyond, the vehicle rolls in from there and turns to the side
    of the new direction, one turn radius about the centre of its circle; near a reversal it may turn to
    either side, two turn radii about the entry.
    """
    sharp = product.real < 0.0
    if not sharp.any():
        return entry, 0.0
    radius = performance.turn_radius
    either = product.real < -math.cos(EITHER_SIDE)
    side = np.where(either, 0.0, np.sign(product.imag))
    centre = entry + (performance.airspeed * performance.roll_time + 1j * side * radius) * ahead
    room = np.where(sharp, np.where(either, 2.0 * radius, radius), 0.0)
    return np.where(sharp, centre, entry), room


def _first_turn(
    start: Complexes, unit: Complexes, length: Floats, course: float, delay: float, performance: Performance
) -> tuple[Complexes, Complexes, Complexes, Floats | float]:
    """The turn on to the first leg from the present course, begun after `delay` [m], all of shape (n,).

    It begins so far ahead of the start as the first result is; then the segment of the way on to the leg,
    and the room about that.
    """
    ahead = complex(math.cos(course), math.sin(course))
    product = ahead.conjugate() * unit
    begin, room = _turn(start + delay * ahead, ahead, product, performance)
    sharp = product.real < 0.0
    angle = np.abs(np.arctan2(product.imag, product.real))
    reach = performance.turn_radius * np.tan(0.5 * np.where(sharp, 0.0, angle))
    reach += delay + performance.airspeed * performance.roll_time
    turn = start + np.where(angle < STRAIGHT, 0.0, reach) * ahead
    joins = np.where(sharp, start, turn) + np.minimum(performance.capture_distance, length) * unit
    return turn, np.where(sharp, begin, turn), joins, room
