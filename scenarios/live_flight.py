"""A flight of a live vehicle: the loop, the record and the judgement of `fly`, on the vehicle's own clock."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Protocol

import numpy as np

from avoidance.agent import Agent as Core
from avoidance.parameters import Parameters
from offboard.link import EditStatus, Radar, VehicleState
from offboard.live.vehicle import LiveVehicle
from offboard.pilot import Frame, Pilot, fly
from scenarios.fence import core_fence
from scenarios.flown import Flown, FlownVehicle, LoggedDecision, WallTime
from scenarios.radar import SimulatedRadar
from scenarios.rally import core_rally
from scenarios.run import informed
from scenarios.scenario import OWN, Home, Point, Scenario, streams
from scenarios.score import Score, score
from scenarios.seen import SeenLog
from scenarios.track import MovingTrack, Track
from scenarios.watched import TimedClock, TimedRadar, WatchedAgent
from scenarios.world import World

GIVE_UP = 30.0
"""A link that has been lost for so long ends the flight; the vehicle flies on without us [s, wall clock]."""
DISARMED_FOR = 5.0
"""A vehicle that has been disarmed for so long before the end of its mission ends the flight [s]."""


GUESSED = 1.0
"""Where the vehicle was so long after the last position it told is a guess [s]."""
AFTER_END = 0.2
"""The record goes on for so long after the end was reached: positions come ten times a second [s]."""
SAME = 1.0
"""Waypoints nearer to one another than this are one: a take-off has its end where the mission begins [m]."""


class Shadow:
    """A live vehicle as a world takes it: where it was at the world's own times.

    Parameters
    ----------
    vehicle : LiveVehicle
        Its clock begins with the world's.
    """

    def __init__(self, vehicle: LiveVehicle) -> None:
        self._vehicle = vehicle
        self._now = 0.0
        self._reckoned: list[tuple[float, float]] = []

    @property
    def reckoned(self) -> tuple[tuple[float, float], ...]:
        """From when to when its position was a guess: nothing had told it [s]."""
        return tuple((round(begin, 3), round(end, 3)) for begin, end in self._reckoned)

    @property
    def finished(self) -> bool:
        """True once it had reached the last waypoint then."""
        return self._now >= self._vehicle.finished_at + AFTER_END

    def state(self) -> VehicleState:
        """Where it was."""
        told = self._vehicle.heard_until
        if self._now - told > GUESSED:
            spans = self._reckoned
            begin = spans.pop()[0] if spans and spans[-1][1] >= told else told
            spans.append((begin, self._now))
        return VehicleState(self._vehicle.aboard.ownship_at(self._now))

    def advance(self, duration: float) -> None:
        """Wait until the vehicle's clock has come so far."""
        self._now += duration
        self._vehicle.wait_until(self._now)


class TakesMessages(Protocol):
    """Makes a radar for a flight whose world is there."""

    def __call__(self, world: World) -> Radar: ...


@dataclass(frozen=True, slots=True)
class Source:
    """Where obstacles are known from."""

    name: str
    """As given on the command line."""
    radar: TakesMessages | None = None
    """What sees them; None takes the simulated radar of the scenario's world."""


class LiveFlight:
    """A flight of a live vehicle: iterate over it, then ask for `result` and `judged`.

    Parameters
    ----------
    scenario : Scenario
        The mission and what is known to be about; see `scenario_of`.
    vehicle : LiveVehicle
        On its mission.
    source : Source
        Where obstacles are known from.
    parameters : Parameters
        Of the avoidance core.
    seed : int
        Of the planner and of a simulated radar.
    """

    def __init__(
        self, scenario: Scenario, vehicle: LiveVehicle, source: Source, parameters: Parameters, seed: int = 0
    ) -> None:
        self._scenario, self._parameters, self._seed = scenario, parameters, seed
        self._source = source
        self.vehicle = vehicle
        truth = source.radar is None
        vehicle.pump()
        vehicle.aboard.begin()  # before intruders are made, which takes seconds of a fast simulation
        from scenarios.hangar import Hangar  # noqa: PLC0415

        self._hangar = Hangar(scenario, parameters) if truth and scenario.traffic else None
        movers = self._hangar.traffic() if self._hangar is not None else []
        self.shadow = Shadow(vehicle)
        self.world = World(scenario.obstacles if truth else (), {OWN: self.shadow}, movers)
        generators = streams(seed)
        made: Radar = (
            SimulatedRadar(self.world, scenario.radar, generators["radar"])
            if source.radar is None
            else source.radar(self.world)
        )
        self.seen = SeenLog(made, parameters.safety_radius)
        self._radar = TimedRadar(self.seen)
        told = informed(parameters, scenario.radar) if truth else parameters
        fence, rally = core_fence(scenario.geofence), core_rally(scenario.rally)
        core = Core(vehicle.performance, told, generators["planner"], geofence=fence, rally=rally)
        self._agent = WatchedAgent(core)
        self._clock = TimedClock(self.world)
        self._total = 0.0
        self.ending = "interrupted"
        """Why the flight has ended: finished, interrupted, link lost or disarmed."""

    @property
    def last_decision(self) -> LoggedDecision | None:
        """The last decision that had a threat or changed the route."""
        return self._agent.log[-1] if self._agent.log else None

    def __iter__(self) -> Iterator[Frame]:
        """Fly: one frame per radar scan."""
        begun = time.perf_counter()
        disarmed = 0.0
        for frame in fly([Pilot(self.vehicle, self._radar, self._agent)], self._clock, self._period):
            self._total = time.perf_counter() - begun
            yield frame
            disarmed = disarmed + self._period if self.vehicle.watch.disarmed else 0.0
            if self.vehicle.silent > GIVE_UP:
                self.ending = "link lost"
                return
            if disarmed > DISARMED_FOR and self.vehicle.touch:
                self.ending = "disarmed"
                return
        while not self.shadow.finished:
            self.world.advance(AFTER_END)
        self._total = time.perf_counter() - begun
        self.ending = "finished"

    def close(self) -> None:
        """Free what flies the traffic; the vehicle flies on."""
        if self._hangar is not None:
            self._hangar.close()

    def result(self) -> Flown:
        """What has been flown so far."""
        track = _until(self.world.tracks()[0], self.vehicle.heard_until)
        scenario, others = self._scenario, list(self.world.others(OWN))
        traffic = list(self.world.moving_tracks())
        if self._source.radar is not None:
            obstacles, moved = self.seen.found(track.times)
            scenario = replace(scenario, obstacles=obstacles, traffic=())
            others, traffic = moved, moved
        count = len(track.times)
        reach = self.vehicle.editor.end_radius()
        flown = FlownVehicle(
            name=OWN,
            mission=scenario.mission,
            performance=replace(self.vehicle.performance, acceptance_radius=reach),
            track=track,
            others=tuple(_cut(one, count) for one in others),
            decisions=tuple(self._agent.log),
            plan=self.vehicle.download_mission(),
            ending="finished" if self.vehicle.finished else self.ending,
        )
        wall = WallTime(self._total, self._agent.seconds, self._radar.seconds, self._clock.seconds)
        return Flown(
            scenario=scenario,
            seed=self._seed,
            parameters=self._parameters,
            avoidance=True,
            frame=self.vehicle.aboard.frame,
            vehicles=(flown,),
            traffic=tuple(_cut(one, count) for one in traffic),
            ending=self.ending,
            wall=wall,
            events=tuple(self.vehicle.aboard.events),
            reckoned=self.shadow.reckoned,
        )

    def judged(self, flown: Flown) -> Score:
        """The flight's figures: those of `fly`, and those of the link."""
        found = score(flown)
        truth = self._source.radar is None
        summary = {**found.summary, **self._link_figures("truth" if truth else "telemetry")}
        if not truth and not self.seen.anything:
            summary |= dict.fromkeys(_UNKNOWN)
        return Score(summary, found.vehicles)

    @property
    def _period(self) -> float:
        return self._scenario.radar.period

    def _link_figures(self, source: str) -> dict[str, Any]:
        records = self.vehicle.editor.records
        times = [one.milliseconds for one in records if one.status is EditStatus.CONFIRMED]
        spread = (
            {"median": round(float(np.median(times)), 3), "p99": round(float(np.percentile(times, 99)), 3)}
            if times
            else {"median": None, "p99": None}
        )
        return {
            "separation_source": source,
            "edits": len(records),
            "edits_confirmed": len(times),
            "edit_ms": spread,
            "fallbacks": self.vehicle.editor.fallbacks,
            "link_losses": self.vehicle.link_losses,
            "frames_dropped": self.vehicle.aboard.session.dropped,
        }


_UNKNOWN = ("violations", "min_separation_m", "min_margin_m", "closest_obstacle", "violation_radius_m")
"""Figures that mean nothing where no obstacle was ever reported."""


def scenario_of(vehicle: LiveVehicle, known: Scenario | None, name: str) -> Scenario:
    """What a live vehicle is about to fly, as a scenario: from where it is, along the mission that it has.

    Parameters
    ----------
    vehicle : LiveVehicle
        With its mission.
    known : Scenario or None
        Where the mission was taken from; its obstacles, traffic and radar are kept.
    name : str
        For a mission that is no scenario's.
    """
    mission, own = vehicle.mission, vehicle.aboard.ownship()
    if mission is None:
        raise ValueError("the vehicle has no mission")
    first = min(vehicle.editor.current(), len(mission.entries) - 1)
    points = [Point(w.north, w.east, w.altitude) for w in mission.ahead(first)]
    points = [b for a, b in pairwise([None, *points]) if b is not None and (a is None or _apart(a, b) > SAME)]
    away = _apart(points[0], Point(own.north, own.east, own.altitude))
    if away > vehicle.performance.acceptance_radius or len(points) < 2:
        points.insert(0, Point(own.north, own.east, own.altitude))
    frame = vehicle.aboard.frame
    if known is None:
        known = Scenario(
            name=name,
            home=Home(frame.latitude_deg, frame.longitude_deg, frame.altitude_m),
            mission=tuple(points),
            description="Flown by a live vehicle.",
        )
    settings = replace(
        known.vehicle,
        airspeed=vehicle.performance.airspeed,
        acceptance_radius=vehicle.performance.acceptance_radius,
    )
    return replace(known, mission=tuple(points), vehicle=settings)


def _apart(a: Point, b: Point) -> float:
    return math.hypot(a.north - b.north, a.east - b.east)


def _until(track: Track, time: float) -> Track:
    """A track up to when something was last heard of the vehicle [s]."""
    keep = max(int(np.searchsorted(track.times, time + 1.0, side="right")), 2)
    return Track(
        track.vehicle,
        track.times[:keep],
        track.positions[:keep],
        track.airspeeds[:keep],
        track.headings_deg[:keep],
        track.banks_deg[:keep],
    )


def _cut(track: MovingTrack, count: int) -> MovingTrack:
    return MovingTrack(track.id, track.radius, track.positions[:count])
