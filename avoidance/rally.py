"""Rally points: places to wait at, chosen by whoever planned the mission, where no way on is free."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from avoidance.conflicts import first_conflict
from avoidance.contingency import first_trap
from avoidance.geometry import segments_clearance
from avoidance.known import Known
from avoidance.orbits import WIDE, orbit_reach
from avoidance.parameters import Parameters
from avoidance.route_check import Blocked, first_blocked_leg
from avoidance.types import Floats, Hold, Ownship, Performance, Route, Rung, Waypoint
from avoidance.words import threat_words


class Rally:
    """Finds the rally point to wait at.

    Parameters
    ----------
    points : sequence of Waypoint
        All of them, in the order of the mission's list.
    performance : Performance
        What the vehicle can fly.
    parameters : Parameters
        What is to be kept.

    Notes
    -----
    As the autopilots do on a return, the nearest is taken; other than with them its way and its circle must
    be free. The way is tested as the rest of a route is, and no sphere may lie nearer to the straight line
    than the room to turn: after turning round, guidance flies to the circle, not back on to that line
    (measured on both fidelities: up to 2.1 turn radii beside it).
    """

    def __init__(self, points: Sequence[Waypoint], performance: Performance, parameters: Parameters) -> None:
        self._points = tuple(points)
        self._performance = performance
        self._parameters = parameters

    @property
    def radius(self) -> float:
        """Of the circle about a rally point [m]."""
        return WIDE * self._performance.turn_radius

    def nearest(self, own: Ownship, known: Known) -> Waypoint | None:
        """The nearest rally point that can be flown to and circled about; None if there is none."""
        ordered = sorted(self._points, key=lambda p: math.hypot(p.north - own.north, p.east - own.east))
        return next((point for point in ordered if self.free(own, point, known)), None)

    def free(self, own: Ownship, point: Waypoint, known: Known, *, flown: bool = False) -> bool:
        """True if a rally point can be flown to and circled about; `flown` for one that is on the way to."""
        low, high = sorted((own.altitude, point.altitude))
        circles = known.circles(low, high)
        here, centre = np.array([[own.north, own.east]]), np.array([[point.north, point.east]])

        def room(begin: Floats) -> float:
            """Least distance of the segment from a point to the centre, from spheres and walls [m]."""
            spheres = segments_clearance(begin, centre, circles.centres)[0] - circles.hard
            return min(float(known.walls.clearance(begin, centre)[0]), float(spheres.min(initial=math.inf)))

        if room(centre) < self.radius + orbit_reach(self._performance, WIDE):
            return False
        if np.hypot(*(centre - here)[0]) <= 2.0 * self.radius:
            return True
        aside = self.radius if flown else self._performance.turn_room
        if room(here) < aside + 2.0 * self._performance.tracking_error:
            return False
        return not self._blocked(
            own, Route(Waypoint(own.north, own.east, own.altitude), (point,)), known, flown
        )

    def at(self, own: Ownship, point: Waypoint) -> bool:
        """True if the vehicle is where it waits at a rally point: on the circle, or turning on to it."""
        away = math.hypot(point.north - own.north, point.east - own.east)
        return away <= self.radius + orbit_reach(self._performance, WIDE)

    def words(self, own: Ownship, point: Waypoint) -> str:
        """Where the vehicle is to wait."""
        away = math.hypot(point.north - own.north, point.east - own.east)
        far = "" if self.at(own, point) else f", {away / 1e3:.1f} km from here"
        return f"wait at rally point {self._points.index(point) + 1}{far}"

    def hold(self, own: Ownship, point: Waypoint, blocked: Blocked) -> Hold:
        """Fly to a rally point and wait there."""
        return Hold(
            why=f"{threat_words(blocked.threat)}; no way round is known, {self.words(own, point)}",
            threat=blocked.threat,
            rung=Rung.ORBIT,
            centre=point,
            radius=self.radius,
            direction=1,
        )

    def _blocked(self, own: Ownship, way: Route, known: Known, flown: bool) -> bool:
        performance = self._performance
        slack = 1.0 if flown else 0.0
        return (
            first_blocked_leg(own, way, known, performance, slack=slack) is not None
            or first_trap(own, way, known, performance, self._parameters) is not None
            or first_conflict(own, way, known, performance, resuming=not flown) is not None
        )
