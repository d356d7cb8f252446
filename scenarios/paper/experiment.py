"""Which flights each table and figure needs, and how it is made of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial

from scenarios.compare_flight import Job, Record
from scenarios.errors import ScenarioError
from scenarios.paper import convergence, scenes, table3, table4, table6, table7
from scenarios.paper.section import Section
from scenarios.paper.worlds import Options, table4_job

Records = Mapping[str, Record]


@dataclass(frozen=True, slots=True)
class Target:
    """A table or figure."""

    jobs: Callable[[Options], list[Job]]
    """Its flights."""
    section: Callable[[Options, Records], Section]
    """Makes it of their records."""


def _no_flights(_: Options) -> list[Job]:
    return []


def _scene(name: str) -> Target:
    return Target(partial(scenes.jobs, name), partial(scenes.section, name))


def _path(name: str) -> Target:
    planner = table4.FIGURES[name]
    return Target(
        lambda options: [table4_job(options, planner)],
        lambda options, records: table4.figure_section(name, options, records),
    )


TARGETS: dict[str, Target] = {
    "table3": Target(table3.jobs, table3.section),
    "table4": Target(table4.jobs, table4.section),
    "table5": Target(table6.jobs, table6.table5),
    "table6": Target(table6.jobs, table6.table6),
    "table7": Target(_no_flights, lambda options, _: table7.section(options)),
    **{f"fig{n}": _scene(f"fig{n}") for n in range(17, 24)},
    "fig24": Target(_no_flights, lambda options, _: convergence.fig24(options)),
    "fig25": Target(_no_flights, lambda options, _: convergence.fig25(options)),
    **{f"fig{n}": _scene(f"fig{n}") for n in range(26, 29)},
    **{f"fig{n}": _path(f"fig{n}") for n in range(29, 33)},
}
"""Tables and figures by name, in the order of the page."""
ALL = "all"
ERRATA = "errata"


def wanted(name: str) -> list[str]:
    """The targets behind a name.

    Raises
    ------
    ScenarioError
        If there is no such table or figure; lists those there are.
    """
    if name == ALL:
        return list(TARGETS)
    if name not in TARGETS:
        known = "all, errata, table3 to table7, fig17 to fig32"
        raise ScenarioError("paper", f"{name!r} is neither a table nor a figure; known: {known}")
    return [name]


def jobs_of(names: Iterable[str], options: Options) -> list[Job]:
    """All flights that some targets need, each once."""
    every = {job.name: job for name in names for job in TARGETS[name].jobs(options)}
    return list(every.values())


def sections_of(names: Iterable[str], options: Options, records: Records) -> list[Section]:
    """The targets, made of the records of their flights."""
    return [TARGETS[name].section(options, records) for name in names]
