"""The paper's rules fly whatever the catalogue holds: to an end, and to an honest verdict."""

from __future__ import annotations

from dataclasses import replace

import pytest

from avoidance.parameters import PAPER
from scenarios.load import load
from scenarios.score import score
from scenarios.trial import aircraft_model, fly_through


@pytest.mark.parametrize("name", ["single", "unsafe-waypoint", "l-hill", "pop-up", "fence", "head-on"])
def test_a_flight_by_the_papers_rules_ends_and_is_judged(name: str) -> None:
    """The cheapest of the catalogue; the others stand in docs/scenarios.md, by benchmarks/paper_preset.py."""
    scenario = load(name)
    scenario = replace(scenario, vehicle=replace(scenario.vehicle, fidelity="kinematic"))
    flown = fly_through(scenario, PAPER, aircraft_model(), avoidance=True)
    judged = score(flown)
    assert flown.ending in ("finished", "time limit")
    assert len(judged.fates) == len(scenario.mission)
    met = flown.ending == "finished" and all(fate.met for fate in judged.fates)
    entered = any(near.entries for near in judged.separations)
    assert judged.safe == (met and not entered)
