"""What a flight leaves in memory: enough to score it and to write it down."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from avoidance import Decision, Ownship, Performance, Route
from avoidance.parameters import Parameters
from offboard.frames import MapFrame
from offboard.mission import MissionPlan
from scenarios.scenario import Point, Scenario
from scenarios.track import MovingTrack, Track

if TYPE_CHECKING:
    from offboard.live.aboard import Event


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
class FlownVehicle:
    """What one own vehicle did."""

    name: str
    mission: tuple[Point, ...]
    """As planned."""
    performance: Performance
    """What it can do."""
    track: Track
    """Where it was."""
    others: tuple[MovingTrack, ...]
    """What moved beside it, traffic and other own vehicles, at the times of its track."""
    decisions: tuple[LoggedDecision, ...]
    """In the order taken."""
    plan: MissionPlan
    """The mission as finally flown."""
    ending: str
    """"finished", "time limit" or "interrupted"."""


@dataclass(frozen=True, slots=True, eq=False)
class Flown:
    """What a flight was: enough to score it and to write it down."""

    scenario: Scenario
    """As flown: random obstacles drawn, command-line changes made."""
    seed: int
    """All randomness came from it."""
    parameters: Parameters
    """Of the avoidance core."""
    avoidance: bool
    """False if it was flown without."""
    frame: MapFrame
    """The map."""
    vehicles: tuple[FlownVehicle, ...]
    """The own vehicles, at least one."""
    traffic: tuple[MovingTrack, ...]
    """Of all traffic, at the times of the longest track."""
    ending: str
    """"finished", "time limit" or "interrupted"."""
    wall: WallTime
    """Where the time went."""
    events: tuple[Event, ...] | None = None
    """What a live vehicle's pilot was told; None for a flight in process."""
    reckoned: tuple[tuple[float, float], ...] = ()
    """From when to when the track is reckoned, for a live vehicle told no position [s]."""

    @property
    def performance(self) -> Performance:
        """Of the first vehicle; all are alike."""
        return self.vehicles[0].performance

    @property
    def track(self) -> Track:
        """Of the first vehicle."""
        return self.vehicles[0].track

    @property
    def decisions(self) -> tuple[LoggedDecision, ...]:
        """Of all vehicles, in the order taken."""
        taken = [entry for vehicle in self.vehicles for entry in vehicle.decisions]
        return tuple(sorted(taken, key=lambda entry: entry.state.time))

    @property
    def plan(self) -> MissionPlan:
        """Of the first vehicle."""
        return self.vehicles[0].plan
