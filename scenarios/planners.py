"""Every planner by name, and how a flight is flown by it."""

from __future__ import annotations

from dataclasses import replace

from avoidance.exact import NAME as EXACT
from avoidance.exact import exact_way
from avoidance.ladder import Way, way_round
from avoidance.parameters import Parameters
from avoidance.search import OPTIMISERS
from scenarios.errors import ScenarioError
from scenarios.outside import OUTSIDE, outside_way, solver

PLANNERS: dict[str, str] = {
    "pso": "PSO",
    "gcpso": "GCPSO",
    "mpso": "MPSO",
    "ga": "GA",
    "sa": "SA",
    "theta-mafoa": "θ-MAFOA (our reading)",
    EXACT: "exact planner",
    "pyswarms": "pyswarms",
    "scipy-de": "scipy differential evolution",
    "ompl-rrtstar": "OMPL RRT*",
    "ompl-bitstar": "OMPL BIT*",
}
"""Title of each planner by the name that users give."""


def planned_by(parameters: Parameters, name: str | None) -> Parameters:
    """Parameters with another planner.

    Parameters
    ----------
    parameters : Parameters
        A preset.
    name : str or None
        One of `PLANNERS`; None leaves the preset's.

    Raises
    ------
    ScenarioError
        If it is unknown, or not installed.
    """
    if name is None:
        return parameters
    if name not in PLANNERS:
        raise ScenarioError("--planner", f"{name!r} is unknown; known: {', '.join(PLANNERS)}")
    if name in OUTSIDE:
        solver(name)
    return replace(parameters, optimiser=name)


def way_of(parameters: Parameters) -> tuple[Parameters, Way]:
    """What the core is told, and what finds its ways: single waypoints by the ladder, all else as itself."""
    name = parameters.optimiser
    if name in OPTIMISERS:
        return parameters, way_round
    way = exact_way if name == EXACT else outside_way(name)
    return replace(parameters, optimiser="pso"), way
