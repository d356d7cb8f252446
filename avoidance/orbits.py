"""Circles to wait on: where they lie, and what room they need."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from avoidance.flown import SEQUENCING_DELAY
from avoidance.geofence import Walls
from avoidance.known import Circles, Known
from avoidance.types import Floats, Ownship, Performance, Waypoint

WIDE, TIGHT = 1.5, 1.2
"""Radii of a holding orbit in turn radii: the one preferred, and the smallest flown."""
SPACING = 25.0
"""Distance between the points of a route at which an orbit is looked for [m]."""
BENDS = 0.5
"""In a bend of a passage an orbit needs so much more room, in turn radii."""
LEFT_ALONE = 1.0
"""A waypoint that lacks no more than this of its room is left where it is [m]."""
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
    (measured on both fidelities, with the wind 3 m/s or more below the airspeed:
    `benchmarks/vehicle_limits.py`).
    """
    radius = radii * performance.turn_radius
    return math.hypot(radius, roll_in(performance)) + 2.0 * performance.tracking_error


def turning_room(performance: Performance) -> float:
    """What is to be kept from spheres on one side, so that an orbit to that side is free [m]."""
    return 2.0 * TIGHT * performance.turn_radius + reach_across(performance)


def reach_across(performance: Performance) -> float:
    """How far a tight orbit reaches across the leg that it begins on, to its other side [m]."""
    return orbit_reach(performance) + 2.0 * performance.tracking_error - TIGHT * performance.turn_radius


def waypoint_room(performance: Performance, margin: float) -> float:
    """What a waypoint needs beyond the margin from every sphere, so that it can be left again [m].

    Room to turn there, and for an orbit wherever the arrival is acted upon, on whatever course the vehicle
    comes: there it can wait, and leave in any direction. `LEFT_ALONE` of it may be lacking.
    """
    roll = roll_in(performance)
    ahead = max(_acted_upon(performance) + roll, performance.acceptance_radius - roll)
    swing = math.hypot(TIGHT * performance.turn_radius, ahead)
    orbit = swing + orbit_reach(performance) + 2.0 * performance.tracking_error
    return max(performance.turn_room, orbit + LEFT_ALONE - margin)


def passage_room(performance: Performance, margin: float) -> float:
    """What is needed beyond the margin on both sides of a way in, so that an orbit fits in beside it [m].

    Half of what is needed on one side, in bends as well, and of what an orbit needs on the other side.
    """
    beside = max(reach_across(performance), margin)
    wide = turning_room(performance) + BENDS * performance.turn_radius + beside
    return 0.5 * max(wide - 2.0 * margin, 0.0)


def _acted_upon(performance: Performance) -> float:
    """How far behind a waypoint the arrival is acted upon at the latest [m]."""
    speed = performance.airspeed + performance.wind_bound
    return speed * (SEQUENCING_DELAY + max(1.0, performance.edit_time))


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


def orbit_on_arrival(
    before: tuple[float, float], waypoint: Waypoint, known: Known, performance: Performance
) -> bool:
    """True if an orbit can be begun wherever the arrival at a waypoint is noticed and acted upon.

    The vehicle comes straight from `before` [m].
    """
    begin, there = np.array(before), np.array([waypoint.north, waypoint.east])
    unit = (there - begin) / max(math.dist(before, there), 1e-9)
    late = _acted_upon(performance)
    along = np.linspace(
        -performance.acceptance_radius, late, 1 + math.ceil((late + performance.acceptance_radius) / SPACING)
    )
    course = np.array([math.atan2(unit[1], unit[0])])
    centres = orbit_centres(there + along[:, None] * unit, course, performance).reshape(-1, 2)
    circles = known.circles(waypoint.altitude, waypoint.altitude)
    clearance = _clearance(centres, circles, known.walls).reshape(-1, 2)
    needed = orbit_reach(performance) + 2.0 * performance.tracking_error
    return bool((clearance >= needed).any(axis=1).all())


def orbit_centres(points: Floats, courses: Floats, performance: Performance, radii: float = TIGHT) -> Floats:
    """Centres of the orbits to both sides that begin at n points, on n courses or on one, (n, 2, 2) [m]."""
    ahead, right = np.empty((len(courses), 2)), np.empty((len(courses), 2))
    ahead[:, 0], ahead[:, 1] = np.cos(courses), np.sin(courses)
    right[:, 0], right[:, 1] = -ahead[:, 1], ahead[:, 0]
    entry = points + roll_in(performance) * ahead
    offset = radii * performance.turn_radius * SIDES
    return np.asarray(entry[:, None] + offset[None, :, None] * right[:, None])


def roll_in(performance: Performance) -> float:
    """How far the vehicle flies until it has rolled into a turn [m]."""
    return (performance.airspeed + performance.wind_bound) * performance.roll_time


def _freer_side(own: Ownship, known: Known, performance: Performance, radii: float) -> Orbit:
    here, course = np.array([[own.north, own.east]]), np.array([own.course])
    centres = orbit_centres(here, course, performance, radii)[0]
    clearance = _clearance(centres, known.circles(own.altitude, own.altitude), known.walls)
    clearance -= orbit_reach(performance, radii)
    side = int(np.argmax(clearance))
    north, east = centres[side].tolist()
    radius = radii * performance.turn_radius
    return Orbit((north, east), radius, int(SIDES[side]), float(clearance[side]))


def _clearance(points: Floats, circles: Circles, walls: Walls) -> Floats:
    """Distance of points, shape (n, 2), from the nearest sphere or wall [m], shape (n,)."""
    north = points[:, 0, None] - circles.centres[:, 0]
    east = points[:, 1, None] - circles.centres[:, 1]
    spheres = (np.hypot(north, east) - circles.hard).min(axis=1, initial=math.inf)
    return np.asarray(np.minimum(spheres, walls.clearance(points, points)))


__all__ = [
    "BENDS",
    "LEFT_ALONE",
    "SPACING",
    "TIGHT",
    "WIDE",
    "Orbit",
    "orbit_centres",
    "orbit_from_here",
    "orbit_on_arrival",
    "orbit_reach",
    "passage_room",
    "reach_across",
    "roll_in",
    "turning_room",
    "waypoint_room",
]
