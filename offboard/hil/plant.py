"""What a bridge needs of an aircraft: surfaces in, the truth that sensors measure out."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple, Protocol


class Phase(IntEnum):
    """Where the aircraft is in its flight."""

    STANDING = 0
    """On the ground or on the catapult, before its launch."""
    LAUNCHING = 1
    """Rolling, or accelerated by the catapult."""
    FLYING = 2
    LANDED = 3
    """Standing where it met the ground."""


class Axes(NamedTuple):
    """What an autopilot asks of its aircraft, as a share of full deflection."""

    roll: float
    """Right wing down positive, -1 to 1."""
    pitch: float
    """Nose up positive, -1 to 1."""
    yaw: float
    """Nose right positive, -1 to 1."""
    throttle: float
    """0 to 1."""


NEUTRAL = Axes(0.0, 0.0, 0.0, 0.0)
"""Surfaces centred, engine off."""


class Truth(NamedTuple):
    """The aircraft at one instant, free of noise; map metres about home, SI, radians."""

    time: float
    """Since the start [s]."""
    north: float
    """North of home on the map [m]."""
    east: float
    """East of home on the map [m]."""
    altitude: float
    """Above home [m]."""
    velocity_north: float
    """Over ground, map axes [m/s]."""
    velocity_east: float
    """Over ground, map axes [m/s]."""
    velocity_down: float
    """Over ground [m/s]."""
    qw: float
    """Attitude, body (forward, right, down) to map axes (north, east, down): quaternion w, x, y, z."""
    qx: float
    qy: float
    qz: float
    p: float
    """Roll rate, body [rad/s]."""
    q: float
    """Pitch rate, body [rad/s]."""
    r: float
    """Yaw rate, body [rad/s]."""
    force_x: float
    """Specific force, body forward: acceleration less gravity [m/s²]."""
    force_y: float
    """Specific force, body right [m/s²]."""
    force_z: float
    """Specific force, body down; -g at rest [m/s²]."""
    static_pressure: float
    """[Pa]"""
    differential_pressure: float
    """Pitot less static pressure [Pa]."""
    temperature: float
    """Of the air [K]."""
    airspeed: float
    """True airspeed [m/s]."""


class HilPlant(Protocol):
    """An aircraft flown by its surfaces, stepped from outside; errors of a failed model are its own."""

    @property
    def phase(self) -> Phase:
        """Standing, launching, flying or landed."""

    @property
    def contact_speed(self) -> float:
        """Rate of descent at the touchdown [m/s]; 0 before it."""

    def truth(self) -> Truth:
        """The state after the last step."""

    def fly(self, axes: Axes) -> None:
        """Command the surfaces and the engine until told otherwise."""

    def launch(self) -> None:
        """Begin the roll or release the catapult; nothing happens unless the aircraft stands."""

    def step(self, duration: float) -> None:
        """Advance by `duration` seconds."""

    def restart(self) -> None:
        """Back to the start of the flight, time zero."""
