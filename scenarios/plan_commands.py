"""`sidestep plan …`: missions as files."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from scenarios.command_errors import expected_errors

app = typer.Typer(
    name="plan",
    help="Missions as files: QGroundControl .plan, QGC WPL 110, scenarios.",
    no_args_is_help=True,
    rich_markup_mode=None,
)


@app.callback()
def _plan() -> None:
    """Missions as files: QGroundControl .plan, QGC WPL 110, scenarios."""


@app.command()
def convert(
    source: Annotated[
        str, typer.Argument(metavar="FROM", help="A .plan, a WPL file, a .toml, or a scenario's name.")
    ],
    target: Annotated[
        Path, typer.Argument(metavar="TO", help=".plan, .waypoints (WPL) or .toml; the ending decides.")
    ],
) -> None:
    """Write a mission in another form.

    Nothing of a .plan or WPL file is lost in its own form; what another form has no place for is named.

    Exit codes: 0 written; 2 it cannot be read or written.
    """
    from offboard.errors import OffboardError  # noqa: PLC0415
    from scenarios.errors import ScenarioError  # noqa: PLC0415
    from scenarios.plan_convert import convert as run  # noqa: PLC0415

    with expected_errors():
        try:
            lost = run(source, target)
        except OffboardError as error:
            raise ScenarioError(source, _without(str(error), source)) from error
    for text in lost:
        typer.echo(f"sidestep: not written to {target}: {text}", err=True)
    typer.echo(str(target))


def _without(message: str, prefix: str) -> str:
    """A message without the file that stands before it anyway."""
    return message.removeprefix(f"{prefix}: ")
