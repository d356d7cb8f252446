"""`sidestep paper …`: the paper's tables and figures, made again."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from scenarios.command_errors import expected_errors

if TYPE_CHECKING:
    from scenarios.paper.worlds import Options


def paper(
    what: Annotated[
        str,
        typer.Argument(
            metavar="[WHAT]", help="table3 … table7, fig17 … fig32, all, or errata (a Markdown table)."
        ),
    ] = "all",
    *,
    runs: Annotated[
        int,
        typer.Option(min=1, max=10_000, help="Worlds of each row of Tables 3, 5, 6; searches of Table 7."),
    ] = 10,
    preset: Annotated[str, typer.Option(help="Avoidance: default, or paper (as printed).")] = "default",
    planner: Annotated[
        str | None,
        typer.Option(help="Flies Table 3 and the figures in PSO's place; one more row in the other tables."),
    ] = None,
    fidelity: Annotated[str, typer.Option(help="Aircraft model: 6dof or kinematic.")] = "6dof",
    jobs: Annotated[int | None, typer.Option(min=1, help="Processes; as many as cores if not given.")] = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Flights and pages are kept there.")
    ] = Path("sidestep-paper"),
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the figures as JSON and nothing else.")
    ] = False,
) -> None:
    """Make tables and figures of the paper again, beside what it prints.

    Flights are kept in DIR and not flown twice: a killed run continues where it stopped. `all` writes
    DIR/paper.html, a single table or figure a page of its own name.

    Exit codes: 0 made; 2 bad input; 3 the aircraft model failed; 130 interrupted, flights so far are kept.
    """
    from scenarios.compare_page import write_page  # noqa: PLC0415
    from scenarios.compare_store import Store, fly_all  # noqa: PLC0415
    from scenarios.paper.errata import errata_markdown  # noqa: PLC0415
    from scenarios.paper.experiment import ALL, ERRATA, jobs_of, sections_of, wanted  # noqa: PLC0415
    from scenarios.paper.page import page  # noqa: PLC0415
    from scenarios.paper.show import show  # noqa: PLC0415

    if what == ERRATA:
        typer.echo(errata_markdown(), nl=False)
        return
    with expected_errors("flights so far are kept; the same command continues"):
        options = _options(preset, planner, runs, fidelity)
        names = wanted(what)
        store = Store(output / "flights")
        records = fly_all(jobs_of(names, options), processes=jobs, store=store, title=f"paper {what}")
        sections = sections_of(names, options, records)
        path = output / f"{'paper' if what == ALL else what}.html"
        write_page(path, page(sections, options))
    if as_json:
        data = {section.name: section.data for section in sections}
        sys.stdout.write(json.dumps(data if what == ALL else data[what], indent=2) + "\n")
        return
    for section in sections:
        show(section)
    typer.echo(f"Open {path} in a browser: the same with the figures and the errata.")


def _options(preset: str, planner: str | None, runs: int, fidelity: str) -> Options:
    """The options, checked."""
    from scenarios.errors import ScenarioError  # noqa: PLC0415
    from scenarios.paper.worlds import Options  # noqa: PLC0415
    from scenarios.planners import planned_by  # noqa: PLC0415
    from scenarios.run import preset as preset_named  # noqa: PLC0415
    from scenarios.scenario import FIDELITIES  # noqa: PLC0415

    planned_by(preset_named(preset), planner)
    if fidelity not in FIDELITIES:
        raise ScenarioError("--fidelity", f"{fidelity!r} is unknown; known: {', '.join(FIDELITIES)}")
    return Options(preset, planner, runs, FIDELITIES[fidelity])
