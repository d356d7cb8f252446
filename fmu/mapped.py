"""A user's own FMU as something to fly, by the roles that its mapping gives."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import TracebackType
from typing import Self

from fmu.commands import LEG, ORBIT, check_direction, check_duration
from fmu.cosimulation import CoSimulation
from fmu.errors import PlantError
from fmu.mapping import LEG_ROLES, ORBIT_ROLES, PlantMapping
from fmu.types import PlantState


class MappedPlant:
    """A user's own FMU, flown by legs and orbits; satisfies `offboard.link.Plant` by shape.

    Parameters
    ----------
    mapping : PlantMapping
        From `load_mapping`.
    start : mapping, optional
        Further start values by variable, over those of the file, in the FMU's own units.
    initial : mapping, optional
        Where to begin, by role, in SI units and radians; roles that the mapping does not have are left out.

    Raises
    ------
    PlantError
        If the FMU does not load or does not start.
    ValueError
        If it refuses a value.
    """

    def __init__(
        self,
        mapping: PlantMapping,
        start: Mapping[str, float] | None = None,
        *,
        initial: Mapping[str, float] | None = None,
    ) -> None:
        self._mapping = mapping
        roles = mapping.initial
        begin = {roles[k].variable: roles[k].to_fmu(x) for k, x in (initial or {}).items() if k in roles}
        values = {**mapping.start, **begin, **(start or {})}
        self._unit = CoSimulation(mapping.fmu, values, mapping.description)
        self._names = [role.variable for role in mapping.state.values()]
        self._wind = (0.0, 0.0)
        self._state: PlantState | None = None

    @property
    def state(self) -> PlantState:
        """State after the last step."""
        if self._state is None:
            numbers = self._unit.read(self._names)
            roles = self._mapping.state.items()
            values = {name: role.from_fmu(x) for (name, role), x in zip(roles, numbers, strict=True)}
            if lost := [f"{name} = {x!r}" for name, x in values.items() if not math.isfinite(x)]:
                raise PlantError("read", self._unit.time, "not finite", ", ".join(lost))
            self._state = self._complete(values)
        return self._state

    def _complete(self, values: dict[str, float]) -> PlantState:
        """The whole state; what the FMU does not tell follows from the rest, or is zero."""
        north = values["velocity_north"] - self._wind[0]
        east = values["velocity_east"] - self._wind[1]
        values.setdefault("airspeed", math.hypot(north, east, values["climb_rate"]))
        values["heading"] = math.remainder(values.get("heading", math.atan2(east, north)), math.tau)
        blank = dict.fromkeys(PlantState._fields, 0.0)
        return PlantState(**(blank | values | {"time": self._unit.time}))

    def fly_leg(
        self,
        from_north: float,
        from_east: float,
        to_north: float,
        to_east: float,
        altitude: float,
        airspeed: float,
    ) -> None:
        """Follow the line through two points [m] at an altitude [m] and airspeed [m/s]."""
        self._command(LEG, LEG_ROLES, (from_north, from_east, to_north, to_east, altitude, airspeed))

    def fly_orbit(
        self, north: float, east: float, radius: float, direction: int, altitude: float, airspeed: float
    ) -> None:
        """Circle a point [m]; direction +1 is clockwise seen from above, -1 anticlockwise."""
        check_direction(direction)
        self._command(ORBIT, ORBIT_ROLES, (north, east, radius, direction, altitude, airspeed))

    def set_wind(self, north: float, east: float, down: float = 0.0) -> None:
        """Steady wind: the velocity of the air over ground [m/s].

        Raises
        ------
        ValueError
            If there is wind and the mapping has no roles for it.
        """
        wind = {"wind.north": north, "wind.east": east, "wind.down": down}
        for role, value in wind.items():
            if role not in self._mapping.command and value != 0.0:
                raise ValueError(f"{role} = {value:g}: the mapping has no command.{role}")
        known = {role: value for role, value in wind.items() if role in self._mapping.command}
        self._tell(known)
        self._wind = (north, east)

    def step(self, duration: float) -> None:
        """Advance by `duration` seconds.

        Raises
        ------
        ValueError
            If the duration is not a positive number.
        PlantError
            If the FMU fails.
        """
        check_duration(duration)
        self._state = None
        self._unit.step(duration)

    def close(self) -> None:
        """Free the instance; a second call does nothing."""
        self._unit.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _command(self, mode: int, roles: Sequence[str], values: Sequence[float]) -> None:
        self._tell(dict(zip(roles, values, strict=True)))
        if (role := self._mapping.command.get("mode")) is not None:
            self._unit.write({role.variable: role.to_fmu(self._mapping.mode[mode])})

    def _tell(self, values: Mapping[str, float]) -> None:
        """Give inputs by role, in SI units and radians."""
        if bad := [f"{role} = {value!r}" for role, value in values.items() if not math.isfinite(value)]:
            raise ValueError(f"{', '.join(bad)}: must be finite")
        command = self._mapping.command
        self._unit.write({command[role].variable: command[role].to_fmu(x) for role, x in values.items()})
        self._state = None
