"""Ways round that lead into a passage too narrow to turn round in."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from avoidance import Decision, Rung
from avoidance.ladder import Plan
from avoidance.parameters import DEFAULT
from avoidance.passages import Gap, way_with_orbits
from avoidance.problem import WaypointProblem
from avoidance.route_check import first_blocked_leg
from avoidance.search import search_waypoint
from tests.avoidance.test_contingency import corridor
from tests.avoidance.test_route_check import known
from tests.avoidance.worlds import PERFORMANCE, ownship, route

INTO = ((1500.0, 0.0), (5000.0, 0.0))
"""Waypoints before a corridor 120 m wide and in it."""


def way_on(target: float, *, moving: bool) -> tuple[Gap, Decision | None]:
    """Where the planner proposes the corridor, to a target in it or behind it [m]."""
    own, way = ownship(east=-1500.0), route((target, 0.0), origin=(0.0, -1500.0))
    around = known(corridor(60.0), own, way)
    blocked = first_blocked_leg(own, way, around, PERFORMANCE)
    assert blocked is not None
    blocked = replace(blocked, threat=replace(blocked.threat, moving=moving))
    gap = Gap.of(own, way, around, blocked, PERFORMANCE, DEFAULT)

    def planner(problem: WaypointProblem, rng: np.random.Generator) -> Plan:
        return Plan(Rung.ROUTE, INTO, search_waypoint(problem, rng))

    return gap, way_with_orbits(gap, planner, np.random.default_rng(0))


@pytest.mark.parametrize("moving", [False, True])
def test_a_way_outside_a_narrow_passage_is_taken_instead(moving: bool) -> None:
    gap, found = way_on(13_000.0, moving=moving)
    assert found is not None
    assert min(abs(east) for _, east in gap.taken(found)) > 1060.0


def test_where_there_is_none_it_is_entered_to_evade_traffic_alone() -> None:
    gap, found = way_on(8000.0, moving=True)
    assert found is not None
    assert gap.taken(found) == INTO
    assert way_on(8000.0, moving=False)[1] is None
