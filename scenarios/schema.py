"""The tables of a scenario file as pydantic models: keys, units, ranges and defaults.

Units are in the keys; this is the border where they are converted (`load.py`).
"""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Annotated, Literal, Self

from pydantic import AwareDatetime, BaseModel, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

MAP_LIMIT = 1_000_000.0
"""Largest distance from home along either axis [m]."""

Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$")]
MapCoordinate = Annotated[float, Field(ge=-MAP_LIMIT, le=MAP_LIMIT)]
Altitude = Annotated[float, Field(ge=0.0, le=10_000.0)]
Latitude = Annotated[float, Field(ge=-90.0, le=90.0)]
Longitude = Annotated[float, Field(ge=-180.0, le=180.0)]
SafetyRadius = Annotated[float, Field(gt=0.0, le=50_000.0)]
Seconds = Annotated[float, Field(ge=0.0, le=1_000_000.0)]
Identity = Annotated[int, Field(ge=0, le=999_999_999)]
Airspeed = Annotated[float, Field(gt=0.0, le=100.0)]
WindComponent = Annotated[float, Field(ge=-30.0, le=30.0)]


class Table(BaseModel):
    """Base of all tables: unknown keys, wrong types, NaN and infinity are refused."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


class HomeTable(Table):
    """Origin of the map and the height of its ground above the sea."""

    latitude_deg: Latitude = 14.39
    longitude_deg: Longitude = 76.60
    altitude_m: Annotated[float, Field(ge=-500.0, le=6_000.0)] = 600.0


class PlaceTable(Table):
    """A point by map metres or by latitude and longitude."""

    north_m: MapCoordinate | None = None
    east_m: MapCoordinate | None = None
    latitude_deg: Latitude | None = None
    longitude_deg: Longitude | None = None

    @model_validator(mode="after")
    def _one_kind_of_position(self) -> Self:
        by_map = (self.north_m, self.east_m)
        by_globe = (self.latitude_deg, self.longitude_deg)
        given = by_map if by_globe == (None, None) else by_globe
        if None in given or (by_map != (None, None) and given is by_globe):
            message = "needs north_m and east_m, or latitude_deg and longitude_deg (both, and not mixed)"
            raise PydanticCustomError("position", message)
        return self


class PositionTable(PlaceTable):
    """A point with its altitude above home."""

    altitude_m: Altitude | None = None


class MissionTable(PositionTable):
    """One waypoint of the mission."""

    speed_m_s: Airspeed | None = None


class ObstacleTable(PositionTable):
    """One stationary obstacle."""

    id: Identity | None = None
    safety_radius_m: SafetyRadius = 1000.0
    appears_at_s: Seconds = 0.0
    kind: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9 _-]{0,31}$")] = "stationary"


class TrafficTable(Table):
    """One moving obstacle."""

    waypoints: Annotated[list[PositionTable], Field(min_length=2, max_length=10_000)]
    id: Identity | None = None
    speed_m_s: Annotated[float, Field(gt=0.0, le=150.0)] = 15.0
    starts_at_s: Seconds = 0.0
    motion: Literal["6dof", "kinematic", "point"] = "6dof"
    violation_radius_m: SafetyRadius | None = None


class WindTable(Table):
    """Wind: where the air moves to, not where it comes from; and its turbulence."""

    north_m_s: WindComponent = 0.0
    east_m_s: WindComponent = 0.0
    turbulence: Literal["none", "light", "moderate", "severe"] = "none"


class RadarTable(Table):
    """The simulated radar; all faults are off by default."""

    range_m: Annotated[float, Field(gt=0.0, le=500_000.0)] = 10_000.0
    period_s: Annotated[float, Field(ge=0.1, le=10.0)] = 1.0
    range_noise_m: Annotated[float, Field(ge=0.0, le=5_000.0)] = 0.0
    bearing_noise_deg: Annotated[float, Field(ge=0.0, le=45.0)] = 0.0
    detection_probability: Annotated[float, Field(gt=0.0, le=1.0)] = 1.0
    field_of_view_deg: Annotated[float, Field(gt=0.0, le=360.0)] = 360.0
    latency_s: Annotated[float, Field(ge=0.0, le=60.0)] = 0.0
    false_tracks_per_scan: Annotated[float, Field(ge=0.0, le=100.0)] = 0.0
    id_swap_probability: Annotated[float, Field(ge=0.0, le=1.0)] = 0.0


class VehicleTable(Table):
    """The own vehicle."""

    aircraft: Name = "skywalker_x8"
    fidelity: Literal["6dof", "kinematic"] = "6dof"
    plant: Annotated[str, Field(min_length=1, max_length=4_000)] | None = None
    airspeed_m_s: Airspeed = 15.0
    acceptance_radius_m: Annotated[float, Field(ge=20.0, le=10_000.0)] | None = None
    heading_deg: Annotated[float, Field(ge=-360.0, le=360.0)] | None = None
    position_error_m: Annotated[float, Field(ge=0.0, le=1_000.0)] = 0.0
    decision_latency_s: Annotated[float, Field(ge=0.0, le=600.0)] = 0.0


class MemberTable(Table):
    """One of several own vehicles: its own mission, or the common one moved aside."""

    name: Name
    id: Identity | None = None
    north_offset_m: MapCoordinate = 0.0
    east_offset_m: MapCoordinate = 0.0
    mission: Annotated[list[MissionTable], Field(min_length=2, max_length=10_000)] | None = None


class RandomTable(Table):
    """Obstacles scattered about the waypoints."""

    count: Annotated[int, Field(ge=0, le=100_000)] = 40
    sigma_m: Annotated[float, Field(gt=0.0, le=100_000.0)] = 3000.0
    clear_of_start_m: Annotated[float, Field(ge=0.0, le=100_000.0)] = 2000.0
    safety_radius_m: SafetyRadius = 1000.0
    largest_safety_radius_m: SafetyRadius | None = None


class FenceTable(Table):
    """One area of the geofence: a polygon, or a circle."""

    type: Literal["include", "exclude"]
    polygon: Annotated[list[PlaceTable], Field(min_length=3, max_length=1_000)] | None = None
    centre: PlaceTable | None = None
    radius_m: Annotated[float, Field(gt=0.0, le=1_000_000.0)] | None = None

    @model_validator(mode="after")
    def _one_shape(self) -> Self:
        circle = (self.centre, self.radius_m)
        if (self.polygon is None) == (circle == (None, None)) or (self.polygon is None and None in circle):
            raise PydanticCustomError("position", "needs polygon, or centre and radius_m (and not both)")
        return self


PlannerName = Literal[
    "pso",
    "gcpso",
    "mpso",
    "ga",
    "sa",
    "theta-mafoa",
    "exact",
    "pyswarms",
    "scipy-de",
    "ompl-rrtstar",
    "ompl-bitstar",
]
"""The names of `scenarios.planners.PLANNERS`."""


class ScenarioTable(Table):
    """A whole scenario file."""

    mission: Annotated[list[MissionTable], Field(min_length=2, max_length=10_000)]
    name: Name | None = None
    description: Annotated[str, Field(max_length=4_000)] = ""
    start_time_utc: AwareDatetime = datetime(2020, 3, 21, 2, 30, tzinfo=UTC)
    time_limit_s: Annotated[float, Field(gt=0.0, le=1_000_000.0)] | None = None
    seed: Annotated[int, Field(ge=0, lt=2**63)] = 0
    preset: Literal["default", "paper"] = "default"
    planner: PlannerName = "pso"
    home: HomeTable = HomeTable()
    wind: WindTable = WindTable()
    radar: RadarTable = RadarTable()
    vehicle: VehicleTable = VehicleTable()
    random: RandomTable | None = None
    obstacles: Annotated[list[ObstacleTable], Field(max_length=100_000)] = []
    traffic: Annotated[list[TrafficTable], Field(max_length=1_000)] = []
    vehicles: Annotated[list[MemberTable], Field(max_length=100)] = []
    geofence: Annotated[list[FenceTable], Field(max_length=100)] = []
    rally: Annotated[list[PositionTable], Field(max_length=1_000)] = []
