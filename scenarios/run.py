"""Fly one scenario: everything built, every scan flown, everything worth keeping kept."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from avoidance.parameters import PRESETS, Parameters
from offboard.frames import MapFrame
from offboard.link import Vehicle
from offboard.pilot import Agent, Frame, Pilot, fly
from scenarios.errors import ScenarioError
from scenarios.fence import core_fence
from scenarios.flown import Flown, FlownVehicle, LoggedDecision, WallTime
from scenarios.movers import Flyer, Mover
from scenarios.pilots import Desk, FaultyPilot, Navigation
from scenarios.planners import way_of
from scenarios.radar import SimulatedRadar
from scenarios.rally import core_rally
from scenarios.scenario import Member, Point, RadarSettings, Scenario, scatter, streams
from scenarios.track import Track
from scenarios.watched import Blind, FlyOn, TimedClock, TimedRadar, WatchedAgent
from scenarios.world import World


class OwnVehicle(Vehicle, Flyer, Protocol):
    """A vehicle that the world can step."""


class Maker(Protocol):
    """Whoever makes the vehicles of a scenario (`scenarios.hangar.Hangar`)."""

    @property
    def frame(self) -> MapFrame:
        """The map."""

    def own_vehicle(self, mission: Sequence[Point]) -> OwnVehicle:
        """A vehicle under test, its mission started."""

    def traffic(self) -> list[Mover]:
        """Everything that moves."""


class Flight:
    """A flight about to be flown: iterate over it, then ask for the `result`.

    Parameters
    ----------
    scenario : Scenario
        What to fly, its random obstacles drawn (`prepare`).
    hangar : Maker
        Makes the vehicles.
    seed : int
        A flight is a function of scenario and seed.
    parameters : Parameters
        Of the avoidance core.
    avoidance : bool
        False flies on whatever the radar shows.

    Raises
    ------
    ValueError
        If random obstacles are still to be drawn.
    PlantError
        If a plant fails.
    """

    def __init__(
        self,
        scenario: Scenario,
        hangar: Maker,
        *,
        seed: int = 0,
        parameters: Parameters,
        avoidance: bool = True,
    ) -> None:
        if scenario.random is not None:
            raise ValueError("scenario.random must be drawn before a flight (scenarios.run.prepare)")
        self._scenario = scenario
        self._seed = seed
        self._parameters = parameters
        self._avoidance = avoidance
        self._frame = hangar.frame
        fleet = scenario.fleet
        vehicles = {member.name: hangar.own_vehicle(member.mission) for member in fleet}
        self.vehicle = vehicles[fleet[0].name]
        ids = {member.name: member.id for member in fleet}
        self.world = World(scenario.obstacles, vehicles, hangar.traffic(), ids)
        self._stations = [
            self._station(number, member, vehicles[member.name]) for number, member in enumerate(fleet)
        ]
        self._clock = TimedClock(self.world)
        self._total = 0.0
        self._ending = "finished"

    @property
    def last_decision(self) -> LoggedDecision | None:
        """The last decision that had a threat or changed a route."""
        last = [station.agent.log[-1] for station in self._stations if station.agent.log]
        return max(last, key=lambda entry: entry.state.time, default=None)

    def __iter__(self) -> Iterator[Frame]:
        """Fly: one frame per radar scan. Leaving the loop early leaves a flight that was interrupted."""
        pilots = [station.pilot for station in self._stations]
        limit = self._scenario.limit
        self._ending = "interrupted"
        begun = time.perf_counter()
        for frame in fly(pilots, self._clock, self._scenario.radar.period):
            self._total = time.perf_counter() - begun
            if frame.time >= limit:
                self._ending = "time limit"
                return
            yield frame
        self._total = time.perf_counter() - begun
        self._ending = "finished"

    def result(self) -> Flown:
        """What has been flown so far."""
        stations = self._stations
        return Flown(
            scenario=self._scenario,
            seed=self._seed,
            parameters=self._parameters,
            avoidance=self._avoidance,
            frame=self._frame,
            vehicles=tuple(
                self._vehicle_flown(station, track)
                for station, track in zip(stations, self.world.tracks(), strict=True)
            ),
            traffic=tuple(self.world.moving_tracks()),
            ending=self._ending,
            wall=WallTime(
                self._total,
                sum(station.agent.seconds for station in stations),
                sum(station.radar.seconds for station in stations),
                self._clock.seconds,
            ),
        )

    def _station(self, number: int, member: Member, vehicle: OwnVehicle) -> _Station:
        """Everything that belongs to one own vehicle, with its own random numbers."""
        settings, generators = self._scenario.vehicle, streams(self._seed, number)
        simulated = SimulatedRadar(self.world, self._scenario.radar, generators["radar"], member.name)
        radar = TimedRadar(simulated if self._avoidance else Blind())
        core: Agent = FlyOn()
        if self._avoidance:
            from avoidance.agent import Agent as Core  # noqa: PLC0415

            told, way = way_of(informed(self._parameters, self._scenario.radar))
            fence = core_fence(self._scenario.geofence)
            rally = core_rally(self._scenario.rally)
            core = Core(vehicle.performance, told, generators["planner"], way, fence, rally)
        agent = WatchedAgent(core)
        pilot = Pilot(vehicle, radar, agent)
        if settings.position_error > 0.0 or settings.decision_latency > 0.0:
            navigation = Navigation(settings.position_error, generators["navigation"])
            pilot = FaultyPilot(vehicle, radar, agent, navigation, Desk(settings.decision_latency))
        return _Station(member, vehicle, radar, agent, pilot)

    def _vehicle_flown(self, station: _Station, track: Track) -> FlownVehicle:
        name = station.member.name
        return FlownVehicle(
            name=name,
            mission=station.member.mission,
            performance=station.vehicle.performance,
            track=track,
            others=tuple(self.world.others(name)),
            decisions=tuple(station.agent.log),
            plan=station.vehicle.download_mission(),
            ending="finished" if station.vehicle.finished else self._ending,
        )


def prepare(scenario: Scenario, seed: int, *, obstacles: int | None = None) -> Scenario:
    """The scenario with its random obstacles drawn, as many as asked for.

    Raises
    ------
    ScenarioError
        If a number is asked for and the scenario has no `random` table.
    """
    if obstacles is not None:
        if scenario.random is None:
            message = f"has no [random] table, so {obstacles} obstacles cannot be drawn; try 'random'"
            raise ScenarioError(scenario.name, message)
        scenario = replace(scenario, random=replace(scenario.random, count=obstacles))
    return scatter(scenario, streams(seed)["world"])


def preset(name: str) -> Parameters:
    """Parameters of the avoidance core by name.

    Raises
    ------
    ScenarioError
        If there is no such preset; lists those there are.
    """
    if name not in PRESETS:
        raise ScenarioError("--preset", f"{name!r} is unknown; known: {', '.join(PRESETS)}")
    return PRESETS[name]


def informed(parameters: Parameters, radar: RadarSettings) -> Parameters:
    """Parameters of a core that has read the data sheet of its radar: how accurate it is."""
    return replace(parameters, range_sigma=radar.range_noise, bearing_sigma=radar.bearing_noise)


@dataclass(frozen=True, slots=True)
class _Station:
    """What belongs to one own vehicle."""

    member: Member
    vehicle: OwnVehicle
    radar: TimedRadar
    agent: WatchedAgent
    pilot: Pilot
