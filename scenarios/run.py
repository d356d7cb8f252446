"""Fly one scenario: everything built, every scan flown, everything worth keeping kept."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Protocol

from avoidance import Decision, Keep, Ownship, Performance, RadarScan, Route
from avoidance.parameters import PRESETS, Parameters
from offboard.frames import MapFrame
from offboard.link import Radar, Vehicle, VehicleState
from offboard.mission import MissionPlan
from offboard.pilot import Agent, Frame, Pilot, fly
from scenarios.errors import ScenarioError
from scenarios.radar import SimulatedRadar
from scenarios.scenario import RadarSettings, Scenario, scatter, streams
from scenarios.track import MovingTrack, Track
from scenarios.world import Flyer, Mover, World

OWN = "own"
"""Name of the vehicle under test."""


class OwnVehicle(Vehicle, Flyer, Protocol):
    """A vehicle that the world can step."""


class Maker(Protocol):
    """Whoever makes the vehicles of a scenario (`scenarios.hangar.Hangar`)."""

    @property
    def frame(self) -> MapFrame:
        """The map."""

    def own_vehicle(self) -> OwnVehicle:
        """The vehicle under test, its mission started."""

    def traffic(self) -> list[Mover]:
        """Everything that moves."""


@dataclass(frozen=True, slots=True, eq=False)
class LoggedDecision:
    """A decision that had a threat or changed the route."""

    state: Ownship
    """The vehicle at the scan."""
    route: Route
    """What it was flying."""
    decision: Decision
    """What was decided."""
    milliseconds: float
    """Wall time of the decision, measured by the caller [ms]."""


@dataclass(frozen=True, slots=True)
class WallTime:
    """Where the wall time of a flight went [s]."""

    total: float = 0.0
    """From the first scan to the last step."""
    avoidance: float = 0.0
    """Decisions."""
    radar: float = 0.0
    """Scans."""
    world: float = 0.0
    """The plants, sequencing, traffic and recording."""


@dataclass(frozen=True, slots=True, eq=False)
class Flown:
    """What a flight was: enough to score it and to write it down."""

    scenario: Scenario
    """As flown: random obstacles drawn, command-line changes made."""
    seed: int
    """All randomness came from it."""
    parameters: Parameters
    """Of the avoidance core."""
    performance: Performance
    """Of the vehicle."""
    avoidance: bool
    """False if it was flown without."""
    frame: MapFrame
    """The map."""
    track: Track
    """Of the own vehicle."""
    traffic: tuple[MovingTrack, ...]
    """Of everything that moved."""
    decisions: tuple[LoggedDecision, ...]
    """In the order taken."""
    plan: MissionPlan
    """The mission as finally flown."""
    ending: str
    """"finished", "time limit" or "interrupted"."""
    wall: WallTime
    """Where the time went."""


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
        generators = streams(seed)
        self.vehicle = hangar.own_vehicle()
        self.world = World(scenario.obstacles, {OWN: self.vehicle}, hangar.traffic())
        self._radar = _TimedRadar(SimulatedRadar(self.world, scenario.radar, generators["radar"]))
        if avoidance:
            from avoidance.agent import Agent as Core  # noqa: PLC0415

            told = informed(parameters, scenario.radar)
            core: Agent = Core(self.vehicle.performance, told, generators["planner"])
        else:
            core = FlyOn()
        self._agent = _WatchedAgent(core)
        self._clock = _TimedClock(self.world)
        self._total = 0.0
        self._ending = "finished"

    @property
    def last_decision(self) -> LoggedDecision | None:
        """The last decision that had a threat or changed the route."""
        return self._agent.log[-1] if self._agent.log else None

    def __iter__(self) -> Iterator[Frame]:
        """Fly: one frame per radar scan. Leaving the loop early leaves a flight that was interrupted."""
        pilots = (Pilot(self.vehicle, self._radar, self._agent),)
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
        return Flown(
            scenario=self._scenario,
            seed=self._seed,
            parameters=self._parameters,
            performance=self.vehicle.performance,
            avoidance=self._avoidance,
            frame=self._frame,
            track=self.world.tracks()[0],
            traffic=tuple(self.world.moving_tracks()),
            decisions=tuple(self._agent.log),
            plan=self.vehicle.download_mission(),
            ending=self._ending,
            wall=WallTime(self._total, self._agent.seconds, self._radar.seconds, self._clock.seconds),
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


class FlyOn:
    """Stands in for the avoidance core: sees everything, does nothing."""

    def decide(self, own: Ownship, route: Route, scan: RadarScan) -> Decision:  # noqa: ARG002
        """Fly on."""
        return _ON


_ON = Keep(why="avoidance is switched off")


class _WatchedAgent:
    """Times every decision and keeps those that matter."""

    def __init__(self, agent: Agent) -> None:
        self._agent = agent
        self.log: list[LoggedDecision] = []
        self.seconds = 0.0

    def decide(self, own: Ownship, route: Route, scan: RadarScan) -> Decision:
        begun = time.perf_counter()
        decision = self._agent.decide(own, route, scan)
        seconds = time.perf_counter() - begun
        self.seconds += seconds
        if decision.threat is not None or not isinstance(decision, Keep):
            self.log.append(LoggedDecision(own, route, decision, 1e3 * seconds))
        return decision


class _TimedRadar:
    def __init__(self, radar: Radar) -> None:
        self._radar = radar
        self.seconds = 0.0

    def scan(self, state: VehicleState, now: float) -> RadarScan:
        begun = time.perf_counter()
        scan = self._radar.scan(state, now)
        self.seconds += time.perf_counter() - begun
        return scan


class _TimedClock:
    def __init__(self, world: World) -> None:
        self._world = world
        self.seconds = 0.0

    @property
    def now(self) -> float:
        return self._world.now

    def advance(self, period: float) -> None:
        begun = time.perf_counter()
        self._world.advance(period)
        self.seconds += time.perf_counter() - begun
