"""What the tracks mean for a flight: circles to stay out of, intruders to stay clear of."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from avoidance.geofence import FENCE, Geofence, Walls
from avoidance.parameters import Parameters
from avoidance.picture import Picture
from avoidance.prediction import DETOUR_HORIZON, Intruders, route_separation
from avoidance.types import Bools, Floats, Ints, Ownship, Performance, Route

ALTITUDE_TOLERANCE = 15.0
"""The vehicle keeps its altitude within this [m]."""
SIGMAS = 3.0
"""Spheres grow by this many standard deviations of their position."""
IMMINENT = 300.0
"""What is seen for the first time nearer to its sphere than this is believed at once [m]."""
NEAR = 1500.0
"""What is nearer to its sphere than this, and not known to move, is taken to stand [m]."""
RUN = 3.0
"""Flown before a change of course takes effect [s]."""
MARGIN_RADII = 0.4
"""Least margin in turn radii: 50 m at R = 120 m."""
KNOWN_SPEED = 1.2
"""Whether a track moves is undecided while the standard deviation of its speed exceeds this [m/s]."""


@dataclass(frozen=True, slots=True, eq=False)
class Circles:
    """What stands still, cut at the altitudes of a leg: circles that the leg must keep out of."""

    rows: Ints
    """Which obstacle of `Known` each is, shape (c,)."""
    centres: Floats
    """North and east [m], shape (c, 2)."""
    keep: Floats
    """Distance that the flown curve keeps: radius of the cut + margin [m], shape (c,)."""
    hard: Floats
    """Distance that nothing ever goes below: radius of the cut + doubt about its place [m], shape (c,)."""
    keep_waypoint: Floats
    """Distance that a new waypoint keeps: the same + tolerance [m], shape (c,)."""
    slack: Floats
    """A route is left alone until it comes nearer than `keep` by this [m], shape (c,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Known:
    """What is known of the obstacles, as it matters for a flight."""

    ids: Ints
    """Radar identities of what stands still, shape (d,)."""
    centres: Floats
    """North and east [m], shape (d, 2)."""
    altitudes: Floats
    """Above home [m], shape (d,)."""
    radii: Floats
    """Radii of the spheres [m], shape (d,)."""
    margin: Floats
    """What is kept beyond the sphere [m], shape (d,)."""
    tolerance: Floats
    """What a new waypoint keeps beyond the sphere [m], shape (d,)."""
    doubt: Floats
    """How far the sphere may lie from where it was measured [m], shape (d,)."""
    slack: Floats
    """A route is left alone until it comes nearer than is to be kept by this [m], shape (d,)."""
    most: Floats
    """No more than this can be kept, for the vehicle is too near already [m], shape (d,)."""
    walls: Walls
    """Edges of the geofence, with what is kept from them."""
    intruder_ids: Ints
    """Radar identities of what moves, shape (q,)."""
    intruders: Intruders
    """Where it is, how it moves, and the distance to keep."""
    _cut: dict[tuple[float, float], Circles] = field(default_factory=dict, init=False, repr=False)

    def circles(self, low: float, high: float) -> Circles:
        """The circles that count between two altitudes [m].

        Notes
        -----
        Spheres are cut at the altitude between `low` and `high`, give or take the vehicle's tolerance, that
        is nearest to their centre; one more than its radius above or below does not count.
        """
        if (low, high) not in self._cut:
            self._cut[low, high] = self._circles(low, high)
        return self._cut[low, high]

    def _circles(self, low: float, high: float) -> Circles:
        above = np.maximum(self.altitudes - high, low - self.altitudes) - ALTITUDE_TOLERANCE
        fence = self.ids == FENCE
        height = np.where(fence, 0.0, np.maximum(above, 0.0))
        rows = np.flatnonzero((height < self.radii) | fence)
        chosen = slice(None) if len(rows) == len(self.ids) else rows
        cut = np.sqrt(self.radii[chosen] ** 2 - height[chosen] ** 2)
        keep = cut + self.margin[chosen]
        return Circles(
            rows=rows,
            centres=self.centres[chosen],
            keep=np.minimum(keep, self.most[chosen]),
            hard=cut + self.doubt[chosen],
            keep_waypoint=np.maximum(cut + self.tolerance[chosen], keep),
            slack=self.slack[chosen],
        )


def kept_margin(parameters: Parameters, performance: Performance) -> float:
    """What the flown curve keeps beyond RS: the preset's margin, more if the vehicle needs more [m].

    Notes
    -----
    A route is left alone until it comes `hysteresis` nearer, and must then still be clear of the spheres by
    the tracking error. A prototype, in random fields: 20 m sufficed at R = 40 m, 50 m at R = 120 m.
    """
    tracked = performance.tracking_error + parameters.hysteresis
    return max(parameters.margin, tracked, MARGIN_RADII * performance.turn_radius)


def known_obstacles(
    picture: Picture, own: Ownship, route: Route, performance: Performance, parameters: Parameters
) -> Known:
    """What the tracks mean for the rest of a route.

    Parameters
    ----------
    picture : Picture
        Tracks.
    own : Ownship
        Position, for what is close and for intruders.
    route : Route
        Its altitudes, for intruders.
    performance : Performance
        Tracking error of the vehicle.
    parameters : Parameters
        Radii, margins and distances.

    Returns
    -------
    Known
    """
    distance = np.hypot(picture.positions[:, 0] - own.north, picture.positions[:, 1] - own.east)
    own_radius = np.where(picture.moving, parameters.moving_radius, parameters.safety_radius)
    radii = np.where(np.isnan(picture.radii), own_radius, picture.radii)
    decided = picture.moving | (picture.speed_sigma < KNOWN_SPEED) | (distance < radii + NEAR)
    believed = (decided & picture.confirmed) | (distance < radii + IMMINENT)
    still = believed & ~picture.moving
    moving = believed & picture.moving & (distance < parameters.reaction_distance)
    if not parameters.predict:
        still, moving = still | moving, np.zeros_like(moving)
    doubt = SIGMAS * picture.sigma
    margin = kept_margin(parameters, performance) + doubt
    tolerance = np.where(picture.moving, 0.0, parameters.tolerance) + doubt
    return Known(
        ids=picture.ids[still],
        centres=picture.positions[still, :2],
        altitudes=picture.positions[still, 2],
        radii=radii[still],
        margin=margin[still],
        tolerance=tolerance[still],
        doubt=doubt[still],
        slack=parameters.hysteresis + doubt[still],
        most=np.full(int(still.sum()), np.inf),
        walls=Walls(),
        **_traffic(picture, moving, radii, own, route, parameters),
    )


def _traffic(
    picture: Picture, moving: Bools, radii: Floats, own: Ownship, route: Route, parameters: Parameters
) -> dict[str, Any]:
    """What moves, where it is at the time of the vehicle's state, and the doubt about it."""
    if not moving.any():
        return {"intruder_ids": np.empty(0, dtype=np.int64), "intruders": Intruders()}
    flown = [own.altitude, *(waypoint.altitude for waypoint in route.waypoints[:3])]
    count = int(moving.sum())
    intruders = Intruders(
        positions=picture.positions[moving, :2],
        velocities=picture.velocities[moving],
        altitudes=picture.positions[moving, 2],
        climbs=picture.climbs[moving],
        radii=radii[moving],
        sigma=picture.sigma[moving],
        speed_sigma=picture.speed_sigma[moving],
        ages=picture.ages[moving],
        most=np.full(count, math.inf),
        until=np.full(count, DETOUR_HORIZON),
        band=(min(flown) - ALTITUDE_TOLERANCE, max(flown) + ALTITUDE_TOLERANCE),
        margin=parameters.moving_margin,
    ).after(max(own.time - picture.time, 0.0))
    return {"intruder_ids": picture.ids[moving], "intruders": _keeping_what_can_be_kept(intruders, own)}


def _keeping_what_can_be_kept(intruders: Intruders, own: Ownship) -> Intruders:
    """The same, asking no more distance than is left after what is flown before a turn takes effect."""
    wanted = intruders.most_needed
    north, east = (intruders.positions - (own.north, own.east)).T
    speeds = np.hypot(*intruders.velocities.T) + own.ground_speed
    if (np.hypot(north, east) > wanted + RUN * speeds).all():
        return intruders
    here, ahead = (own.north, own.east), (RUN * own.velocity_north, RUN * own.velocity_east)
    run = np.array([[here, (here[0] + ahead[0], here[1] + ahead[1])]])
    nearest = route_separation(run, max(own.ground_speed, 1.0), intruders)[0]
    return replace(intruders, most=np.where(nearest < wanted, nearest - 1.0, math.inf))


def within_fence(known: Known, fence: Geofence, own: Ownship, parameters: Parameters) -> Known:
    """The same with the geofence: its circles and the ends of its walls as obstacles, and the walls.

    Outside the fence its walls are left out: they must not bar the way back.
    """
    if not fence.areas:
        return known
    inside = bool(fence.allows(np.array([[own.north, own.east]]))[0])
    posts = np.column_stack([fence.posts, np.zeros(len(fence.posts))]) if inside else np.empty((0, 3))
    rows = np.concatenate([fence.discs, posts])
    count = len(rows)

    def with_rows(values: Floats, more: Floats | float) -> Floats:
        return np.concatenate([values, np.broadcast_to(more, (count,))])

    return replace(
        known,
        ids=np.concatenate([known.ids, np.full(count, FENCE, dtype=np.int64)]),
        centres=np.concatenate([known.centres, rows[:, :2]]),
        altitudes=with_rows(known.altitudes, own.altitude),
        radii=with_rows(known.radii, rows[:, 2]),
        margin=with_rows(known.margin, parameters.margin),
        tolerance=with_rows(known.tolerance, parameters.margin),
        doubt=with_rows(known.doubt, 0.0),
        slack=with_rows(known.slack, parameters.hysteresis),
        most=with_rows(known.most, np.inf),
        walls=Walls(fence.walls, parameters.margin) if inside else Walls(),
    )


def keep_what_can_be_kept(known: Known, own: Ownship, performance: Performance) -> Known:
    """The same, asking no more distance of an obstacle than can be kept.

    What lies within the distance flown before any command takes effect cannot be helped; a search that
    insisted on the margin there would find nothing. Below the sphere's radius this goes only where the
    vehicle is about to be inside the sphere whatever it does.
    """
    run = performance.airspeed * (performance.roll_time + max(1.0, performance.edit_time))
    ahead = np.array([math.cos(own.course), math.sin(own.course)])
    if len(known.walls):
        here = np.array([[own.north, own.east]])
        gap = float(known.walls.clearance(here, here + run * ahead)[0])
        room = min(known.walls.room, max(gap - 1.0, 0.0))
        known = replace(known, walls=replace(known.walls, room=room))
    if not len(known.ids):
        return known
    offset = known.centres - np.array([own.north, own.east])
    along = np.clip(offset @ ahead, 0.0, run)
    nearest = np.hypot(offset[:, 0] - along * ahead[0], offset[:, 1] - along * ahead[1])
    if bool((nearest > known.radii + known.margin).all()):
        return known
    return replace(known, most=np.maximum(nearest - 1.0, 0.0))
