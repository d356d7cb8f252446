"""`sidestep fmu …`: build, look at, check and fly the aircraft's FMUs on their own."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fmu.check import Finding

OK, FOUND, BAD_INPUT, BROKEN = 0, 1, 2, 3

app = typer.Typer(
    name="fmu",
    help="The aircraft as FMUs (FMI 3.0 and 2.0): build, look at, check, fly alone.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

Files = Annotated[
    list[Path] | None, typer.Argument(metavar="[FMU]...", help="FMU files; the built ones if not given.")
]


@app.command()
def build(
    *,
    everywhere: Annotated[
        bool, typer.Option("--all", help="For Linux, Windows and macOS at once; needs ziglang.")
    ] = False,
    encounter: Annotated[
        Path | None,
        typer.Option("--ssp", metavar="FILE", help="Also write an encounter of two aircraft as SSP."),
    ] = None,
) -> None:
    """Compile the model and pack both FMUs; prints where they lie.

    Exit codes: 0 built; 3 not built.
    """
    from fmu.build import main  # noqa: PLC0415

    code = main(["--all"] if everywhere else [])
    if code == OK and encounter is not None:
        from fmu.ssp import write_encounter  # noqa: PLC0415

        with _errors():
            typer.echo(str(write_encounter(encounter)))
    raise typer.Exit(code)


@app.command()
def info(
    files: Files = None,
    *,
    variables: Annotated[
        bool, typer.Option("--variables", help="Print every variable, as Markdown, and nothing else.")
    ] = False,
) -> None:
    """Print where the FMUs lie and what is in them.

    Exit codes: 0 shown; 2 no such file; 3 no FMU.
    """
    from fmu.contents import contents, variable_tables  # noqa: PLC0415
    from fmu.parameters import aircraft_names  # noqa: PLC0415

    if variables:
        typer.echo(variable_tables(), nl=False)
        return
    with _errors():
        for file in _chosen(files):
            typer.echo(str(file.resolve()))
            for name, text in contents(file).items():
                typer.echo(f"  {name:<12}{text}")
        typer.echo(f"Parameter sets: {', '.join(aircraft_names())}")


@app.command()
def check(
    files: Files = None,
    *,
    nesc: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Folder of NASA's reference trajectories.")
    ] = None,
) -> None:
    """Check the FMUs: schema, trims, twin, determinism, NASA's cases; one table.

    Exit codes: 0 nothing wrong; 1 something failed; 2 no such file; 3 it does not load.
    """
    from fmu.check import FAILED  # noqa: PLC0415
    from fmu.check import check as run  # noqa: PLC0415
    from fmu.nesc import DATA  # noqa: PLC0415

    with _errors():
        chosen = _chosen(files)
        if nesc is not None and not nesc.is_dir():
            raise ValueError(f"--nesc {nesc}: no such folder")
        findings = list(run(chosen, nesc or DATA))
    for file in chosen:
        typer.echo(str(file.resolve()))
    _table(findings)
    raise typer.Exit(FOUND if any(each.verdict == FAILED for each in findings) else OK)


@app.command()
def simulate(
    fmu: Annotated[Path | None, typer.Argument(help="FMU file; the built FMI 3.0 one if not given.")] = None,
    *,
    inputs: Annotated[
        Path | None,
        typer.Option("-i", "--input", metavar="CSV", help="Inputs over time: `time` and variables' names."),
    ] = None,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="CSV", help="What is written.")] = Path(
        "flight.csv"
    ),
    stop: Annotated[float, typer.Option(min=0.001, max=1e6, help="Until when [s].")] = 60.0,
    step: Annotated[float, typer.Option(min=0.0001, max=3600.0, help="Communication step [s].")] = 0.1,
    aircraft: Annotated[
        str | None, typer.Option(help="Parameter set: a name, or the path of a TOML file.")
    ] = None,
    values: Annotated[
        list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Start value; may be repeated.")
    ] = None,
    columns: Annotated[
        list[str] | None,
        typer.Option("--column", metavar="NAME", help="Only these outputs; may be repeated."),
    ] = None,
) -> None:
    """Fly an FMU alone: inputs from a CSV file, outputs to another.

    Exit codes: 0 flown; 2 bad input; 3 the model failed.
    """
    from fmu.alone import simulate as run  # noqa: PLC0415

    with _errors():
        file = _chosen([fmu] if fmu else None)[0]
        rows = run(
            file,
            output,
            inputs=inputs,
            stop=stop,
            step=step,
            aircraft=aircraft,
            values=values or (),
            columns=columns or (),
        )
    typer.echo(f"{rows} rows written to {output}")


def _chosen(files: Sequence[Path] | None) -> Sequence[Path]:
    """The files given, or the ones that have been built."""
    from fmu.check import packaged  # noqa: PLC0415
    from fmu.errors import PlantError  # noqa: PLC0415

    if files:
        if missing := [str(file) for file in files if not file.is_file()]:
            raise ValueError(f"no such file: {', '.join(missing)}")
        return files
    if not (built := packaged()):
        raise PlantError("load", 0.0, "missing", "no FMU has been built; run `sidestep fmu build`")
    return built


def _table(findings: Sequence[Finding]) -> None:
    """Print the findings; red is what failed."""
    from rich.console import Console  # noqa: PLC0415
    from rich.table import Table  # noqa: PLC0415

    colours = {"passed": "green", "FAILED": "bold red", "skipped": "yellow"}
    table = Table(box=None, pad_edge=False)
    table.add_column("FMU", no_wrap=True)
    table.add_column("check", no_wrap=True)
    table.add_column("result", no_wrap=True)
    table.add_column("what was seen (limit)")
    for each in findings:
        verdict = f"[{colours[each.verdict]}]{each.verdict}[/]"
        table.add_row(each.fmu, each.check, verdict, each.detail.replace("[", r"\["))
    counts = {word: sum(each.verdict == word for each in findings) for word in colours}
    console = Console()
    if not console.is_terminal:
        console.width = 140  # a file or a pipe has no width of its own
    console.print(table, highlight=False)
    console.print(", ".join(f"{count} {word}" for word, count in counts.items()), highlight=False)


@contextlib.contextmanager
def _errors() -> Iterator[None]:
    """Expected errors become one message on stderr and an exit code."""
    from fmu.errors import AircraftError, FmuError  # noqa: PLC0415

    try:
        yield
    except (ValueError, AircraftError) as error:
        typer.echo(f"sidestep: {error}", err=True)
        raise typer.Exit(BAD_INPUT) from error
    except (FmuError, OSError) as error:
        typer.echo(f"sidestep: {error}", err=True)
        raise typer.Exit(BROKEN) from error
