"""Short real flights for tests: the aircraft model, the avoidance core, everything."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from scenarios.hangar import Hangar
from scenarios.load import parse
from scenarios.run import Flight, Flown, prepare, preset
from scenarios.scenario import Scenario
from scenarios.score import Score, score

ENCOUNTER = """
name = "encounter"
obstacles = [
    {id = 1, north_m = 6000.0, east_m = 200.0, safety_radius_m = 800.0},
    {id = 2, north_m = 12000.0, east_m = 6000.0, appears_at_s = 400.0, kind = "pop-up"},
]
[vehicle]
fidelity = "kinematic"
[[traffic]]
id = 9
motion = "point"
speed_m_s = 30.0
starts_at_s = 50.0
waypoints = [{north_m = 3000.0, east_m = 9000.0}, {north_m = -3000.0, east_m = 9000.0}]
[[mission]]
north_m = 0.0
east_m = 0.0
[[mission]]
north_m = 12000.0
east_m = 0.0
"""
ON_A_WAYPOINT = """
obstacles = [{north_m = 8000.0, east_m = 0.0}]
vehicle = {fidelity = "kinematic"}
mission = [{north_m = 0.0, east_m = 0.0}, {north_m = 8000.0, east_m = 0.0}]
"""


def flown(
    scenario: Scenario, *, seed=0, preset_name="default", avoidance=True, frames=None
) -> tuple[Flown, Score]:
    """Fly a scenario, or its first frames only."""
    parameters = preset(preset_name)
    with Hangar(scenario, parameters) as hangar:
        flight = Flight(
            prepare(scenario, seed), hangar, seed=seed, parameters=parameters, avoidance=avoidance
        )
        for number, _ in enumerate(flight, start=1):
            if number == frames:
                break
        result = flight.result()
    return result, score(result)


@cache
def encounter(fidelity="kinematic", avoidance=True) -> tuple[Flown, Score]:
    """Twelve kilometres with an obstacle on the leg, a pop-up and traffic beside it."""
    scenario = parse(ENCOUNTER)
    scenario = replace(scenario, vehicle=replace(scenario.vehicle, fidelity=fidelity))
    return flown(scenario, avoidance=avoidance)
