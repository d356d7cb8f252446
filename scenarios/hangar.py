"""Vehicles for a scenario: plants of one FMU, with their missions uploaded and started."""

from __future__ import annotations

import math
from collections.abc import Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Self

from avoidance import Performance
from avoidance.parameters import Parameters
from offboard.frames import MapFrame
from offboard.mission import MissionItem, MissionPlan
from offboard.simulated import SimulatedVehicle
from scenarios.errors import ScenarioError
from scenarios.movers import FlownMover, Mover, PointMover
from scenarios.scenario import (
    WIND_AT_20_FT,
    Fidelity,
    Point,
    Scenario,
    Traffic,
    Turbulence,
    Wind,
    turbulence_seed,
)
from scenarios.score import Energy

if TYPE_CHECKING:
    from fmu.library import FmuLibrary
    from fmu.mapped import MappedPlant
    from fmu.plant import FmuPlant

TRACKING_ERROR: dict[str, dict[Turbulence, float]] = {
    "l1": {"none": 6.0, "light": 6.0, "moderate": 10.0, "severe": 30.0},
    "paper": {"none": 10.0, "light": 35.0, "moderate": 65.0, "severe": 105.0},
}
"""Largest distance from a straight leg once it is captured, by guidance law and turbulence [m].

Measured over 20,000 s of the mission of Sec. 5.1 in 8 m/s of wind, in both fidelities: in turbulence 4.5, 9.5
and 26.5 m (L1), 31.5, 64.9 and 101.5 m (paper). After sharper turns: `benchmarks/vehicle_limits.py`.
"""
IN_STILL_AIR = {"l1": 2.5, "paper": 10.0}
"""The same without wind and turbulence, at 15 m/s; it grows with the airspeed."""
CAPTURE_DISTANCE = {"l1": 250.0, "paper": 2500.0}
"""Distance along a new leg until it is captured within that, after a reversal of course, at 15 m/s [m].

Measured on the mission of Sec. 5.1: 219 m (L1, acceptance radius 100 m) and 2,399 m (paper, 1 km).
"""
MEASURED_AT = 15.0
"""Speed at which they were measured [m/s]."""


def tracking_error(guidance: str, airspeed: float, wind: Wind) -> float:
    """Largest distance from a straight leg once it is captured, in a wind [m]."""
    still = IN_STILL_AIR[guidance] * max(airspeed / MEASURED_AT, 1.0)
    if wind.turbulence == "none" and wind.speed == 0.0:
        return still
    return max(still, TRACKING_ERROR[guidance][wind.turbulence])


def capture_distance(guidance: str, airspeed: float, wind: Wind) -> float:
    """Distance along a new leg until it is captured within the tracking error [m].

    That of L1 grows with the ground speed (`benchmarks/vehicle_limits.py`); the paper's is taken as measured.
    """
    faster = max((airspeed + wind.speed + wind.gusts) / MEASURED_AT, 1.0)
    return CAPTURE_DISTANCE[guidance] * (faster if guidance == "l1" else 1.0)


class Hangar:
    """Makes the own vehicle and the traffic of a scenario; a context manager, for it holds the library.

    Parameters
    ----------
    scenario : Scenario
        Gives home, wind and vehicle.
    parameters : Parameters
        Gives guidance law and acceptance radius.
    library : FmuLibrary, optional
        One that is loaded already and stays loaded; else one is loaded, and freed at the end.

    Raises
    ------
    PlantError
        If the FMU is missing or does not load.
    """

    def __init__(self, scenario: Scenario, parameters: Parameters, library: FmuLibrary | None = None) -> None:
        from fmu.library import FmuLibrary  # noqa: PLC0415

        home = scenario.home
        self.frame = MapFrame(home.latitude_deg, home.longitude_deg, home.altitude_m)
        self._scenario = scenario
        self._parameters = parameters
        self._shared = library is not None
        self._library: FmuLibrary = FmuLibrary.open() if library is None else library
        self._plants: list[FmuPlant | MappedPlant] = []
        self._own: list[FmuPlant] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Free all plants, and the library unless it was given."""
        for plant in self._plants:
            plant.close()
        self._plants.clear()
        if not self._shared:
            self._library.close()

    def own_vehicle(self, mission: Sequence[Point] | None = None) -> SimulatedVehicle:
        """A vehicle under test, at the start of its mission; the scenario's unless another is given."""
        points = self._scenario.mission if mission is None else mission
        users = self._scenario.vehicle.plant is not None
        plant, performance = self._user_plant(points) if users else self.own_plant(points)
        return self._vehicle(plant, performance, points)

    def energy(self) -> Energy | None:
        """What is left in the battery; of several own vehicles the least. None of a user's own FMU."""
        if not self._plants:
            raise ValueError("own_vehicle() has not been called")
        if not self._own:
            return None
        return Energy(
            min(plant.get("battery.state_of_charge") for plant in self._own),
            any(bool(plant.get("battery.on_reserve")) for plant in self._own),
        )

    def traffic(self) -> list[Mover]:
        """Everything that moves."""
        return [self._mover(plan) for plan in self._scenario.traffic]

    def _mover(self, plan: Traffic) -> Mover:
        if plan.motion == "point":
            return PointMover(plan)
        wind = self._scenario.wind
        plant, performance = self._plant(
            plan.waypoints, airspeed=plan.speed, fidelity=plan.motion, acceptance_radius=100.0
        )
        vehicle = self._vehicle(plant, performance, plan.waypoints)
        return FlownMover(plan, vehicle, wind.speed + wind.gusts)

    def own_plant(
        self, mission: Sequence[Point] | None = None, *, on_ground: bool = False
    ) -> tuple[FmuPlant, Performance]:
        """A plant for somebody else's autopilot, and what it can do.

        Parameters
        ----------
        mission : sequence of Point, optional
            It is put at the first point, its nose to the second; the scenario's own if not given.
        on_ground : bool
            Stand there on a catapult, instead of flying there in level trim.

        Raises
        ------
        ScenarioError
            If the scenario names a plant of the user's own, or the aircraft cannot be flown so.
        """
        settings = self._scenario.vehicle
        if settings.plant is not None:
            message = f"vehicle.plant = {str(settings.plant)!r} cannot stand behind an autopilot"
            raise ScenarioError(self._scenario.name, message)
        plant, performance = self._plant(
            self._scenario.mission if mission is None else mission,
            airspeed=settings.airspeed,
            fidelity=settings.fidelity,
            acceptance_radius=settings.acceptance_radius or self._parameters.acceptance_radius,
            heading=settings.heading,
            on_ground=on_ground,
        )
        self._own.append(plant)
        return plant, performance

    def _vehicle(
        self, plant: FmuPlant | MappedPlant, performance: Performance, points: Sequence[Point]
    ) -> SimulatedVehicle:
        """A vehicle in front of a plant, its mission started."""
        vehicle = SimulatedVehicle(plant, self.frame, performance)
        vehicle.upload_mission(mission_plan(points, self.frame))
        vehicle.start_mission()
        return vehicle

    def _user_plant(self, points: Sequence[Point]) -> tuple[MappedPlant, Performance]:
        from scenarios.user_plant import user_plant  # noqa: PLC0415

        settings = self._scenario.vehicle
        heading = _heading(points) if settings.heading is None else settings.heading
        radius = settings.acceptance_radius or self._parameters.acceptance_radius
        plant, performance = user_plant(self._scenario, points[0], heading, radius)
        self._plants.append(plant)
        return plant, performance

    def _plant(
        self,
        points: Sequence[Point],
        *,
        airspeed: float,
        fidelity: Fidelity,
        acceptance_radius: float,
        heading: float | None = None,
        on_ground: bool = False,
    ) -> tuple[FmuPlant, Performance]:
        from fmu.plant import FmuPlant  # noqa: PLC0415

        start = points[0]
        wind = self._scenario.wind
        try:
            plant = FmuPlant(
                self._library,
                aircraft=self._scenario.vehicle.aircraft,
                fidelity=fidelity,
                guidance=self._parameters.guidance,
                north=start.north,
                east=start.east,
                altitude=0.0 if on_ground else start.altitude,
                heading=_heading(points) if heading is None else heading,
                airspeed=airspeed,
                home_elevation=self._scenario.home.altitude_m,
                wind=(wind.north, wind.east, 0.0),
                parameters=self._place_and_time()
                | self._turbulence()
                | {"launch.mode": 1.0 if on_ground else 0.0},
            )
        except ValueError as error:
            raise ScenarioError(self._scenario.name, f"the aircraft cannot be flown so: {error}") from error
        self._plants.append(plant)
        performance = Performance(
            airspeed=airspeed,
            max_bank=math.atan(plant.limits.turn_factor * math.tan(plant.limits.max_bank)),
            roll_time=plant.limits.roll_time,
            acceptance_radius=acceptance_radius,
            tracking_error=tracking_error(self._parameters.guidance, airspeed, wind),
            capture_distance=capture_distance(self._parameters.guidance, airspeed, wind),
            wind_bound=wind.speed + wind.gusts,
        )
        return plant, performance

    def _turbulence(self) -> dict[str, float]:
        """Gusts about the next aircraft."""
        speed = WIND_AT_20_FT[self._scenario.wind.turbulence]
        seed = turbulence_seed(self._scenario.seed, len(self._plants))
        return {"turbulence.wind_speed": speed, "turbulence.seed": seed}

    def _place_and_time(self) -> dict[str, float]:
        """Where and when the aircraft flies, for the sun on its wings."""
        home = self._scenario.home
        return {
            "environment.latitude": math.radians(home.latitude_deg),
            "environment.longitude": math.radians(home.longitude_deg),
            "environment.start_time": self._scenario.start_time_utc.timestamp(),
        }


def _heading(points: Sequence[Point]) -> float:
    """Along the first leg [rad]."""
    start, then = points[0], points[1]
    return math.atan2(then.east - start.east, then.north - start.north)


def mission_plan(points: Sequence[Point], frame: MapFrame) -> MissionPlan:
    """The mission as a vehicle takes it."""
    items = []
    for point in points:
        latitude, longitude = frame.to_geodetic(point.north, point.east)
        speed = math.nan if point.speed is None else point.speed
        items.append(MissionItem(latitude, longitude, point.altitude, speed_m_s=speed))
    return MissionPlan.of(items)
