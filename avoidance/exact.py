"""The exact planner in the swarm's place: the shortest route at once, instead of as the rescue."""

from __future__ import annotations

import numpy as np

from avoidance.exact_route import exact_route
from avoidance.ladder import Plan, way_round
from avoidance.problem import WaypointProblem
from avoidance.types import Floats, Rung, Search

NAME = "exact"
"""What the planner is called."""


def exact_way(problem: WaypointProblem, rng: np.random.Generator) -> Plan | None:
    """The shortest route of several waypoints; where there is none, or traffic is in it, the ladder's way.

    Parameters
    ----------
    problem : WaypointProblem
        What is asked; the constraints on single waypoints (g1, g2, g4) do not hold for routes.
    rng : numpy.random.Generator
        For the ladder.
    """
    return exact_plan(problem) or way_round(problem, rng)


def exact_plan(problem: WaypointProblem, room: Floats | float = 0.0) -> Plan | None:
    """The shortest route of several waypoints, or None where there is none that traffic leaves free.

    It keeps `room` more from each obstacle, as of `exact_route` [m].
    """
    route = exact_route(problem, room=room)
    if route is None or problem.separation_shortfall(route) > 0.0:
        return None
    search = Search(
        start=problem.start,
        target=problem.target,
        centres=problem.centres,
        radii=problem.keep,
        planner=NAME,
        evaluations=1,
        problem=problem,
    )
    return Plan(Rung.ROUTE, route, search)
