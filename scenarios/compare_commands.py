"""`sidestep compare`: planners side by side on any scenario."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from scenarios.command_errors import UNSAFE, expected_errors

if TYPE_CHECKING:
    from collections.abc import Sequence

    from scenarios.compare import Row


def compare(
    scenario: Annotated[
        str, typer.Argument(help="Name from `sidestep list`, or the path of a .toml file.")
    ] = "table4",
    *,
    planners: Annotated[
        str, typer.Option(metavar="A,B,…", help="Who is compared; `sidestep compare --list` names all.")
    ] = "pso,ga,sa,theta-mafoa,exact",
    runs: Annotated[int, typer.Option(min=1, max=10_000, help="Worlds; seeds count up from --seed.")] = 1,
    seed: Annotated[int | None, typer.Option(min=0, help="Of the first run; else the scenario's.")] = None,
    obstacles: Annotated[
        int | None, typer.Option(metavar="N", min=0, max=100_000, help="How many 'random' draws.")
    ] = None,
    preset: Annotated[str | None, typer.Option(help="default or paper; else the scenario's.")] = None,
    fidelity: Annotated[str | None, typer.Option(help="6dof or kinematic; else the scenario's.")] = None,
    jobs: Annotated[int | None, typer.Option(min=1, help="Processes; as many as cores if not given.")] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="Also write a page with a map."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the rows as JSON and nothing else.")] = False,
    names: Annotated[bool, typer.Option("--list", help="List the planners and exit.")] = False,
) -> None:
    """Fly the same worlds by several planners and put their figures side by side.

    Exit codes: 0 every flight was safe; 1 some were not; 2 bad input; 3 the aircraft model failed;
    130 interrupted.
    """
    from dataclasses import replace  # noqa: PLC0415

    from scenarios import run  # noqa: PLC0415
    from scenarios.compare import jobs_of, rows  # noqa: PLC0415
    from scenarios.compare_page import comparison_page, write_page  # noqa: PLC0415
    from scenarios.compare_store import fly_all  # noqa: PLC0415
    from scenarios.errors import ScenarioError  # noqa: PLC0415
    from scenarios.load import load  # noqa: PLC0415
    from scenarios.planners import PLANNERS  # noqa: PLC0415
    from scenarios.scenario import FIDELITIES  # noqa: PLC0415

    if names:
        for name, words in PLANNERS.items():
            typer.echo(f"{name:<14}{words}")
        return
    with expected_errors():
        chosen = load(scenario)
        wanted = list(dict.fromkeys(name.strip() for name in planners.split(",")))
        parameters = run.preset(preset or chosen.preset)
        if fidelity is not None:
            if fidelity not in FIDELITIES:
                raise ScenarioError("--fidelity", f"{fidelity!r} is unknown; known: {', '.join(FIDELITIES)}")
            chosen = replace(chosen, vehicle=replace(chosen.vehicle, fidelity=FIDELITIES[fidelity]))
        if obstacles is not None:
            run.prepare(chosen, 0, obstacles=obstacles)
            if chosen.random is not None:
                chosen = replace(chosen, random=replace(chosen.random, count=obstacles))
        chosen = replace(chosen, seed=chosen.seed if seed is None else seed)
        planned = jobs_of(chosen, parameters, wanted, runs)
        found = rows(fly_all(planned, processes=jobs, title=chosen.name), wanted)
        if output is not None:
            write_page(output, comparison_page(chosen, found))
    if as_json:
        sys.stdout.write(json.dumps([row.as_json() for row in found], indent=2) + "\n")
    else:
        _table(found, chosen.name, parameters.name)
        if output is not None:
            typer.echo(f"Open {output} in a browser.")
    safe = all(record["safe"] for row in found for record in row.records)
    raise typer.Exit(0 if safe else UNSAFE)


def _table(rows: Sequence[Row], name: str, preset: str) -> None:
    from rich.console import Console  # noqa: PLC0415
    from rich.table import Table  # noqa: PLC0415

    from scenarios.compare import COLUMNS, cells  # noqa: PLC0415

    console = Console()
    if not console.is_terminal:
        console.width = 170  # a file or a pipe has no width of its own
    runs = len(rows[0].records)
    console.print(f"{name}, preset {preset}, {runs} run{'' if runs == 1 else 's'} each", style="bold")
    table = Table(box=None, pad_edge=False)
    for number, (heading, _) in enumerate(COLUMNS):
        table.add_column(heading, justify="left" if number == 0 else "right", no_wrap=number == 0)
    for row in rows:
        table.add_row(*cells(row))
    console.print(table, highlight=False)
    for heading, meaning in COLUMNS[1:]:
        console.print(f"  {heading}: {meaning}", style="dim", highlight=False)
