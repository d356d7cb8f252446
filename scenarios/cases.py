"""The worlds of a stress campaign: run i of seed S is the same world for ever."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from scenarios.encounters import encounter
from scenarios.load import load
from scenarios.scenario import Fidelity, RadarSettings, RandomField, Scenario, Turbulence, Wind, scatter

if TYPE_CHECKING:
    from avoidance.parameters import Parameters

FIELD = "random"
"""Catalogue scenario whose mission is flown through random fields."""
REACH = 20.0
"""Acceptance radius of every flight [m]: corners cut wide would flatter the flown length."""
MIXED_RADII = (300.0, 2000.0)
"""Safety radii of mixed fields [m]."""
MIXED_WIND = 8.0
"""Wind of mixed fields, from anywhere [m/s]."""
MIXED_TURBULENCE: Turbulence = "moderate"
NOISE = RadarSettings(range_noise=50.0, bearing_noise=math.radians(1.0), detection_probability=0.9)
"""The noisy radar."""


@dataclass(frozen=True, slots=True)
class Case:
    """Names one world."""

    kind: str
    """One of `KINDS`."""
    obstacles: int
    """Obstacles of a field, intruders of an encounter."""
    seed: int
    """Of the campaign."""
    index: int
    """Number of the run, from 0."""

    @property
    def name(self) -> str:
        """Says all of it, in a way that files can be named."""
        return f"{self.kind}-{self.obstacles}-seed{self.seed}-run{self.index}"


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of world."""

    number: int
    """Enters the random numbers, so it never changes."""
    words: str
    """What it is."""
    traffic: bool
    """True if the obstacles move."""
    counts: tuple[int, ...]
    """Obstacles or intruders, unless others are asked for."""
    draw: Callable[[int, np.random.Generator, Fidelity], Scenario]
    """Makes a world from number of obstacles, random generator and equations of motion."""


def scenario_of(case: Case, fidelity: Fidelity, parameters: Parameters) -> Scenario:
    """The world of a case, ready to be flown.

    Parameters
    ----------
    case : Case
        Which one; nothing else decides what is in the way.
    fidelity : {"kinematic", "6dof"}
        Equations of motion, also of intruders that the aircraft model can fly.
    parameters : Parameters
        The preset that the file is to name; the paper's keeps its own acceptance radius of 1 km.
    """
    kind = KINDS[case.kind]
    sequence = np.random.SeedSequence(entropy=case.seed, spawn_key=(kind.number, case.obstacles, case.index))
    world, flight = sequence.spawn(2)
    scenario = kind.draw(case.obstacles, np.random.default_rng(world), fidelity)
    reach = min(REACH, parameters.acceptance_radius) if parameters.all_obstacles else None
    return replace(
        scenario,
        name=case.name,
        seed=int(flight.generate_state(1)[0]),
        preset=parameters.name,
        planner=parameters.optimiser,
        vehicle=replace(scenario.vehicle, fidelity=fidelity, acceptance_radius=reach),
    )


def _static(count: int, rng: np.random.Generator, _fidelity: Fidelity) -> Scenario:
    base = load(FIELD)
    return scatter(replace(base, random=RandomField(count)), rng)


def _mixed(count: int, rng: np.random.Generator, _fidelity: Fidelity) -> Scenario:
    least, largest = MIXED_RADII
    field = RandomField(count, safety_radius=least, largest_safety_radius=largest)
    scenario = scatter(replace(load(FIELD), random=field), rng)
    angle = rng.uniform(-math.pi, math.pi)
    wind = Wind(
        round(MIXED_WIND * math.cos(angle), 3), round(MIXED_WIND * math.sin(angle), 3), MIXED_TURBULENCE
    )
    return replace(scenario, wind=wind)


def _moving(count: int, rng: np.random.Generator, fidelity: Fidelity) -> Scenario:
    return encounter(rng, load(FIELD).home, intruders=count, aircraft=fidelity == "6dof")


def _turning(count: int, rng: np.random.Generator, fidelity: Fidelity) -> Scenario:
    return encounter(rng, load(FIELD).home, intruders=count, aircraft=fidelity == "6dof", turning=True)


def _noise(count: int, rng: np.random.Generator, fidelity: Fidelity) -> Scenario:
    return replace(_moving(count, rng, fidelity), radar=NOISE)


KINDS: dict[str, Kind] = {
    "static": Kind(0, "obstacles of 1 km scattered about the waypoints", False, (10, 40, 70, 100), _static),
    "moving": Kind(1, "intruders at constant velocity, each would pass within 1 km", True, (1,), _moving),
    "mixed": Kind(2, "obstacles of 0.3 to 2 km, 8 m/s of gusty wind", False, (10, 40, 70, 100), _mixed),
    "turning": Kind(
        4, "intruders that turn on to a course that would pass within 1 km", True, (1,), _turning
    ),
    "noise": Kind(3, "intruders seen by a radar with noise and missed scans", True, (1,), _noise),
}
"""Kinds of worlds by name."""
