"""What flies along to take the time and keep the decisions, and stand-ins for who is not asked."""

from __future__ import annotations

import time

from avoidance import Decision, Keep, Ownship, RadarScan, Route
from offboard.link import Radar, VehicleState
from offboard.pilot import Agent
from scenarios.flown import LoggedDecision
from scenarios.world import World


class Blind:
    """Stands in for a radar where nobody looks at it."""

    def scan(self, state: VehicleState, now: float) -> RadarScan:  # noqa: ARG002
        """Nothing."""
        return RadarScan.of(now, ())


class FlyOn:
    """Stands in for the avoidance core: does nothing."""

    def decide(self, own: Ownship, route: Route, scan: RadarScan) -> Decision:  # noqa: ARG002
        """Fly on."""
        return _ON


_ON = Keep(why="avoidance is switched off")


class WatchedAgent:
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


class TimedRadar:
    def __init__(self, radar: Radar) -> None:
        self._radar = radar
        self.seconds = 0.0

    def scan(self, state: VehicleState, now: float) -> RadarScan:
        begun = time.perf_counter()
        scan = self._radar.scan(state, now)
        self.seconds += time.perf_counter() - begun
        return scan


class TimedClock:
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
