"""The way out that is always kept: an orbit in free space, here or a little further along the route.

Whatever is new is first seen with its sphere `Parameters.pop_up_room` away or more. If at every moment an
orbit can be begun within that distance, along the route, that is free of everything known, then no news
ever leaves the vehicle without a way out. The rule that follows: never enter a passage too narrow to turn
round in, unless it is short. `docs/guarantee.md` states it with its assumptions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from avoidance.flown import SEQUENCING_DELAY, late_turn
from avoidance.geofence import FENCE, Walls
from avoidance.geometry import distances, segments_clearance
from avoidance.known import Circles, Known
from avoidance.parameters import Parameters
from avoidance.route_check import Blocked, altitude_bands, remaining_points
from avoidance.types import Bools, Floats, Ints, Ownship, Performance, Route, Threat

WIDE, TIGHT = 1.5, 1.2
"""Radii of a holding orbit in turn radii: the one preferred, and the smallest flown."""
SPACING = 25.0
"""Distance between the points of a route at which an orbit is looked for [m]."""
SIDES = np.array([1.0, -1.0])
"""Clockwise seen from above, anticlockwise."""


@dataclass(frozen=True, slots=True)
class Orbit:
    """A circle to wait on."""

    centre: tuple[float, float]
    """North and east [m]."""
    radius: float
    """Radius [m]."""
    direction: int
    """+1 clockwise seen from above, -1 anticlockwise."""
    clearance: float
    """Least distance between any sphere and the flown curve, its errors included [m]; negative inside."""


def orbit_reach(performance: Performance, radii: float = TIGHT) -> float:
    """Radius of the disc about an orbit's centre that holds the flight into it and round it [m].

    Notes
    -----
    The orbit touches the present course one roll time ahead, so the flight begins √(r² + ℓ²) from its
    centre; what guidance overshoots, wind and an opposite bank included, is below two tracking errors
    (measured on both fidelities, wind up to 11 m/s: at most 8.4 m).
    """
    radius = radii * performance.turn_radius
    return math.hypot(radius, _lead(performance)) + 2.0 * performance.tracking_error


def orbit_from_here(own: Ownship, known: Known, performance: Performance) -> Orbit:
    """The best orbit that can be begun at once: a wide one if it is free, else the freer of the tight ones.

    Parameters
    ----------
    own : Ownship
        Where the vehicle is.
    known : Known
        What stands still, and the geofence.
    performance : Performance
        How it turns.

    Returns
    -------
    Orbit
        Free if its clearance is not negative.
    """
    wide, tight = (_freer_side(own, known, performance, radii) for radii in (WIDE, TIGHT))
    return wide if wide.clearance >= 0.0 else tight


def _freer_side(own: Ownship, known: Known, performance: Performance, radii: float) -> Orbit:
    here, course = np.array([[own.north, own.east]]), np.array([own.course])
    centres = _centres(here, course, performance, radii)[0]
    clearance = _clearance(centres, known.circles(own.altitude, own.altitude), known.walls)
    clearance -= orbit_reach(performance, radii)
    side = int(np.argmax(clearance))
    north, east = centres[side].tolist()
    radius = radii * performance.turn_radius
    return Orbit((north, east), radius, int(SIDES[side]), float(clearance[side]))


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
    corners = _corner_room(points, own.course, performance)
    steps = points[1:] - points[:-1]
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    reached = np.concatenate([[0.0], np.cumsum(lengths)])
    cuts = [(known.circles(*band), legs) for band, legs in altitude_bands(own, route).items()]
    cut_on = {leg: circles for circles, legs in cuts for leg in legs}
    run, last = 0.0, -math.inf
    for k in range(len(points) - 1):
        leg = max(k - inserted, 0)
        circles = cut_on[leg]
        at, rows = _narrow(points[k : k + 2], corners[k], circles, known.walls, performance)
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


def turning_room(performance: Performance) -> float:
    """What is to be kept from spheres on one side, so that an orbit to that side is free [m]."""
    return TIGHT * performance.turn_radius + orbit_reach(performance) + 2.0 * performance.tracking_error


def _lead(performance: Performance) -> float:
    """How far the vehicle flies until it has rolled into a turn [m]."""
    return (performance.airspeed + performance.wind_bound) * performance.roll_time


def _centres(points: Floats, courses: Floats, performance: Performance, radii: float) -> Floats:
    """Centres of the orbits to both sides that begin at n points, on n courses or on one, (n, 2, 2) [m]."""
    ahead, right = np.empty((len(courses), 2)), np.empty((len(courses), 2))
    ahead[:, 0], ahead[:, 1] = np.cos(courses), np.sin(courses)
    right[:, 0], right[:, 1] = -ahead[:, 1], ahead[:, 0]
    entry = points + _lead(performance) * ahead
    offset = radii * performance.turn_radius * SIDES
    return np.asarray(entry[:, None] + offset[None, :, None] * right[:, None])


def _clearance(points: Floats, circles: Circles, walls: Walls) -> Floats:
    """Distance of points, shape (n, 2), from the nearest sphere or wall [m], shape (n,)."""
    north = points[:, 0, None] - circles.centres[:, 0]
    east = points[:, 1, None] - circles.centres[:, 1]
    spheres = (np.hypot(north, east) - circles.hard).min(axis=1, initial=math.inf)
    return np.asarray(np.minimum(spheres, walls.clearance(points, points)))


def _corner_room(points: Floats, course: float, performance: Performance) -> Floats:
    """How much further an orbit may lie from where it is looked for, before and after each leg, (k, 2) [m].

    In a corner the vehicle is off the legs and flies neither's direction. Up to 90 degrees it stays within
    the triangle of entry, waypoint and exit, or overshoots the new leg; beyond, within three turn radii.
    """
    steps = points[1:] - points[:-1]
    courses = np.empty(len(points))
    courses[0], courses[1:] = course, np.arctan2(steps[:, 1], steps[:, 0])
    turn = np.abs(np.mod(courses[1:] - courses[:-1] + math.pi, math.tau) - math.pi)
    run = performance.acceptance_radius + SEQUENCING_DELAY * performance.airspeed
    late = late_turn(np.minimum(turn, 0.5 * math.pi), performance) * np.sin(turn)
    gentle = np.maximum(run * np.sin(0.5 * turn), late)
    off = np.where(turn <= 0.5 * math.pi, gentle, 3.0 * performance.turn_radius)
    swung = 2.0 * np.sin(0.5 * turn) * math.hypot(TIGHT * performance.turn_radius, _lead(performance))
    room = np.zeros((len(turn), 2))
    room[:, 0] = off + swung
    room[:-1, 1] = room[1:, 0]
    return room


def _narrow(
    leg: Floats, room: Floats, circles: Circles, walls: Walls, performance: Performance
) -> tuple[Floats, Ints]:
    """Where on a leg, ends of shape (2, 2), no orbit can be begun, and what is in the way on both sides.

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
    near = np.flatnonzero(segments_clearance(leg[:1], leg[1:], circles.centres)[0] - circles.hard < widest)
    fenced = bool(walls.clearance(leg[:1], leg[1:])[0] < widest)
    if not (len(near) or fenced) or length < 1e-6:
        return np.empty(0), np.empty((0, 2), dtype=np.int64)
    unit = (end - begin) / length
    radii = circles.hard[near] + widest
    at = _places(unit, begin, length, circles.centres[near], radii, (walls if fenced else Walls(), widest))
    course = np.array([math.atan2(unit[1], unit[0])])
    run = performance.acceptance_radius + SEQUENCING_DELAY * performance.airspeed
    extra = np.maximum(
        np.where(at < performance.capture_distance, room[0], 0.0), np.where(length - at < run, room[1], 0.0)
    )
    centres = _centres(begin + at[:, None] * unit, course, performance, TIGHT).reshape(-1, 2)
    margins = np.empty((len(centres), len(near) + 1))
    margins[:, :-1] = distances(centres, circles.centres[near]) - circles.hard[near]
    margins[:, -1] = walls.clearance(centres, centres)
    sides = margins.reshape(len(at), 2, -1)
    free: Bools = (sides.min(axis=2) >= (reach + extra)[:, None]).any(axis=1)
    return at[~free], np.append(near, -1)[sides[~free].argmin(axis=2)]


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


__all__ = ["Orbit", "first_trap", "longest_stretch", "orbit_from_here", "orbit_reach", "turning_room"]
