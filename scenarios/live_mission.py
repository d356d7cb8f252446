"""What a live vehicle is to fly and where obstacles are known from, as given on the command line."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from offboard.frames import MapFrame
from offboard.live.limits import OWN_ADDRESS
from offboard.mission_files import read_mission_file
from offboard.raw_mission import RawMission
from offboard.udp_radar import UdpRadar
from offboard.wire_radar import WireRadar
from scenarios.errors import ScenarioError
from scenarios.hangar import mission_plan
from scenarios.live_flight import Source
from scenarios.load import load
from scenarios.plan_convert import is_mission_file, scenario_of_file
from scenarios.run import prepare
from scenarios.scenario import Home, Obstacle, Point, Scenario
from scenarios.world import World

if TYPE_CHECKING:
    from avoidance.parameters import Parameters
    from offboard.link import Radar
    from offboard.live.vehicle import LiveVehicle

T = TypeVar("T", Obstacle, Point)


WIND = 3.0
"""Steady wind that is allowed for where nothing is known of it [m/s]."""


@dataclass(frozen=True, slots=True)
class LiveMission:
    """A mission before it is on the vehicle."""

    name: str
    raw: RawMission | None = None
    """None for the one that the vehicle has."""
    frame: MapFrame | None = None
    """The map; None for one about the vehicle's home."""
    begin: tuple[float, float] = (0.0, 0.0)
    """Where it begins, north and east [m]."""
    scenario: Scenario | None = None
    """Where it was taken from, if from one."""
    seed: int = 0
    from_file: bool = False
    """True for a plan file: it says nothing of the wind."""

    @property
    def preset(self) -> str:
        """Of the avoidance core, where the user gives none."""
        return "default" if self.scenario is None else self.scenario.preset

    @property
    def wind_bound(self) -> float:
        """Largest steady wind to allow for, where the user gives none [m/s]."""
        return WIND if self.scenario is None or self.from_file else self.scenario.wind.speed

    def named(self, source: SourceChoice) -> Scenario:
        """A scenario with the name under which the run is kept."""
        stand_in = Scenario(self.name, Home(0.0, 0.0, 0.0), (Point(0.0, 0.0, 0.0),))
        return self.scenario or source.scenario or stand_in


@dataclass(frozen=True, slots=True)
class SourceChoice:
    """Where obstacles are known from."""

    kind: str
    """mavlink, scenario or udp."""
    text: str
    """As shown to the user."""
    scenario: Scenario | None = None
    """With its obstacles, for a simulated radar."""
    port: int = 0

    def make(self, vehicle: LiveVehicle, parameters: Parameters) -> Source:
        """The source for a vehicle that is there."""
        aboard = vehicle.aboard
        if self.kind == "scenario":
            return Source(self.text)
        radar: Radar
        if self.kind == "udp":
            radar = UdpRadar(self.port, aboard.frame, lambda text: aboard.tell("warning", text))
        else:
            radar = wire = WireRadar(
                aboard.frame,
                aboard.clock.ours,
                parameters.safety_radius,
                lambda text: aboard.tell("alarm", text),
                own_address=int(aboard.parameters.get(OWN_ADDRESS, 0)),
                note=lambda text: aboard.tell("info", text),
            )
            vehicle.on_obstacle = wire.take

        def made(world: World) -> Radar:  # noqa: ARG001
            return radar

        return Source(self.text, made)


def mission_of(text: str | None) -> LiveMission:
    """The mission that a user has named.

    Raises
    ------
    PlanFileError, ScenarioError
        If it cannot be read.
    """
    if text is None:
        return LiveMission("live")
    if is_mission_file(text):
        content = read_mission_file(Path(text))
        scenario = scenario_of_file(content, Path(text).stem)
        home, start = scenario.home, scenario.mission[0]
        frame = MapFrame(home.latitude_deg, home.longitude_deg, home.altitude_m)
        return LiveMission(
            scenario.name, content.mission(), frame, (start.north, start.east), scenario, from_file=True
        )
    scenario = _prepared(text)
    home = scenario.home
    frame = MapFrame(home.latitude_deg, home.longitude_deg, home.altitude_m)
    raw = RawMission.of_plan(mission_plan(scenario.mission, frame))
    start = scenario.mission[0]
    return LiveMission(
        scenario.name, raw, frame, (start.north, start.east), scenario=scenario, seed=scenario.seed
    )


def source_of(text: str | None, mission: LiveMission) -> SourceChoice:
    """Where a user wants obstacles to be known from.

    Raises
    ------
    ScenarioError
        If there is no such source.
    """
    known = mission.scenario
    if text is None:
        if known is not None and (known.obstacles or known.traffic):
            return SourceChoice("scenario", f"a simulated radar in the world of {known.name!r}", known)
        text = "mavlink"
    kind, _, rest = text.partition(":")
    if kind == "mavlink" and not rest:
        bare = None if known is None else replace(known, obstacles=(), traffic=())
        return SourceChoice("mavlink", "what the vehicle sends", bare)
    if kind == "scenario" and rest:
        world = _prepared(rest)
        if mission.frame is not None and world.home != _home(mission.frame):
            world = moved(world, mission.frame)
        return SourceChoice("scenario", f"a simulated radar in the world of {world.name!r}", world)
    if kind == "udp" and rest.isdecimal() and 0 < int(rest) < 65536:
        bare = None if known is None else replace(known, obstacles=(), traffic=())
        return SourceChoice("udp", f"JSON lines on UDP port {rest}", bare, int(rest))
    raise ScenarioError("--obstacles", f"{text!r} must be mavlink, scenario:FILE or udp:PORT (1 to 65535)")


def moved(world: Scenario, frame: MapFrame) -> Scenario:
    """A scenario's obstacles and traffic on the map of another home, where they are on earth."""
    own = MapFrame(world.home.latitude_deg, world.home.longitude_deg, world.home.altitude_m)
    up = world.home.altitude_m - frame.altitude_m

    def there(one: T) -> T:
        north, east = frame.to_map(*own.to_geodetic(one.north, one.east))
        return replace(one, north=north, east=east, altitude=one.altitude + up)

    obstacles = tuple(there(obstacle) for obstacle in world.obstacles)
    traffic = tuple(
        replace(one, waypoints=tuple(there(point) for point in one.waypoints)) for one in world.traffic
    )
    return replace(world, home=_home(frame), obstacles=obstacles, traffic=traffic)


def _prepared(text: str) -> Scenario:
    scenario = load(text)
    return prepare(scenario, scenario.seed)


def _home(frame: MapFrame) -> Home:
    return Home(frame.latitude_deg, frame.longitude_deg, frame.altitude_m)
