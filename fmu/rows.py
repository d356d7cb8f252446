"""One row of the table of variables, and how rows of each kind are written down."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from fmu.units import UNITS

Causality = Literal["independent", "parameter", "input", "output"]
Kind = Literal["Float64", "Int32", "Boolean"]

INF = math.inf
FAR = 1e7
"""Largest map coordinate accepted [m]."""


@dataclass(frozen=True, slots=True)
class Variable:
    """One row of the table."""

    name: str
    """Structured FMI name."""
    causality: Causality
    """Role towards the importer; parameters are fixed once the run begins."""
    unit: str
    """Key of `UNITS`."""
    description: str
    """One line for the user."""
    start: float | None = None
    """Start value; None for outputs and for what the aircraft file gives."""
    minimum: float = -INF
    """Smallest value accepted."""
    maximum: float = INF
    """Largest value accepted."""
    kind: Kind = "Float64"
    """FMI type; in C everything is a double."""

    @property
    def field(self) -> str:
        """Name of the member in the C struct."""
        return self.name.replace(".", "_")

    @property
    def bounds(self) -> tuple[float, float]:
        """Smallest and largest value; those of the unit where the row gives none."""
        limit = UNITS[self.unit].limit
        return max(self.minimum, -limit), min(self.maximum, limit)

    @property
    def nominal(self) -> float:
        """A usual size."""
        return UNITS[self.unit].nominal

    @property
    def variability(self) -> str:
        """FMI variability that follows from causality and type."""
        if self.causality == "parameter":
            return "fixed"
        return "continuous" if self.kind == "Float64" else "discrete"


def parameter(
    name: str,
    unit: str,
    text: str,
    start: float | None = None,
    bounds: tuple[float, float] = (-INF, INF),
    *,
    kind: Kind = "Float64",
) -> Variable:
    """A row that is fixed once the run begins; an aircraft file gives those without a start value."""
    return Variable(name, "parameter", unit, text, start, *bounds, kind)


def given(
    name: str, unit: str, text: str, start: float, bounds: tuple[float, float], *, kind: Kind = "Float64"
) -> Variable:
    """A row that the importer gives during the run: an input."""
    return Variable(name, "input", unit, text, start, *bounds, kind)


def told(
    name: str, unit: str, text: str, bounds: tuple[float, float] = (-INF, INF), *, kind: Kind = "Float64"
) -> Variable:
    """A row that the model tells: an output."""
    return Variable(name, "output", unit, text, None, *bounds, kind)
