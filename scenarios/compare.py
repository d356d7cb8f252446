"""Planners side by side on one scenario: the same worlds flown by each, and the figures over them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from avoidance.parameters import Parameters
from scenarios.compare_flight import Job, Record
from scenarios.planners import PLANNERS, planned_by
from scenarios.run import prepare
from scenarios.scenario import Scenario
from scenarios.statistics import Estimate, wilson


@dataclass(frozen=True, slots=True)
class Row:
    """The figures of one planner over all its runs; medians are over the runs that were safe."""

    planner: str
    """One of `PLANNERS`."""
    records: tuple[Record, ...]
    """In the order of the runs."""

    @property
    def safe(self) -> Estimate:
        """Share of the runs completed without entering a sphere, with its Wilson interval."""
        return wilson(sum(record["safe"] for record in self.records), len(self.records))

    def median(self, key: str, digits: int = 3) -> float | None:
        """Median of a figure of the summary."""
        return _median([record["summary"][key] for record in self._safe()], digits)

    @property
    def length_ratio(self) -> float | None:
        """Flown length over the shortest safe one, median."""
        pairs = [(r["summary"]["path_length_m"], r["summary"]["optimum_length_m"]) for r in self._safe()]
        return _median([flown / best for flown, best in pairs if best], 6)

    @property
    def least_margin(self) -> float | None:
        """Least distance from any sphere over all runs [m]; negative inside."""
        margins = [r["summary"]["min_margin_m"] for r in self.records]
        return min((m for m in margins if m is not None), default=None)

    def per_search(self, key: str, digits: int) -> float | None:
        """Mean of a figure over all searches that have it."""
        values = [s[key] for record in self.records for s in record["searches"] if s[key] is not None]
        return round(float(np.mean(values)), digits) if values else None

    @property
    def gap(self) -> float | None:
        """Median `search_gap` of the waypoints found."""
        values = [s["gap"] for record in self.records for s in record["searches"] if s["gap"] is not None]
        return _median(values, 9)

    @property
    def decision_ms(self) -> float | None:
        """Median wall time of a decision [ms]."""
        return _median([value for record in self.records for value in record["decision_ms"]], 3)

    def as_json(self) -> dict[str, Any]:
        """One object of `--json`; null where a figure has no meaning."""
        return {
            "planner": self.planner,
            "runs": len(self.records),
            "safe": sum(record["safe"] for record in self.records),
            "success": {"value": self.safe.value, "low": self.safe.low, "high": self.safe.high},
            "violations": sum(record["summary"]["violations"] for record in self.records),
            "min_margin_m": self.least_margin,
            "plan_length_m": self.median("plan_length_m"),
            "path_length_m": self.median("path_length_m"),
            "length_ratio": self.length_ratio,
            "replans": self.median("replans", 1),
            "first_feasible": self.per_search("first_feasible", 2),
            "evaluations": self.per_search("evaluations", 1),
            "search_gap": self.gap,
            "decision_ms": self.decision_ms,
        }

    def _safe(self) -> list[Record]:
        return [record for record in self.records if record["safe"]]


def jobs_of(scenario: Scenario, parameters: Parameters, planners: Sequence[str], runs: int) -> list[Job]:
    """Every planner on every world; run i has the scenario's seed + i, and with it its random obstacles.

    Raises
    ------
    ScenarioError
        If a planner is unknown or not installed.
    """
    flown_by = {name: planned_by(parameters, name) for name in planners}
    jobs = []
    for run in range(runs):
        seed = scenario.seed + run
        world = prepare(replace(scenario, seed=seed, preset=parameters.name), seed)
        for name, chosen in flown_by.items():
            label = f"{scenario.name}-{seed}-{name}"
            jobs.append(Job(label, replace(world, planner=name), chosen, gaps=True))
    return jobs


def rows(records: Mapping[str, Record], planners: Sequence[str]) -> list[Row]:
    """Records gathered by planner."""
    every = list(records.values())
    return [Row(name, tuple(r for r in every if r["planner"] == name)) for name in planners]


COLUMNS: tuple[tuple[str, str], ...] = (
    ("planner", "who finds the ways round"),
    ("flown safely", "runs, share and 95 % Wilson interval"),
    ("least margin", "distance from the nearest sphere, all runs"),
    ("plan", "final waypoints, median"),
    ("flown ÷ shortest", "of the shortest safe way, median"),
    ("changes", "of the route in a run, median"),
    ("CS", "iteration with all constraints met, mean"),
    ("gap", "of waypoints to the best there is, median"),
    ("decision", "wall time, median"),
)
"""Heading of each column of the table, and what it means."""


def cells(row: Row) -> list[str]:
    """One line of the table."""
    safe, found = row.safe, sum(record["safe"] for record in row.records)
    low, high = 100.0 * (safe.low or 0.0), 100.0 * (safe.high or 0.0)
    return [
        PLANNERS[row.planner],
        f"{found} of {len(row.records)} [{low:.0f}, {high:.0f}] %",
        _cell(row.least_margin, ",.1f", " m"),
        _cell(row.median("plan_length_m"), ",.1f", " m"),
        _cell(row.length_ratio, ".5f"),
        _cell(row.median("replans", 1), ".1f"),
        _cell(row.per_search("first_feasible", 2), ".2f"),
        _cell(row.gap, ".6f"),
        _cell(row.decision_ms, ".1f", " ms"),
    ]


def _cell(value: float | None, form: str, unit: str = "") -> str:
    return "–" if value is None else f"{value:{form}}{unit}"


def _median(values: Sequence[float], digits: int) -> float | None:
    return round(float(np.median(values)), digits) if values else None
