"""The curve that will really be flown along a route, enclosed by straight segments.

A vehicle that follows legs leaves them at every corner: it turns before the waypoint (acceptance radius),
needs room for the turn, and captures the next leg some distance later. The curve stays inside the hull of
the segments returned here, widened by `extra`; testing these segments against discs therefore tests the
flight, continuously and in closed form.
"""

from __future__ import annotations

import math

import numpy as np

from avoidance.types import Bools, Floats, Performance

EITHER_SIDE = math.radians(10.0)
"""Within this of a reversal a turn may go either way [rad]."""
SEQUENCING_DELAY = 1.0
"""A vehicle notices that it has reached a waypoint within this time [s]."""


def flown_segments(
    points: Floats, course: float | None, performance: Performance
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

    Returns
    -------
    starts, ends : array, shape (n, m, 2)
        End points of the segments [m].
    extra : array, shape (n, m)
        How far the curve may leave each segment beyond the tracking error [m].

    Notes
    -----
    At a corner of up to 90 degrees the vehicle turns inside the triangle of entry point, waypoint and exit
    point, so the chord is added to the two legs. At a sharper one it flies the turning circle beside the end
    of the incoming leg, and from there to the exit point. After a change of target the turn begins where the vehicle is: it
    runs on by R tan(dchi/2) plus the roll distance and joins the leg from outside.
    """
    legs = np.diff(points, axis=1)
    lengths = np.hypot(legs[..., 0], legs[..., 1])
    units = legs / np.maximum(lengths, 1e-9)[..., None]
    starts = [points[:, :-1]]
    ends = [points[:, 1:]]
    extra = [np.zeros(lengths.shape)]
    if points.shape[1] > 2:
        run = performance.acceptance_radius + SEQUENCING_DELAY * performance.airspeed
        before = np.minimum(run, lengths[:, :-1])
        entry = points[:, 1:-1] - before[..., None] * units[:, :-1]
        exit_ = points[:, 1:-1] + np.minimum(performance.capture_distance, lengths[:, 1:])[..., None] * units[:, 1:]
        centre, room, sharp = _turning_circle(entry, units[:, :-1], units[:, 1:], performance)
        starts.append(np.where(sharp[..., None], centre, entry))
        ends.append(exit_)
        extra.append(room)
    if course is not None:
        begin = _first_turn(points[:, 0], units[:, 0], lengths[:, 0], course, performance)
        starts.append(begin[0])
        ends.append(begin[1])
        extra.append(begin[2])
    return np.concatenate(starts, axis=1), np.concatenate(ends, axis=1), np.concatenate(extra, axis=1)


def turn_angle(first: Floats, second: Floats) -> Floats:
    """Unsigned angle between unit vectors of shape (..., 2) [rad]."""
    dot = first[..., 0] * second[..., 0] + first[..., 1] * second[..., 1]
    cross = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    angle: Floats = np.abs(np.arctan2(cross, dot))
    return angle


def _turning_circle(
    entry: Floats, first: Floats, second: Floats, performance: Performance
) -> tuple[Floats, Floats, Bools]:
    """Centre of a turn through more than 90 degrees, the room about it, and where a turn is that sharp.

    The vehicle rolls in from the entry point and turns to the side of the new direction; near a reversal
    it may turn to either side, and the room is two turn radii about the entry instead of one about the
    circle's centre.
    """
    dot = first[..., 0] * second[..., 0] + first[..., 1] * second[..., 1]
    cross = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    sharp = dot < 0.0
    either = dot < -math.cos(EITHER_SIDE)
    radius = performance.turn_radius
    side = np.where(either, 0.0, np.sign(cross))
    normal = np.stack([-first[..., 1], first[..., 0]], axis=-1)
    roll_in = performance.airspeed * performance.roll_time
    centre = entry + roll_in * first + (side * radius)[..., None] * normal
    room = np.where(sharp, np.where(either, 2.0, 1.0) * radius, 0.0)
    return centre, room, sharp


def _first_turn(
    start: Floats, unit: Floats, length: Floats, course: float, performance: Performance
) -> tuple[Floats, Floats, Floats]:
    """The turn on to the first leg from the present course: two segments for each polyline."""
    ahead = np.broadcast_to(np.array([math.cos(course), math.sin(course)]), unit.shape)
    angle = turn_angle(ahead, unit)
    run = performance.airspeed * (performance.roll_time + SEQUENCING_DELAY)
    centre, room, sharp = _turning_circle(
        start + SEQUENCING_DELAY * performance.airspeed * ahead, ahead, unit, performance
    )
    reach = run + performance.turn_radius * np.tan(0.5 * np.where(sharp, 0.0, angle))
    reach = np.where(angle < 1e-3, 0.0, reach)
    turn = start + reach[..., None] * ahead
    capture = np.minimum(performance.capture_distance, length)[..., None] * unit
    joins = np.where(sharp[..., None], start + capture, turn + capture)
    starts = np.stack([start, np.where(sharp[..., None], centre, turn)], axis=1)
    ends = np.stack([turn, joins], axis=1)
    return starts, ends, np.stack([np.zeros_like(room), room], axis=1)
