"""Mission waypoints that lie where nothing may fly, and what stands for them (Algorithm 4)."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from avoidance.fenced_space import nearest_within
from avoidance.free_space import nearest_free
from avoidance.geofence import FENCE, OPEN, Geofence, Walls
from avoidance.geometry import point_distances
from avoidance.known import Circles, Known
from avoidance.orbits import LEFT_ALONE, passage_room, waypoint_room
from avoidance.parameters import Parameters
from avoidance.types import Decision, Ownship, Performance, Replace, Route, Rung, Waypoint
from avoidance.words import replace_words


class Replacements:
    """Chooses the stand-ins of mission waypoints, and puts the waypoints back when it can.

    Parameters
    ----------
    performance : Performance
        What the vehicle can fly.
    parameters : Parameters
        Preset.
    geofence : Geofence, optional
        Bounds the stand-ins.
    """

    def __init__(self, performance: Performance, parameters: Parameters, geofence: Geofence = OPEN) -> None:
        self._geofence = geofence
        self._performance = performance
        self._parameters = parameters
        self._mission: dict[int, Waypoint] = {}
        self._reconsidered = 0
        self._wide: set[int | None] = set()

    def learn(self, route: Route) -> None:
        """Remember where the mission's own waypoints are, as uploaded last."""
        for waypoint in route.waypoints:
            if waypoint.item is not None and not waypoint.moved:
                self._mission[waypoint.item] = waypoint

    def decide(self, own: Ownship, route: Route, known: Known, version: int) -> Decision | None:
        """Move the first mission waypoint that is unsafe, or put back one that is not; None if all are well.

        Parameters
        ----------
        own, route, known
            The vehicle, what it is to fly, what it knows.
        version : int
            Changes when what is known does: stand-ins are chosen again only then.
        """
        if not (len(known.ids) or self._geofence.areas) and not any(w.moved for w in route.waypoints):
            return None
        room = self._waypoint_room()
        circles: dict[float, Circles] = {}
        for index, waypoint in enumerate(route.waypoints):
            if waypoint.item is None or (index == 0 and self._arriving(own, waypoint)):
                continue
            height = waypoint.altitude
            if height not in circles:
                circles[height] = known.circles(height, height)
            near = circles[height]
            distance = point_distances(near.centres, (waypoint.north, waypoint.east))
            unsafe = np.flatnonzero(distance < near.keep + room - LEFT_ALONE)
            unsafe = unsafe[np.argsort(distance[unsafe], kind="stable")]
            reconsider = waypoint.moved and self._reconsidered != version
            fenced = self._too_near_to_fence(waypoint, room)
            if not (len(unsafe) or reconsider or fenced):
                continue
            ids = tuple(dict.fromkeys([*known.ids[near.rows[unsafe]].tolist(), *([FENCE] if fenced else [])]))
            decision = self.move(own, route, near, index, ids)
            if decision is not None:
                return decision
        self._reconsidered = version
        return None

    def move(
        self, own: Ownship, route: Route, circles: Circles, index: int, ids: tuple[int, ...]
    ) -> Decision | None:
        """Decide on the stand-in for a mission waypoint: the nearest safe point that can be reached.

        None if there is no better one than what is flown to already.
        """
        waypoint = route.waypoints[index]
        original = self._mission.get(-1 if waypoint.item is None else waypoint.item, waypoint)
        here = (own.north, own.east)
        wide = circles.keep + (self._passage_room() if waypoint.item in self._wide else 0.0)
        passing = np.maximum(np.minimum(wide, point_distances(circles.centres, here) - 1.0), 0.0)
        place = (original.north, original.east)
        point = None
        for room in self._rooms():
            safe = circles.keep + room
            discs = (circles.centres, safe, np.minimum(passing, safe))
            if len(self._geofence.walls):
                fence = (self._geofence, self._parameters.margin, self._parameters.margin + room)
                point = nearest_within(place, here, *discs, *fence)
            else:
                point = nearest_free(place, here, *discs)
            if point is not None:
                break
        if point is None or math.dist(point, (waypoint.north, waypoint.east)) < 1.0:
            return None
        before = route.waypoints[:index]
        while before and before[-1].item is None:
            before = before[:-1]  # a detour towards the old place has lost its purpose
        back = math.dist(point, place) < 1e-6
        chosen = original if back else replace(original, north=point[0], east=point[1], moved=True)
        return Replace(
            why=replace_words(original, chosen, ids),
            route=(*before, chosen, *route.waypoints[index + 1 :]),
            waypoint=chosen,
            rung=Rung.WAYPOINT,
        )

    def ask_for_wide_ways(self, waypoint: Waypoint) -> bool:
        """From now on its stand-in must be reached through passages in which the vehicle can turn round.

        True if that is news.
        """
        if self._parameters.pop_up_room is None or waypoint.item in self._wide:
            return False
        self._wide.add(waypoint.item)
        return True

    def _too_near_to_fence(self, waypoint: Waypoint, room: float) -> bool:
        """True if a waypoint lies outside the geofence, or nearer to its edge than may be flown to."""
        place = np.array([[waypoint.north, waypoint.east]])
        if not len(self._geofence.walls):
            return False
        gap = float(Walls(self._geofence.walls).clearance(place, place)[0])
        return gap < self._parameters.margin + room - LEFT_ALONE or not self._geofence.allows(place)[0]

    def _waypoint_room(self) -> float:
        """Room beyond `keep` that a mission waypoint needs, so that it can be left again."""
        if not self._parameters.all_obstacles:
            return 0.0
        return waypoint_room(self._performance, self._parameters.margin)

    def _passage_room(self) -> float:
        """Room beyond `keep` that is needed on both sides of a way in, so that the vehicle can turn round."""
        return passage_room(self._performance, self._parameters.margin)

    def _arriving(self, own: Ownship, waypoint: Waypoint) -> bool:
        """True if the waypoint is reached within the next two seconds anyway."""
        distance = math.hypot(waypoint.north - own.north, waypoint.east - own.east)
        return distance < self._performance.acceptance_radius + 2.0 * own.ground_speed

    def _rooms(self) -> tuple[float, ...]:
        """Room beyond `keep` that a stand-in is given, most wanted first."""
        turn = self._performance.turn_room
        if self._parameters.all_obstacles:
            return (self._waypoint_room(), turn, 0.5 * turn)
        return (self._parameters.tolerance - self._parameters.margin, turn)
