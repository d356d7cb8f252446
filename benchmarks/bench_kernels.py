"""How much of a decision compiled kernels could save: its processor time, and what is left without them.

Run from the repository's root: `python benchmarks/bench_kernels.py`. The kernels are the tests and costs of
candidates, the curves they stand on, and the tangent graph's arrays and search; what is left is the work
around them, which a compiler of numerical functions does not see.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from bench_decision import decision_ms

from avoidance.problem import WaypointProblem
from avoidance.seed_curves import Curves
from avoidance.tangent_graph import _Graph

WORLDS = 40
REPEATS = 3
KERNELS: tuple[tuple[type, tuple[str, ...]], ...] = (
    (WaypointProblem, ("_on_the_way", "waypoint_violation", "leg_violation", "cost", "rank")),
    (Curves, ("corners", "pierced", "crossings", "beside")),
    (_Graph, ("add", "search")),
)


class Stopwatch:
    """Sums the processor time spent in functions; one called by another counts once."""

    def __init__(self) -> None:
        self.milliseconds = 0.0
        self._inside = False

    def around(self, function: Callable[..., object]) -> Callable[..., object]:
        """The function, watched."""

        def watched(*values: object, **named: object) -> object:
            if self._inside:
                return function(*values, **named)
            self._inside, begun = True, time.process_time()
            try:
                return function(*values, **named)
            finally:
                self.milliseconds += 1000.0 * (time.process_time() - begun)
                self._inside = False

        return watched


def least(watch: Stopwatch, seed: int, obstacles: int) -> tuple[float, float]:
    """Time of one decision and what is left of it without the kernels [ms]: the quickest of several."""
    found = []
    for _ in range(REPEATS):
        watch.milliseconds = 0.0
        spent = decision_ms(seed, obstacles, overlapping=obstacles == 140, clock=time.process_time)
        found.append((spent, spent - watch.milliseconds))
    return min(found)


def main() -> None:
    """Print the table."""
    watch = Stopwatch()
    for owner, names in KERNELS:
        for name in names:
            setattr(owner, name, watch.around(getattr(owner, name)))
    print("| obstacles known | median [ms] | without kernels [ms] | kernels' share |")
    print("|---|---|---|---|")
    for obstacles in (1, 20, 100, 140):
        times = np.array([least(watch, seed, obstacles) for seed in range(WORLDS)])
        whole, left = np.median(times, axis=0)
        share = 100.0 * (1.0 - times[:, 1].sum() / times[:, 0].sum())
        print(f"| {obstacles} | {whole:.1f} | {left:.1f} | {share:.0f} % |", flush=True)


if __name__ == "__main__":
    main()
