"""The rules of PX4 and of ArduPilot's planes, as far as they differ (docs/offboard.md has the table)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum
from typing import Protocol

from offboard.errors import LinkError
from offboard.raw_mission import ABSOLUTE, DEGREE, WAYPOINT, RawItem, RawMission


class Mode(Enum):
    """What a flight mode means to us."""

    MISSION = "mission"
    HOLD = "hold"
    GOTO = "goto"
    TAKE_OFF = "take-off"
    OTHER = "other"
    """Someone else flies: a human, or the autopilot on its own account."""


@dataclass(frozen=True, slots=True)
class Named:
    """A parameter and what it is worth in SI units."""

    name: str
    scale: float = 1.0


@dataclass(frozen=True, slots=True)
class Home:
    """Where the vehicle's home is."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float
    """Above mean sea level."""


class Rules(Protocol):
    """What is peculiar to one autopilot."""

    @property
    def name(self) -> str: ...
    @property
    def airspeed(self) -> tuple[Named, ...]: ...
    @property
    def bank(self) -> tuple[Named, ...]: ...
    @property
    def acceptance_radius(self) -> tuple[Named, ...]: ...
    @property
    def traffic_reaction(self) -> str: ...
    @property
    def traffic_warns(self) -> float: ...
    @property
    def goto_mode(self) -> Mode: ...
    @property
    def edit_may_cause(self) -> frozenset[Mode]: ...
    @property
    def demand(self) -> str: ...
    @property
    def loiter_radius(self) -> str: ...
    @property
    def first_item(self) -> int: ...
    @property
    def mission_taken(self) -> str: ...
    def mode(self, custom_mode: int) -> Mode:
        """The meaning of HEARTBEAT.custom_mode."""

    def mode_name(self, custom_mode: int) -> str:
        """Its name, as the autopilot's own documentation writes it."""

    def wire(self, items: tuple[RawItem, ...], home: Home) -> tuple[RawItem, ...]:
        """A mission as it must be uploaded."""

    def total(self, uploaded: int) -> int:
        """MISSION_CURRENT.total of a mission of so many uploaded items."""

    def problem(self, mission: RawMission, parameters: dict[str, float]) -> str | None:
        """Why the vehicle would not fly a mission; None if nothing is known against it."""


_PX4_MAIN = {
    1: "Manual",
    2: "Altitude",
    3: "Position",
    5: "Acro",
    6: "Offboard",
    7: "Stabilized",
    8: "Rattitude",
}
_PX4_AUTO = {
    1: "Ready",
    2: "Takeoff",
    3: "Hold",
    4: "Mission",
    5: "Return",
    6: "Land",
    8: "Follow me",
    9: "Precision land",
}


@dataclass(frozen=True, slots=True)
class Px4:
    """PX4 fixed-wing."""

    name: str = "PX4"
    airspeed: tuple[Named, ...] = (Named("FW_AIRSPD_TRIM"),)
    """Cruise airspeed [m/s]."""
    bank: tuple[Named, ...] = (Named("FW_R_LIM", math.pi / 180.0),)
    """Bank limit [rad]."""
    acceptance_radius: tuple[Named, ...] = (Named("NAV_ACC_RAD"),)
    """[m]."""
    traffic_reaction: str = "NAV_TRAFF_AVOID"
    """What makes it react to traffic by itself."""
    traffic_warns: float = 1.0
    """Up to this value it only warns."""
    goto_mode: Mode = Mode.HOLD
    edit_may_cause: frozenset[Mode] = frozenset({Mode.HOLD})
    """A plan that it finds infeasible is acknowledged, then it drops to Hold."""
    loiter_radius: str = "NAV_LOITER_RAD"
    """Radius of a circle where the item gives none [m]."""
    demand: str = "MIS_TKO_LAND_REQ"
    """What makes it ask for a take-off or a landing in each mission."""
    first_item: int = 0
    mission_taken: str = ""
    """What it says when it has taken a mission; PX4 tells by another `mission_id`."""

    def mode(self, custom_mode: int) -> Mode:
        """The meaning of HEARTBEAT.custom_mode: main mode in byte 2, sub-mode in byte 3."""
        main, sub = custom_mode >> 16 & 0xFF, custom_mode >> 24 & 0xFF
        if main != 4:
            return Mode.OTHER
        return {2: Mode.TAKE_OFF, 3: Mode.HOLD, 4: Mode.MISSION}.get(sub, Mode.OTHER)

    def mode_name(self, custom_mode: int) -> str:
        """Its name."""
        main, sub = custom_mode >> 16 & 0xFF, custom_mode >> 24 & 0xFF
        if main == 4:
            return _PX4_AUTO.get(sub, f"Auto {sub}")
        return _PX4_MAIN.get(main, f"mode {main}")

    def wire(self, items: tuple[RawItem, ...], home: Home) -> tuple[RawItem, ...]:  # noqa: ARG002
        """As they are."""
        return items

    def total(self, uploaded: int) -> int:
        """All items count."""
        return uploaded

    def problem(self, mission: RawMission, parameters: dict[str, float]) -> str | None:
        """PX4 wants a landing at the end, or `MIS_TKO_LAND_REQ` without that demand."""
        demand = int(parameters.get("MIS_TKO_LAND_REQ", 0.0))
        if demand in (2, 3) and not mission.lands:
            return (
                f"MIS_TKO_LAND_REQ = {demand}: PX4 accepts this mission and then drops to Hold, for it has "
                "no landing; end it with one, or set MIS_TKO_LAND_REQ to 0"
            )
        if demand in (1, 3) and not mission.takes_off:
            return (
                f"MIS_TKO_LAND_REQ = {demand}: PX4 accepts this mission and then drops to Hold, for it has "
                "no take-off; begin it with one, or set MIS_TKO_LAND_REQ to 0"
            )
        return None


_PLANE_MODES = {
    0: "MANUAL",
    1: "CIRCLE",
    2: "STABILIZE",
    3: "TRAINING",
    4: "ACRO",
    5: "FBWA",
    6: "FBWB",
    7: "CRUISE",
    8: "AUTOTUNE",
    10: "AUTO",
    11: "RTL",
    12: "LOITER",
    13: "TAKEOFF",
    14: "AVOID_ADSB",
    15: "GUIDED",
    16: "INITIALISING",
    17: "QSTABILIZE",
    18: "QHOVER",
    19: "QLOITER",
    20: "QLAND",
    21: "QRTL",
    24: "THERMAL",
}


@dataclass(frozen=True, slots=True)
class ArduPilot:
    """ArduPilot's planes. Item 0 of a mission is home: one without it loses its first waypoint silently."""

    name: str = "ArduPilot"
    airspeed: tuple[Named, ...] = (Named("AIRSPEED_CRUISE"), Named("TRIM_ARSPD_CM", 0.01))
    """Cruise airspeed [m/s]; the second name is the one before version 4.5."""
    bank: tuple[Named, ...] = (
        Named("ROLL_LIMIT_DEG", math.pi / 180.0),
        Named("LIM_ROLL_CD", math.pi / 18000.0),
    )
    """Bank limit [rad]; the second name is the one before version 4.5."""
    acceptance_radius: tuple[Named, ...] = (Named("WP_RADIUS"),)
    """[m]."""
    traffic_reaction: str = "AVD_ENABLE"
    """What makes it react to traffic by itself."""
    traffic_warns: float = 0.0
    """Up to this value it does nothing."""
    goto_mode: Mode = Mode.GOTO
    edit_may_cause: frozenset[Mode] = frozenset()
    loiter_radius: str = "WP_LOITER_RAD"
    """Radius of a circle where the item gives none [m]; negative turns to the left."""
    demand: str = ""
    first_item: int = 1
    mission_taken: str = "Flight plan received"
    """What it says when it has taken a mission: one of as many items cannot be seen otherwise."""

    def mode(self, custom_mode: int) -> Mode:
        """The meaning of HEARTBEAT.custom_mode."""
        known = {10: Mode.MISSION, 12: Mode.HOLD, 13: Mode.TAKE_OFF, 15: Mode.GOTO}
        return known.get(custom_mode, Mode.OTHER)

    def mode_name(self, custom_mode: int) -> str:
        """Its name."""
        return _PLANE_MODES.get(custom_mode, f"mode {custom_mode}")

    def wire(self, items: tuple[RawItem, ...], home: Home) -> tuple[RawItem, ...]:
        """Home first; no NaN anywhere, it is refused."""
        first = RawItem(
            WAYPOINT,
            min(ABSOLUTE),
            x=round(home.latitude_deg * DEGREE),
            y=round(home.longitude_deg * DEGREE),
            z=home.altitude_m,
        )
        return first, *(_without_nan(item) for item in items)

    def total(self, uploaded: int) -> int:
        """Home does not count."""
        return uploaded - 1

    def problem(self, mission: RawMission, parameters: dict[str, float]) -> str | None:  # noqa: ARG002
        """Nothing is known against any mission."""
        return None


def _without_nan(item: RawItem) -> RawItem:
    a, b, c, d = (0.0 if math.isnan(value) else value for value in item.params)
    return replace(item, params=(a, b, c, d))


RULES: dict[int, Rules] = {12: Px4(), 3: ArduPilot()}
"""By HEARTBEAT.autopilot (MAV_AUTOPILOT)."""


def rules_of(autopilot: int) -> Rules:
    """The rules of an autopilot by its MAV_AUTOPILOT number.

    Raises
    ------
    LinkError
        If it is neither PX4 nor ArduPilot.
    """
    if autopilot not in RULES:
        raise LinkError(f"the autopilot (MAV_AUTOPILOT {autopilot}) is neither PX4 nor ArduPilot")
    return RULES[autopilot]
