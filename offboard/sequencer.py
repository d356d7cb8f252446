"""Leg sequencing: which waypoint is flown to, and from where the leg begins.

Pure functions on immutable values, shared by every simulated vehicle. The paper's leg change (Sec. 3.6,
Fig. 5): a leg ends when its end is nearer than the acceptance radius, or has been passed abeam. Differs
from the paper: E25, Eqs. (16)-(17) end a leg a second time, by the distance from its start, which is wrong
off the track.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from avoidance.types import Waypoint


@dataclass(frozen=True, slots=True)
class Target:
    """A waypoint of the mission as sequencing sees it."""

    waypoint: Waypoint
    """Where it is, map frame."""
    acceptance_radius: float
    """It counts as reached within this horizontal distance [m]."""
    airspeed: float
    """Airspeed on the leg to it [m/s]."""
    loiter_time: float = 0.0
    """How long to orbit there before going on [s]."""


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a mission has come."""

    current: int
    """Index of the target being flown to; the number of targets once all have been reached."""
    origin: Waypoint
    """Where the leg to it begins."""
    loiter_until: float | None = None
    """Time at which the orbit at the current target ends [s]; None while flying to it."""


def begin_leg(current: int, north: float, east: float, altitude: float) -> Progress:
    """Progress of a mission that flies from this position [m] straight to target `current`."""
    return Progress(current, Waypoint(north, east, altitude))


def advance(
    progress: Progress, targets: Sequence[Target], position: tuple[float, float, float], time: float
) -> Progress:
    """Progress after the vehicle has come to a position.

    Parameters
    ----------
    progress : Progress
        Progress so far.
    targets : sequence of Target
        The whole mission.
    position : tuple of float
        North, east, altitude [m].
    time : float
        Time of the position [s].

    Returns
    -------
    Progress
        `progress` itself as long as nothing changes (so `is` tells). Several targets can end in one call.

    Notes
    -----
    A leg begins at the target just left. If the vehicle is already past the new leg's end, or the leg has
    no length, it begins at the vehicle instead: so a waypoint is never taken for passed when its leg has
    only just begun, and a vehicle that follows the line always comes to the waypoint.
    """
    while progress.current < len(targets):
        target = targets[progress.current]
        if progress.loiter_until is not None:
            if time < progress.loiter_until:
                return progress
        elif not _reached(progress.origin, target, position):
            return progress
        elif target.loiter_time > 0.0:
            return Progress(progress.current, progress.origin, time + target.loiter_time)
        progress = next_leg(progress.current + 1, target.waypoint, targets, position)
    return progress


def _reached(origin: Waypoint, target: Target, position: tuple[float, float, float]) -> bool:
    """True within the acceptance radius of the target, or past the end of the leg."""
    north, east, _ = position
    end = target.waypoint
    return math.hypot(end.north - north, end.east - east) <= target.acceptance_radius or _past_end(
        origin, end, north, east
    )


def _past_end(origin: Waypoint, end: Waypoint, north: float, east: float) -> bool:
    """True if a position, projected on the leg, lies at or beyond its end."""
    leg_north = end.north - origin.north
    leg_east = end.east - origin.east
    return (north - end.north) * leg_north + (east - end.east) * leg_east >= 0.0


def next_leg(
    current: int, left: Waypoint, targets: Sequence[Target], position: tuple[float, float, float]
) -> Progress:
    """The leg from the target just left to the next, or from the vehicle if it is past that leg's end."""
    north, east, altitude = position
    if current < len(targets) and _past_end(left, targets[current].waypoint, north, east):
        return begin_leg(current, north, east, altitude)
    return Progress(current, left)
