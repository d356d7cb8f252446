"""What can go wrong with the aircraft, split by whose fault it is."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

STATUS = ("OK", "Warning", "Discard", "Error", "Fatal")
"""FMI's status values by number."""


class FmuError(Exception):
    """Base of all errors of this package."""


class PlantError(FmuError):
    """The model failed or cannot be loaded.

    Parameters
    ----------
    step : str
        What was being done: "load", "initialise", "step", "set aircraft.mass" …
    time : float
        Simulated time [s].
    status : str
        FMI status, or the reason in words.
    message : str
        What the model said about it.
    """

    def __init__(self, step: str, time: float, status: str, message: str = "") -> None:
        self.step = step
        self.time = time
        self.status = status
        self.message = message
        detail = f": {message}" if message else ""
        super().__init__(f"plant failed to {step} at t = {time:g} s ({status}){detail}")


class RefusedError(PlantError, ValueError):
    """The model refused a value: a wrong call where a user gives it, a failure where a flight does."""


class AircraftError(FmuError):
    """An aircraft file is unusable; lists every mistake in it.

    Parameters
    ----------
    file : Path
        The file.
    mistakes : sequence of str
        One line each, with key, value and allowed range.
    """

    def __init__(self, file: Path, mistakes: Sequence[str]) -> None:
        self.file = file
        self.mistakes = tuple(mistakes)
        super().__init__(f"{file}: " + "; ".join(mistakes))


class BuildError(FmuError):
    """The FMU cannot be built: no compiler, or it refused the source."""
