"""What a vehicle can do, from its own parameters."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from avoidance import Performance
from offboard.errors import LinkError
from offboard.live.autopilots import Named, Rules
from offboard.live.messages import Session

ROLL_TIME = 1.0
"""Time that a bank takes to be reached; no parameter of either autopilot says it [s]."""
TRACKING_ERROR = 15.0
"""How far from a straight leg autopilots stay once it is captured, gusts included [m]."""
PER_ITEM = 0.025
"""ArduPlane takes a mission at this pace [s]: seven items in 150 ms were measured at real time."""
SHORT = 40
"""Up to so many items the usual time is enough."""
OWN_ADDRESS = "ADSB_ICAO_ID"
"""Parameter of both autopilots: ICAO address of the own transponder."""
EXTRA = {
    "PX4": ("MIS_TKO_LAND_REQ", "NAV_LOITER_RAD", "SYS_HITL", "SYS_AUTOSTART", OWN_ADDRESS),
    "ArduPilot": ("SIM_SPEEDUP", "WP_LOITER_RAD", OWN_ADDRESS),
}
"""Parameters that are looked at beside those of the performance, by autopilot, where they exist."""
SIMULATED_AIRFRAMES = range(10040, 10050)
"""PX4's numbers of aircraft that its own simulator flies."""


@dataclass(frozen=True, slots=True)
class EditTimes:
    """How long an edit may take over the link; wall clock."""

    attempt: float = 3.0
    """From sending a mission to seeing it flown [s]; MAVSDK gives a dead link up after 2.5 s."""
    attempts: int = 2
    """How often it is sent."""
    fall_back: float = 2.0
    """To be on the way to a place instead, after the last attempt has failed [s]."""

    def of(self, items: int) -> EditTimes:
        """The same for a mission of so many items: a long one takes its time over the wire."""
        return replace(self, attempt=self.attempt + PER_ITEM * max(items - SHORT, 0))

    @property
    def worst_case(self) -> float:
        """Longest time until the vehicle flies the edit or the fall-back [s]."""
        return self.attempt * self.attempts + self.fall_back


@dataclass(frozen=True, slots=True)
class Limits:
    """What the parameters say."""

    airspeed: float
    bank: float
    acceptance_radius: float
    traffic_reaction: bool
    """True if the autopilot reacts to traffic by itself."""
    extra: dict[str, float]
    """Other parameters by name, those that exist."""

    @property
    def simulated(self) -> bool:
        """True for a vehicle that says that it is a simulation; one that does not may be real."""
        airframe = int(self.extra.get("SYS_AUTOSTART", 0.0))
        hitl = self.extra.get("SYS_HITL", 0.0) > 0.0
        return hitl or airframe in SIMULATED_AIRFRAMES or "SIM_SPEEDUP" in self.extra

    def performance(self, times: EditTimes, wind_bound: float) -> Performance:
        """The same for the avoidance core."""
        return Performance(
            airspeed=self.airspeed,
            max_bank=self.bank,
            roll_time=ROLL_TIME,
            acceptance_radius=self.acceptance_radius,
            tracking_error=TRACKING_ERROR,
            wind_bound=wind_bound,
            edit_time=times.worst_case,
        )


def read_limits(session: Session, rules: Rules) -> Limits:
    """Ask a vehicle for its limits; waits for the answers.

    Raises
    ------
    LinkError
        If it does not say what cannot be guessed, or says what cannot be.
    """
    airspeed = _first(session, rules.airspeed, (3.0, 100.0))
    bank = _first(session, rules.bank, (math.radians(5.0), math.radians(80.0)))
    radius = _first(session, rules.acceptance_radius, (0.1, 10_000.0))
    reaction = session.parameter(rules.traffic_reaction)
    extra = {name: value for name in EXTRA[rules.name] if (value := session.parameter(name)) is not None}
    return Limits(airspeed, bank, radius, bool(reaction and reaction > rules.traffic_warns), extra)


def _first(session: Session, names: tuple[Named, ...], allowed: tuple[float, float]) -> float:
    """The first of some parameters that the vehicle has."""
    for named in names:
        value = session.parameter(named.name)
        if value is None:
            continue
        if not allowed[0] <= value * named.scale <= allowed[1]:
            low, high = allowed[0] / named.scale, allowed[1] / named.scale
            raise LinkError(f"the vehicle's {named.name} = {value:g}, must be between {low:g} and {high:g}")
        return value * named.scale
    known = " nor ".join(named.name for named in names)
    raise LinkError(f"the vehicle does not tell its {known}; if it signs its frames, it needs --signing-key")
