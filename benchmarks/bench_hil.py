"""The plant in the loop: steps per second of one core against the scripted autopilots, and their split.

python benchmarks/bench_hil.py [--repeat 5] [--seconds 60]
"""

from __future__ import annotations

import argparse
import statistics

from offboard.hil.timing import PARTS
from scenarios.hil_self_test import TARGETS, SelfTest, fly_ardupilot, fly_px4
from scenarios.hil_setup import HilOptions, Rig

FLOWN = {"ardupilot": ("ArduPilot JSON, UDP", fly_ardupilot), "px4": ("PX4 simulator API, TCP", fly_px4)}


def measure(autopilot: str, seconds: float) -> SelfTest:
    """One self-test."""
    with Rig(HilOptions(autopilot=autopilot)) as rig:
        return FLOWN[autopilot][1](rig, seconds)


def main() -> None:
    """Print the table as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=60.0)
    arguments = parser.parse_args()
    print(f"| | steps/s (wanted) | {' | '.join(f'{part}' for part in PARTS)} |")
    print(f"|---|{'---|' * (len(PARTS) + 1)}")
    for autopilot, (name, _) in FLOWN.items():
        runs = [measure(autopilot, arguments.seconds) for _ in range(arguments.repeat)]
        rate = statistics.median(run.timing.steps / run.processor for run in runs)
        each = [
            statistics.median(100.0 * run.timing.seconds[part] / run.timing.total for run in runs)
            for part in PARTS
        ]
        cells = " | ".join(f"{share:.0f} %" for share in each)
        print(f"| {name} | {rate:,.0f} ({TARGETS[autopilot]:,.0f}) | {cells} |")


if __name__ == "__main__":
    main()
