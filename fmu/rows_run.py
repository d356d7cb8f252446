"""Rows of the table: what a run is given, settings before it and inputs during it."""

from __future__ import annotations

import math

from fmu.rows import FAR, Variable, given, parameter

SETTINGS: tuple[Variable, ...] = (
    parameter("fidelity", "1", "0: six degrees of freedom, 1: kinematic", 0, (0, 1), kind="Int32"),
    parameter(
        "guidance.law", "1", "Lateral law of a leg, 0: the paper's Eqs. 13-20, 1: L1", 1, (0, 1), kind="Int32"
    ),
    parameter("guidance.max_bank", "rad", "Bank limit of the guidance", math.radians(30.0), (0.01, 1.2)),
    parameter("guidance.l1_damping", "1", "Damping of the L1 law", 0.75, (0.1, 2.0)),
    parameter("guidance.l1_period", "s", "Period of the L1 law", 20.0, (2.0, 200.0)),
    parameter(
        "environment.gravity",
        "m/s2",
        "Acceleration of gravity at mean sea level (9.81 as the paper has it)",
        9.81,
        (0.0, 100.0),
    ),
    parameter("environment.gravity_gradient", "1/s2", "Loss of gravity per height", 3.086e-6, (0.0, 1e-3)),
    parameter(
        "environment.earth_rate", "rad/s", "Rotation of the earth (7.292115e-5); 0: none", 0.0, (0.0, 1e-3)
    ),
    parameter("environment.earth_curvature", "1/m", "Inverse radius of the earth; 0: flat", 0.0, (0.0, 1e-5)),
    parameter("environment.latitude", "rad", "Latitude of home", math.radians(47.37), (-1.58, 1.58)),
    parameter("environment.longitude", "rad", "Longitude of home", math.radians(8.55), (-6.3, 6.3)),
    parameter(
        "environment.start_time",
        "s",
        "When the run starts, in Unix time (UTC); default 2025-06-21 08:00",
        1750492800.0,
        (-1e10, 1e10),
    ),
    parameter("environment.clearness", "1", "Share of a clear day's sunlight", 1.0, (0.0, 1.0)),
    parameter(
        "turbulence.wind_speed", "m/s", "Wind 20 ft above ground that makes the turbulence", 0.0, (0.0, 50.0)
    ),
    parameter("turbulence.seed", "1", "Seed of the turbulence", 1, (-2147483648, 2147483647), kind="Int32"),
    parameter("ground.present", "1", "True: a descent to the ground ends there", 1, (0, 1), kind="Boolean"),
    parameter("ground.elevation", "m", "Height of the ground above home", 0.0, (-1000.0, 10000.0)),
    parameter("launch.mode", "1", "0: starts in the air, 1: catapult, 2: runway", 0, (0, 2), kind="Int32"),
    parameter(
        "launch.speed",
        "m/s",
        "Catapult: speed over ground at its end; runway: airspeed at which it lifts off",
        14.0,
        (1.0, 100.0),
    ),
    parameter("launch.length", "m", "Length of the catapult", 4.0, (0.1, 100.0)),
    parameter("launch.pitch", "rad", "Pitch of catapult or standing aircraft", 0.15, (-0.2, 0.7)),
    parameter("launch.friction", "1", "Rolling friction on the runway", 0.04, (0.0, 1.0)),
    parameter("initial.charge", "1", "State of charge of the battery at the start", 1.0, (0.0, 1.0)),
    parameter(
        "environment.home_elevation", "m", "Elevation of home above mean sea level", 0.0, (-500.0, 9000.0)
    ),
    parameter("initial.north", "m", "Position at the start", 0.0, (-FAR, FAR)),
    parameter("initial.east", "m", "Position at the start", 0.0, (-FAR, FAR)),
    parameter("initial.altitude", "m", "Altitude above home at the start", 200.0, (-1000.0, 20000.0)),
    parameter("initial.heading", "rad", "Direction of the nose at the start", 0.0, (-10.0, 10.0)),
    parameter("initial.airspeed", "m/s", "True airspeed at the start", 15.0, (0.0, 200.0)),
    parameter(
        "initial.trimmed",
        "1",
        "True: start in level trim; false: use the values below",
        1,
        (0, 1),
        kind="Boolean",
    ),
    parameter("initial.bank", "rad", "Bank at the start if not trimmed", 0.0, (-4.0, 4.0)),
    parameter("initial.pitch", "rad", "Pitch at the start if not trimmed", 0.0, (-1.6, 1.6)),
    parameter("initial.alpha", "rad", "Angle of attack at the start if not trimmed", 0.0, (-1.6, 1.6)),
    parameter("initial.beta", "rad", "Sideslip at the start if not trimmed", 0.0, (-1.6, 1.6)),
    parameter("initial.p", "rad/s", "Roll rate at the start if not trimmed", 0.0, (-50.0, 50.0)),
    parameter("initial.q", "rad/s", "Pitch rate at the start if not trimmed", 0.0, (-50.0, 50.0)),
    parameter("initial.r", "rad/s", "Yaw rate at the start if not trimmed", 0.0, (-50.0, 50.0)),
    parameter("initial.aileron", "rad", "Aileron at the start if not trimmed", 0.0, (-1.5, 1.5)),
    parameter("initial.elevator", "rad", "Elevator at the start if not trimmed", 0.0, (-1.5, 1.5)),
    parameter("initial.rudder", "rad", "Rudder at the start if not trimmed", 0.0, (-1.5, 1.5)),
    parameter("initial.throttle", "1", "Throttle at the start if not trimmed", 0.0, (0.0, 1.0)),
)

INPUTS: tuple[Variable, ...] = (
    given("command.mode", "1", "0: direct surfaces, 1: leg, 2: orbit", 1, (0, 2), kind="Int32"),
    given(
        "command.orbit.direction",
        "1",
        "+1 clockwise seen from above, -1 anticlockwise",
        1,
        (-1, 1),
        kind="Int32",
    ),
    given("command.leg.from_north", "m", "Where the leg begins", 0.0, (-FAR, FAR)),
    given("command.leg.from_east", "m", "Where the leg begins", 0.0, (-FAR, FAR)),
    given("command.leg.to_north", "m", "Where the leg ends; it is flown on beyond", 1000.0, (-FAR, FAR)),
    given("command.leg.to_east", "m", "Where the leg ends; it is flown on beyond", 0.0, (-FAR, FAR)),
    given("command.orbit.north", "m", "Centre of the orbit", 0.0, (-FAR, FAR)),
    given("command.orbit.east", "m", "Centre of the orbit", 0.0, (-FAR, FAR)),
    given("command.orbit.radius", "m", "Radius of the orbit", 100.0, (1.0, FAR)),
    given("command.altitude", "m", "Altitude to hold above home", 200.0, (-1000.0, 20000.0)),
    given(
        "command.airspeed", "m/s", "True airspeed to hold, within the aircraft's limits", 15.0, (1.0, 100.0)
    ),
    given("command.aileron", "rad", "Aileron in direct mode; positive rolls right", 0.0, (-1.5, 1.5)),
    given(
        "command.elevator", "rad", "Elevator in direct mode; positive is trailing edge down", 0.0, (-1.5, 1.5)
    ),
    given("command.rudder", "rad", "Rudder in direct mode", 0.0, (-1.5, 1.5)),
    given("command.throttle", "1", "Throttle in direct mode", 0.0, (0.0, 1.0)),
    given("command.launch", "1", "True: launch, if held on the ground", 0, (0, 1), kind="Boolean"),
    given("wind.north", "m/s", "Velocity of the air over ground", 0.0, (-100.0, 100.0)),
    given("wind.east", "m/s", "Velocity of the air over ground", 0.0, (-100.0, 100.0)),
    given("wind.down", "m/s", "Velocity of the air over ground", 0.0, (-100.0, 100.0)),
)
