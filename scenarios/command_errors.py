"""Exit codes of the commands, and expected errors as one message each."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import typer

OK, UNSAFE, BAD_INPUT, FAILED, INTERRUPTED = 0, 1, 2, 3, 130


@contextlib.contextmanager
def expected_errors(interrupted: str = "nothing was written") -> Iterator[None]:
    """Expected errors become one message on stderr and an exit code."""
    from fmu.errors import FmuError  # noqa: PLC0415
    from offboard.errors import InputError, OffboardError  # noqa: PLC0415
    from scenarios.errors import RunDirectoryError, ScenarioError  # noqa: PLC0415

    try:
        yield
    except (ScenarioError, RunDirectoryError, InputError) as error:
        typer.echo(f"sidestep: {error}", err=True)
        raise typer.Exit(BAD_INPUT) from error
    except (FmuError, OffboardError) as error:
        typer.echo(f"sidestep: {error}", err=True)
        raise typer.Exit(FAILED) from error
    except KeyboardInterrupt as error:
        typer.echo(f"sidestep: interrupted, {interrupted}", err=True)
        raise typer.Exit(INTERRUPTED) from error
