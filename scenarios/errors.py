"""What can go wrong with scenarios and run directories."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Problem:
    """One mistake in a scenario file."""

    key: str
    """Where it is: table, entry (counted from 1) and key; empty for the file as a whole."""
    value: object
    """The offending value; None where there is none to show."""
    message: str
    """What is wrong, with the allowed range."""

    def __str__(self) -> str:
        if not self.key:
            return self.message
        shown = "" if self.value is None else f" = {_brief(self.value)}"
        return f"{self.key}{shown}: {self.message}"


class ScenarioError(Exception):
    """A scenario cannot be used; holds all mistakes that were found, not only the first."""

    def __init__(self, file: str | Path, problems: Sequence[Problem] | str) -> None:
        self.file = str(file)
        if isinstance(problems, str):
            problems = (Problem("", None, problems),)
        self.problems = tuple(problems)
        super().__init__(str(self))

    def __str__(self) -> str:
        if len(self.problems) == 1:
            return f"{self.file}: {self.problems[0]}"
        lines = [f"{self.file}: {len(self.problems)} mistakes", *(f"  {p}" for p in self.problems)]
        return "\n".join(lines)


class RunDirectoryError(Exception):
    """A run directory cannot be written or read; says which file and why."""

    def __init__(self, path: str | Path, message: str) -> None:
        self.path = str(path)
        self.message = message
        super().__init__(f"{self.path}: {message}")


def _brief(value: object) -> str:
    try:
        text = str(value) if isinstance(value, float) else repr(value)
    except (RecursionError, ValueError):  # nested too deeply, or thousands of digits
        return "..."
    return text if len(text) <= 60 else text[:57] + "..."
