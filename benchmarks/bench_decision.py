"""Time of one decision with a threat, by obstacles known: medians as a Markdown table.

Run from the repository's root: `python benchmarks/bench_decision.py`. One obstacle blocks the leg, the
others stand about it as the seeds place them; last, a hill of 140 spheres that overlap.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from avoidance import Contact, Ownship, Performance, RadarScan, Route, Waypoint
from avoidance.agent import Agent
from avoidance.constraints import feasible_segments
from avoidance.flown import flown_segments

WORLDS = 60
PERFORMANCE = Performance(
    airspeed=15.0, max_bank=0.5236, roll_time=1.3, acceptance_radius=100.0, tracking_error=5.0
)


def heap(rng: np.random.Generator, obstacles: int) -> list[Contact]:
    """A hill of overlapping spheres across the leg."""
    places = rng.normal((7000.0, 0.0), (800.0, 1200.0), (obstacles, 2))
    return [Contact(number, float(north), float(east), 200.0) for number, (north, east) in enumerate(places)]


def field(rng: np.random.Generator, obstacles: int) -> list[Contact]:
    """One obstacle on the leg, the others beside it."""
    blocking = Contact(0, 8000.0, float(rng.uniform(-600.0, 600.0)), 200.0)
    contacts = [blocking]
    while len(contacts) < obstacles:
        north, east = rng.uniform(2500.0, 10_000.0), rng.uniform(-7000.0, 7000.0)
        if abs(east) > 1200.0:
            contacts.append(Contact(len(contacts), float(north), float(east), 200.0))
    return contacts


def decision_ms(
    seed: int,
    obstacles: int,
    *,
    overlapping: bool = False,
    clock: Callable[[], float] = time.perf_counter,
) -> float:
    """Time of the decision about one random world [ms]."""
    rng = np.random.default_rng(seed)
    contacts = (heap if overlapping else field)(rng, obstacles)
    agent = Agent(PERFORMANCE, rng=rng)
    route = Route(Waypoint(0.0, 0.0, 200.0), (Waypoint(40_000.0, 0.0, 200.0, item=0),))
    spent = 0.0
    for second in range(2):
        own = Ownship(float(second), 15.0 * second, 0.0, 200.0, 15.0, 0.0, airspeed=15.0)
        scan = RadarScan.of(float(second), contacts)
        begun = clock()
        decision = agent.decide(own, route, scan)
        spent = 1000.0 * (clock() - begun)
        if decision.route is not None:
            break
    return spent


def scan_ms(obstacles: int, intruders: int) -> float:
    """Median time of a scan without a threat [ms]: obstacles beside the route, traffic behind."""
    rng = np.random.default_rng(0)
    standing = [
        Contact(
            k,
            float(rng.uniform(0.0, 10_000.0)),
            float(rng.choice((-1, 1)) * rng.uniform(2500.0, 6000.0)),
            200.0,
        )
        for k in range(obstacles)
    ]
    agent = Agent(PERFORMANCE, rng=rng)
    route = Route(Waypoint(0.0, 0.0, 200.0), (Waypoint(40_000.0, 0.0, 200.0, item=0),))
    times = []
    for second in range(100):
        own = Ownship(float(second), 15.0 * second, 0.0, 200.0, 15.0, 0.0, airspeed=15.0)
        moving = [
            Contact(1000 + k, -4000.0 - 500.0 * k - 10.0 * second, 3000.0, 200.0) for k in range(intruders)
        ]
        scan = RadarScan.of(float(second), standing + moving)
        begun = time.perf_counter()
        agent.decide(own, route, scan)
        times.append(1000.0 * (time.perf_counter() - begun))
    return float(np.median(times))


def bare_test_ms(obstacles: int) -> float:
    """Median time of the bare vectorised test of a route against obstacles [ms]: the yardstick of a scan."""
    rng = np.random.default_rng(0)
    centres = rng.uniform(-6000.0, 10_000.0, (obstacles, 2))
    points = np.array([[[0.0, 0.0], [40_000.0, 0.0]]])
    times = []
    for _ in range(200):
        begun = time.perf_counter()
        starts, ends, extra = flown_segments(points, 0.0, PERFORMANCE)
        feasible_segments(starts, ends, extra, centres, np.full(obstacles, 1050.0))
        times.append(1000.0 * (time.perf_counter() - begun))
    return float(np.median(times))


def main() -> None:
    """Print the tables."""
    decision_ms(0, 5)  # imports and caches
    print("| obstacles known | median [ms] | p99 [ms] |")
    print("|---|---|---|")
    for count in (1, 5, 20, 50, 100):
        times = [decision_ms(seed, count) for seed in range(WORLDS)]
        print(f"| {count} | {np.median(times):.1f} | {np.percentile(times, 99):.1f} |")
    times = [decision_ms(seed, 140, overlapping=True) for seed in range(WORLDS)]
    print(f"| 140 overlapping | {np.median(times):.1f} | {np.percentile(times, 99):.1f} |")
    print()
    print("| scan without a threat | median [ms] |")
    print("|---|---|")
    print(f"| bare test of the route against 100 obstacles | {bare_test_ms(100):.2f} |")
    for obstacles, intruders in ((100, 0), (0, 1), (0, 8), (100, 1), (100, 8)):
        print(f"| {obstacles} known, {intruders} moving | {scan_ms(obstacles, intruders):.2f} |")


if __name__ == "__main__":
    main()
