"""The FMU as the plant behind an autopilot: surfaces in, truth out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import TracebackType
from typing import TYPE_CHECKING, Self

from offboard.hil.plant import Axes, Phase, Truth

if TYPE_CHECKING:
    from fmu.library import FmuLibrary

LAUNCHES = ("runway", "catapult", "air")
"""How a flight begins."""
_LAUNCH_MODE = {"air": 0, "catapult": 1, "runway": 2}
_DEFAULTS: Mapping[str, Mapping[str, float]] = {
    "runway": {"launch.pitch": 0.1},
    "catapult": {"launch.speed": 16.0, "launch.length": 4.0, "launch.pitch": 0.2},
    "air": {},
}
"""Standing nearly level on its wheels; a catapult that leaves enough speed to climb."""
_TRUTH = (
    *(f"state.{name}" for name in ("north", "east", "altitude")),
    *(f"state.velocity_{name}" for name in ("north", "east", "down")),
    *(f"state.quaternion.{name}" for name in "wxyz"),
    *(f"state.{name}" for name in "pqr"),
    *(f"sensor.specific_force.{axis}" for axis in "xyz"),
    *(f"sensor.{name}" for name in ("static_pressure", "differential_pressure", "temperature")),
    "state.airspeed",
)


class FmuHilPlant:
    """Our FMU flown by its surfaces; satisfies `offboard.hil.plant.HilPlant` by shape.

    Parameters
    ----------
    library : FmuLibrary
        Loaded once.
    aircraft : str
        Name of a parameter set, or path of its TOML file.
    launch : {"runway", "catapult", "air"}
        How the flight begins; "air" is level flight at 100 m.
    heading : float
        Direction of runway or catapult [rad].
    home_elevation : float
        Above mean sea level [m].
    wind : tuple of float
        Velocity of the air over ground, north and east [m/s].
    values : mapping, optional
        Further values by variable name.
    """

    def __init__(
        self,
        library: FmuLibrary,
        *,
        aircraft: str,
        launch: str = "runway",
        heading: float = 0.0,
        home_elevation: float = 0.0,
        wind: tuple[float, float] = (0.0, 0.0),
        values: Mapping[str, float] | None = None,
    ) -> None:
        from fmu.plant import FmuPlant  # noqa: PLC0415

        if launch not in LAUNCHES:
            raise ValueError(f"launch={launch!r}: must be one of {', '.join(LAUNCHES)}")
        start = {"command.mode": 0.0, "launch.mode": _LAUNCH_MODE[launch], **_DEFAULTS[launch]}
        self._plant = FmuPlant(
            library,
            aircraft=aircraft,
            altitude=100.0,
            heading=heading,
            home_elevation=home_elevation,
            wind=(*wind, 0.0),
            parameters={**start, **(values or {})},
            name="in the loop",
        )
        get = self._plant.get
        limits = [get(f"aircraft.actuator.{name}_limit") for name in ("aileron", "elevator", "rudder")]
        if get("aircraft.actuator.elevons"):
            limits[1] = limits[0]  # the limit is that of each elevon
        aero = ("Cl_aileron", "Cm_elevator", "Cn_rudder")
        signs = [math.copysign(1.0, get(f"aircraft.aero.{name}")) for name in aero]
        self._gains = [limit * sign for limit, sign in zip(limits, signs, strict=True)]
        self._channel = self._plant.channel(_TRUTH)
        self._trim = Axes(0.0, *self._level_trim())
        self._begin()

    def _level_trim(self) -> tuple[float, float, float]:
        """Pitch, yaw and throttle of level flight, for a start in the air."""
        elevator, throttle = self._plant.get("state.elevator"), self._plant.get("state.throttle")
        return (elevator / self._gains[1] if self._gains[1] else 0.0, 0.0, throttle)

    def _begin(self) -> None:
        self._phase = Phase(int(self._plant.get("flight.phase")))
        if self._phase is Phase.FLYING:
            self.fly(self._trim)

    @property
    def phase(self) -> Phase:
        """Standing, launching, flying or landed."""
        if self._phase is not Phase.LANDED:
            self._phase = Phase(int(self._plant.get("flight.phase")))
        return self._phase

    @property
    def contact_speed(self) -> float:
        """Rate of descent at the touchdown [m/s]; 0 before it."""
        return self._plant.get("flight.contact_speed")

    def truth(self) -> Truth:
        """The state after the last step."""
        return Truth(self._plant.time, *self._channel.read())

    def fly(self, axes: Axes) -> None:
        """Command the surfaces and the engine; a NaN is refused by the model with a `ValueError`."""
        roll, pitch, yaw = self._gains
        self._plant.fly_direct(roll * axes.roll, pitch * axes.pitch, yaw * axes.yaw, axes.throttle)

    def launch(self) -> None:
        """Begin the roll or release the catapult."""
        self._plant.set("command.launch", 1)

    def step(self, duration: float) -> None:
        """Advance by `duration` seconds."""
        self._plant.step(duration)

    def restart(self) -> None:
        """Back to the start of the flight, on the ground if it began there."""
        self._plant.set("command.launch", 0)
        self._plant.reset()
        self._begin()

    def close(self) -> None:
        """Free the instance; a second call does nothing."""
        self._plant.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
