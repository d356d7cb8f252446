"""Time the exact planner: `python benchmarks/bench_tangent_graph.py` prints a Markdown table."""

from __future__ import annotations

import math
import platform
import statistics
import time
from collections.abc import Callable
from functools import partial

import numpy as np

from avoidance.free_space import connected, nearest_free
from avoidance.tangent_graph import shortest_path
from avoidance.types import Floats

WORLDS = {
    "clear way, 20 discs": (20, 20_000.0, 10.0),
    "20 discs in view (10 km radar)": (20, 20_000.0, 1_000.0),
    "20 discs, crowded": (20, 12_000.0, 1_000.0),
    "100 overlapping discs": (100, 12_000.0, 1_000.0),
    "140 overlapping discs": (140, 14_000.0, 1_000.0),
    "140 overlapping discs, spread": (140, 20_000.0, 1_000.0),
}
"""Name: number of discs, side of the square they are drawn from [m], radius [m]."""


def problems(count: int, side: float, radius: float, number: int, seed: int) -> list[tuple[Floats, Floats]]:
    """Start and goal, and centres, of random worlds crossed from side to side."""
    rng = np.random.default_rng(seed)
    ends = np.array([(-side / 2.0 - 1.5 * radius, 0.0), (side / 2.0 + 1.5 * radius, 0.0)])
    return [(ends, rng.uniform(-side / 2.0, side / 2.0, (count, 2))) for _ in range(number)]


def milliseconds(task: Callable[[], object]) -> float:
    """Wall time of one call, the best of three [ms]."""
    times = []
    for _ in range(3):
        begin = time.perf_counter()
        task()
        times.append(time.perf_counter() - begin)
    return min(times) * 1e3


def main() -> None:
    """Print one row for each kind of world."""
    print(f"Python {platform.python_version()}, numpy {np.__version__}, {platform.machine()}\n")
    print("| world | shortest path, median [ms] | p95 [ms] | connected [ms] | nearest free [ms] |")
    print("|---|---|---|---|---|")
    for name, (count, side, radius) in WORLDS.items():
        number = 100 if count <= 20 else 20
        columns: tuple[list[float], list[float], list[float]] = ([], [], [])
        for (start, goal), centres in problems(count, side, radius, number, seed=1):
            radii = np.full(count, radius)
            safe, target = radii + math.sqrt(radius), np.zeros(2)
            columns[0].append(milliseconds(partial(shortest_path, start, goal, centres, radii)))
            columns[1].append(milliseconds(partial(connected, start, goal, centres, radii)))
            columns[2].append(milliseconds(partial(nearest_free, target, start, centres, safe, radii)))
        middle = [statistics.median(column) for column in columns]
        tail = float(np.percentile(columns[0], 95))
        print(f"| {name} | {middle[0]:.2f} | {tail:.2f} | {middle[1]:.2f} | {middle[2]:.2f} |")


if __name__ == "__main__":
    main()
