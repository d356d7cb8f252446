"""Does the vehicle fly where it says? Its ground track after an edit, against the line of that edit. Pure."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from avoidance import Ownship, Performance, Waypoint

SETTLE = 10.0
"""Time on top of the turn until the track must fit [s]."""
COURSE = math.radians(25.0)
"""A course this near to the direction of the target fits [rad]."""


class Fit(Enum):
    """What the ground track says."""

    OPEN = "open"
    ON = "on the line"
    OFF = "off the line"


@dataclass(frozen=True, slots=True)
class TrackCheck:
    """The line that is to be flown after an edit, and until when it must be seen."""

    target: Waypoint
    """Where it leads."""
    deadline: float
    """The track must fit by then [s]."""
    near: float
    """This near to the target nothing can be said [m]."""

    @classmethod
    def begin(
        cls, own: Ownship, target: Waypoint, performance: Performance, circle: float = 0.0
    ) -> TrackCheck:
        """The check of an edit that has just been confirmed; the target may have a circle about it [m]."""
        turn = abs(_turn(own, target)) * performance.turn_radius / max(performance.airspeed, 1.0)
        near = 2.0 * (performance.turn_radius + circle) + performance.acceptance_radius
        return cls(target, own.time + performance.roll_time + 1.5 * turn + SETTLE, near)

    def look(self, own: Ownship) -> Fit:
        """What the vehicle's present motion says."""
        away = math.hypot(self.target.north - own.north, self.target.east - own.east)
        if away < self.near or abs(_turn(own, self.target)) < COURSE:
            return Fit.ON
        return Fit.OFF if own.time > self.deadline else Fit.OPEN


def _turn(own: Ownship, target: Waypoint) -> float:
    """Angle from the course to the direction of a target, -π to π [rad]."""
    direction = math.atan2(target.east - own.east, target.north - own.north)
    return math.remainder(direction - own.course, 2.0 * math.pi)
