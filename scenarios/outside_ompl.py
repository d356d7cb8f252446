"""A route among discs by a planner of OMPL, the Open Motion Planning Library (extra `bench`)."""

from __future__ import annotations

from typing import Any

import numpy as np

from avoidance.geometry import segment_point_distance
from avoidance.problem import WaypointProblem

Points = tuple[tuple[float, float], ...]

MOTION_CHECKS = 2000
"""Segments that may be tested in one search; a budget in time would make results depend on the machine."""
PADDING = 1.0
"""This much more is kept from every disc than must be [m]; turns are judged afterwards."""


def ompl_route(planner: str, problem: WaypointProblem, rng: np.random.Generator) -> tuple[Points | None, int]:
    """Waypoints between start and target, or None, and how many segments were tested.

    Parameters
    ----------
    planner : str
        Class in `ompl.geometric`.
    problem : WaypointProblem
        Only its ends and discs count.
    rng : numpy.random.Generator
        Seeds OMPL's own.
    """
    from ompl import base, geometric, util  # noqa: PLC0415

    util.setLogLevel(util.LogLevel.LOG_NONE)
    util.RNG.setSeed(int(rng.integers(1, 2**31)))
    checks = 0

    class Segments(base.MotionValidator):  # type: ignore[misc]
        """A segment is free if it keeps clear of every disc, in closed form."""

        def checkMotion(self, first: Any, second: Any, *_rest: object) -> bool:  # noqa: ANN401, N802
            nonlocal checks
            checks += 1
            gap = segment_point_distance((first[0], first[1]), (second[0], second[1]), problem.centres)
            return bool((gap >= problem.keep + PADDING).all())

    space = _space(base, problem)
    information = base.SpaceInformation(space)
    information.setStateValidityChecker(lambda state: _free(problem, state))
    information.setMotionValidator(Segments(information))
    information.setup()
    definition = base.ProblemDefinition(information)
    definition.setStartAndGoalStates(_state(space, problem.start), _state(space, problem.target))
    definition.setOptimizationObjective(base.PathLengthOptimizationObjective(information))
    search = getattr(geometric, planner)(information)
    search.setProblemDefinition(definition)
    search.setup()
    search.solve(base.PlannerTerminationCondition(lambda: checks >= MOTION_CHECKS))
    if not definition.hasExactSolution():
        return None, checks
    path = definition.getSolutionPath()
    geometric.PathSimplifier(information).reduceVertices(path)
    return tuple((float(s[0]), float(s[1])) for s in path.getStates()[1:-1]), checks


def _space(base: Any, problem: WaypointProblem) -> Any:  # noqa: ANN401 (OMPL has no types)
    """The plane about the leg."""
    space = base.RealVectorStateSpace(2)
    bounds = base.RealVectorBounds(2)
    reach = 2.0 * problem.parameters.search_limit
    for axis, ends in enumerate(zip(problem.start, problem.target, strict=True)):
        bounds.setLow(axis, min(ends) - reach)
        bounds.setHigh(axis, max(ends) + reach)
    space.setBounds(bounds)
    return space


def _state(space: Any, place: tuple[float, float]) -> Any:  # noqa: ANN401
    state = space.allocState()
    state[0], state[1] = place
    return state


def _free(problem: WaypointProblem, state: Any) -> bool:  # noqa: ANN401
    away = problem.centres - np.array((state[0], state[1]))
    return bool((np.hypot(away[:, 0], away[:, 1]) >= problem.keep + PADDING).all())
