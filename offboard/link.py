"""The protocols between the avoidance core and whatever flies, sees and keeps time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Protocol

from avoidance import Decision, Ownship, Performance, RadarScan, Route
from offboard.mission import MissionItem, MissionPlan, MissionProgress


class EditStatus(Enum):
    """How far the vehicle is with the last mission edit it was given."""

    IDLE = "idle"
    PENDING = "pending"
    CONFIRMED = "confirmed"
    REFUSED = "refused"
    TIMED_OUT = "timed out"


@dataclass(frozen=True, slots=True)
class VehicleState:
    """What a vehicle reports at one instant."""

    ownship: Ownship
    """Position and motion, in the mission's map frame."""
    edit: EditStatus = EditStatus.IDLE
    """Progress of the edit under way."""


class Vehicle(Protocol):
    """A vehicle that flies a mission: the FMU in process, a simulated autopilot, a real one.

    The mission calls carry MAVSDK's names. `route`, `begin` and `performance` are what the avoidance
    core needs beside them.
    """

    @property
    def performance(self) -> Performance:
        """Speed, bank limit, acceptance radius and tracking error of this vehicle."""

    @property
    def finished(self) -> bool:
        """True once the last mission item has been reached."""

    def state(self) -> VehicleState:
        """The latest state; never blocks."""

    def route(self) -> Route:
        """What is still to be flown, in map metres."""

    def begin(self, decision: Decision) -> None:
        """Start at most one mission edit (or hold) that carries out the decision; never blocks."""

    def upload_mission(self, mission_plan: MissionPlan) -> None:
        """Replace the whole mission; the vehicle must be told to start it."""

    def download_mission(self) -> MissionPlan:
        """The mission as the vehicle has it now, injected items included."""

    def start_mission(self) -> None:
        """Start or resume at the current item."""

    def pause_mission(self) -> None:
        """Orbit where the vehicle is until `start_mission`."""

    def set_current_mission_item(self, index: int) -> None:
        """Fly to item `index` next, from where the vehicle is."""

    def mission_progress(self) -> MissionProgress:
        """Current item and total."""

    def is_mission_finished(self) -> bool:
        """True once the last item has been reached (MAVSDK's name for `finished`)."""

    def inject(self, mission_items: Sequence[MissionItem]) -> None:
        """Put items before the current one, in flight, and fly to the first of them at once."""


class Radar(Protocol):
    """Something that sees obstacles."""

    def scan(self, state: VehicleState, now: float) -> RadarScan:
        """The sweep at time `now` [s] from the vehicle's position."""


class Clock(Protocol):
    """Whoever owns time: a simulation steps the world, a live link waits."""

    @property
    def now(self) -> float:
        """Seconds since the start."""

    def advance(self, period: float) -> None:
        """Let `period` seconds pass."""


class PlantState(Protocol):
    """What a plant tells of itself; map metres, radians, m/s."""

    @property
    def time(self) -> float: ...
    @property
    def north(self) -> float: ...
    @property
    def east(self) -> float: ...
    @property
    def altitude(self) -> float: ...
    @property
    def velocity_north(self) -> float: ...
    @property
    def velocity_east(self) -> float: ...
    @property
    def climb_rate(self) -> float: ...
    @property
    def airspeed(self) -> float: ...
    @property
    def heading(self) -> float: ...
    @property
    def bank(self) -> float: ...
    @property
    def pitch(self) -> float: ...


class Plant(Protocol):
    """An aircraft with its own guidance, stepped from outside."""

    @property
    def state(self) -> PlantState:
        """State after the last step."""

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

    def fly_orbit(
        self, north: float, east: float, radius: float, direction: int, altitude: float, airspeed: float
    ) -> None:
        """Circle a point [m]; direction +1 is clockwise seen from above, -1 anticlockwise."""

    def set_wind(self, north: float, east: float, down: float = 0.0) -> None:
        """Steady wind: the velocity of the air over ground [m/s]."""

    def step(self, duration: float) -> None:
        """Advance by `duration` seconds.

        Raises an error of the plant's own family if the model fails.
        """
