"""The aircraft as something to fly: commands in, state out, one FMU instance behind it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import TracebackType
from typing import Literal

from fmu.commands import DIRECT, LEG, ORBIT, check_direction, check_duration
from fmu.library import Channel, FmuLibrary
from fmu.parameters import DEFAULT
from fmu.saving import SavedPlant
from fmu.types import PlantLimits, PlantState

Fidelity = Literal["6dof", "kinematic"]
Law = Literal["l1", "paper"]
FIDELITIES: dict[str, int] = {"6dof": 0, "kinematic": 1}
LAWS: dict[str, int] = {"paper": 0, "l1": 1}

_LEG = tuple(f"command.leg.{k}" for k in ("from_north", "from_east", "to_north", "to_east"))
_HOLD = ("command.altitude", "command.airspeed")
_ORBIT = ("command.orbit.north", "command.orbit.east", "command.orbit.radius")
_WIND = ("wind.north", "wind.east", "wind.down")
_SURFACES = tuple(f"command.{k}" for k in ("aileron", "elevator", "rudder", "throttle"))


class FmuPlant:
    """An aircraft with its own guidance, flown by legs and orbits; satisfies `offboard.link.Plant` by shape.

    It starts in level trim. What is set before the first step (wind, parameters) belongs to the start: the
    aircraft begins in trim within that wind.

    Parameters
    ----------
    library : FmuLibrary
        Loaded once, shared by all plants.
    aircraft : str
        Name of a packaged parameter set, or path of a TOML file.
    fidelity : {"6dof", "kinematic"}
        Equations of motion.
    guidance : {"l1", "paper"}
        Lateral law of legs.
    north, east, altitude : float
        Start in map metres about home; altitude above home.
    heading : float
        Direction of the nose at the start [rad].
    airspeed : float
        True airspeed at the start, and until commanded otherwise [m/s].
    home_elevation : float
        Elevation of home above mean sea level, for the air density [m].
    wind : tuple of float
        Steady wind, north, east, down [m/s]: where the air goes to.
    parameters : mapping, optional
        Further values by variable name, over those of the aircraft file.
    name : str
        For messages.

    Raises
    ------
    ValueError
        If a value is refused; the message names variable, value and range.
    AircraftError
        If the aircraft file is unusable.
    PlantError
        If the aircraft cannot fly like this (no trim at this airspeed).
    """

    def __init__(
        self,
        library: FmuLibrary,
        *,
        aircraft: str = DEFAULT,
        fidelity: Fidelity = "6dof",
        guidance: Law = "l1",
        north: float = 0.0,
        east: float = 0.0,
        altitude: float = 200.0,
        heading: float = 0.0,
        airspeed: float = 15.0,
        home_elevation: float = 0.0,
        wind: tuple[float, float, float] = (0.0, 0.0, 0.0),
        parameters: Mapping[str, float] | None = None,
        name: str = "own",
    ) -> None:
        self.name = name
        self._values: dict[str, float] = library.aircraft(aircraft)
        self._values |= {
            "fidelity": _choice("fidelity", fidelity, FIDELITIES),
            "guidance.law": _choice("guidance", guidance, LAWS),
            "environment.home_elevation": home_elevation,
            "initial.north": north,
            "initial.east": east,
            "initial.altitude": altitude,
            "initial.heading": heading,
            "initial.airspeed": airspeed,
        }
        ahead = (north + 1e3 * math.cos(heading), east + 1e3 * math.sin(heading))
        self._values |= zip(_LEG + _HOLD, (north, east, *ahead, altitude, max(airspeed, 1.0)), strict=True)
        self._values |= zip(_WIND, wind, strict=True)
        self._values |= {"command.mode": LEG} | dict(parameters or {})
        self._instance = library.instantiate(name)
        try:
            self._instance.start(self._values)
        except Exception:
            self._instance.close()
            raise
        self._leg = Channel(self._instance, _LEG + _HOLD)
        self._orbit = Channel(self._instance, _ORBIT + _HOLD)
        self._surfaces = Channel(self._instance, _SURFACES)
        self._wind = Channel(self._instance, _WIND)
        self._motion = Channel(self._instance, [f"state.{field}" for field in PlantState._fields[1:]])
        self._command: tuple[float, ...] = ()
        self._state: PlantState | None = None

    @property
    def time(self) -> float:
        """Since the start [s]."""
        return self._instance.time

    @property
    def state(self) -> PlantState:
        """State after the last step."""
        if self._state is None:
            self._state = PlantState._make((self._instance.time, *self._motion.read()))
        return self._state

    @property
    def limits(self) -> PlantLimits:
        """What this aircraft can do."""
        get = self.get
        lag = get("aircraft.control.roll_time") + 2.0 * get("aircraft.actuator.surface_time")
        return PlantLimits(
            cruise_airspeed=get("aircraft.limits.cruise_airspeed"),
            min_airspeed=get("aircraft.limits.min_airspeed"),
            max_airspeed=get("aircraft.limits.max_airspeed"),
            max_bank=get("guidance.max_bank"),
            climb_rate=get("aircraft.limits.climb_rate"),
            sink_rate=get("aircraft.limits.sink_rate"),
            roll_rate=get("aircraft.control.roll_rate_limit"),
            roll_lag=lag,
            turn_factor=get("aircraft.kinematic.turn_factor"),
            gravity=get("environment.gravity"),
        )

    def fly_leg(
        self,
        from_north: float,
        from_east: float,
        to_north: float,
        to_east: float,
        altitude: float,
        airspeed: float,
    ) -> None:
        """Follow the line through two points [m] at an altitude [m] and airspeed [m/s], also beyond its end.

        If the points coincide, the aircraft flies straight to them from where it is. The airspeed is kept
        within the aircraft's limits.
        """
        command = (LEG, from_north, from_east, to_north, to_east, altitude, airspeed)
        if command != self._command:
            self._give(self._leg, command, _LEG + _HOLD)

    def fly_orbit(
        self, north: float, east: float, radius: float, direction: int, altitude: float, airspeed: float
    ) -> None:
        """Circle a point [m]; direction +1 is clockwise seen from above, -1 anticlockwise."""
        check_direction(direction)
        command = (ORBIT, north, east, radius, altitude, airspeed, direction)
        if command != self._command:
            self._give(self._orbit, command[:-1], _ORBIT + _HOLD)
            self.set("command.orbit.direction", direction)
            self._command = command

    def fly_direct(self, aileron: float, elevator: float, rudder: float, throttle: float) -> None:
        """Give the surfaces [rad] and the throttle (0 to 1) directly."""
        command = (DIRECT, aileron, elevator, rudder, throttle)
        if command != self._command:
            self._give(self._surfaces, command, _SURFACES)

    def set_wind(self, north: float, east: float, down: float = 0.0) -> None:
        """Steady wind: the velocity of the air over ground [m/s]."""
        wind = (north, east, down)
        if self._instance.time == 0.0:
            self._restart(dict(zip(_WIND, wind, strict=True)))
        else:
            self._wind.write(wind)
            self._state = None

    def step(self, duration: float) -> None:
        """Advance by `duration` seconds.

        Raises
        ------
        ValueError
            If the duration is not a positive number.
        PlantError
            If the model fails.
        """
        check_duration(duration)
        self._state = None
        self._instance.step(duration)

    def channel(self, names: Sequence[str]) -> Channel:
        """Real variables that are read together, in one call: names and arrays are prepared once.

        Raises
        ------
        ValueError
            If the model has no real variable of a name.
        """
        for name in names:
            if (kind := self._instance.kind(name)) != "Float64":
                raise ValueError(f"name={name!r}: is {kind}, not Float64")
        return Channel(self._instance, names)

    def get(self, name: str) -> float:
        """Any variable of the model by name, in SI units and radians."""
        return self._instance.get(name)

    def set(self, name: str, value: float) -> None:
        """Set an input, or before the first step a parameter, by name, in SI units and radians."""
        self._instance.kind(name)
        if self._instance.library.causalities[name] == "parameter" and self._instance.time == 0.0:
            self._restart({name: value})
        else:
            self._set_inputs({name: value})
        self._command = ()

    def reset(self) -> None:
        """Back to the start, with what was set before the first step and the commands given since."""
        self._restart({})

    def save(self) -> SavedPlant:
        """This moment of the flight, to go back to it or to fly on from it with another plant of the FMU."""
        saved = self._instance.save()
        return SavedPlant(saved.model, saved.nanoseconds, self._command, dict(self._values))

    def restore(self, saved: SavedPlant) -> None:
        """Go on from a saved moment, bit for bit.

        Raises
        ------
        ValueError
            If it was not saved by this FMU, or is damaged.
        """
        self._instance.restore(saved)
        self._command = saved.command
        self._values = dict(saved.values)
        self._state = None

    def close(self) -> None:
        """Free the instance; a second call does nothing."""
        self._instance.close()

    def __enter__(self) -> FmuPlant:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _give(self, channel: Channel, command: tuple[float, ...], names: tuple[str, ...]) -> None:
        """Write a command and its mode; the values go first so that a refused one changes nothing."""
        channel.write(command[1:])
        if not self._command or self._command[0] != command[0]:
            self._instance.set_many({"command.mode": command[0]})
        self._values |= zip(("command.mode", *names), command, strict=True)
        self._command = command
        self._state = None

    def _set_inputs(self, values: dict[str, float]) -> None:
        self._instance.set_many(values)
        self._values |= values
        self._state = None

    def _restart(self, changes: dict[str, float]) -> None:
        """Start again with changed values; if they are refused, with the old ones."""
        try:
            self._instance.start(self._values | changes)
        except Exception:
            self._instance.start(self._values)
            raise
        self._values |= changes
        self._state = None


def _choice(argument: str, value: str, known: Mapping[str, int]) -> int:
    if value not in known:
        raise ValueError(f"{argument}={value!r}: must be one of {', '.join(known)}")
    return known[value]
