"""The loop: radar scan in, decision out, mission edit to the vehicle (Algorithm 1)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from avoidance import Decision, Keep, Ownship, RadarScan, Route
from offboard.link import Clock, Radar, Vehicle, VehicleState


class Agent(Protocol):
    """Whoever decides."""

    def decide(self, ownship: Ownship, route: Route, scan: RadarScan) -> Decision:
        """What to do about one scan."""


@dataclass(frozen=True, slots=True)
class Step:
    """What one pilot saw and did at one scan."""

    state: VehicleState
    """The vehicle at the time of the scan."""
    scan: RadarScan
    """What the radar reported."""
    decision: Decision
    """What was decided about it."""


@dataclass(frozen=True, slots=True)
class Frame:
    """One instant of a flight."""

    time: float
    """Seconds since the start."""
    steps: tuple[Step, ...]
    """One step per pilot, in their order."""


@dataclass(frozen=True, slots=True)
class Pilot:
    """One vehicle, what it sees with, and who decides for it."""

    vehicle: Vehicle
    """The vehicle, its mission started."""
    radar: Radar
    """Its radar."""
    agent: Agent
    """The avoidance core, or a stand-in."""

    @property
    def finished(self) -> bool:
        """True once the vehicle has reached its last mission item."""
        return self.vehicle.finished

    def step(self, now: float) -> Step:
        """Look once, decide once, start at most one mission edit; never blocks."""
        state = self.vehicle.state()
        scan = self.radar.scan(state, now)
        if self.vehicle.finished:
            return Step(state, scan, Keep(why="The mission is finished."))
        decision = self.agent.decide(state.ownship, self.vehicle.route(), scan)
        self.vehicle.begin(decision)
        return Step(state, scan, decision)


def fly(pilots: Sequence[Pilot], clock: Clock, period: float) -> Iterator[Frame]:
    """Fly every uploaded mission to its end, one radar scan per step (Algorithm 1).

    Parameters
    ----------
    pilots : sequence of Pilot
        A formation, or one. All see the same instant.
    clock : Clock
        A simulation steps vehicles and traffic; a live link waits.
    period : float
        Time between scans [s].

    Yields
    ------
    Frame
        What all of them saw and did; time has not yet moved on.
    """
    while not all(pilot.finished for pilot in pilots):
        now = clock.now
        yield Frame(now, tuple(pilot.step(now) for pilot in pilots))
        clock.advance(period)
