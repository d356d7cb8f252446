"""Where a run may be written: found out before the flight, for none is flown in vain."""

from __future__ import annotations

import errno
import os
import tempfile
from pathlib import Path

from scenarios.errors import RunDirectoryError
from scenarios.scenario import Scenario

MARKS_OF_A_RUN = ("summary.json", "track.csv", "scenario.toml")
"""A directory with these files is a previous run."""
FILES_OF_A_PLANT = ("plant-track.csv", "plant-events.jsonl", "plant-summary.json")
"""What a plant in the loop adds to the run of the autopilot that flew it."""
FILE_OF_A_LINK = "events.jsonl"
"""What a live vehicle's pilot was told."""
FILES_OF_A_RUN = frozenset(
    (
        *MARKS_OF_A_RUN,
        *("obstacles.csv", "traffic.csv", "waypoints.csv", "decisions.jsonl", "run.json", "mission.plan"),
        "report.html",
        FILE_OF_A_LINK,
        *FILES_OF_A_PLANT,
    )
)
"""A previous run with nothing else beside it may be replaced."""
PREFIX = ".sidestep-"
"""Directories that are being written begin with this; they stand beside where the run will be."""


def check_target(directory: Path) -> None:
    """Make sure, before the flight, that a run can be written to a directory.

    Raises
    ------
    RunDirectoryError
        If it is a file, holds anything but a previous run, cannot be created or cannot be replaced there.

    Notes
    -----
    What would be done after the flight is tried on an empty directory beside the place.
    """
    try:
        target = followed(directory)
        if target.is_dir():
            _check_content(directory, target)
        elif target.exists() or target.is_symlink():
            raise RunDirectoryError(directory, "is a file")
        parent = target.parent
        while not parent.exists():
            parent = parent.parent
        with tempfile.TemporaryDirectory(prefix=PREFIX, dir=parent) as trial:
            inner = Path(trial) / target.relative_to(parent)
            (inner / "occupied").mkdir(parents=True)
            if target.exists():
                _check_movable(target, inner)
    except OSError as error:
        raise RunDirectoryError(directory, f"cannot be written to ({error.strerror})") from error


def followed(directory: Path) -> Path:
    """Where a path leads once every link in it is followed: a link stays, its target is written."""
    try:
        return directory.resolve()
    except RuntimeError as error:  # how Python before 3.13 tells of links that lead in a circle
        raise RunDirectoryError(directory, "is a link that leads back to itself") from error


def _check_content(directory: Path, target: Path) -> None:
    names = sorted(entry.name for entry in target.iterdir())
    if names and not is_run(target):
        raise RunDirectoryError(directory, "is not empty and holds no previous run; it is left alone")
    for name in names:
        if name not in FILES_OF_A_RUN or not (target / name).is_file():
            message = f"holds {name!r} besides a previous run; it is left alone"
            raise RunDirectoryError(directory, message)


def _check_movable(target: Path, occupied: Path) -> None:
    """Ask to rename a directory onto one that is not empty: refused, but for which reason tells.

    Raises
    ------
    OSError
        If it could not be moved away either: where a volume is mounted, or in someone else's directory.
    """
    try:
        target.rename(occupied)
    except OSError as error:
        if error.errno not in (errno.ENOTEMPTY, errno.EEXIST) and os.name != "nt":
            raise


def is_run(directory: Path) -> bool:
    """True if a directory holds a run."""
    return all((directory / name).is_file() for name in MARKS_OF_A_RUN)


def free_directory(scenario: Scenario, seed: int, base: Path = Path("sidestep-runs")) -> Path:
    """A directory that does not exist yet: `sidestep-runs/<scenario>-<seed>-<number>`."""
    number = 1
    while (directory := base / f"{scenario.name}-{seed}-{number}").exists():
        number += 1
    return directory
