"""What can go wrong between us and a vehicle or a plan file."""

from __future__ import annotations

from pathlib import Path


class OffboardError(Exception):
    """Base of this package's errors."""


class LinkError(OffboardError):
    """The vehicle cannot do, or did not do, what it was asked."""


class InputError(OffboardError):
    """What a user has given cannot be used: a file, a key, an address."""


class PlanFileError(InputError):
    """A plan file cannot be read or written.

    Parameters
    ----------
    file : Path
        The file.
    problem : str
        What is wrong with it.
    item : int or None
        Index of the mission item at fault, counted from 0 as in the file; None for the file as a whole.
    """

    def __init__(self, file: Path, problem: str, item: int | None = None) -> None:
        where = f"{file}: " if item is None else f"{file}: item {item}: "
        super().__init__(where + problem)
        self.file = file
        self.problem = problem
        self.item = item
