"""A stress campaign: many worlds flown by many processes, and the figures over them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from avoidance.types import Rung
from scenarios.cases import KINDS, Case, scenario_of
from scenarios.errors import RunDirectoryError, ScenarioError
from scenarios.scenario import Fidelity
from scenarios.statistics import Estimate, paired_ratio, wilson
from scenarios.toml_text import to_toml
from scenarios.trial import Outcome, attempt

if TYPE_CHECKING:
    from avoidance.parameters import Parameters

RUNGS = tuple(rung.name.lower() for rung in Rung if rung is not Rung.FREE)
"""Rungs of the ladder that change a route."""
RISKS = ("loss", "well_clear", "nmac")
"""Events whose risk ratio is given."""
LARGEST = 100_000
"""Most obstacles, and most runs."""


@dataclass(frozen=True, slots=True)
class Campaign:
    """What is flown."""

    kind: str
    """One of `cases.KINDS`."""
    counts: tuple[int, ...]
    """Obstacles of each field, or intruders of each encounter; one row of the table for each."""
    runs: int
    """Worlds per row."""
    seed: int
    """Decides all of them."""
    fidelity: Fidelity
    """Equations of motion."""
    parameters: Parameters
    """Of the avoidance core."""

    @property
    def cases(self) -> list[Case]:
        """All worlds, row by row."""
        return [Case(self.kind, count, self.seed, i) for count in self.counts for i in range(self.runs)]


@dataclass(frozen=True, slots=True)
class Row:
    """The figures over all runs with the same number of obstacles."""

    outcomes: tuple[Outcome, ...]
    """In the order of the runs, whoever finished first."""

    @property
    def obstacles(self) -> int:
        """Obstacles of each field, or intruders of each encounter."""
        return self.outcomes[0].case.obstacles

    @property
    def feasible(self) -> int:
        """How many runs could be flown at all."""
        return sum(o.feasible for o in self.outcomes)

    @property
    def successes(self) -> int:
        """How many of those were completed without a violation."""
        return sum(o.feasible and o.success for o in self.outcomes)

    @property
    def success(self) -> Estimate:
        """Share of the feasible runs, with its Wilson interval."""
        return wilson(self.successes, self.feasible)

    @property
    def clear(self) -> Estimate:
        """Share of all runs without a violation, with its Wilson interval."""
        return wilson(sum(o.violations == 0 and o.error is None for o in self.outcomes), len(self.outcomes))

    @property
    def rungs(self) -> dict[str, float | None]:
        """Share of each rung among the changes of the route for something in the way."""
        counts: Counter[str] = Counter()
        for outcome in self.outcomes:
            counts.update(outcome.rungs)
        total = sum(counts[name] for name in RUNGS)
        return {name: round(counts[name] / total, 4) if total else None for name in RUNGS}

    def per_run(self, name: str) -> float:
        """Mean of a count over all runs."""
        return float(np.mean([getattr(o, name) for o in self.outcomes]))

    def figures(self, name: str) -> list[float]:
        """A figure of all runs that have it; lengths only count where the mission was completed."""
        kept = (o for o in self.outcomes if o.success or name not in ("length_ratio", "added_path"))
        return [value for o in kept if (value := getattr(o, name)) is not None]

    def risk(self, event: str) -> Estimate:
        """Risk of an event with avoidance over that without, on the same worlds."""
        outcomes = [o for o in self.outcomes if o.error is None]
        if not KINDS[self.outcomes[0].case.kind].traffic and event != "loss":
            return Estimate(None, None, None)
        return paired_ratio(
            [getattr(o.events, event) for o in outcomes], [getattr(o.unmitigated, event) for o in outcomes]
        )

    @property
    def decision_ms(self) -> list[float]:
        """Wall times of all decisions that had a threat or changed the route [ms]."""
        return [value for outcome in self.outcomes for value in outcome.decision_ms]

    def as_json(self) -> dict[str, Any]:
        """One object of `--json`; null where a figure has no meaning."""
        first = self.outcomes[0].case
        added, lengths = self.figures("added_path"), self.figures("length_ratio")
        return {
            "kind": first.kind,
            "obstacles": first.obstacles,
            "runs": len(self.outcomes),
            "feasible": self.feasible,
            "successes": self.successes,
            "violations": sum(o.violations for o in self.outcomes),
            "min_separation_m": quantile(self.figures("min_separation"), 0.0, 3),
            "length_ratio_median": quantile(lengths, 50.0, 6),
            "length_ratio_p95": quantile(lengths, 95.0, 6),
            "added_path_pct": {"median": quantile(added, 50.0, 4), "p95": quantile(added, 95.0, 4)},
            "risk_ratio": {event: _estimate(self.risk(event)) for event in RISKS},
            "rungs": self.rungs,
            "replans_median": quantile(self.figures("replans"), 50.0, 1),
            "decision_ms": {
                "median": quantile(self.decision_ms, 50.0, 3),
                "p99": quantile(self.decision_ms, 99.0, 3),
            },
            "seed": first.seed,
        }


def run(campaign: Campaign, *, jobs: int | None = None, dask: str | None = None) -> Iterator[Outcome]:
    """Fly all worlds of a campaign; outcomes come as they are ready, in any order.

    Parameters
    ----------
    campaign : Campaign
        What is flown.
    jobs : int, optional
        Processes; one for each core if not given. One flies in this process.
    dask : str, optional
        Address of the scheduler of a Dask cluster, which then does the work.

    Raises
    ------
    ScenarioError
        If the cluster cannot be used.
    PlantError
        If the aircraft model does not load.
    """
    from joblib import Parallel, delayed  # noqa: PLC0415

    with ExitStack() as stack:
        if dask is not None:
            stack.enter_context(_cluster(dask))
        workers = Parallel(n_jobs=-1 if jobs is None else jobs, return_as="generator_unordered")
        task = delayed(attempt)
        yield from workers(task(case, campaign.fidelity, campaign.parameters) for case in campaign.cases)


def rows(outcomes: Iterable[Outcome]) -> list[Row]:
    """Outcomes put in order and gathered by number of obstacles."""
    ordered = sorted(outcomes, key=lambda o: (o.case.obstacles, o.case.index))
    counts = sorted({o.case.obstacles for o in ordered})
    return [Row(tuple(o for o in ordered if o.case.obstacles == count)) for count in counts]


def write_case(outcome: Outcome, campaign: Campaign, directory: Path) -> Path:
    """Write the world of one run as a scenario file that `sidestep fly` flies again; returns its path.

    Raises
    ------
    RunDirectoryError
        If it cannot be written.
    """
    scenario = scenario_of(outcome.case, campaign.fidelity, campaign.parameters)
    path = directory / f"{scenario.name}.toml"
    half = path.with_suffix(".part")
    try:
        directory.mkdir(parents=True, exist_ok=True)
        half.write_text(f"# {outcome.why}\n{to_toml(scenario)}", encoding="utf-8", newline="\n")
        half.replace(path)
    except OSError as error:
        raise RunDirectoryError(directory, f"cannot be written ({error})") from error
    return path


def quantile(values: Sequence[float], percent: float, digits: int) -> float | None:
    """Percentile of some figures; None of none."""
    return round(float(np.percentile(values, percent)), digits) if values else None


def _estimate(estimate: Estimate) -> dict[str, float | None]:
    values = {"value": estimate.value, "low": estimate.low, "high": estimate.high}
    return {name: None if value is None else round(value, 6) for name, value in values.items()}


def _cluster(address: str) -> AbstractContextManager[object]:
    """Everything that joblib does inside is done by a Dask cluster."""
    try:
        from dask.distributed import Client  # noqa: PLC0415
    except ImportError as error:
        message = "needs Dask on this machine and on the cluster: pip install 'sidestep[dask]'"
        raise ScenarioError("--dask", message) from error
    from joblib import parallel_config  # noqa: PLC0415

    stack = ExitStack()
    try:
        stack.enter_context(Client(address, timeout=10))
        stack.enter_context(parallel_config(backend="dask"))
    except (OSError, ValueError) as error:
        stack.close()
        raise ScenarioError("--dask", f"no cluster answers at {address} ({error})") from error
    return stack
