"""Does the route come too near to something that moves (Algorithm 7)?"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from avoidance.known import Known
from avoidance.prediction import CONFLICT_HORIZON, DETOUR_HORIZON, Intruders, ground_speeds, leg_approaches
from avoidance.right_of_way import gives_way
from avoidance.route_check import Blocked
from avoidance.types import Bools, Floats, Ownship, Performance, Route, Threat

HASTE = 60.0
"""A conflict sooner than this does not wait until more is known [s]."""
PATIENCE = 20.0
"""Whoever has flown straight on for a second is expected to do so for this many [s]."""
STAND_ON = 10.0
"""The same for whoever is to give way to the own vehicle: it is given time to do so [s]."""
STAND_ON_HORIZON = 650.0
"""A closest approach to one of those later than this is no conflict yet [s]."""
WIND_DOUBT = 2.0
"""A wind estimate stronger than the bound by more than this is not believed [m/s]."""


def wind_estimate(own: Ownship, performance: Performance) -> tuple[float, float]:
    """Wind by the difference of ground velocity and airspeed, towards north and east [m/s].

    None where the vehicle allows for none, or where the state cannot be right: the heading may be missing.
    """
    if performance.wind_bound <= 0.0:
        return 0.0, 0.0
    north = own.velocity_north - own.airspeed * math.cos(own.heading)
    east = own.velocity_east - own.airspeed * math.sin(own.heading)
    if math.hypot(north, east) > performance.wind_bound + WIND_DOUBT:
        return 0.0, 0.0
    return north, east


def first_conflict(
    own: Ownship, route: Route, known: Known, performance: Performance, *, resuming: bool = False
) -> Blocked | None:
    """The first leg on which an intruder comes too close, or None.

    Parameters
    ----------
    own, route, known, performance
        The vehicle, what it is to fly, what it knows, what it can.
    resuming : bool
        True for a route that is to be taken up: it keeps d + h and the doubt about the prediction. One that
        is being flown is left alone unless it surely comes nearer than d + h/2; in the last minute, unless
        it surely does not.

    Notes
    -----
    Algorithm 7. Differs from the paper: a shrinking distance alone proves nothing; the closest point of
    approach along the whole route is taken.
    """
    intruders = known.intruders
    if not len(intruders) or not route.waypoints:
        return None
    separation, times = _approaches(own, route, performance, intruders)
    doubt, needed = intruders.doubt(times), intruders.needed(times)
    surely = intruders.radii + 0.5 * intruders.margin - np.where(times > HASTE, doubt, -doubt)
    surely = np.minimum(surely, intruders.most)
    limit = needed if resuming else np.maximum(surely, 0.0)
    close = ((separation < limit) & (times < CONFLICT_HORIZON))[0]
    if not resuming and close.any():
        missing, yields = (needed - separation)[0], _yields(own, intruders)
        close &= ~_learning(intruders, missing, times[0], doubt[0]) & ~_young(intruders, times[0], yields)
    if not close.any():
        return None
    leg = int(np.argmax(close.any(axis=1)))
    who = np.flatnonzero(close[leg])
    who = who[np.argsort(separation[0, leg, who], kind="stable")]
    nearest = int(who[0])
    time = float(times[0, leg, nearest])
    threat = Threat(
        ids=tuple(int(i) for i in known.intruder_ids[who]),
        leg=leg,
        distance=time * max(own.ground_speed, 1.0),
        time=time,
        clearance=float(separation[0, leg, nearest]),
        required=float(needed[0, leg, nearest]),
        moving=True,
    )
    return Blocked(threat, leg, np.empty(0, dtype=np.int64))


def _approaches(
    own: Ownship, route: Route, performance: Performance, intruders: Intruders
) -> tuple[Floats, Floats]:
    """As `leg_approaches`, of the route as far as intruders are extrapolated, shape (1, k - 1, q)."""
    points = _within_horizon(own, route, performance.airspeed)
    legs = points[:, 1:] - points[:, :-1]
    speeds = ground_speeds(legs, performance.airspeed, wind_estimate(own, performance))
    return leg_approaches(points, speeds, intruders)


def to_be_avoided(own: Ownship, route: Route, known: Known, performance: Performance) -> Known:
    """The same without those who are to give way to the own vehicle and still have the time to do so.

    What is in the way must be avoided for good: a detour that only put it off until later, as a course
    nearly the same does, would lead to where there is no room left.
    """
    intruders = known.intruders
    if not len(intruders) or not route.waypoints:
        return known
    separation, times = _approaches(own, route, performance, intruders)
    when = np.take_along_axis(times[0], separation[0].argmin(axis=0)[None], axis=0)[0]
    yields = _yields(own, intruders)
    waits = ~yields & _young(intruders, when, yields)
    late = separation[0].min(axis=0) < intruders.needed(when)
    intruders = replace(intruders, until=np.where(late, math.inf, intruders.until))
    return replace(known, intruder_ids=known.intruder_ids[~waits], intruders=intruders.chosen(~waits))


def _yields(own: Ownship, intruders: Intruders) -> Bools:
    return gives_way(own.course, (own.north, own.east), intruders)


def _young(intruders: Intruders, times: Floats, yields: Bools) -> Bools:
    """True where a closest approach is too far off to be sure that it will come to that, shape (..., q).

    Whoever has turned a moment ago may turn back: a velocity is trusted for so long, in proportion, as it has
    been kept. And who is to give way to the own vehicle must be left the time to do so.
    """
    trusted = np.where(yields, PATIENCE, STAND_ON) * np.maximum(intruders.ages, 1.0)
    until = np.where(yields, CONFLICT_HORIZON, STAND_ON_HORIZON)
    return np.asarray((times > HASTE) & (times > np.minimum(trusted, until)))


def _learning(intruders: Intruders, missing: Floats, times: Floats, doubt: Floats) -> Bools:
    """True where it pays to know more before a conflict is acted on; all of shape (k - 1, q).

    Notes
    -----
    A detour grows with (what is missing)²/(time left), so waiting costs 1/time left a second; the doubt about
    a velocity falls with time^-1.5, so it saves up to 3 doubt/(age x missing).
    """
    ages = np.maximum(intruders.ages, 1.0)
    worth = missing * ages / (3.0 * np.maximum(times, 1.0))
    return np.asarray((times > HASTE) & (doubt > np.maximum(intruders.margin, worth)))


def _within_horizon(own: Ownship, route: Route, airspeed: float) -> Floats:
    """The part of the route that intruders are extrapolated for, shape (1, k, 2) [m]."""
    points = [(own.north, own.east)]
    ahead = 0.0
    for waypoint in route.waypoints:
        points.append((waypoint.north, waypoint.east))
        ahead += math.dist(points[-2], points[-1])
        if ahead > 2.0 * airspeed * DETOUR_HORIZON:  # downwind it gets no further
            break
    return np.array(points)[None]
