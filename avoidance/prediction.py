"""Own route against intruders that fly on as they do: separation in closed form (Algorithm 7)."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace

import numpy as np

from avoidance.types import Bools, Floats

SIGMAS = 1.5
"""A new route keeps this many standard deviations of a prediction beyond d + h."""
LARGEST_DOUBT = 300.0
"""No prediction is taken to be less certain than this: else nothing would ever be decided [m]."""
CONFLICT_HORIZON = 800.0
"""A closest approach later than this is no conflict yet [s]."""
DETOUR_HORIZON = 1000.0
"""A detour keeps its distance from all that come nearest before this, and from those it is for always [s]."""
LEVEL_FLIGHT = 1e-6
"""A climb rate below this is none [m/s]."""


def _none() -> Floats:
    return np.empty(0)


@dataclass(frozen=True, slots=True, eq=False)
class Intruders:
    """Moving obstacles, extrapolated with the velocity that they have now."""

    positions: Floats = field(default_factory=lambda: np.empty((0, 2)))
    """North and east now [m], shape (q, 2)."""
    velocities: Floats = field(default_factory=lambda: np.empty((0, 2)))
    """Over ground [m/s], shape (q, 2)."""
    altitudes: Floats = field(default_factory=_none)
    """Above home [m], shape (q,)."""
    climbs: Floats = field(default_factory=_none)
    """Climb rates, 0 unless significant [m/s], shape (q,)."""
    radii: Floats = field(default_factory=_none)
    """Distance in space that is a violation: d, or the radius that the sensor gave [m], shape (q,)."""
    sigma: Floats = field(default_factory=_none)
    """Standard deviation of the position [m], shape (q,)."""
    speed_sigma: Floats = field(default_factory=_none)
    """Standard deviation of the velocity [m/s], shape (q,)."""
    ages: Floats = field(default_factory=_none)
    """How long they have flown straight on as far as is known [s], shape (q,)."""
    most: Floats = field(default_factory=_none)
    """No more than this can be kept, for they are so near already [m], shape (q,)."""
    until: Floats = field(default_factory=_none)
    """A detour keeps its distance from those that come nearest before this time [s], shape (q,)."""
    band: tuple[float, float] = (0.0, 0.0)
    """Lowest and highest altitude that the own vehicle flies at [m]."""
    margin: float = 0.0
    """h, kept beyond the radius [m]."""

    def __len__(self) -> int:
        return len(self.radii)

    def chosen(self, rows: Bools) -> Intruders:
        """Some of them."""
        columns = {f.name: getattr(self, f.name) for f in fields(self) if f.name not in ("band", "margin")}
        return replace(self, **{name: values[rows] for name, values in columns.items()})

    def after(self, time: float) -> Intruders:
        """The same, `time` seconds later."""
        if time == 0.0:
            return self
        return replace(
            self,
            positions=self.positions + time * self.velocities,
            altitudes=self.altitudes + time * self.climbs,
            sigma=np.hypot(self.sigma, time * self.speed_sigma),
        )

    def doubt(self, times: Floats) -> Floats:
        """Standard deviation of where they are after `times` of shape (..., q) [m], same shape."""
        spread = np.sqrt(self.sigma**2 + (self.speed_sigma * times) ** 2)
        return np.asarray(np.minimum(spread, LARGEST_DOUBT))

    @property
    def most_needed(self) -> Floats:
        """What a new route keeps at most from each, however little is known of it, shape (q,) [m]."""
        return self.radii + self.margin + SIGMAS * LARGEST_DOUBT

    def needed(self, times: Floats) -> Floats:
        """What a new route keeps from each that is nearest after `times`, shape (..., q) [m]."""
        return np.asarray(np.minimum(self.radii + self.margin + SIGMAS * self.doubt(times), self.most))


def leg_approaches(points: Floats, speeds: Floats | float, intruders: Intruders) -> tuple[Floats, Floats]:
    """Closest approach of a flight along each polyline to each intruder, leg by leg.

    Parameters
    ----------
    points : array, shape (n, k, 2)
        n polylines, north and east [m], flown from now on.
    speeds : array, shape (n, k - 1), or float
        Own ground speed on each leg [m/s].
    intruders : Intruders
        q of them.

    Returns
    -------
    separations : array, shape (n, k - 1, q)
        Least distance in space [m].
    times : array, shape (n, k - 1, q)
        When it is reached, from now [s].

    Notes
    -----
    On each leg the relative motion is a straight line, so the least distance is that of the origin from a
    segment: the closest point of approach of Algorithm 7 and Eq. (21), exact for the whole leg. The own
    vehicle may be anywhere in its band of altitudes; an intruder that climbs or descends is above, in, or
    below it, each for one part of the leg.
    """
    legs = points[:, 1:] - points[:, :-1]
    lengths = np.sqrt(legs[..., 0] ** 2 + legs[..., 1] ** 2)
    lasting = lengths / speeds
    begin = np.zeros_like(lasting)
    lasting[:, :-1].cumsum(axis=1, out=begin[:, 1:])
    own = legs / np.maximum(lasting, 1e-9)[..., None]
    since, until = begin[..., None], lasting[..., None]
    north = points[:, :-1, 0, None] - intruders.positions[:, 0] - intruders.velocities[:, 0] * since
    east = points[:, :-1, 1, None] - intruders.positions[:, 1] - intruders.velocities[:, 1] * since
    rates = (own[..., 0, None] - intruders.velocities[:, 0], own[..., 1, None] - intruders.velocities[:, 1])
    low, high = intruders.band
    height = intruders.altitudes + intruders.climbs * since
    if (np.abs(intruders.climbs) < LEVEL_FLIGHT).all():
        gap = np.maximum(np.maximum(low - height, height - high), 0.0)
        square, moment = _nearest(north, east, gap, rates, 0.0, 0.0, until)
    else:
        square, moment = _climbing(north, east, height, rates, intruders.climbs, (low, high), until)
    return np.sqrt(square), since + moment


def _nearest(
    north: Floats,
    east: Floats,
    up: Floats,
    rates: tuple[Floats, Floats],
    climb: Floats | float,
    first: Floats | float,
    last: Floats,
) -> tuple[Floats, Floats]:
    """Least squared distance of a uniform motion from the origin between two times, and when."""
    speed = rates[0] ** 2 + rates[1] ** 2 + climb**2
    along = north * rates[0] + east * rates[1] + up * climb
    moment = np.minimum(np.maximum(-along / np.maximum(speed, 1e-12), first), last)
    square = (north + rates[0] * moment) ** 2 + (east + rates[1] * moment) ** 2 + (up + climb * moment) ** 2
    return square, moment


def _climbing(
    north: Floats,
    east: Floats,
    height: Floats,
    rates: tuple[Floats, Floats],
    climbs: Floats,
    band: tuple[float, float],
    until: Floats,
) -> tuple[Floats, Floats]:
    """The same where some climb: before, in and after the own band of altitudes."""
    climb = np.where(np.abs(climbs) < LEVEL_FLIGHT, LEVEL_FLIGHT, climbs)
    near, far = np.where(climb > 0.0, band[0], band[1]), np.where(climb > 0.0, band[1], band[0])
    enters = np.clip((near - height) / climb, 0.0, until)
    leaves = np.clip((far - height) / climb, 0.0, until)
    level = np.zeros_like(height)
    parts = (
        _nearest(north, east, height - near, rates, climb, 0.0, enters),
        _nearest(north, east, level, rates, 0.0, enters, leaves),
        _nearest(north, east, height - far, rates, climb, leaves, until),
    )
    void = (enters <= 0.0, leaves <= enters, leaves >= until)
    best, moment = np.full_like(height, np.inf), np.zeros_like(height)
    for (square, when), nothing in zip(parts, void, strict=True):
        better = (square < best) & ~nothing
        best, moment = np.where(better, square, best), np.where(better, when, moment)
    return best, moment


def route_separation(points: Floats, speeds: Floats | float, intruders: Intruders) -> Floats:
    """Least distance between a flight along each polyline and each intruder, shape (n, q) [m].

    Arguments as of `leg_approaches`.
    """
    return np.asarray(leg_approaches(points, speeds, intruders)[0].min(axis=1))


def separation_shortfall(points: Floats, speeds: Floats | float, intruders: Intruders) -> Floats:
    """How much is missing to d + h and the doubt about the prediction, worst intruder, shape (n,) [m].

    Arguments as of `leg_approaches`.
    """
    separation, times = leg_approaches(points, speeds, intruders)
    missing = np.where(times < intruders.until, intruders.needed(times) - separation, 0.0)
    return np.asarray(np.maximum(missing.max(axis=(1, 2)), 0.0))


def ground_speeds(legs: Floats, airspeed: float, wind: tuple[float, float]) -> Floats | float:
    """Ground speed along legs in steady wind.

    Parameters
    ----------
    legs : array, shape (..., 2)
        From their beginnings to their ends, north and east [m].
    airspeed : float
        True airspeed [m/s].
    wind : (float, float)
        Towards north and east [m/s].

    Returns
    -------
    array, shape (...), or float
        [m/s]; the airspeed itself without wind, at least 1.
    """
    if wind == (0.0, 0.0):
        return airspeed
    length = np.maximum(np.hypot(legs[..., 0], legs[..., 1]), 1e-9)
    tail = (legs[..., 0] * wind[0] + legs[..., 1] * wind[1]) / length
    cross = (legs[..., 0] * wind[1] - legs[..., 1] * wind[0]) / length
    return np.asarray(np.maximum(tail + np.sqrt(np.maximum(airspeed**2 - cross**2, 0.0)), 1.0))
