"""The way out that is always kept: an orbit in free space, here or a little further along the route.

Whatever is new is first seen with its sphere `Parameters.pop_up_room` away or more. If at every moment an
orbit can be begun within that distance, along the route, that is free of everything known, then no news
ever leaves the vehicle without a way out. The rule that follows: never enter a passage too narrow to turn
round in, unless it is short. `docs/guarantee.md` states it with its assumptions.
"""

from __future__ import annotations

import math

import numpy as np

from avoidance.flown import early_turn, late_turn
from avoidance.geofence import FENCE, Walls
from avoidance.geometry import segment_point_distance, segments_clearance
from avoidance.known import Circles, Known
from avoidance.orbits import SPACING, TIGHT, orbit_centres, orbit_reach, reach_across, roll_in, turning_room
from avoidance.parameters import Parameters
from avoidance.route_check import Blocked, altitude_bands, remaining_points
from avoidance.types import Bools, Floats, Ints, Ownship, Performance, Route, Threat

SHARP = 0.5 * math.pi
"""Beyond this change of course a vehicle may leave a corner's triangle [rad]."""


def first_trap(
    own: Ownship, route: Route, known: Known, performance: Performance, parameters: Parameters
) -> Blocked | None:
    """The first stretch of a route without an orbit that is longer than may be flown without one.

    Parameters
    ----------
    own : Ownship
        Where the vehicle is.
    route : Route
        What it is to fly.
    known : Known
        What stands still.
    performance : Performance
        How it turns.
    parameters : Parameters
        `pop_up_room`, within which the next orbit must lie.

    Returns
    -------
    Blocked or None
        The leg on which the stretch becomes too long, and what makes it narrow; None if there is always an
        orbit.

    Notes
    -----
    Orbits are looked for every `SPACING` metres where something is near; each is tested in closed form,
    with the corners of the route allowed for.
    """
    if parameters.pop_up_room is None or not route.waypoints:
        return None
    if not (len(known.ids) or len(known.walls)):
        return None
    points = remaining_points(own, route, performance.tracking_error, performance.capture_distance)[0]
    inserted = len(points) - 1 - len(route.waypoints)
    longest = longest_stretch(performance, parameters.pop_up_room)
    room, courses = _corners(points, own.course, performance)
    steps = points[1:] - points[:-1]
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    reached = np.concatenate([[0.0], np.cumsum(lengths)])
    cuts = [(known.circles(*band), legs) for band, legs in altitude_bands(own, route).items()]
    cut_on = {leg: circles for circles, legs in cuts for leg in legs}
    run, last = 0.0, -math.inf
    for k in range(len(points) - 1):
        leg = max(k - inserted, 0)
        circles = cut_on[leg]
        at, rows = _narrow(points[k : k + 2], room[k], courses[k : k + 3], circles, known.walls, performance)
        for s, walls in zip((at + reached[k]).tolist(), rows.tolist(), strict=True):
            run = run + (s - last) if s - last < 2.0 * SPACING else 0.0
            last = s
            if run > longest:
                found = np.unique([circles.rows[w] for w in walls if w >= 0]).astype(np.int64)
                return _blocked(known, found, leg, s - run, own, turning_room(performance))
    return None


def longest_stretch(performance: Performance, pop_up_room: float) -> float:
    """How far may be flown without an orbit [m].

    Notes
    -----
    News is at most one scan old when it is heard, and the orbit at the far end lies beyond the stretch by
    its diameter; both are taken from `pop_up_room`, and the spacing of the points looked at.
    """
    speed = performance.airspeed + performance.wind_bound
    return pop_up_room - 2.0 * orbit_reach(performance) - 2.0 * speed - 2.0 * SPACING


def room_outside(performance: Performance, turn: float) -> float:
    """What a route round a sphere keeps from it so that orbits on the other side are free [m].

    `turn` is the change of course at each of its corners [rad]; legs are longer than the run before a corner,
    else there are stretches, shorter than `longest_stretch`, that would need a little more.
    """
    return reach_across(performance) + float(_corner_room(np.array([turn]), performance)[0])


def _corners(points: Floats, course: float, performance: Performance) -> tuple[Floats, Floats]:
    """What is different about orbits near corners.

    Returns
    -------
    room : array, shape (k, 2)
        How much further an orbit may lie from where it is looked for, before and after each leg [m].
    courses : array, shape (k + 2,)
        Of the legs, with the present course before and the last one again behind [rad]. The vehicle flies
        neither leg's in a corner but one in between; beyond 90 degrees `room` allows for that.
    """
    steps = points[1:] - points[:-1]
    courses = np.empty(len(points) + 1)
    courses[0], courses[1:-1] = course, np.arctan2(steps[:, 1], steps[:, 0])
    courses[-1] = courses[-2]
    turn = _turned(courses[:-1])
    sharp = 3.0 * performance.turn_radius + 2.0 * np.sin(0.5 * turn) * _swing(performance)
    room = np.zeros((len(turn), 2))
    room[:, 0] = np.where(turn <= SHARP, _corner_room(turn, performance), sharp)
    room[:-1, 1] = room[1:, 0]
    return room, courses


def _turned(courses: Floats) -> Floats:
    """Changes of course, without their sign [rad]."""
    return np.asarray(np.abs(np.mod(courses[1:] - courses[:-1] + math.pi, math.tau) - math.pi))


def _corner_room(turn: Floats, performance: Performance) -> Floats:
    """The same for corners of up to 90 degrees, their turn in radians, for the positions alone [m].

    The vehicle stays within the triangle of entry, waypoint and exit, or overshoots the new leg; the centres
    of its orbits lie on an arc from that of the one course to that of the other, whose chord is tested.
    """
    turn = np.minimum(turn, SHARP)
    run = early_turn(performance)
    off = np.maximum(run * np.sin(0.5 * turn), late_turn(turn, performance) * np.sin(turn))
    return np.asarray(off + (1.0 - np.cos(0.5 * turn)) * _swing(performance))


def _swing(performance: Performance) -> float:
    """How far an orbit's centre lies from where it is decided on [m]."""
    return math.hypot(TIGHT * performance.turn_radius, roll_in(performance))


def _narrow(
    leg: Floats, room: Floats, courses: Floats, circles: Circles, walls: Walls, performance: Performance
) -> tuple[Floats, Ints]:
    """Where on a leg, ends of shape (2, 2), no orbit can be begun, and what is in the way on both sides.

    Of `_corners`, `room` of shape (2,) and `courses` of shape (3,): before, on and after the leg.

    Returns
    -------
    along : array, shape (n,)
        Distances from the beginning, ascending, `SPACING` apart within one stretch [m].
    nearest : array, shape (n, 2)
        Rows of the `circles` in the way of the orbits to both sides; -1 for walls.
    """
    begin, end = leg
    length = float(np.hypot(*(end - begin)))
    reach = orbit_reach(performance) + 2.0 * performance.tracking_error
    widest = reach + 2.0 * TIGHT * performance.turn_radius + float(room.max())
    near = np.flatnonzero(segment_point_distance(begin, end, circles.centres) - circles.hard < widest)
    fenced = len(walls) > 0 and bool(walls.clearance(leg[:1], leg[1:])[0] < widest)
    if not (len(near) or fenced) or length < 1e-6:
        return np.empty(0), np.empty((0, 2), dtype=np.int64)
    unit = (end - begin) / length
    radii = circles.hard[near] + widest
    at = _places(unit, begin, length, circles.centres[near], radii, (walls if fenced else Walls(), widest))
    run = early_turn(performance)
    places, circle = begin + at[:, None] * unit, (circles.centres[near], circles.hard[near])
    centres = orbit_centres(places, courses[1:2], performance)
    margins = _margins(centres, centres, *circle, walls)
    extra = np.zeros(len(at))
    zones = (at < performance.capture_distance, length - at < run)
    for zone, more, course, turn in zip(zones, room, courses[::2], _turned(courses), strict=True):
        extra[zone] = np.maximum(extra[zone], more)
        if 0.0 < turn <= SHARP and zone.any():
            swung = orbit_centres(places[zone], np.array([course]), performance)
            margins[zone] = np.minimum(margins[zone], _margins(centres[zone], swung, *circle, walls))
    free: Bools = (margins.min(axis=2) >= (reach + extra)[:, None]).any(axis=1)
    return at[~free], np.append(near, -1)[margins[~free].argmin(axis=2)]


def _margins(starts: Floats, ends: Floats, centres: Floats, radii: Floats, walls: Walls) -> Floats:
    """Of segments, ends (m, 2, 2), from n spheres and from the nearest wall, shape (m, 2, n + 1) [m]."""
    first, last = starts.reshape(-1, 2), ends.reshape(-1, 2)
    found = np.empty((len(first), len(centres) + 1))
    found[:, :-1] = segments_clearance(first, last, centres) - radii
    found[:, -1] = walls.clearance(first, last)
    return found.reshape(len(starts), 2, -1)


def _places(
    unit: Floats,
    begin: Floats,
    length: float,
    centres: Floats,
    radii: Floats,
    walls: tuple[Walls, float],
) -> Floats:
    """Distances along a segment, every `SPACING`, at which a circle or a wall is near [m], ascending."""
    offset = centres - begin
    along = offset @ unit
    across = unit[0] * offset[:, 1] - unit[1] * offset[:, 0]
    half = np.sqrt(np.maximum(radii**2 - across**2, 0.0))
    grid = np.arange(0.0, length + SPACING, SPACING)
    grid[-1] = length
    inside = (np.abs(along[:, None] - grid) <= (half + SPACING)[:, None]).any(axis=0)
    if len(walls[0]):
        places = begin + grid[:, None] * unit
        inside |= walls[0].clearance(places, places) < walls[1] + SPACING
    return np.asarray(grid[inside])


def _blocked(known: Known, rows: Ints, leg: int, distance: float, own: Ownship, required: float) -> Blocked:
    """A passage that may not be entered, as the record has it."""
    threat = Threat(
        ids=tuple(dict.fromkeys(known.ids[rows].tolist())) or (FENCE,),
        leg=leg,
        distance=max(distance, 0.0),
        time=max(distance, 0.0) / max(own.ground_speed, 1.0),
        clearance=0.0,
        required=required,
        narrow=True,
    )
    return Blocked(threat, leg, rows)


__all__ = ["first_trap", "longest_stretch", "room_outside"]
