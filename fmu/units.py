"""Units of the model's variables, as FMI spells them."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit as FMI spells it: SI exponents and how people like to see it."""

    name: str
    """Name used in the table."""
    base: tuple[tuple[str, int], ...] = ()
    """SI base units and their exponents."""
    display: str | None = None
    """Name of the display unit, if there is one."""
    factor: float = 1.0
    """Display value = factor × value + offset."""
    offset: float = 0.0
    """See `factor`."""
    nominal: float = 1.0
    """A usual size of what has this unit."""
    limit: float = 1e12
    """Bound of outputs in this unit; a state beyond it has diverged."""


UNITS: dict[str, Unit] = {
    unit.name: unit
    for unit in (
        Unit("1"),
        Unit("s", (("s", 1),)),
        Unit("m", (("m", 1),), nominal=100.0),
        Unit("m2", (("m", 2),)),
        Unit("m/s", (("m", 1), ("s", -1)), nominal=10.0),
        Unit("m/s2", (("m", 1), ("s", -2)), nominal=10.0),
        Unit("kg", (("kg", 1),)),
        Unit("kg.m2", (("kg", 1), ("m", 2))),
        Unit("kg/m3", (("kg", 1), ("m", -3))),
        Unit("N", (("kg", 1), ("m", 1), ("s", -2)), nominal=10.0),
        Unit("Pa", (("kg", 1), ("m", -1), ("s", -2)), "hPa", 0.01, nominal=1e3),
        Unit("K", (("K", 1),), "degC", 1.0, -273.15, nominal=300.0),
        Unit("1/K", (("K", -1),)),
        Unit("W", (("kg", 1), ("m", 2), ("s", -3)), nominal=100.0),
        Unit("W/m2", (("kg", 1), ("s", -3)), nominal=1e3),
        Unit("J", (("kg", 1), ("m", 2), ("s", -2)), "Wh", 1.0 / 3600.0, nominal=1e5),
        Unit("1/s", (("s", -1),)),
        Unit("1/s2", (("s", -2),)),
        Unit("1/m", (("m", -1),)),
        Unit("rad", (("rad", 1),), "deg", 180.0 / math.pi),
        Unit("rad/s", (("rad", 1), ("s", -1)), "deg/s", 180.0 / math.pi),
        Unit("rad/s2", (("rad", 1), ("s", -2)), "deg/s2", 180.0 / math.pi),
    )
}
"""All of them, by name."""
