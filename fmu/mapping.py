"""A user's own FMU as plant: a TOML file says which of its variables plays which role.

The file, with all its roles, is described in docs/aircraft.md. In short::

    fmu = "my_aircraft.fmu"      # beside this file

    [start]                      # start values in the FMU's own units
    "wing.mass" = 3.2

    [state]                      # what the FMU tells: a variable's name, or a table
    north = "pos.x"
    altitude = {variable = "pos.h_ft", scale = 0.3048}

    [command]                    # what the FMU is told
    "leg.to_north" = "target.x"

    [initial]                    # where it is to begin, if it can be told
    north = "pos.x0"

    [limits]                     # what the avoidance must know of it, to fly it in a scenario
    max_bank_deg = 30

A role's value in SI units and radians is scale × variable + offset, for what is told as for what is read.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from fmu.commands import LEG, ORBIT
from fmu.cosimulation import read_description
from fmu.errors import FmuError
from fmu.mapped_limits import MappedLimits, read_limits
from fmu.types import PlantState

STATE_ROLES = tuple(
    field for field in PlantState._fields if field not in ("time", "p", "q", "r", "alpha", "beta")
)
"""What a plant tells; the time is counted here."""
OPTIONAL_STATE = ("bank", "pitch", "airspeed", "heading")
"""Where absent, bank and pitch are zero, airspeed and heading follow from the velocity less the wind."""
_HOLD = ("altitude", "airspeed")
LEG_ROLES = tuple(f"leg.{end}_{axis}" for end in ("from", "to") for axis in ("north", "east")) + _HOLD
ORBIT_ROLES = ("orbit.north", "orbit.east", "orbit.radius", "orbit.direction", *_HOLD)
COMMAND_ROLES = tuple(dict.fromkeys(LEG_ROLES + ORBIT_ROLES))
"""What a plant must be able to be told."""
OPTIONAL_COMMAND = ("mode", "wind.north", "wind.east", "wind.down")
"""mode: 1 leg, 2 orbit. Without the wind's roles the plant refuses any wind."""
INITIAL_ROLES = ("north", "east", "altitude", "heading", "airspeed")
"""Where a plant can be told to begin."""
_MODES = ("leg", "orbit")
_TABLES = ("start", "state", "command", "mode", "initial", "limits")
_SETTABLE = ("input", "parameter", "structuralParameter")
_FIELDS = ("variable", "scale", "offset")


class MappingError(FmuError):
    """A mapping cannot be used; lists every mistake with its key and value.

    Parameters
    ----------
    file : Path
        The mapping.
    mistakes : sequence of str
        One line each.
    """

    def __init__(self, file: Path, mistakes: Sequence[str]) -> None:
        self.file = file
        self.mistakes = tuple(mistakes)
        super().__init__(f"{file}: " + "; ".join(mistakes))


@dataclass(frozen=True, slots=True)
class Role:
    """One variable of the FMU and how it becomes SI: value = scale × variable + offset."""

    variable: str
    """Name in the FMU."""
    scale: float = 1.0
    """SI units per unit of the variable."""
    offset: float = 0.0
    """SI value where the variable is zero."""

    def from_fmu(self, number: float) -> float:
        """The role's value, in SI units and radians."""
        return self.scale * number + self.offset

    def to_fmu(self, value: float) -> float:
        """The variable that stands for a value in SI units and radians."""
        return (value - self.offset) / self.scale


@dataclass(frozen=True, slots=True)
class PlantMapping:
    """A mapping file that has been checked against its FMU."""

    fmu: Path
    """The FMU."""
    start: Mapping[str, float]
    """Start values by variable, in the FMU's own units."""
    state: Mapping[str, Role]
    """What is read."""
    command: Mapping[str, Role]
    """What is told."""
    mode: Mapping[int, float]
    """The FMU's own numbers for leg and orbit."""
    description: Any
    """fmpy's model description of the FMU."""
    initial: Mapping[str, Role]
    """Where it is told to begin."""
    limits: MappedLimits | None
    """What it can do; None if the file does not say."""


def load_mapping(file: Path) -> PlantMapping:
    """Read a mapping and check it against the FMU that it names.

    Raises
    ------
    MappingError
        With every mistake: unknown roles, roles that are missing, variables that the FMU does not have or
        that cannot be set, an FMU without Co-Simulation.
    PlantError
        If the FMU is missing or is none.
    """
    try:
        with file.open("rb") as stream:
            document = tomllib.load(stream)
    except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise MappingError(file, [str(error)]) from error
    if not isinstance(document.get("fmu"), str):
        raise MappingError(file, [f"fmu = {document.get('fmu')!r} must be the path of an FMU"])
    fmu = file.parent / document["fmu"]
    description = read_description(fmu)
    if description.coSimulation is None:
        message = f"fmu = {document['fmu']!r} is for Model Exchange only; a plant needs Co-Simulation"
        raise MappingError(file, [message])
    mistakes = [f"{key} is unknown" for key in document if key not in ("fmu", *_TABLES)]
    for key in _TABLES:
        if not isinstance(document.setdefault(key, {}), dict):
            mistakes.append(f"{key} = {document[key]!r} must be a table")
            document[key] = {}
    mapping = _checked(document, fmu, description, mistakes)
    if mistakes:
        raise MappingError(file, mistakes)
    return mapping


def _checked(document: Mapping[str, Any], fmu: Path, description: Any, mistakes: list[str]) -> PlantMapping:  # noqa: ANN401
    """The mapping; what is wrong with it goes to the list of mistakes."""
    known = {variable.name: variable.causality for variable in description.modelVariables}
    commands = (*COMMAND_ROLES, *OPTIONAL_COMMAND)
    state = dict(read_roles(document, "state", STATE_ROLES, OPTIONAL_STATE, known, mistakes))
    command = dict(read_roles(document, "command", commands, OPTIONAL_COMMAND, known, mistakes))
    for role, found in command.items():
        if (causality := known[found.variable]) != "input":
            mistakes.append(f"command.{role}.variable = {found.variable!r} is no input but {causality}")
    start = dict(_numbers(document, "start", mistakes))
    for name, value in start.items():
        if name not in known:
            mistakes.append(f"start.{name} = {value:g}: {_no_variable(name, known)}")
    modes = dict(_numbers(document, "mode", mistakes))
    mistakes += [f"mode.{name} is unknown; known: leg, orbit" for name in modes if name not in _MODES]
    numbers = {LEG: modes.get("leg", LEG), ORBIT: modes.get("orbit", ORBIT)}
    initial = dict(read_roles(document, "initial", INITIAL_ROLES, INITIAL_ROLES, known, mistakes))
    for role, found in initial.items():
        if (causality := known[found.variable]) not in _SETTABLE:
            what = f"{found.variable!r} cannot be set before the start: it is {causality}"
            mistakes.append(f"initial.{role}.variable = {what}")
    limits = read_limits(document["limits"], mistakes) if document["limits"] else None
    return PlantMapping(fmu, start, state, command, numbers, description, initial, limits)


def read_roles(
    document: Mapping[str, Any],
    table: str,
    roles: Sequence[str],
    optional: Sequence[str],
    known: Mapping[str, str],
    mistakes: list[str],
) -> Iterator[tuple[str, Role]]:
    """Roles of one table; what is wrong goes to the list of mistakes."""
    given = document.get(table, {})
    mistakes += [
        f"{table}.{role} is unknown; known: {', '.join(roles)}" for role in given if role not in roles
    ]
    mistakes += [f"{table}.{role} is missing" for role in roles if role not in given and role not in optional]
    for name, entry in given.items():
        if name not in roles:
            continue
        where = f"{table}.{name}"
        fields = {"variable": entry} if isinstance(entry, str) else entry
        if not isinstance(fields, dict) or not isinstance(fields.get("variable"), str):
            mistakes.append(f"{where} = {entry!r} must be a variable's name, or a table with `variable`")
            continue
        mistakes += [
            f"{where}.{key} is unknown; known: {', '.join(_FIELDS)}" for key in fields if key not in _FIELDS
        ]
        scale, offset = fields.get("scale", 1.0), fields.get("offset", 0.0)
        if not _finite(scale) or scale == 0:
            mistakes.append(f"{where}.scale = {scale!r} must be a finite number other than zero")
        elif not _finite(offset):
            mistakes.append(f"{where}.offset = {offset!r} must be a finite number")
        elif fields["variable"] not in known:
            mistakes.append(
                f"{where}.variable = {fields['variable']!r}: {_no_variable(fields['variable'], known)}"
            )
        else:
            yield name, Role(fields["variable"], float(scale), float(offset))


def _numbers(document: Mapping[str, Any], table: str, mistakes: list[str]) -> Iterator[tuple[str, float]]:
    for name, value in document.get(table, {}).items():
        if _finite(value) or isinstance(value, bool):
            yield name, float(value)
        else:
            mistakes.append(f"{table}.{name} = {value!r} must be a finite number")


def _finite(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _no_variable(name: str, known: Mapping[str, str]) -> str:
    """That there is no such variable, and which one may have been meant."""
    near = get_close_matches(name, known, 1)
    return "the FMU has no such variable" + (f" (did you mean {near[0]!r}?)" if near else "")
