"""The one table of the model's variables: name, causality, unit, start, bounds, description.

Everything that must agree about them is generated from here: `modelDescription.xml`, the C header with
the memory layout and the bounds, the checks of the aircraft files. A variable's value reference is its
row in `TABLE`; new variables go to the end of their section only before a release, to the end of the
table after it.

Frames: north and east are map metres about home, altitude is above home; "body" is forward, right, down.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

Causality = Literal["independent", "parameter", "input", "output"]
Kind = Literal["Float64", "Int32", "Boolean"]

INF = math.inf
FAR = 1e7
"""Largest map coordinate accepted [m]."""


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


def _parameter(
    name: str,
    unit: str,
    text: str,
    start: float | None = None,
    bounds: tuple[float, float] = (-INF, INF),
    *,
    kind: Kind = "Float64",
) -> Variable:
    return Variable(name, "parameter", unit, text, start, *bounds, kind)


def _input(
    name: str, unit: str, text: str, start: float, bounds: tuple[float, float], *, kind: Kind = "Float64"
) -> Variable:
    return Variable(name, "input", unit, text, start, *bounds, kind)


def _output(
    name: str, unit: str, text: str, bounds: tuple[float, float] = (-INF, INF), *, kind: Kind = "Float64"
) -> Variable:
    return Variable(name, "output", unit, text, None, *bounds, kind)


def _derivatives() -> tuple[Variable, ...]:
    """Rows of the aerodynamic polynomial (Beard & McLain 2012, ch. 4; rates made nondimensional with
    b/2V for roll and yaw, c/2V for pitch; angles in radians)."""
    longitudinal = {
        "CL": ("0", "_alpha", "_alpha2", "_alpha3", "_q", "_elevator"),
        "CD": ("0", "_alpha", "_alpha2", "_elevator2", "_beta", "_beta2"),
        "Cm": ("0", "_alpha", "_q", "_elevator"),
    }
    lateral = ("_beta", "_p", "_r", "_aileron", "_rudder")
    words = {"CL": "Lift", "CD": "Drag", "Cm": "Pitching moment", "CY": "Side force", "Cl": "Rolling moment"}
    words["Cn"] = "Yawing moment"
    rows = [(head, tail) for head, tails in longitudinal.items() for tail in tails]
    rows += [(head, tail) for head in ("CY", "Cl", "Cn") for tail in lateral]
    return tuple(
        _parameter(
            f"aircraft.aero.{head}{tail}",
            "1",
            f"{words[head]} coefficient: "
            + ("constant term" if tail == "0" else f"derivative with respect to {tail[1:]}"),
            bounds=(-1000.0, 1000.0),
        )
        for head, tail in rows
    )


_AIRCRAFT: tuple[Variable, ...] = (
    _parameter("aircraft.mass", "kg", "Mass", bounds=(1e-3, 1e5)),
    _parameter("aircraft.inertia.xx", "kg.m2", "Moment of inertia about the roll axis", bounds=(1e-9, 1e7)),
    _parameter("aircraft.inertia.yy", "kg.m2", "Moment of inertia about the pitch axis", bounds=(1e-9, 1e7)),
    _parameter("aircraft.inertia.zz", "kg.m2", "Moment of inertia about the yaw axis", bounds=(1e-9, 1e7)),
    _parameter("aircraft.inertia.xz", "kg.m2", "Product of inertia, integral of x z dm", bounds=(-1e7, 1e7)),
    _parameter("aircraft.wing.area", "m2", "Reference area", bounds=(1e-6, 1e4)),
    _parameter("aircraft.wing.span", "m", "Reference span", bounds=(1e-3, 200.0)),
    _parameter("aircraft.wing.chord", "m", "Reference chord", bounds=(1e-3, 50.0)),
    _parameter(
        "aircraft.aero.alpha_min", "rad", "Angle of attack below which lift is held", bounds=(-3.2, 0.0)
    ),
    _parameter(
        "aircraft.aero.alpha_max", "rad", "Angle of attack beyond which lift is held", bounds=(0.0, 3.2)
    ),
    *_derivatives(),
    _parameter(
        "aircraft.propulsion.model",
        "1",
        "0: disc (Fitzpatrick), 1: thrust = throttle x maximum",
        bounds=(0, 1),
        kind="Int32",
    ),
    _parameter("aircraft.propulsion.disc_area", "m2", "Swept area of the propeller", bounds=(0.0, 1e3)),
    _parameter("aircraft.propulsion.coefficient", "1", "Efficiency of the disc", bounds=(0.0, 10.0)),
    _parameter("aircraft.propulsion.motor_speed", "m/s", "Slipstream at full throttle", bounds=(0.0, 1e3)),
    _parameter("aircraft.propulsion.max_thrust", "N", "Full thrust of the linear model", bounds=(0.0, 1e6)),
    _parameter(
        "aircraft.actuator.elevons",
        "1",
        "True: two elevons are aileron and elevator at once; aileron_limit is that of each of them",
        bounds=(0, 1),
        kind="Boolean",
    ),
    _parameter("aircraft.actuator.aileron_limit", "rad", "Largest aileron", bounds=(0.0, 1.5)),
    _parameter("aircraft.actuator.elevator_limit", "rad", "Largest elevator", bounds=(0.0, 1.5)),
    _parameter("aircraft.actuator.rudder_limit", "rad", "Largest rudder; 0: none fitted", bounds=(0.0, 1.5)),
    _parameter("aircraft.actuator.surface_rate", "rad/s", "Largest rate of a surface", bounds=(0.1, 100.0)),
    _parameter("aircraft.actuator.surface_time", "s", "Lag of a surface", bounds=(0.01, 10.0)),
    _parameter(
        "aircraft.actuator.throttle_rate", "1/s", "Largest rate of the throttle", bounds=(0.05, 100.0)
    ),
    _parameter("aircraft.actuator.throttle_time", "s", "Lag of the engine", bounds=(0.01, 10.0)),
    _parameter("aircraft.limits.cruise_airspeed", "m/s", "Cruise true airspeed", bounds=(1.0, 100.0)),
    _parameter("aircraft.limits.min_airspeed", "m/s", "Slowest commanded airspeed", bounds=(1.0, 100.0)),
    _parameter("aircraft.limits.max_airspeed", "m/s", "Fastest commanded airspeed", bounds=(1.0, 100.0)),
    _parameter("aircraft.limits.climb_rate", "m/s", "Fastest commanded climb", bounds=(0.0, 50.0)),
    _parameter("aircraft.limits.sink_rate", "m/s", "Fastest commanded descent", bounds=(0.0, 50.0)),
    _parameter(
        "aircraft.control.roll_time", "s", "Time constant of the roll attitude loop", bounds=(0.05, 10.0)
    ),
    _parameter(
        "aircraft.control.roll_rate_limit", "rad/s", "Largest commanded roll rate", bounds=(0.01, 10.0)
    ),
    _parameter("aircraft.control.roll_rate_gain", "s", "Aileron per roll rate error", bounds=(0.0, 10.0)),
    _parameter(
        "aircraft.control.roll_integral_gain", "1/s", "Aileron rate per bank error", bounds=(0.0, 10.0)
    ),
    _parameter("aircraft.control.yaw_rate_gain", "s", "Rudder per yaw rate error", bounds=(0.0, 10.0)),
    _parameter("aircraft.control.sideslip_gain", "1", "Rudder per sideslip", bounds=(0.0, 10.0)),
    _parameter(
        "aircraft.control.sideslip_integral_gain", "1/s", "Rudder rate per sideslip", bounds=(0.0, 10.0)
    ),
    _parameter("aircraft.control.pitch_gain", "1", "Elevator per pitch error", bounds=(0.0, 10.0)),
    _parameter("aircraft.control.pitch_rate_gain", "s", "Elevator per pitch rate error", bounds=(0.0, 10.0)),
    _parameter("aircraft.control.climb_gain", "1", "Pitch per flight path angle error", bounds=(0.0, 10.0)),
    _parameter(
        "aircraft.control.climb_integral_gain", "1/s", "Pitch rate per flight path error", bounds=(0.0, 10.0)
    ),
    _parameter(
        "aircraft.control.climb_acceleration", "m/s2", "Slew of the climb command", bounds=(0.01, 50.0)
    ),
    _parameter(
        "aircraft.control.altitude_time", "s", "Time constant of the altitude hold", bounds=(0.1, 100.0)
    ),
    _parameter(
        "aircraft.control.airspeed_time", "s", "Time constant of the airspeed hold", bounds=(0.1, 100.0)
    ),
    _parameter(
        "aircraft.control.airspeed_integral_gain", "1/s", "Integral of the airspeed hold", bounds=(0.0, 10.0)
    ),
    _parameter(
        "aircraft.control.acceleration_limit", "m/s2", "Largest commanded acceleration", bounds=(0.01, 50.0)
    ),
    _parameter("aircraft.kinematic.turn_factor", "1", "Turn rate over g tan(bank)/V", bounds=(0.1, 2.0)),
    _parameter(
        "aircraft.kinematic.roll_time", "s", "Roll lag of the kinematic fidelity", bounds=(0.05, 10.0)
    ),
    _parameter(
        "aircraft.kinematic.climb_time", "s", "Climb lag of the kinematic fidelity", bounds=(0.05, 100.0)
    ),
    _parameter(
        "aircraft.kinematic.airspeed_time",
        "s",
        "Airspeed lag of the kinematic fidelity",
        bounds=(0.05, 100.0),
    ),
    _parameter("aircraft.solar.area", "m2", "Area of the solar cells; 0: none", bounds=(0.0, 1e3)),
    _parameter("aircraft.solar.efficiency", "1", "Efficiency of the cells at 25 degC", bounds=(0.0, 1.0)),
    _parameter("aircraft.solar.chain_efficiency", "1", "Camber and tracker of the array", bounds=(0.0, 1.0)),
    _parameter(
        "aircraft.solar.temperature_coefficient", "1/K", "Loss of the cells by warmth", bounds=(0.0, 0.02)
    ),
    _parameter("aircraft.battery.capacity", "J", "Energy of the full battery; 0: none", bounds=(0.0, 1e10)),
    _parameter("aircraft.battery.reserve", "1", "Share that a flight is not to use", bounds=(0.0, 1.0)),
    _parameter("aircraft.battery.charge_efficiency", "1", "Stored over supplied", bounds=(0.1, 1.0)),
    _parameter("aircraft.battery.discharge_efficiency", "1", "Delivered over drawn", bounds=(0.1, 1.0)),
    _parameter(
        "aircraft.power.chain_efficiency",
        "1",
        "Thrust times airspeed over electric power",
        bounds=(0.01, 1.0),
    ),
    _parameter("aircraft.power.avionics", "W", "Power of everything but the motor", bounds=(0.0, 1e5)),
)

_SETTINGS: tuple[Variable, ...] = (
    _parameter("fidelity", "1", "0: six degrees of freedom, 1: kinematic", 0, (0, 1), kind="Int32"),
    _parameter(
        "guidance.law", "1", "Lateral law of a leg, 0: the paper's Eqs. 13-20, 1: L1", 1, (0, 1), kind="Int32"
    ),
    _parameter("guidance.max_bank", "rad", "Bank limit of the guidance", math.radians(30.0), (0.01, 1.2)),
    _parameter("guidance.l1_damping", "1", "Damping of the L1 law", 0.75, (0.1, 2.0)),
    _parameter("guidance.l1_period", "s", "Period of the L1 law", 20.0, (2.0, 200.0)),
    _parameter(
        "environment.gravity",
        "m/s2",
        "Acceleration of gravity at mean sea level (9.81 as the paper has it)",
        9.81,
        (0.0, 100.0),
    ),
    _parameter("environment.gravity_gradient", "1/s2", "Loss of gravity per height", 3.086e-6, (0.0, 1e-3)),
    _parameter(
        "environment.earth_rate", "rad/s", "Rotation of the earth (7.292115e-5); 0: none", 0.0, (0.0, 1e-3)
    ),
    _parameter(
        "environment.earth_curvature", "1/m", "Inverse radius of the earth; 0: flat", 0.0, (0.0, 1e-5)
    ),
    _parameter("environment.latitude", "rad", "Latitude of home", math.radians(47.37), (-1.58, 1.58)),
    _parameter("environment.longitude", "rad", "Longitude of home", math.radians(8.55), (-6.3, 6.3)),
    _parameter(
        "environment.start_time",
        "s",
        "When the run starts, in Unix time (UTC); default 2025-06-21 08:00",
        1750492800.0,
        (-1e10, 1e10),
    ),
    _parameter("environment.clearness", "1", "Share of a clear day's sunlight", 1.0, (0.0, 1.0)),
    _parameter(
        "turbulence.wind_speed", "m/s", "Wind 20 ft above ground that makes the turbulence", 0.0, (0.0, 50.0)
    ),
    _parameter("turbulence.seed", "1", "Seed of the turbulence", 1, (-2147483648, 2147483647), kind="Int32"),
    _parameter("ground.present", "1", "True: a descent to the ground ends there", 1, (0, 1), kind="Boolean"),
    _parameter("ground.elevation", "m", "Height of the ground above home", 0.0, (-1000.0, 10000.0)),
    _parameter("launch.mode", "1", "0: starts in the air, 1: catapult, 2: runway", 0, (0, 2), kind="Int32"),
    _parameter(
        "launch.speed",
        "m/s",
        "Catapult: speed over ground at its end; runway: airspeed at which it lifts off",
        14.0,
        (1.0, 100.0),
    ),
    _parameter("launch.length", "m", "Length of the catapult", 4.0, (0.1, 100.0)),
    _parameter("launch.pitch", "rad", "Pitch of catapult or standing aircraft", 0.15, (-0.2, 0.7)),
    _parameter("launch.friction", "1", "Rolling friction on the runway", 0.04, (0.0, 1.0)),
    _parameter("initial.charge", "1", "State of charge of the battery at the start", 1.0, (0.0, 1.0)),
    _parameter(
        "environment.home_elevation", "m", "Elevation of home above mean sea level", 0.0, (-500.0, 9000.0)
    ),
    _parameter("initial.north", "m", "Position at the start", 0.0, (-FAR, FAR)),
    _parameter("initial.east", "m", "Position at the start", 0.0, (-FAR, FAR)),
    _parameter("initial.altitude", "m", "Altitude above home at the start", 200.0, (-1000.0, 20000.0)),
    _parameter("initial.heading", "rad", "Direction of the nose at the start", 0.0, (-10.0, 10.0)),
    _parameter("initial.airspeed", "m/s", "True airspeed at the start", 15.0, (0.0, 200.0)),
    _parameter(
        "initial.trimmed",
        "1",
        "True: start in level trim; false: use the values below",
        1,
        (0, 1),
        kind="Boolean",
    ),
    _parameter("initial.bank", "rad", "Bank at the start if not trimmed", 0.0, (-4.0, 4.0)),
    _parameter("initial.pitch", "rad", "Pitch at the start if not trimmed", 0.0, (-1.6, 1.6)),
    _parameter("initial.alpha", "rad", "Angle of attack at the start if not trimmed", 0.0, (-1.6, 1.6)),
    _parameter("initial.beta", "rad", "Sideslip at the start if not trimmed", 0.0, (-1.6, 1.6)),
    _parameter("initial.p", "rad/s", "Roll rate at the start if not trimmed", 0.0, (-50.0, 50.0)),
    _parameter("initial.q", "rad/s", "Pitch rate at the start if not trimmed", 0.0, (-50.0, 50.0)),
    _parameter("initial.r", "rad/s", "Yaw rate at the start if not trimmed", 0.0, (-50.0, 50.0)),
    _parameter("initial.aileron", "rad", "Aileron at the start if not trimmed", 0.0, (-1.5, 1.5)),
    _parameter("initial.elevator", "rad", "Elevator at the start if not trimmed", 0.0, (-1.5, 1.5)),
    _parameter("initial.rudder", "rad", "Rudder at the start if not trimmed", 0.0, (-1.5, 1.5)),
    _parameter("initial.throttle", "1", "Throttle at the start if not trimmed", 0.0, (0.0, 1.0)),
)

_INPUTS: tuple[Variable, ...] = (
    _input("command.mode", "1", "0: direct surfaces, 1: leg, 2: orbit", 1, (0, 2), kind="Int32"),
    _input(
        "command.orbit.direction",
        "1",
        "+1 clockwise seen from above, -1 anticlockwise",
        1,
        (-1, 1),
        kind="Int32",
    ),
    _input("command.leg.from_north", "m", "Where the leg begins", 0.0, (-FAR, FAR)),
    _input("command.leg.from_east", "m", "Where the leg begins", 0.0, (-FAR, FAR)),
    _input("command.leg.to_north", "m", "Where the leg ends; it is flown on beyond", 1000.0, (-FAR, FAR)),
    _input("command.leg.to_east", "m", "Where the leg ends; it is flown on beyond", 0.0, (-FAR, FAR)),
    _input("command.orbit.north", "m", "Centre of the orbit", 0.0, (-FAR, FAR)),
    _input("command.orbit.east", "m", "Centre of the orbit", 0.0, (-FAR, FAR)),
    _input("command.orbit.radius", "m", "Radius of the orbit", 100.0, (1.0, FAR)),
    _input("command.altitude", "m", "Altitude to hold above home", 200.0, (-1000.0, 20000.0)),
    _input(
        "command.airspeed", "m/s", "True airspeed to hold, within the aircraft's limits", 15.0, (1.0, 100.0)
    ),
    _input("command.aileron", "rad", "Aileron in direct mode; positive rolls right", 0.0, (-1.5, 1.5)),
    _input(
        "command.elevator", "rad", "Elevator in direct mode; positive is trailing edge down", 0.0, (-1.5, 1.5)
    ),
    _input("command.rudder", "rad", "Rudder in direct mode", 0.0, (-1.5, 1.5)),
    _input("command.throttle", "1", "Throttle in direct mode", 0.0, (0.0, 1.0)),
    _input("command.launch", "1", "True: launch, if held on the ground", 0, (0, 1), kind="Boolean"),
    _input("wind.north", "m/s", "Velocity of the air over ground", 0.0, (-100.0, 100.0)),
    _input("wind.east", "m/s", "Velocity of the air over ground", 0.0, (-100.0, 100.0)),
    _input("wind.down", "m/s", "Velocity of the air over ground", 0.0, (-100.0, 100.0)),
)

_OUTPUTS: tuple[Variable, ...] = (
    _output("state.north", "m", "Position"),
    _output("state.east", "m", "Position"),
    _output("state.altitude", "m", "Altitude above home"),
    _output("state.velocity_north", "m/s", "Velocity over ground"),
    _output("state.velocity_east", "m/s", "Velocity over ground"),
    _output("state.climb_rate", "m/s", "Upward velocity over ground"),
    _output("state.airspeed", "m/s", "True airspeed"),
    _output("state.heading", "rad", "Direction of the nose, -pi to pi"),
    _output("state.bank", "rad", "Roll angle, right wing down positive"),
    _output("state.pitch", "rad", "Pitch angle"),
    _output("state.p", "rad/s", "Roll rate, body"),
    _output("state.q", "rad/s", "Pitch rate, body"),
    _output("state.r", "rad/s", "Yaw rate, body"),
    _output("state.alpha", "rad", "Angle of attack"),
    _output("state.beta", "rad", "Sideslip, wind from the right positive"),
    _output("state.ground_speed", "m/s", "Horizontal speed over ground"),
    _output("state.course", "rad", "Direction of travel over ground, -pi to pi"),
    _output("state.velocity_down", "m/s", "Velocity over ground"),
    _output("state.quaternion.w", "1", "Attitude, body to north-east-down"),
    _output("state.quaternion.x", "1", "Attitude, body to north-east-down"),
    _output("state.quaternion.y", "1", "Attitude, body to north-east-down"),
    _output("state.quaternion.z", "1", "Attitude, body to north-east-down"),
    _output("state.u", "m/s", "Velocity over ground, body forward"),
    _output("state.v", "m/s", "Velocity over ground, body right"),
    _output("state.w", "m/s", "Velocity over ground, body down"),
    _output("state.aileron", "rad", "Aileron position"),
    _output("state.elevator", "rad", "Elevator position"),
    _output("state.rudder", "rad", "Rudder position"),
    _output("state.throttle", "1", "Throttle position"),
    _output("rate.u", "m/s2", "Time derivative of state.u"),
    _output("rate.v", "m/s2", "Time derivative of state.v"),
    _output("rate.w", "m/s2", "Time derivative of state.w"),
    _output("rate.quaternion.w", "1/s", "Time derivative of state.quaternion.w"),
    _output("rate.quaternion.x", "1/s", "Time derivative of state.quaternion.x"),
    _output("rate.quaternion.y", "1/s", "Time derivative of state.quaternion.y"),
    _output("rate.quaternion.z", "1/s", "Time derivative of state.quaternion.z"),
    _output("rate.p", "rad/s2", "Time derivative of state.p"),
    _output("rate.q", "rad/s2", "Time derivative of state.q"),
    _output("rate.r", "rad/s2", "Time derivative of state.r"),
    _output("rate.aileron", "rad/s", "Time derivative of state.aileron"),
    _output("rate.elevator", "rad/s", "Time derivative of state.elevator"),
    _output("rate.rudder", "rad/s", "Time derivative of state.rudder"),
    _output("rate.throttle", "1/s", "Time derivative of state.throttle"),
    _output("state.elevon_left", "rad", "Left elevon, trailing edge down positive: elevator + aileron"),
    _output("state.elevon_right", "rad", "Right elevon, trailing edge down positive: elevator - aileron"),
    _output("sensor.specific_force.x", "m/s2", "What an accelerometer reads, body forward"),
    _output("sensor.specific_force.y", "m/s2", "What an accelerometer reads, body right"),
    _output("sensor.specific_force.z", "m/s2", "What an accelerometer reads, body down"),
    _output("sensor.load_factor", "1", "Specific force along body up over gravity"),
    _output("sensor.static_pressure", "Pa", "Static pressure"),
    _output("sensor.differential_pressure", "Pa", "Pitot less static pressure"),
    _output("sensor.temperature", "K", "Temperature of the air"),
    _output("air.gust_north", "m/s", "Turbulence, over the steady wind"),
    _output("air.gust_east", "m/s", "Turbulence, over the steady wind"),
    _output("air.gust_down", "m/s", "Turbulence, over the steady wind"),
    _output("air.density", "kg/m3", "Density of the US Standard Atmosphere 1976"),
    _output("engine.thrust", "N", "Thrust"),
    _output("guidance.cross_track", "m", "Right of the leg positive; outside the orbit positive"),
    _output("guidance.bank_command", "rad", "Bank asked for by the guidance"),
    _output("guidance.climb_command", "m/s", "Climb asked for by the guidance"),
    _output("state.stalled", "1", "Angle of attack is outside the range of the lift data", kind="Boolean"),
    _output("flight.phase", "1", "0: held, 1: being launched, 2: flying, 3: landed", (0, 3), kind="Int32"),
    _output("flight.contact_speed", "m/s", "Rate of descent at the contact with the ground"),
    _output("battery.energy", "J", "Energy in the battery"),
    _output("battery.state_of_charge", "1", "Energy over capacity"),
    _output("battery.power_in", "W", "Power of the solar array"),
    _output("battery.power_out", "W", "Power of motor and avionics"),
    _output("battery.power_stored", "W", "Time derivative of battery.energy"),
    _output("battery.on_reserve", "1", "The reserve has been touched", kind="Boolean"),
    _output("battery.empty", "1", "The battery has been emptied; the motor is off", kind="Boolean"),
    _output("sun.elevation", "rad", "Height of the sun above the horizon"),
    _output("sun.azimuth", "rad", "Direction of the sun, clockwise from north"),
    _output("sun.irradiance", "W/m2", "Sunlight on a level surface"),
    _output("event.ground", "1", "Positive until the aircraft leaves or meets the ground"),
    _output("event.launch", "1", "Positive until the launch is over"),
    _output("event.battery", "1", "Positive until the battery is at its reserve, then until it is empty"),
)

TABLE: tuple[Variable, ...] = (
    Variable("time", "independent", "s", "Simulated time"),
    *_AIRCRAFT,
    *_SETTINGS,
    *_INPUTS,
    *_OUTPUTS,
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
