"""The two presets: the paper as printed, and the best we can build."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal


@dataclass(frozen=True, slots=True)
class SwarmSettings:
    """Coefficients of a particle swarm (Eqs. 28-30, Table 2)."""

    particles: int = 20
    """Swarm size N."""
    iterations: int = 30
    """Most iterations I."""
    inertia_start: float = 0.73
    """w of Eq. 30 in the first iteration."""
    inertia_end: float = 0.35
    """w of Eq. 30 in the last iteration."""
    cognitive: float = 1.5
    """C1, the pull towards a particle's own best."""
    social: float = 1.5
    """C2, the pull towards the swarm's best."""
    largest_step: float = 800.0
    """Velocity bound per axis [m] (Algorithm 9 with alpha = 0.1: 0.1 x 2 x 4 km)."""
    shared_best: bool = False
    """True: the personal best is the iteration's one best, as Fig. 16 prints it (erratum E28)."""
    stop_change: float = 1e-5
    """Stop when the best changes by less than this ..."""
    stop_iterations: int = 2
    """... in as many iterations running; in one, where the rules have found the best already."""


@dataclass(frozen=True, slots=True)
class Parameters:
    """Everything the core can be tuned by. Distances in metres, angles in radians."""

    name: str = "default"
    """Name of the preset."""
    safety_radius: float = 1000.0
    """RS of an obstacle whose sensor does not know better."""
    tolerance: float = 1000.0
    """New waypoints keep RS + tolerance (g1, Eq. 7)."""
    search_limit: float = 4000.0
    """New waypoints lie within this distance of what they avoid (g2, Eq. 8)."""
    margin: float = 15.0
    """The flown curve keeps RS + margin from every known obstacle (g3), more if the vehicle needs more
    (`avoidance.known.kept_margin`): 17 m at a turn radius of 42 m."""
    hysteresis: float = 10.0
    """A route is left alone until it comes this much nearer than RS + margin."""
    turn_limit: float | None = None
    """Largest heading change at a new waypoint (g4 as printed); None tests if the turn can be flown."""
    all_obstacles: bool = True
    """g1 holds for every known obstacle, not only for those being avoided."""
    path_weight: float = 0.1
    """W_t of Eq. 6."""
    risk_weight: float = 0.9
    """W_o of Eq. 6."""
    risk_distance: float = 3000.0
    """MXRSK of Eqs. 4-5."""
    risk_squared_metres: bool = False
    """f2 in square metres as printed; else dimensionless, the sum of squared relative intrusions."""
    pop_up_room: float | None = 1000.0
    """Whatever is new is first seen with its sphere no nearer than this [m]: an orbit in free space is always
    kept within it. None does without one."""
    memory: bool = True
    """Obstacles once seen stay known; else only those of the current scan are."""
    range_sigma: float = 0.0
    """Standard deviation of the radar's range, as specified."""
    bearing_sigma: float = 0.0
    """Standard deviation of the radar's bearing, as specified."""
    link_distance: float = 1000.0
    """Obstacles nearer to one another than this are one hill (Algorithm 3)."""
    acceptance_radius: float = 100.0
    """A waypoint counts as reached within this distance."""
    guidance: Literal["l1", "paper"] = "l1"
    """Lateral guidance law the vehicle is to fly."""
    moving_radius: float = 1000.0
    """d: entering this distance from a moving obstacle is a violation."""
    moving_margin: float = 30.0
    """h: kept on top of d, and on top of the doubt about a prediction."""
    wrong_side: float = 150.0
    """A detour that leaves on its right who has the right of way must be shorter by this [m]."""
    reaction_distance: float = math.inf
    """Moving obstacles further away than this are watched, not avoided."""
    predict: bool = True
    """Moving obstacles are extrapolated; else their present position is taken as a stationary one."""
    worth_relaxing: float = 20.0
    """A waypoint that keeps the tolerance (g1) gives way to one nearer the obstacles that is shorter by more
    than this."""
    worth_route: float = 60.0
    """A single waypoint gives way to a route of several that is shorter by more than this."""
    optimiser: str = "pso"
    """Name of the planner of single waypoints."""
    swarm: SwarmSettings = field(default_factory=SwarmSettings)
    """Coefficients of the swarm."""
    rule_seeds: bool = True
    """Seed the search with tangent and circle intersections; else with points about the sphere (Eq. 27)."""


DEFAULT = Parameters()

PAPER = Parameters(
    name="paper",
    margin=30.0,
    turn_limit=math.radians(30.0),
    all_obstacles=False,
    risk_distance=2000.0,
    risk_squared_metres=True,
    memory=False,
    acceptance_radius=1000.0,
    guidance="paper",
    moving_radius=2000.0,
    moving_margin=0.0,
    reaction_distance=8000.0,
    predict=False,
    worth_relaxing=math.inf,
    worth_route=math.inf,
    pop_up_room=None,
    swarm=SwarmSettings(
        particles=10,
        iterations=30,
        inertia_start=0.09,
        inertia_end=0.02,
        cognitive=2.0,
        social=2.0,
        shared_best=True,
        stop_change=200.0,
        stop_iterations=5,
    ),
    rule_seeds=False,
)
"""The paper as printed, repaired only where it cannot work (errata E16-E29)."""

PRESETS: dict[str, Parameters] = {"default": DEFAULT, "paper": PAPER}
