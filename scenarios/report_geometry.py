"""What the report works out from a run: closest passes, separation over time, thinned lines, encounters."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from avoidance.types import Floats, Ints
from scenarios.report_data import Hazard, Mark, Run, position

QUIET = 300.0
"""Events further apart than this belong to different encounters [s]."""
AHEAD = 1800.0
"""A decision is over when its waypoints have been passed, at the latest after this [s]."""
LARGEST_VIEW = 25_000.0
"""No encounter's view grows beyond this [m]."""
CLOSE = 1000.0
"""A pass is shown as an encounter if it comes within this of a sphere [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Pass:
    """The moment at which the vehicle was nearest to one hazard."""

    hazard: Hazard
    time: float
    """Time [s]."""
    distance: float
    """In three dimensions [m]."""
    own: Floats
    """North, east, altitude of the vehicle then [m]."""
    other: Floats
    """North, east, altitude of the hazard then [m]."""

    @property
    def margin(self) -> float:
        """Distance less the violation radius [m]; negative inside the sphere."""
        return self.distance - self.hazard.radius


@dataclass(frozen=True, slots=True, eq=False)
class Nearest:
    """Distance to whatever sphere was nearest, at each sample of the track."""

    distance: Floats
    """To its centre, shape (n,) [m]; infinite where there was nothing."""
    required: Floats
    """Its violation radius, shape (n,) [m]; infinite where there was nothing."""
    hazard: Ints
    """Its index in `Run.hazards`, -1 where there was none."""


def passes(run: Run) -> list[Pass]:
    """The closest pass of each hazard that was ever met, in the order of `Run.hazards`."""
    times, places = run.track.times, run.track.positions
    return [
        Pass(
            hazard,
            hazard.closest.time,
            hazard.closest.distance,
            position(times, places, hazard.closest.time),
            hazard.place(times),
        )
        for hazard in run.hazards
        if hazard.closest is not None
    ]


def nearest(run: Run) -> Nearest:
    """Distance to the nearest sphere over the whole track."""
    times, own = run.track.times, run.track.positions
    margin, distance, required = (np.full(len(times), math.inf) for _ in range(3))
    index = np.full(len(times), -1, dtype=np.int64)
    for i, hazard in enumerate(run.hazards):
        apart = own - hazard.places
        away = np.sqrt(np.einsum("ij,ij->i", apart, apart))
        nearer = hazard.exists(times) & (away - hazard.radius < margin)
        margin[nearer] = away[nearer] - hazard.radius
        distance[nearer], required[nearer], index[nearer] = away[nearer], hazard.radius, i
    return Nearest(distance, required, index)


@dataclass(slots=True)
class Encounter:
    """Decisions and close passes near one another, to be seen in one map with equal axes."""

    low: Floats
    """Least north and east of what must be seen [m], shape (2,)."""
    high: Floats
    """Greatest north and east [m], shape (2,)."""
    start: float
    """Time of its first event [s]."""
    end: float
    """Time of its last event [s]."""
    decisions: list[Mark] = field(default_factory=list)
    passes: list[Pass] = field(default_factory=list)

    @property
    def tightest(self) -> Pass | None:
        """The pass with the least margin."""
        return min(self.passes, key=lambda p: p.margin, default=None)


def encounters(run: Run, closest: Sequence[Pass]) -> list[Encounter]:
    """Group decisions and close passes, in order of time; none grows too large to be seen."""
    events = [_of_decision(mark, run) for mark in run.decisions]
    events += [_of_pass(p) for p in closest if p.margin < max(CLOSE, p.hazard.radius)]
    groups: list[Encounter] = []
    for event in sorted(events, key=lambda e: e.start):
        home = next((g for g in reversed(groups[-4:]) if _belongs(event, g)), None)
        if home is None:
            groups.append(event)
            continue
        home.low, home.high = np.minimum(home.low, event.low), np.maximum(home.high, event.high)
        home.end = max(home.end, event.end)
        home.decisions += event.decisions
        home.passes += event.passes
    return groups


def _belongs(event: Encounter, group: Encounter) -> bool:
    view = np.maximum(group.high, event.high) - np.minimum(group.low, event.low)
    return event.start - group.end < QUIET and float(view.max()) <= LARGEST_VIEW


def _of_decision(mark: Mark, run: Run) -> Encounter:
    corners = np.array([(mark.north, mark.east), *mark.waypoints])
    corners = corners[np.linalg.norm(corners - corners[0], axis=1) <= LARGEST_VIEW]
    first, last = np.searchsorted(run.track.times, (mark.time, mark.time + AHEAD), side="right")
    times, points = run.track.times[first - 1 : last], run.track.positions[first - 1 : last, :2]
    away = [np.linalg.norm(points - corner, axis=1) for corner in corners[1:]]
    end = max([mark.time, *(float(times[np.argmin(a)]) for a in away if len(a))])
    return Encounter(corners.min(0), corners.max(0), mark.time, end, decisions=[mark])


def _of_pass(p: Pass) -> Encounter:
    reach = p.hazard.radius
    low = np.minimum(p.other[:2] - reach, p.own[:2])
    high = np.maximum(p.other[:2] + reach, p.own[:2])
    return Encounter(low, high, p.time, p.time, passes=[p])


def ring(north: float, east: float, radius: float, corners: int = 72) -> Floats:
    """A closed circle as points north, east [m], shape (corners + 1, 2)."""
    angle = np.linspace(0.0, 2.0 * math.pi, corners + 1)
    return np.column_stack([north + radius * np.cos(angle), east + radius * np.sin(angle)])


def simplified(points: Floats, tolerance: float) -> Ints:
    """Indices of the points that a line needs to stay within `tolerance` of all of them.

    Parameters
    ----------
    points : (n, 2) array
        The line [m].
    tolerance : float
        Largest distance of a dropped point from the line that is left [m].

    Returns
    -------
    (k,) array
        Ascending, first and last point always included.

    Notes
    -----
    Ramer (1972), Douglas and Peucker (1973).
    """
    keep = np.zeros(len(points), dtype=np.bool_)
    keep[[0, -1]] = True
    spans = [(0, len(points) - 1)]
    while spans:
        first, last = spans.pop()
        if last - first < 2:
            continue
        between = points[first + 1 : last] - points[first]
        chord = points[last] - points[first]
        squared = float(chord @ chord)
        along = np.clip(between @ chord / squared, 0.0, 1.0) if squared else np.zeros(len(between))
        away = np.linalg.norm(between - along[:, None] * chord, axis=1)
        worst = int(np.argmax(away))
        if away[worst] > tolerance:
            middle = first + 1 + worst
            keep[middle] = True
            spans += [(first, middle), (middle, last)]
    return np.flatnonzero(keep)


def extremes(series: Sequence[Floats], buckets: int = 1200) -> Ints:
    """Indices that keep the least and greatest value of every series in each of `buckets` equal slices.

    Parameters
    ----------
    series : arrays of shape (n,)
        Drawn over the same abscissa.
    buckets : int
        Slices of the abscissa; at most 2 × len(series) × buckets + 2 indices come back.
    """
    size = len(series[0])
    if size <= 2 * buckets:
        return np.arange(size)
    edges = np.linspace(0, size, buckets + 1).astype(np.int64)
    chosen = [0, size - 1]
    for values in series:
        for first, last in pairwise(edges.tolist()):
            part = values[first:last]
            chosen += [first + int(np.argmin(part)), first + int(np.argmax(part))]
    return np.unique(np.array(chosen, dtype=np.int64))


def inside(points: Floats, low: Floats, high: Floats) -> list[Floats]:
    """The stretches of a line inside a rectangle, each with its neighbours outside, as (k, 2) arrays.

    Parameters
    ----------
    points : (n, 2) array
        The line, north and east [m]; rows of NaN are outside.
    low, high : (2,) arrays
        Opposite corners [m].
    """
    within = np.all((points >= low) & (points <= high), axis=1)
    known = np.isfinite(points[:, 0])
    wider = within.copy()
    wider[:-1] |= within[1:]
    wider[1:] |= within[:-1]
    edges = np.flatnonzero(np.diff(np.concatenate([[False], wider & known, [False]]).astype(np.int8)))
    return [points[a:b] for a, b in edges.reshape(-1, 2)]
