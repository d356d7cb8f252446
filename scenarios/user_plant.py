"""A user's own FMU as the own vehicle of a scenario: what is wrong with it, and the plant itself."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from avoidance import Performance
from scenarios.errors import Problem, ScenarioError
from scenarios.scenario import Point, Scenario

if TYPE_CHECKING:
    from fmu.mapped import MappedPlant
    from fmu.mapping import PlantMapping

KEY = "vehicle.plant"
FAR_FROM_START = 50.0
"""A plant must begin within this distance of the mission's first point [m], sideways as in height."""


def plant_problems(scenario: Scenario) -> list[Problem]:
    """Why a user's FMU cannot fly this scenario; nothing if none is asked for."""
    file = scenario.vehicle.plant
    if file is None:
        return []
    try:
        mapping = _mapping(file)
    except ScenarioError as error:
        return list(error.problems)
    problems = []
    limits = mapping.limits
    if limits is None:
        message = "has no [limits]: the avoidance must know how the aircraft turns and how fast it flies"
        return [Problem(KEY, str(file), message)]
    points = [point for member in scenario.fleet for point in member.mission]
    speeds = [scenario.vehicle.airspeed, *(p.speed for p in points if p.speed is not None)]
    for speed in speeds:
        if not limits.min_airspeed <= speed <= limits.max_airspeed:
            message = (
                f"the mission is flown at {speed:g} m/s; [limits] of the plant allow "
                f"{limits.min_airspeed:g} to {limits.max_airspeed:g}"
            )
            problems.append(Problem(KEY, str(file), message))
            break
    wind = scenario.wind
    if wind.turbulence != "none":
        message = f"turbulence cannot be given to a plant of your own; {wind.turbulence!r} is asked for"
        problems.append(Problem(KEY, str(file), message))
    if wind.speed > 0.0 and not {"wind.north", "wind.east"} <= set(mapping.command):
        message = "there is wind, and command.wind.north and command.wind.east are not mapped"
        problems.append(Problem(KEY, str(file), message))
    return problems


def user_plant(
    scenario: Scenario, start: Point, heading: float, acceptance_radius: float
) -> tuple[MappedPlant, Performance]:
    """The plant where the mission begins, in the scenario's wind, and what it can do.

    Raises
    ------
    ScenarioError
        If it cannot be put there.
    PlantError
        If the FMU fails.
    """
    from fmu.mapped import MappedPlant  # noqa: PLC0415

    settings, wind = scenario.vehicle, scenario.wind
    file = settings.plant
    if file is None:
        raise ValueError("scenario.vehicle.plant is None: there is no plant of the user's own")
    if problems := plant_problems(scenario):
        raise ScenarioError(scenario.name, problems)
    mapping = _mapping(file)
    if mapping.limits is None:  # told by plant_problems
        raise ScenarioError(file, "has no [limits]")
    place = {"north": start.north, "east": start.east, "altitude": start.altitude}
    try:
        plant = MappedPlant(mapping, initial=place | {"heading": heading, "airspeed": settings.airspeed})
    except ValueError as error:
        raise ScenarioError(file, f"the FMU refused to begin so: {error}") from error
    try:
        plant.set_wind(wind.north, wind.east)
        _begins_at(plant, start, file)
    except Exception:
        plant.close()
        raise
    limits = mapping.limits
    return plant, Performance(
        airspeed=settings.airspeed,
        max_bank=limits.max_bank,
        roll_time=limits.roll_time,
        acceptance_radius=acceptance_radius,
        tracking_error=limits.tracking_error,
        capture_distance=limits.capture_distance,
        wind_bound=wind.speed,
    )


def _mapping(file: Path) -> PlantMapping:
    """The mapping, checked against its FMU; every mistake is one of the scenario's key."""
    from fmu.errors import PlantError  # noqa: PLC0415
    from fmu.mapping import MappingError, load_mapping  # noqa: PLC0415

    try:
        return load_mapping(file)
    except MappingError as error:
        problems = [Problem(KEY, str(file), mistake) for mistake in error.mistakes]
        raise ScenarioError(file, problems) from error
    except PlantError as error:
        raise ScenarioError(file, [Problem(KEY, str(file), error.message)]) from error


def _begins_at(plant: MappedPlant, start: Point, file: Path) -> None:
    """Refuse a plant that begins somewhere else than the mission."""
    state = plant.state
    aside = math.hypot(state.north - start.north, state.east - start.east)
    if aside <= FAR_FROM_START and abs(state.altitude - start.altitude) <= FAR_FROM_START:
        return
    begins = f"({state.north:.0f}, {state.east:.0f}) m, {state.altitude:.0f} m up"
    message = (
        f"the FMU begins at {begins}, the mission at "
        f"({start.north:.0f}, {start.east:.0f}) m, {start.altitude:.0f} m up; map initial.north, .east and "
        ".altitude, or give it other start values"
    )
    raise ScenarioError(file, message)
