"""The options of `sidestep stress`, checked together."""

from __future__ import annotations

from scenarios.cases import KINDS
from scenarios.errors import Problem, ScenarioError
from scenarios.planners import planned_by
from scenarios.run import preset as preset_named
from scenarios.scenario import FIDELITIES
from scenarios.stress import LARGEST, Campaign


def campaign_of(
    kind: str,
    obstacles: str | None,
    runs: int,
    seed: int,
    vehicle: str,
    preset: str,
    planner: str | None,
    jobs: int | None,
    dask: str | None,
) -> Campaign:
    """The campaign that the options describe.

    Raises
    ------
    ScenarioError
        With every mistake.
    """
    problems = []
    if kind not in KINDS:
        problems.append(Problem("--kind", kind, f"is unknown; known: {', '.join(KINDS)}"))
    if vehicle not in FIDELITIES:
        problems.append(Problem("--vehicle", vehicle, f"is unknown; known: {', '.join(FIDELITIES)}"))
    counts = _counts(obstacles)
    least = 1 if kind in KINDS and KINDS[kind].traffic else 0
    if counts is None or any(not least <= count <= LARGEST for count in counts):
        message = f"must be whole numbers from {least} to {LARGEST:,} with commas between, such as 10,40"
        problems.append(Problem("--obstacles", obstacles, message))
    if jobs is not None and dask is not None:
        problems.append(Problem("--jobs", jobs, "cannot be given with --dask, whose cluster decides"))
    if problems:
        raise ScenarioError("stress", problems)
    return Campaign(
        kind=kind,
        counts=counts or KINDS[kind].counts,
        runs=runs,
        seed=seed,
        fidelity=FIDELITIES[vehicle],
        parameters=planned_by(preset_named(preset), planner),
    )


def _counts(text: str | None) -> tuple[int, ...] | None:
    """Each number once, in rising order; empty if none are asked for, None if they cannot be read."""
    if text is None:
        return ()
    try:
        return tuple(sorted({int(part) for part in text.split(",")}))
    except ValueError:
        return None
