"""Rows of the table: what an aircraft is, its parameters (`fmu/aircraft/*.toml` give them)."""

from __future__ import annotations

from fmu.rows import Variable, parameter


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
        parameter(
            f"aircraft.aero.{head}{tail}",
            "1",
            f"{words[head]} coefficient: "
            + ("constant term" if tail == "0" else f"derivative with respect to {tail[1:]}"),
            bounds=(-1000.0, 1000.0),
        )
        for head, tail in rows
    )


AIRCRAFT: tuple[Variable, ...] = (
    parameter("aircraft.mass", "kg", "Mass", bounds=(1e-3, 1e5)),
    parameter("aircraft.inertia.xx", "kg.m2", "Moment of inertia about the roll axis", bounds=(1e-9, 1e7)),
    parameter("aircraft.inertia.yy", "kg.m2", "Moment of inertia about the pitch axis", bounds=(1e-9, 1e7)),
    parameter("aircraft.inertia.zz", "kg.m2", "Moment of inertia about the yaw axis", bounds=(1e-9, 1e7)),
    parameter("aircraft.inertia.xz", "kg.m2", "Product of inertia, integral of x z dm", bounds=(-1e7, 1e7)),
    parameter("aircraft.wing.area", "m2", "Reference area", bounds=(1e-6, 1e4)),
    parameter("aircraft.wing.span", "m", "Reference span", bounds=(1e-3, 200.0)),
    parameter("aircraft.wing.chord", "m", "Reference chord", bounds=(1e-3, 50.0)),
    parameter(
        "aircraft.aero.alpha_min", "rad", "Angle of attack below which lift is held", bounds=(-3.2, 0.0)
    ),
    parameter(
        "aircraft.aero.alpha_max", "rad", "Angle of attack beyond which lift is held", bounds=(0.0, 3.2)
    ),
    *_derivatives(),
    parameter(
        "aircraft.propulsion.model",
        "1",
        "0: disc (Fitzpatrick), 1: thrust = throttle x maximum",
        bounds=(0, 1),
        kind="Int32",
    ),
    parameter("aircraft.propulsion.disc_area", "m2", "Swept area of the propeller", bounds=(0.0, 1e3)),
    parameter("aircraft.propulsion.coefficient", "1", "Efficiency of the disc", bounds=(0.0, 10.0)),
    parameter("aircraft.propulsion.motor_speed", "m/s", "Slipstream at full throttle", bounds=(0.0, 1e3)),
    parameter("aircraft.propulsion.max_thrust", "N", "Full thrust of the linear model", bounds=(0.0, 1e6)),
    parameter(
        "aircraft.actuator.elevons",
        "1",
        "True: two elevons are aileron and elevator at once; aileron_limit is that of each of them",
        bounds=(0, 1),
        kind="Boolean",
    ),
    parameter("aircraft.actuator.aileron_limit", "rad", "Largest aileron", bounds=(0.0, 1.5)),
    parameter("aircraft.actuator.elevator_limit", "rad", "Largest elevator", bounds=(0.0, 1.5)),
    parameter("aircraft.actuator.rudder_limit", "rad", "Largest rudder; 0: none fitted", bounds=(0.0, 1.5)),
    parameter("aircraft.actuator.surface_rate", "rad/s", "Largest rate of a surface", bounds=(0.1, 100.0)),
    parameter("aircraft.actuator.surface_time", "s", "Lag of a surface", bounds=(0.01, 10.0)),
    parameter("aircraft.actuator.throttle_rate", "1/s", "Largest rate of the throttle", bounds=(0.05, 100.0)),
    parameter("aircraft.actuator.throttle_time", "s", "Lag of the engine", bounds=(0.01, 10.0)),
    parameter("aircraft.limits.cruise_airspeed", "m/s", "Cruise true airspeed", bounds=(1.0, 100.0)),
    parameter("aircraft.limits.min_airspeed", "m/s", "Slowest commanded airspeed", bounds=(1.0, 100.0)),
    parameter("aircraft.limits.max_airspeed", "m/s", "Fastest commanded airspeed", bounds=(1.0, 100.0)),
    parameter("aircraft.limits.climb_rate", "m/s", "Fastest commanded climb", bounds=(0.0, 50.0)),
    parameter("aircraft.limits.sink_rate", "m/s", "Fastest commanded descent", bounds=(0.0, 50.0)),
    parameter(
        "aircraft.control.roll_time", "s", "Time constant of the roll attitude loop", bounds=(0.05, 10.0)
    ),
    parameter(
        "aircraft.control.roll_rate_limit", "rad/s", "Largest commanded roll rate", bounds=(0.01, 10.0)
    ),
    parameter("aircraft.control.roll_rate_gain", "s", "Aileron per roll rate error", bounds=(0.0, 10.0)),
    parameter(
        "aircraft.control.roll_integral_gain", "1/s", "Aileron rate per bank error", bounds=(0.0, 10.0)
    ),
    parameter("aircraft.control.yaw_rate_gain", "s", "Rudder per yaw rate error", bounds=(0.0, 10.0)),
    parameter("aircraft.control.sideslip_gain", "1", "Rudder per sideslip", bounds=(0.0, 10.0)),
    parameter(
        "aircraft.control.sideslip_integral_gain", "1/s", "Rudder rate per sideslip", bounds=(0.0, 10.0)
    ),
    parameter("aircraft.control.pitch_gain", "1", "Elevator per pitch error", bounds=(0.0, 10.0)),
    parameter("aircraft.control.pitch_rate_gain", "s", "Elevator per pitch rate error", bounds=(0.0, 10.0)),
    parameter("aircraft.control.climb_gain", "1", "Pitch per flight path angle error", bounds=(0.0, 10.0)),
    parameter(
        "aircraft.control.climb_integral_gain", "1/s", "Pitch rate per flight path error", bounds=(0.0, 10.0)
    ),
    parameter(
        "aircraft.control.climb_acceleration", "m/s2", "Slew of the climb command", bounds=(0.01, 50.0)
    ),
    parameter(
        "aircraft.control.altitude_time", "s", "Time constant of the altitude hold", bounds=(0.1, 100.0)
    ),
    parameter(
        "aircraft.control.airspeed_time", "s", "Time constant of the airspeed hold", bounds=(0.1, 100.0)
    ),
    parameter(
        "aircraft.control.airspeed_integral_gain", "1/s", "Integral of the airspeed hold", bounds=(0.0, 10.0)
    ),
    parameter(
        "aircraft.control.acceleration_limit", "m/s2", "Largest commanded acceleration", bounds=(0.01, 50.0)
    ),
    parameter("aircraft.kinematic.turn_factor", "1", "Turn rate over g tan(bank)/V", bounds=(0.1, 2.0)),
    parameter("aircraft.kinematic.roll_time", "s", "Roll lag of the kinematic fidelity", bounds=(0.05, 10.0)),
    parameter(
        "aircraft.kinematic.climb_time", "s", "Climb lag of the kinematic fidelity", bounds=(0.05, 100.0)
    ),
    parameter(
        "aircraft.kinematic.airspeed_time",
        "s",
        "Airspeed lag of the kinematic fidelity",
        bounds=(0.05, 100.0),
    ),
    parameter("aircraft.solar.area", "m2", "Area of the solar cells; 0: none", bounds=(0.0, 1e3)),
    parameter("aircraft.solar.efficiency", "1", "Efficiency of the cells at 25 degC", bounds=(0.0, 1.0)),
    parameter("aircraft.solar.chain_efficiency", "1", "Camber and tracker of the array", bounds=(0.0, 1.0)),
    parameter(
        "aircraft.solar.temperature_coefficient", "1/K", "Loss of the cells by warmth", bounds=(0.0, 0.02)
    ),
    parameter("aircraft.battery.capacity", "J", "Energy of the full battery; 0: none", bounds=(0.0, 1e10)),
    parameter("aircraft.battery.reserve", "1", "Share that a flight is not to use", bounds=(0.0, 1.0)),
    parameter("aircraft.battery.charge_efficiency", "1", "Stored over supplied", bounds=(0.1, 1.0)),
    parameter("aircraft.battery.discharge_efficiency", "1", "Delivered over drawn", bounds=(0.1, 1.0)),
    parameter(
        "aircraft.power.chain_efficiency",
        "1",
        "Thrust times airspeed over electric power",
        bounds=(0.01, 1.0),
    ),
    parameter("aircraft.power.avionics", "W", "Power of everything but the motor", bounds=(0.0, 1e5)),
)
