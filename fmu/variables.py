"""The one table of the model's variables: name, causality, unit, start, bounds, description.

Everything that must agree about them is generated from here: `modelDescription.xml`, the C header with
the memory layout and the bounds, the checks of the aircraft files. A variable's value reference is its
row in `TABLE`; new variables go to the end of their section only before a release, to the end of the
table after it.

Frames: north and east are map metres about home, altitude is above home; "body" is forward, right, down.
"""

from __future__ import annotations

from fmu.rows import Variable
from fmu.rows_aircraft import AIRCRAFT
from fmu.rows_outputs import OUTPUTS
from fmu.rows_run import INPUTS, SETTINGS

TABLE: tuple[Variable, ...] = (
    Variable("time", "independent", "s", "Simulated time"),
    *AIRCRAFT,
    *SETTINGS,
    *INPUTS,
    *OUTPUTS,
)
"""All scalar variables; the index is the value reference."""

REFERENCE: dict[str, int] = {variable.name: index for index, variable in enumerate(TABLE)}
"""Value reference by name."""

STATES: tuple[tuple[str, str], ...] = (
    ("state.north", "state.velocity_north"),
    ("state.east", "state.velocity_east"),
    ("state.altitude", "state.climb_rate"),
    *((f"state.{k}", f"rate.{k}") for k in "uvw"),
    *((f"state.quaternion.{k}", f"rate.quaternion.{k}") for k in "wxyz"),
    *((f"state.{k}", f"rate.{k}") for k in "pqr"),
    *((f"state.{k}", f"rate.{k}") for k in ("aileron", "elevator", "rudder", "throttle")),
    ("battery.energy", "battery.power_stored"),
)
"""Continuous states and their derivatives, in the order of the model's state vector."""

INDICATORS: tuple[str, ...] = ("event.ground", "event.launch", "event.battery")
"""Event indicators, in the model's order."""
