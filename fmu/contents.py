"""What is in an FMU file, in words: for a user who has just been given it."""

from __future__ import annotations

import zipfile
from collections import Counter
from pathlib import Path

from fmu.cosimulation import read_description


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
