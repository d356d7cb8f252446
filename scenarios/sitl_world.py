"""A world with simulated autopilots in it: what they fly, what their radars see, who else is there."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import TracebackType
from typing import TYPE_CHECKING, Self

from avoidance.parameters import Parameters
from offboard.area_items import fence_items, rally_items
from offboard.frames import MapFrame
from offboard.link import VehicleState
from offboard.raw_mission import RawItem
from offboard.sitl.aircraft import Aircraft, Phase
from offboard.sitl.autopilot import Autopilot, Settings
from offboard.sitl.dialect import mavlink
from offboard.sitl.flavour import Flavour
from offboard.sitl.items import WireItem
from offboard.sitl.px4 import LANDING_WANTED
from offboard.sitl.sensors import Report, Return, show_radar, show_traffic
from scenarios.errors import ScenarioError
from scenarios.fence import geofence_data
from scenarios.hangar import Hangar
from scenarios.movers import Mover
from scenarios.radar import SimulatedRadar
from scenarios.rally import rally_data
from scenarios.scenario import OWN, Member, Point, Scenario, streams
from scenarios.world import World

if TYPE_CHECKING:
    from fmu.plant import FmuPlant

APART = 3000.0
"""Vehicles that were not given missions of their own fly so far from each other [m]."""
APART_ON_GROUND = 300.0
"""The same for what stands on the ground [m]."""
FIRST_ID = 901
"""Identity of the first vehicle of several whose scenario gives none."""


@dataclass(frozen=True, slots=True)
class Catapult:
    """Lets the FMU's aircraft go."""

    plant: FmuPlant

    def launch(self) -> None:
        """Launch it."""
        self.plant.set("command.launch", 1.0)


class SitlWorld:
    """Autopilots in a scenario's world; a context manager, for it holds the FMU.

    The world's own time, its traffic and the pop-ups in it begin with the first launch.

    Parameters
    ----------
    scenario : Scenario
        Its random obstacles drawn (`scenarios.run.prepare`).
    parameters : Parameters
        Give guidance law and acceptance radius.
    flavour : Flavour
        Whose rules the autopilots follow.
    members : sequence of Member
        The vehicles and their missions (`fleet_of`).
    on_ground : bool
        They stand on catapults at home, without a mission; else they are held in the air where their
        missions begin, with these in their memories.
    retry : float
        Time until a mission item is asked for again [s of simulated time].
    settings : mapping, optional
        Autopilot parameters.
    signing_key : bytes, optional
        Key with which all frames must be signed.
    """

    def __init__(
        self,
        scenario: Scenario,
        parameters: Parameters,
        flavour: Flavour,
        members: Sequence[Member],
        *,
        on_ground: bool = False,
        retry: float = 0.2,
        settings: Mapping[str, float] | None = None,
        signing_key: bytes | None = None,
    ) -> None:
        self.scenario = scenario
        self._hangar = Hangar(scenario, parameters)
        self._on_ground = on_ground
        common = Settings(
            flavour=flavour,
            parameters=_usual(flavour, on_ground) | dict(settings or {}),
            start_time=scenario.start_time_utc.timestamp(),
            retry=retry,
            signing_key=signing_key,
        )
        self.autopilots = {
            member.name: self._autopilot(member, replace(common, system_id=number))
            for number, member in enumerate(members, start=1)
        }
        ids = {member.name: member.id for member in members}
        self._traffic = self._hangar.traffic()
        self.world = World(scenario.obstacles, self.autopilots, self._traffic, ids)
        self._radars = {
            name: SimulatedRadar(self.world, scenario.radar, streams(scenario.seed, number)["radar"], name)
            for number, name in enumerate(self.autopilots)
        }
        self._ids = ids
        self._places: dict[int, tuple[float, float, float]] = {}
        self._clock = 0.0
        self._next_sweep = 0.0

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._hangar.close()

    @property
    def flying(self) -> bool:
        """True once anything has been launched."""
        return any(each.aircraft.phase is not Phase.HELD for each in self.autopilots.values())

    @property
    def over(self) -> bool:
        """True once every vehicle has flown its mission to its end."""
        return all(each.captain.mission_over for each in self.autopilots.values())

    def advance(self, duration: float) -> None:
        """Let time pass for all: fly, sweep, tell."""
        if self.flying:
            self.world.advance(duration)
        else:
            for autopilot in self.autopilots.values():
                autopilot.advance(duration)
        self._clock += duration
        if self._clock >= self._next_sweep - 1e-9:
            period = self.scenario.radar.period
            self._next_sweep = max(self._next_sweep + period, self._clock + 0.5 * period)
            self._sweep(period)
        for autopilot in self.autopilots.values():
            autopilot.tick()

    def _autopilot(self, member: Member, settings: Settings) -> Autopilot:
        on_ground = self._on_ground
        plant, performance = self._hangar.own_plant(member.mission, on_ground=on_ground)
        wind = self.scenario.wind
        aircraft = Aircraft(
            plant,
            self._hangar.frame,
            performance,
            launcher=Catapult(plant) if on_ground else None,
            charge=lambda: plant.get("battery.state_of_charge"),
            wind=(wind.north, wind.east),
        )
        autopilot = Autopilot(aircraft, settings)
        if not on_ground:
            autopilot.load_mission(wire_mission(member.mission, self._hangar.frame))
            autopilot.load_areas(*self._areas())
        return autopilot

    def _areas(self) -> tuple[list[WireItem], list[WireItem]]:
        """The scenario's geofence and rally points as wire items."""
        fence = fence_items(geofence_data(self.scenario.geofence, self._hangar.frame))
        rally = rally_items(rally_data(self.scenario.rally, self._hangar.frame))
        return list(map(_wire, fence)), list(map(_wire, rally))

    def _sweep(self, period: float) -> None:
        """What each vehicle's radar sees, and who reports to it, goes out on its links."""
        moving = self._reports(period)
        for name, autopilot in self.autopilots.items():
            state = VehicleState(autopilot.aircraft.ownship())
            scan = self._radars[name].scan(state, self.world.now)
            own = self._ids[name]
            returns, reports = [], []
            rows = zip(scan.ids.tolist(), scan.positions.tolist(), strict=True)
            for identity, (north, east, altitude) in rows:
                report = moving.get(identity)
                if report is None:
                    returns.append(Return(identity, north, east, altitude))
                elif identity != own:
                    reports.append(replace(report, north=north, east=east, altitude=altitude))
            show_radar(autopilot, returns, self.scenario.radar.range)
            show_traffic(autopilot, reports)

    def _reports(self, period: float) -> dict[int, Report]:
        """What moves, by identity, with its velocity."""
        found = {}
        for mover in self._traffic:
            if (report := self._report_of(mover, period)) is not None:
                found[mover.id] = report
        for name, autopilot in self.autopilots.items():
            own = autopilot.aircraft.ownship()
            velocity = (own.velocity_north, own.velocity_east, own.climb_rate)
            place = (own.north, own.east, own.altitude)
            found[self._ids[name]] = Report(self._ids[name], *place, *velocity)
        return found

    def _report_of(self, mover: Mover, period: float) -> Report | None:
        """A mover tells its place only: its velocity is what it has moved by since the last sweep."""
        here = mover.position()
        before = self._places.get(mover.id)
        if here is None:
            self._places.pop(mover.id, None)
            return None
        self._places[mover.id] = here
        velocity = (
            [0.0] * 3 if before is None else [(a - b) / period for a, b in zip(here, before, strict=True)]
        )
        return Report(mover.id, *here, *velocity)


def _usual(flavour: Flavour, on_ground: bool) -> dict[str, float]:
    """Parameters that go with where the flight begins: a scenario's mission has no landing."""
    return {} if on_ground or LANDING_WANTED not in flavour.parameters else {LANDING_WANTED: 0.0}


def fleet_of(scenario: Scenario, count: int, *, on_ground: bool) -> tuple[Member, ...]:
    """So many vehicles of a scenario: its own formation, or one mission flown side by side.

    Raises
    ------
    ScenarioError
        If the scenario has vehicles, but not so many.
    """
    if scenario.vehicles:
        if count > len(scenario.vehicles):
            message = f"{count} vehicles, but {scenario.name} has {len(scenario.vehicles)}"
            raise ScenarioError("--vehicles", message)
        return scenario.vehicles[:count]
    apart = APART_ON_GROUND if on_ground else APART
    if count == 1:
        return (Member(-1, OWN, scenario.mission),)
    members = []
    for number in range(count):
        mission = tuple(replace(point, east=point.east + apart * number) for point in scenario.mission)
        members.append(Member(FIRST_ID + number, f"vehicle {number + 1}", mission))
    return tuple(members)


def _wire(item: RawItem) -> WireItem:
    return WireItem(item.frame, item.command, *item.params, item.x, item.y, item.z, item.autocontinue)


def wire_mission(points: Sequence[Point], frame: MapFrame) -> list[WireItem]:
    """A mission as wire items: waypoints, changes of speed, and circling at the end."""
    items: list[WireItem] = []
    for number, point in enumerate(points, start=1):
        latitude, longitude = frame.to_geodetic(point.north, point.east)
        last = number == len(points)
        items.append(
            WireItem(
                mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT,
                mavlink.MAV_CMD_NAV_LOITER_UNLIM if last else mavlink.MAV_CMD_NAV_WAYPOINT,
                param4=0.0,
                x=round(latitude * 1e7),
                y=round(longitude * 1e7),
                z=point.altitude,
            )
        )
        if point.speed is not None and not math.isnan(point.speed) and not last:
            items.append(
                WireItem(
                    mavlink.MAV_FRAME_MISSION,
                    mavlink.MAV_CMD_DO_CHANGE_SPEED,
                    param2=point.speed,
                    param3=-1.0,
                )
            )
    return items
