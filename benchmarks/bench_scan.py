"""What a scan without a threat costs, beside the bare test of the route: a Markdown table.

Run from the repository's root: `python benchmarks/bench_scan.py`. The bare test is one vectorised
calculation of the distances of 100 obstacles from the route's legs. The scan is everything that happens
once a second: what the radar sees of the world, tracking, and the agent's decision to leave the route.
"""

from __future__ import annotations

import math
import time

import numpy as np

from avoidance import Ownship, Performance, Route, Waypoint
from avoidance.agent import Agent
from avoidance.geometry import segments_clearance
from avoidance.types import Floats
from offboard.link import VehicleState
from scenarios.radar import SimulatedRadar
from scenarios.scenario import OWN, Obstacle, RadarSettings
from scenarios.world import World

IN_VIEW = 100
SCANS = 300
LEGS = 8
SPEED = 15.0
PERFORMANCE = Performance(
    airspeed=SPEED, max_bank=0.5236, roll_time=1.3, acceptance_radius=100.0, tracking_error=5.0
)
ROUTE = tuple(Waypoint(5_000.0 * leg, 0.0, 200.0, item=leg) for leg in range(1, LEGS + 1))


def places(count: int) -> Floats:
    """Obstacles beside the route: the first 100 in the radar's view all the time, the others far away."""
    rng = np.random.default_rng(0)
    side = rng.choice([-1.0, 1.0], count) * rng.uniform(1_500.0, 5_000.0, count)
    near = np.stack([rng.uniform(4_500.0, 8_000.0, count), side], axis=1)
    angle, reach = rng.uniform(0.0, 2.0 * math.pi, count), rng.uniform(60_000.0, 300_000.0, count)
    far = reach[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.where(np.arange(count)[:, None] < IN_VIEW, near, far)


class StraightFlyer:
    """A vehicle that flies north."""

    finished = False

    def __init__(self) -> None:
        self._time = 0.0

    def state(self) -> VehicleState:
        """The latest state."""
        place = SPEED * self._time
        return VehicleState(Ownship(self._time, place, 0.0, 200.0, SPEED, 0.0, airspeed=SPEED))

    def advance(self, duration: float) -> None:
        """Fly on."""
        self._time += duration


def bare_ms() -> float:
    """The bare test [ms]."""
    corners = np.array([(0.0, 0.0), *((w.north, w.east) for w in ROUTE)])
    centres = places(IN_VIEW)
    required = np.full(IN_VIEW, 1050.0)
    spent = []
    for _ in range(SCANS):
        begun = time.perf_counter()
        (segments_clearance(corners[:-1], corners[1:], centres) < required).any()
        spent.append(time.perf_counter() - begun)
    return 1000.0 * float(np.median(spent))


def scan_ms(in_world: int) -> tuple[float, float]:
    """Median time of the radar's sweep and of the agent's decision about it [ms]."""
    obstacles = tuple(
        Obstacle(number, float(north), float(east), 200.0, safety_radius=1000.0)
        for number, (north, east) in enumerate(places(in_world))
    )
    flyer = StraightFlyer()
    world = World(obstacles, {OWN: flyer})
    radar = SimulatedRadar(world, RadarSettings(), np.random.default_rng(0))
    agent = Agent(PERFORMANCE)
    route = Route(Waypoint(0.0, 0.0, 200.0), ROUTE)
    swept, decided = [], []
    for _ in range(SCANS):
        state = flyer.state()
        begun = time.perf_counter()
        scan = radar.scan(state, world.now)
        middle = time.perf_counter()
        decision = agent.decide(state.ownship, route, scan)
        swept.append(middle - begun)
        decided.append(time.perf_counter() - middle)
        if decision.route is not None or len(scan.ids) != IN_VIEW:
            raise RuntimeError(f"a scan without a threat was to be timed, not {decision}")
        world.advance(1.0)
    return 1000.0 * float(np.median(swept)), 1000.0 * float(np.median(decided))


def main() -> None:
    """Print the table."""
    bare_ms(), scan_ms(IN_VIEW)
    bare = bare_ms()
    print(
        f"| in the world | sweep [ms] | decision [ms] | decision / bare test ({bare:.3f} ms) | sweep / bare |"
    )
    print("|---|---|---|---|---|")
    for count in (IN_VIEW, 100_000):
        sweep, decision = scan_ms(count)
        print(f"| {count:,} | {sweep:.3f} | {decision:.3f} | {decision / bare:.1f} | {sweep / bare:.1f} |")


if __name__ == "__main__":
    main()
