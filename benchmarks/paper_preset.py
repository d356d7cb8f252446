"""Every scenario of the catalogue flown by the paper's rules: what becomes of it, as a Markdown table.

Run from the repository's root: `python benchmarks/paper_preset.py`, or with names of scenarios. The paper's
rules promise nothing; the table shows that every flight comes to an end and is judged.
"""

from __future__ import annotations

import sys
import time
from dataclasses import replace
from importlib.resources import files

from avoidance.parameters import PAPER
from scenarios.load import load
from scenarios.run import prepare
from scenarios.score import score
from scenarios.trial import aircraft_model, fly_through


def row(name: str) -> str:
    """One scenario, flown on the kinematic model and judged."""
    scenario = prepare(load(name), 0)
    scenario = replace(scenario, vehicle=replace(scenario.vehicle, fidelity="kinematic"))
    begun = time.process_time()
    flown = fly_through(scenario, PAPER, aircraft_model(), avoidance=True)
    spent = time.process_time() - begun
    judged = score(flown)
    summary = judged.summary
    margin = summary["min_margin_m"]
    entered = summary["violations"] or summary.get("fence_breaches")
    verdict = "safe" if judged.safe else "unsafe" if entered else "not completed"
    return (
        f"| `{name}` | {verdict} | {summary['violations']} | {'–' if margin is None else f'{margin:.0f}'} "
        f"| {summary['replans']} | {summary['flight_time_s'] / 3600.0:.2f} | {spent:.0f} |"
    )


def main() -> None:
    """Print the table."""
    catalogue = sorted(p.name.removesuffix(".toml") for p in (files("scenarios") / "catalogue").iterdir())
    print(
        "| scenario | verdict | spheres entered | least margin [m] | replans | flight [h] | processor [s] |"
    )
    print("|---|---|---|---|---|---|---|")
    for name in sys.argv[1:] or catalogue:
        print(row(name), flush=True)


if __name__ == "__main__":
    main()
