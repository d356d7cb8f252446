"""Fly an FMU alone, with fmpy as the importer: inputs from a CSV file, outputs to another."""

from __future__ import annotations

import contextlib
import csv
import io
import math
import os
import tempfile
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmu.cosimulation import read_description
from fmu.errors import PlantError
from fmu.parameters import load_aircraft


def simulate(
    fmu: Path,
    output: Path,
    *,
    inputs: Path | None = None,
    stop: float = 60.0,
    step: float = 0.1,
    aircraft: str | None = None,
    values: Sequence[str] = (),
    columns: Sequence[str] = (),
) -> int:
    """Fly and write the outputs; the file appears whole or not at all.

    Parameters
    ----------
    fmu, output : Path
        The FMU, and the CSV file to write.
    inputs : Path, optional
        CSV file: a column `time` [s] and one for each input, named as the variable, in SI units. Between two
        rows continuous inputs are interpolated; whole numbers change at the row.
    stop, step : float
        End and communication step [s].
    aircraft : str, optional
        Parameter set, over the FMU's own.
    values : sequence of str
        Start values, NAME=VALUE, over those.
    columns : sequence of str
        Outputs to write; all if none are named.

    Returns
    -------
    int
        Number of rows written.

    Raises
    ------
    ValueError
        If a file, a name or a value is unusable.
    PlantError
        If the model fails.
    """
    description = read_description(fmu)
    causality = {variable.name: variable.causality for variable in description.modelVariables}
    start: dict[str, Any] = dict(load_aircraft(aircraft)) if aircraft else {}
    start |= dict(_assignment(text, causality) for text in values)
    if unknown := [name for name in columns if name not in causality]:
        raise ValueError(f"--column {unknown[0]}: the FMU has no such variable")
    if not output.parent.is_dir():
        raise ValueError(f"{output}: no such folder")
    table = _inputs(inputs, causality) if inputs else None
    scalars = [
        variable.name
        for variable in description.modelVariables
        if variable.causality == "output" and not getattr(variable, "dimensions", ())
    ]
    result = _fly(fmu, description, start, table, columns or scalars, stop, step)
    _write(result, output)
    return len(result)


def _fly(
    fmu: Path,
    description: Any,  # noqa: ANN401  (fmpy has no types)
    start: dict[str, Any],
    table: Any,  # noqa: ANN401
    columns: Sequence[str],
    stop: float,
    step: float,
) -> Any:  # noqa: ANN401
    from fmpy import simulate_fmu  # noqa: PLC0415  (slow import)

    said: list[str] = []

    def remember(*arguments: Any) -> None:  # noqa: ANN401
        said.append(arguments[-1].decode("utf-8", "replace"))

    try:
        with contextlib.redirect_stdout(io.StringIO()):  # it tells of each input that keeps its start value
            return simulate_fmu(
                str(fmu),
                validate=False,
                stop_time=stop,
                output_interval=step,
                fmi_type="CoSimulation",
                start_values=start,
                input=table,
                output=list(columns),
                model_description=description,
                debug_logging=True,
                logger=remember,
            )
    except Exception as error:  # fmpy raises its own and the FMU's
        raise PlantError("simulate", 0.0, "Error", said[-1] if said else str(error)) from error


def _assignment(text: str, causality: Mapping[str, str]) -> tuple[str, float]:
    name, equals, number = text.partition("=")
    if not equals:
        raise ValueError(f"--set {text}: must be NAME=VALUE")
    if name not in causality:
        raise ValueError(f"--set {text}: the FMU has no variable {name!r}")
    try:
        return name, float(number)
    except ValueError as error:
        raise ValueError(f"--set {text}: {number!r} is no number") from error


def _inputs(file: Path, causality: Mapping[str, str]) -> NDArray[np.void]:
    """The input table as fmpy takes it: one named column each."""
    try:
        with file.open(newline="", encoding="utf-8") as stream:
            names, *rows = csv.reader(stream, skipinitialspace=True)
    except (OSError, UnicodeDecodeError, ValueError, csv.Error) as error:
        raise ValueError(f"{file}: no table with a header: {error}") from error
    if names[:1] != ["time"]:
        raise ValueError(f"{file}: the first column must be 'time', not {', '.join(names[:1])!r}")
    for name in names[1:]:
        if causality.get(name) != "input":
            raise ValueError(f"{file}: column {name!r} is no input of the FMU")
    numbers = []
    for line, row in enumerate(rows, 2):
        try:
            numbers.append(tuple(float(text) for text in row))
        except ValueError as error:
            raise ValueError(f"{file}, line {line}: {error}") from error
        if len(row) != len(names) or not all(math.isfinite(number) for number in numbers[-1]):
            raise ValueError(f"{file}, line {line}: must be {len(names)} finite numbers")
    if not numbers or any(b[0] < a[0] for a, b in pairwise(numbers)):
        raise ValueError(f"{file}: time must not go back, and one row at least is needed")
    return np.array(numbers, dtype=[(name, np.float64) for name in names])


def _write(result: NDArray[np.void], output: Path) -> None:
    """One row per communication point; every digit of each number."""
    names = result.dtype.names or ()
    handle, name = tempfile.mkstemp(dir=output.parent, prefix=f".{output.name}.")
    try:
        with os.fdopen(handle, "w", newline="", encoding="utf-8") as stream:
            writer = csv.writer(stream, lineterminator="\n")
            writer.writerow(names)
            writer.writerows([value.item() for value in row] for row in result)
        Path(name).chmod(0o644)
        Path(name).replace(output)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
