"""What is in an FMU file, in words: for a user who has just been given it."""

from __future__ import annotations

import zipfile
from collections import Counter
from pathlib import Path

from fmu.cosimulation import read_description
from fmu.emit import starts
from fmu.rows import Variable
from fmu.units import UNITS
from fmu.variables import TABLE
from fmu.views import VIEWS

_HEADINGS = {
    "input": "Inputs",
    "output": "Outputs",
    "parameter": "Parameters",
}


def contents(file: Path) -> dict[str, str]:
    """A few lines about an FMU, by subject.

    Raises
    ------
    PlantError
        If the file is no FMU.
    """
    description = read_description(file)
    with zipfile.ZipFile(file) as archive:
        names = archive.namelist()
    platforms = sorted(
        {name.split("/")[1] for name in names if name.startswith("binaries/") and name.count("/") > 1}
    )
    interfaces = [("Co-Simulation", description.coSimulation), ("Model Exchange", description.modelExchange)]
    given = " and ".join(name for name, interface in interfaces if interface is not None)
    counts = Counter(variable.causality for variable in description.modelVariables)
    experiment = description.defaultExperiment
    return {
        "model": f"{description.modelName}: {description.description}",
        "FMI": f"{description.fmiVersion}, {given}",
        "platforms": ", ".join(platforms) or "none",
        "variables": ", ".join(f"{count} {causality}" for causality, count in sorted(counts.items())),
        "step": f"{experiment.stepSize} s suggested" if experiment is not None else "none suggested",
        "sources": f"{sum(name.endswith('.c') for name in names)} C files",
        "token": str(description.guid),
        "size": f"{file.stat().st_size / 1024:.0f} KiB",
    }


def variable_tables() -> str:
    """Every variable of our FMUs as Markdown: one table for each causality, and the arrays over them."""
    lines = [
        "# Variables of the aircraft FMU",
        "",
        "Written by `sidestep fmu info --variables`; do not edit.",
        "",
    ]
    for causality, heading in _HEADINGS.items():
        rows = [row for row in TABLE if row.causality == causality]
        lines += [
            f"## {heading}",
            "",
            "| name | unit | start | bounds | what it is |",
            "|---|---|---|---|---|",
        ]
        lines += [_row(row) for row in rows] + [""]
    lines += ["## Arrays over the same memory (FMI 3.0)", "", "| name | over | what it is |", "|---|---|---|"]
    lines += [
        f"| `{view.name}` | `{view.first}` and the next {view.size - 1} | {view.description} |"
        for view in VIEWS
    ]
    return "\n".join(lines) + "\n"


def _row(row: Variable) -> str:
    display = UNITS[row.unit].display
    unit = row.unit if row.kind == "Float64" else row.kind
    shown = f"{unit} ({display})" if display else unit
    start = "" if row.causality == "output" else f"{starts()[row.name]:.6g}"
    bounds = "" if row.causality == "output" else f"{row.minimum:g} … {row.maximum:g}"
    return f"| `{row.name}` | {shown} | {start} | {bounds} | {row.description} |"
