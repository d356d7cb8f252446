"""The nouns of the core: what flows from a radar scan to a decision.

Frames: north and east are map metres about the mission's home, altitude is metres above it, velocities
are over ground in the same axes. Angles are radians, clockwise from north; times are seconds since the
start of the flight. Everything is immutable; arrays are read-only.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

GRAVITY = 9.81
"""Standard gravity as the paper uses it [m/s²] (Eqs. 13-14)."""

Floats: TypeAlias = NDArray[np.float64]
Complexes: TypeAlias = NDArray[np.complex128]
Ints: TypeAlias = NDArray[np.int64]
Bools: TypeAlias = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Ownship:
    """Where the own vehicle is and how it moves."""

    time: float
    """Time of the state [s]."""
    north: float
    """North of home [m]."""
    east: float
    """East of home [m]."""
    altitude: float
    """Above home [m]."""
    velocity_north: float
    """Ground velocity [m/s]."""
    velocity_east: float
    """Ground velocity [m/s]."""
    climb_rate: float = 0.0
    """Upward velocity [m/s]."""
    airspeed: float = 0.0
    """True airspeed [m/s]."""
    heading: float = 0.0
    """Direction of the nose [rad]."""
    bank: float = 0.0
    """Roll angle, right wing down positive [rad]."""
    position_error: float = 0.0
    """One standard deviation of the own horizontal position [m]."""

    @property
    def course(self) -> float:
        """Direction of travel over ground [rad]."""
        return math.atan2(self.velocity_east, self.velocity_north)

    @property
    def ground_speed(self) -> float:
        """Horizontal speed over ground [m/s]."""
        return math.hypot(self.velocity_north, self.velocity_east)


@dataclass(frozen=True, slots=True)
class Performance:
    """What the vehicle can do; the vehicle gives it to the core, the core assumes nothing."""

    airspeed: float
    """Cruise true airspeed [m/s]."""
    max_bank: float
    """Bank limit of the guidance [rad]."""
    roll_time: float
    """Time to reach a commanded bank [s]."""
    acceptance_radius: float
    """A waypoint counts as reached within this distance, or when passed abeam [m]."""
    tracking_error: float
    """Largest distance from a straight leg once it is captured [m]."""
    capture_distance: float = 250.0
    """Distance flown along a new leg until it is captured within the tracking error [m]."""
    wind_bound: float = 0.0
    """Largest steady wind the clearances must allow for [m/s]."""
    edit_time: float = 0.0
    """Longest time from a decision until the vehicle flies it [s]: what a mission edit takes over a link."""

    @property
    def turn_radius(self) -> float:
        """Largest turn radius over ground at the bank limit, R = (V + W)²/(g tan φ) [m] (Eq. 13)."""
        return (self.airspeed + self.wind_bound) ** 2 / (GRAVITY * math.tan(self.max_bank))

    @property
    def turn_room(self) -> float:
        """Free radius about a point that lets the vehicle turn there in any direction [m]."""
        return 2.0 * self.turn_radius + self.airspeed * self.roll_time


@dataclass(frozen=True, slots=True)
class Waypoint:
    """One point of a route."""

    north: float
    """North of home [m]."""
    east: float
    """East of home [m]."""
    altitude: float
    """Above home [m]."""
    item: int | None = None
    """Index, in the mission as uploaded, of the item this is or stands for; None if avoidance put it in."""
    moved: bool = False
    """True if it stands for a mission item that cannot be reached."""


@dataclass(frozen=True, slots=True)
class Route:
    """What is still to be flown."""

    origin: Waypoint
    """Where the leg now being flown begins."""
    waypoints: tuple[Waypoint, ...]
    """The waypoints still ahead; the first is the one being flown to."""
    held: bool | None = None
    """True while the vehicle waits on a circle instead of flying it; None if nobody says."""


@dataclass(frozen=True, slots=True)
class Contact:
    """One radar return."""

    id: int
    """Identity as the radar gives it: a hint, not a fact."""
    north: float
    """North of home [m]."""
    east: float
    """East of home [m]."""
    altitude: float
    """Above home [m]."""
    safety_radius: float | None = None
    """Radius of the sphere to stay out of [m]; None takes the core's own."""


@dataclass(frozen=True, slots=True, eq=False)
class RadarScan:
    """All returns of one sweep, as arrays."""

    time: float
    """Time of the sweep [s]."""
    ids: Ints
    """Identities, shape (n,)."""
    positions: Floats
    """North, east, altitude [m], shape (n, 3)."""
    radii: Floats
    """Safety radius of each [m], NaN where the sensor does not know, shape (n,)."""

    @classmethod
    def of(cls, time: float, contacts: Sequence[Contact]) -> RadarScan:
        """Build a scan from single contacts."""
        rows = [(c.north, c.east, c.altitude) for c in contacts]
        radii = [math.nan if c.safety_radius is None else c.safety_radius for c in contacts]
        return cls(
            time=time,
            ids=np.array([c.id for c in contacts], dtype=np.int64),
            positions=np.array(rows, dtype=np.float64).reshape(-1, 3),
            radii=np.array(radii, dtype=np.float64),
        )


@dataclass(frozen=True, slots=True)
class Threat:
    """Why the route cannot be flown as it is."""

    ids: tuple[int, ...]
    """Track numbers of the obstacles that cut the route, nearest first."""
    leg: int
    """Index in `Route.waypoints` of the waypoint at the end of the blocked leg."""
    distance: float
    """Distance along the route to the first point inside a sphere [m]."""
    time: float
    """Time until then [s]."""
    clearance: float
    """Least distance between the route and the nearest of them [m]."""
    required: float
    """Distance that must be kept from it [m]."""
    moving: bool = False
    """True for an intruder, false for something that stands still."""
    narrow: bool = False
    """True for a passage that is clear but too narrow to turn round in for too long."""


class Rung(Enum):
    """How far down the ladder a decision had to go; each rung gives up a little more."""

    FREE = "free"
    """Nothing to avoid."""
    WAYPOINT = "waypoint"
    """One waypoint with every constraint met."""
    WIDE_TURN = "waypoint, turn limit (g4) relaxed"
    """One waypoint, the turn limit g4 given up."""
    FAR = "waypoint, search limit (g2) relaxed"
    """One waypoint, the search limit g2 given up as well."""
    CLOSE = "waypoint, tolerance (g1) relaxed"
    """One waypoint, kept outside RS + margin only."""
    ROUTE = "route"
    """Several waypoints, from the exact planner."""
    ORBIT = "orbit"
    """No way is known: wait in an orbit."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Decision:
    """What the agent wants done about one scan. Use one of the subclasses with `match`."""

    why: str
    """The reason, in a pilot's words."""
    threat: Threat | None = None
    """What made it necessary."""
    rung: Rung = Rung.FREE
    """How far down the ladder it had to go."""
    route: tuple[Waypoint, ...] | None = None
    """The remaining route from now on, the next waypoint first; None leaves it as it is."""
    search: Search | None = None
    """The waypoint search behind it, for the record."""

    @property
    def name(self) -> str:
        """The kind of decision in lower case, as files and tables write it."""
        return type(self).__name__.lower()


@dataclass(frozen=True, slots=True, kw_only=True)
class Keep(Decision):
    """Fly on."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Detour(Decision):
    """Fly round the threat by one waypoint put into the route."""

    waypoint: Waypoint
    """The new waypoint."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Replace(Decision):
    """A mission waypoint lies where nothing may fly: `waypoint` stands for it, or it is skipped."""

    waypoint: Waypoint | None
    """The point flown instead; None if there is none and the item is skipped."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Reroute(Decision):
    """Fly round the threat by several waypoints from the exact planner."""

    waypoints: tuple[Waypoint, ...]
    """The new waypoints, in order."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Hold(Decision):
    """Orbit in space proven free until a way opens."""

    centre: Waypoint
    """Centre of the orbit."""
    radius: float
    """Radius of the orbit [m]."""
    direction: int
    """+1 clockwise seen from above, -1 anticlockwise."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Resume(Decision):
    """The reason for a detour or hold has gone: fly the mission's own leg again."""


@dataclass(frozen=True, slots=True, eq=False)
class Search:
    """One waypoint search: the question, the answer and what it cost. Yardsticks are computed from it."""

    start: tuple[float, float]
    """Where the detour begins, north and east [m]."""
    target: tuple[float, float]
    """Where it must lead, north and east [m]."""
    centres: Floats
    """Discs known then, north and east [m], shape (n, 2)."""
    radii: Floats
    """What the segments must keep from each centre [m], shape (n,)."""
    planner: str
    """Name of the planner that searched."""
    found: tuple[float, float] | None = None
    """The waypoint, north and east [m]; None if there was none."""
    least_violating: tuple[float, float] = (math.nan, math.nan)
    """The best point looked at, whether or not it meets every constraint [m]."""
    cost: float = math.nan
    """f of Eq. 6 at the waypoint."""
    iterations: int = 0
    """Iterations of the planner."""
    evaluations: int = 0
    """Candidate waypoints evaluated."""
    first_feasible: int | None = None
    """Iteration in which all constraints were first met (CS)."""
    problem: object | None = None
    """The `WaypointProblem` itself."""
