"""What the tracks mean for a flight at one altitude: circles to stay out of, intruders to stay clear of."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from avoidance.parameters import Parameters
from avoidance.problem import Intruders
from avoidance.tracking import Picture
from avoidance.types import Bools, Floats, Ints, Ownship, Performance, Route

ALTITUDE_TOLERANCE = 15.0
"""The vehicle keeps its altitude within this [m]."""
SIGMAS = 3.0
"""Spheres grow by this many standard deviations of their position."""
CLOSE = 3000.0
"""An unconfirmed contact nearer than this is believed at once [m]."""
KNOWN_SPEED = 3.5
"""Whether a track moves is undecided while the standard deviation of its speed exceeds this [m/s]."""
LONGEST_LOOK = 600.0
"""The uncertainty of a predicted miss grows no longer than this [s]."""
LARGEST_DOUBT = 400.0
"""An uncertain prediction adds no more than this to what is kept [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Known:
    """Obstacles as circles in the plane of flight."""

    ids: Ints
    """Radar identities of what stands still, shape (d,)."""
    centres: Floats
    """North and east [m], shape (d, 2)."""
    keep: Floats
    """Distance that the flown curve keeps: radius at flight altitude + margin [m], shape (d,)."""
    keep_waypoint: Floats
    """Distance that a new waypoint keeps: the same + tolerance [m], shape (d,)."""
    slack: Floats
    """A route is left alone until it comes nearer than `keep` by this [m], shape (d,)."""
    intruder_ids: Ints
    """Radar identities of what moves, shape (q,)."""
    intruders: Intruders
    """Where it is, how it moves, and the distance to keep."""


def known_obstacles(
    picture: Picture, own: Ownship, route: Route, performance: Performance, parameters: Parameters
) -> Known:
    """Circles and intruders that count for the rest of a route.

    Parameters
    ----------
    picture : Picture
        Tracks.
    own : Ownship
        Position, for the altitude band and for what is close.
    route : Route
        Its altitudes.
    performance : Performance
        Tracking error of the vehicle.
    parameters : Parameters
        Radii, margins and distances.

    Returns
    -------
    Known

    Notes
    -----
    Spheres are cut at flight altitude; an obstacle more than its radius above or below does not count.
    """
    distance = np.hypot(picture.positions[:, 0] - own.north, picture.positions[:, 1] - own.east)
    believed = (picture.confirmed & (picture.speed_sigma < KNOWN_SPEED)) | (distance < CLOSE)
    still = believed & ~picture.moving
    moving = believed & picture.moving & (distance < parameters.reaction_distance)
    if not parameters.predict:
        still, moving = still | moving, np.zeros_like(moving)
    radii = np.where(picture.moving, parameters.moving_radius, picture.radii)
    height = _outside_band(picture.positions[:, 2], own, route)
    cut = np.sqrt(np.maximum(radii**2 - height**2, 0.0))
    still &= cut > 0.0
    moving &= cut > 0.0
    margin = max(parameters.margin, performance.tracking_error) + SIGMAS * picture.sigma
    keep = cut + margin
    tolerance = np.where(picture.moving, 0.0, parameters.tolerance)
    return Known(
        ids=picture.ids[still],
        centres=picture.positions[still, :2],
        keep=keep[still],
        keep_waypoint=np.maximum(cut + tolerance + SIGMAS * picture.sigma, keep)[still],
        slack=parameters.hysteresis + SIGMAS * picture.sigma[still],
        intruder_ids=picture.ids[moving],
        intruders=_intruders(picture, moving, cut, own, parameters),
    )


def _intruders(
    picture: Picture, moving: Bools, cut: Floats, own: Ownship, parameters: Parameters
) -> Intruders:
    """What moves, with what is to be kept: more, and called a conflict later, the less sure its path is."""
    positions, velocities = picture.positions[moving, :2], picture.velocities[moving]
    relative = positions - np.array([own.north, own.east])
    closing = velocities - np.array([own.velocity_north, own.velocity_east])
    square = np.maximum((closing**2).sum(axis=1), 1e-6)
    time = np.clip(-(relative * closing).sum(axis=1) / square, 0.0, LONGEST_LOOK)
    doubt = np.hypot(picture.sigma[moving], picture.speed_sigma[moving] * time)
    added = np.minimum(doubt, LARGEST_DOUBT)
    least = cut[moving] + parameters.moving_margin
    return Intruders(
        positions=positions,
        velocities=velocities,
        required=least + added,
        conflict=np.maximum(least - 0.5 * parameters.moving_margin - doubt, 0.0),
    )


def within_reach(known: Known, own: Ownship, performance: Performance) -> Known:
    """The same with circles shrunk where the vehicle is too near to keep the margin.

    What lies within the distance flown before any command takes effect cannot be helped; a search that
    insisted on the margin there would find nothing.
    """
    if not len(known.keep):
        return known
    run = performance.airspeed * (performance.roll_time + 1.0)
    ahead = np.array([math.cos(own.course), math.sin(own.course)])
    offset = known.centres - np.array([own.north, own.east])
    along = np.clip(offset @ ahead, 0.0, run)
    nearest = np.hypot(offset[:, 0] - along * ahead[0], offset[:, 1] - along * ahead[1])
    if bool((nearest > known.keep).all()):
        return known
    keep = np.minimum(known.keep, np.maximum(nearest - 1.0, 0.0))
    return Known(
        ids=known.ids,
        centres=known.centres,
        keep=keep,
        keep_waypoint=known.keep_waypoint,
        slack=known.slack,
        intruder_ids=known.intruder_ids,
        intruders=known.intruders,
    )


def _outside_band(altitudes: Floats, own: Ownship, route: Route) -> Floats:
    """How far altitudes lie above or below those flown from now on [m]."""
    flown = [own.altitude, *(waypoint.altitude for waypoint in route.waypoints[:3])]
    low, high = min(flown) - ALTITUDE_TOLERANCE, max(flown) + ALTITUDE_TOLERANCE
    return np.maximum(np.maximum(low - altitudes, altitudes - high), 0.0)
