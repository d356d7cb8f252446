"""Other ways to reach the variables: arrays over the same memory, and terminals that group them (FMI 3.0)."""

from __future__ import annotations

from dataclasses import dataclass

from fmu.rows import Variable
from fmu.variables import REFERENCE, TABLE


@dataclass(frozen=True, slots=True)
class View:
    """An array variable that lies over scalars which follow one another in the table."""

    name: str
    """Structured FMI name."""
    first: str
    """Name of the first scalar."""
    size: int
    """Number of elements."""
    description: str
    """One line for the user."""

    @property
    def rows(self) -> tuple[Variable, ...]:
        """The scalars it lies over."""
        start = REFERENCE[self.first]
        return TABLE[start : start + self.size]


VIEWS: tuple[View, ...] = (
    View("vector.position", "state.north", 3, "North, east, altitude"),
    View("vector.velocity_body", "state.u", 3, "Velocity over ground: forward, right, down"),
    View("vector.quaternion", "state.quaternion.w", 4, "Attitude, body to north-east-down: w, x, y, z"),
    View("vector.rates", "state.p", 3, "Body rates: roll, pitch, yaw"),
    View("vector.surfaces", "state.aileron", 4, "Positions: aileron, elevator, rudder, throttle"),
    View("vector.specific_force", "sensor.specific_force.x", 3, "Specific force: forward, right, down"),
    View("vector.wind", "wind.north", 3, "Wind: north, east, down; the same as wind.*"),
    View("vector.command_surfaces", "command.aileron", 4, "Direct commands; the same as command.aileron ..."),
)
"""Array variables; their value references follow those of the table."""

TERMINALS: dict[str, tuple[str, tuple[str, ...]]] = {
    "state": ("Motion of the aircraft", ("state.",)),
    "sensors": ("What an autopilot measures", ("sensor.",)),
    "power": ("Solar array and battery", ("battery.", "sun.")),
    "guidance": (
        "Leg or orbit to fly",
        ("command.leg.", "command.orbit.", "command.altitude", "command.airspeed"),
    ),
    "surfaces": (
        "Direct control",
        ("command.aileron", "command.elevator", "command.rudder", "command.throttle"),
    ),
    "wind": ("Air over ground", ("wind.",)),
}
"""Terminals: description, and the beginnings of the names of their members."""


def members(terminal: str) -> list[Variable]:
    """Inputs and outputs that belong to a terminal."""
    beginnings = TERMINALS[terminal][1]
    return [row for row in TABLE if row.causality in ("input", "output") and row.name.startswith(beginnings)]
