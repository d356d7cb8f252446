"""A user's own FMU as the plant behind an autopilot: a TOML file says which variable plays which role.

The file::

    fmu = "my_aircraft.fmu"           # beside this file

    [start]                           # start values in the FMU's own units
    "wing.mass" = 3.2

    [state]                           # what the FMU tells: a variable's name, or a table
    north = "pos.x"
    altitude = {variable = "pos.h_ft", scale = 0.3048}

    [command]                         # what the FMU is told
    roll = {variable = "da_deg", scale = 0.0333}   # value = scale × variable: full aileron, 30 deg, is 1
    throttle = "throttle"

Without accelerometer, pressures or airspeed these follow from the rest; `flight.phase` from height and speed.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from fmu.cosimulation import CoSimulation, read_description
from fmu.mapping import MappingError, Role, read_roles
from offboard.hil.attitude import quaternion, to_body
from offboard.hil.plant import Axes, Phase, Truth

GRAVITY = 9.80665
_ATTITUDE = ("bank", "pitch", "heading")
_QUATERNION = ("qw", "qx", "qy", "qz")
_FORCE = ("force_x", "force_y", "force_z")
_AIR = ("static_pressure", "differential_pressure", "temperature", "airspeed")
_NEEDED = ("north", "east", "altitude", "velocity_north", "velocity_east", "velocity_down", "p", "q", "r")
STATE_ROLES = (*_NEEDED, *_ATTITUDE, *_QUATERNION, *_FORCE, *_AIR, "phase")
COMMAND_ROLES = (*Axes._fields, "launch", "wind.north", "wind.east")
_OPTIONAL_COMMANDS = ("yaw", "launch", "wind.north", "wind.east")
_TABLES = ("start", "state", "command")


@dataclass(frozen=True, slots=True)
class HilMapping:
    """A mapping file that has been checked against its FMU."""

    fmu: Path
    start: Mapping[str, float]
    """Start values by variable, in the FMU's own units."""
    state: Mapping[str, Role]
    """What is read."""
    command: Mapping[str, Role]
    """What is told."""
    description: Any
    """fmpy's model description."""


def load_hil_mapping(file: Path) -> HilMapping:
    """Read a mapping and check it against the FMU that it names.

    Raises
    ------
    MappingError
        With every mistake.
    PlantError
        If the FMU is missing or is none.
    """
    try:
        document = tomllib.loads(file.read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise MappingError(file, [str(error)]) from error
    fmu = file.parent / str(document.get("fmu"))
    description = read_description(fmu)
    mistakes = [f"{key} is unknown" for key in document if key not in ("fmu", *_TABLES)]
    if description.coSimulation is None:
        mistakes.append(f"fmu = {document['fmu']!r} is for Model Exchange only; a plant needs Co-Simulation")
    for table in _TABLES:
        if not isinstance(document.setdefault(table, {}), dict):
            mistakes.append(f"{table} = {document[table]!r} must be a table")
            document[table] = {}
    optional = (*_ATTITUDE, *_QUATERNION, *_FORCE, *_AIR, "phase")
    known = {variable.name: variable.causality for variable in description.modelVariables}
    state = dict(read_roles(document, "state", STATE_ROLES, optional, known, mistakes))
    command = dict(read_roles(document, "command", COMMAND_ROLES, _OPTIONAL_COMMANDS, known, mistakes))
    for name, role in command.items():
        if (causality := known[role.variable]) != "input":
            mistakes.append(f"command.{name}.variable = {role.variable!r} is no input but {causality}")
    for names in (_FORCE, _ATTITUDE, _QUATERNION):
        given = [name for name in names if name in document["state"]]
        if given and len(given) < len(names):
            mistakes.append(f"state: {', '.join(given)} without the others of {', '.join(names)}")
    if not any(set(names) <= set(document["state"]) for names in (_ATTITUDE, _QUATERNION)):
        mistakes.append(f"state: needs {', '.join(_ATTITUDE)} or {', '.join(_QUATERNION)}")
    if mistakes:
        raise MappingError(file, mistakes)
    start = {name: float(value) for name, value in document["start"].items()}
    return HilMapping(fmu, start, state, command, description)


class MappedHilPlant:
    """A user's own FMU flown by its surfaces; satisfies `offboard.hil.plant.HilPlant` by shape.

    Parameters
    ----------
    mapping : HilMapping
        From `load_hil_mapping`.
    elevation : float
        Of home above mean sea level [m], for the air.
    wind : tuple of float
        Velocity of the air over ground, north and east [m/s].
    values : mapping, optional
        Further start values by variable, in the FMU's own units.
    """

    def __init__(
        self,
        mapping: HilMapping,
        elevation: float,
        wind: tuple[float, float] = (0.0, 0.0),
        values: Mapping[str, float] | None = None,
    ) -> None:
        self._mapping = mapping
        self._elevation = elevation
        self._wind = wind
        self._start = {**mapping.start, **(values or {})}
        for role, value in zip(("wind.north", "wind.east"), wind, strict=True):
            if role in mapping.command:
                self._start[mapping.command[role].variable] = mapping.command[role].to_fmu(value)
            elif value != 0.0:
                raise MappingError(mapping.fmu, [f"{role} = {value:g}: the mapping has no command.{role}"])
        self._unit = CoSimulation(mapping.fmu, self._start, mapping.description)
        self._names = [role.variable for role in mapping.state.values()]
        self._begin()

    def _begin(self) -> None:
        self._before: tuple[float, float, float] | None = None
        self._force = (0.0, 0.0, -GRAVITY)
        self._phase = Phase.STANDING
        self._now: Truth | None = None
        self._contact = self._step = 0.0

    @property
    def phase(self) -> Phase:
        """Told by the FMU, or reckoned: it stands until it moves, flies above 1 m, lands below 0.1 m."""
        return self._phase

    @property
    def contact_speed(self) -> float:
        """Rate of descent at the touchdown [m/s]; 0 before it."""
        return self._contact

    def truth(self) -> Truth:
        """The state after the last step."""
        if self._now is None:
            numbers = self._unit.read(self._names)
            roles = self._mapping.state.items()
            read = {name: role.from_fmu(x) for (name, role), x in zip(roles, numbers, strict=True)}
            self._now = self._complete(read)
        return self._now

    def fly(self, axes: Axes) -> None:
        """Command the surfaces and the engine."""
        command = self._mapping.command
        given = zip(axes._fields, axes, strict=True)
        self._unit.write({command[n].variable: command[n].to_fmu(x) for n, x in given if n in command})

    def launch(self) -> None:
        """Tell the FMU, if it knows of launches."""
        if (role := self._mapping.command.get("launch")) is not None:
            self._unit.write({role.variable: role.to_fmu(1.0)})
        if self._phase is Phase.STANDING and "phase" not in self._mapping.state:
            self._phase = Phase.LAUNCHING

    def step(self, duration: float) -> None:
        """Advance by `duration` seconds."""
        before = self.truth()
        self._before = (before.velocity_north, before.velocity_east, before.velocity_down)
        self._step = duration
        self._unit.step(duration)
        self._now = None
        self._follow(before, self.truth())

    def restart(self) -> None:
        """Back to the start of the flight."""
        self._unit.restart(self._start)
        self._begin()

    def close(self) -> None:
        """Free the instance; a second call does nothing."""
        self._unit.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _complete(self, read: dict[str, float]) -> Truth:
        """The whole truth; what the FMU does not tell follows from the rest."""
        if "qw" not in read:
            read |= zip(_QUATERNION, quaternion(*(read[name] for name in _ATTITUDE)), strict=True)
        height = self._elevation + read["altitude"]
        temperature = 288.15 - 0.0065 * height
        pressure = 101325.0 * math.pow(temperature / 288.15, 5.25587611)
        north, east = read["velocity_north"] - self._wind[0], read["velocity_east"] - self._wind[1]
        airspeed = read.setdefault("airspeed", math.hypot(north, east, read["velocity_down"]))
        read.setdefault("temperature", temperature)
        read.setdefault("static_pressure", pressure)
        density = read["static_pressure"] / (287.05287 * read["temperature"])
        read.setdefault("differential_pressure", 0.5 * density * airspeed**2)
        fields = {name: read.get(name, 0.0) for name in Truth._fields}
        truth = Truth(**(fields | {"time": self._unit.time}))
        if "phase" in read:
            self._phase = Phase(round(read["phase"]))
        return truth if "force_x" in read else self._with_force(truth)

    def _with_force(self, truth: Truth) -> Truth:
        """Specific force from the change of velocity over the last step."""
        acceleration = (0.0, 0.0, 0.0)
        if self._before is not None and self._step > 0.0:
            now = (truth.velocity_north, truth.velocity_east, truth.velocity_down)
            north, east, down = ((b - a) / self._step for a, b in zip(self._before, now, strict=True))
            acceleration = (north, east, down)
        force = to_body(truth, (acceleration[0], acceleration[1], acceleration[2] - GRAVITY))
        return truth._replace(force_x=force[0], force_y=force[1], force_z=force[2])

    def _follow(self, before: Truth, now: Truth) -> None:
        """Reckon the phase where the FMU does not tell it."""
        told = "phase" in self._mapping.state
        if not told and self._phase in (Phase.STANDING, Phase.LAUNCHING) and now.altitude > 1.0:
            self._phase = Phase.FLYING
        if not told and self._phase is Phase.FLYING and now.altitude <= 0.1:
            self._phase = Phase.LANDED
        if self._phase is Phase.LANDED and self._contact == 0.0:
            self._contact = max(before.velocity_down, 0.0)
