"""The options of `sidestep fly` that change the scenario before it is flown."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from scenarios.check import wind_problems
from scenarios.errors import ScenarioError
from scenarios.scenario import FIDELITIES, TURBULENCES, Scenario
from scenarios.user_plant import plant_problems

T = TypeVar("T")


def changed(
    scenario: Scenario,
    *,
    wind: str | None = None,
    turbulence: str | None = None,
    fidelity: str | None = None,
    plant: Path | None = None,
) -> Scenario:
    """The scenario with what the options say; None leaves a thing as it is.

    Parameters
    ----------
    scenario : Scenario
        As loaded.
    wind : str, optional
        Steady wind towards north and east [m/s], such as "3,-4".
    turbulence : str, optional
        none, light, moderate or severe.
    fidelity : str, optional
        Equations of motion of the own vehicle.
    plant : Path, optional
        Mapping of a user's own FMU.

    Raises
    ------
    ScenarioError
        With the option, its value and what is allowed.
    """
    if wind is not None:
        north, east = _two_numbers(wind)
        scenario = replace(scenario, wind=replace(scenario.wind, north=north, east=east))
        if problems := wind_problems(scenario):
            raise ScenarioError("--wind", problems)
    if turbulence is not None:
        word = _known("--turbulence", turbulence, TURBULENCES)
        scenario = replace(scenario, wind=replace(scenario.wind, turbulence=word))
    if fidelity is not None:
        chosen = _known("--fidelity", fidelity, FIDELITIES)
        scenario = replace(scenario, vehicle=replace(scenario.vehicle, fidelity=chosen))
    if plant is not None:
        scenario = replace(scenario, vehicle=replace(scenario.vehicle, plant=plant.resolve()))
    if scenario.vehicle.plant is not None and (problems := plant_problems(scenario)):
        raise ScenarioError("--plant" if plant else scenario.name, problems)
    return scenario


def _known(option: str, value: str, values: Mapping[str, T]) -> T:
    if value not in values:
        raise ScenarioError(option, f"{value!r} is unknown; known: {', '.join(values)}")
    return values[value]


def _two_numbers(text: str) -> tuple[float, float]:
    try:
        north, east = (float(part) for part in text.split(","))
    except ValueError as error:
        raise ScenarioError("--wind", f"{text!r} must be two numbers with a comma, such as 3,-4") from error
    if not (math.isfinite(north) and math.isfinite(east)):
        raise ScenarioError("--wind", f"{text!r} must be two finite numbers")
    return north, east
