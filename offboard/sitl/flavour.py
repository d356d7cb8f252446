"""What one autopilot does otherwise than the other, as data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from offboard.sitl.modes import Mode, Task
from offboard.sitl.parameters import Value


class Role(Enum):
    """Parameters by what they are for; each autopilot has its own name for them."""

    AIRSPEED = "cruise airspeed [m/s]"
    ACCEPTANCE = "acceptance radius [m]"
    LOITER = "radius of a circle [m]"
    BANK = "bank limit [deg]"
    TAKEOFF = "altitude of a take-off without a mission [m]"
    RETURN = "altitude of a return [m]"


class Say(Enum):
    """Events that are told as text."""

    ARMED = "armed"
    DISARMED = "disarmed"
    NOT_ARMED = "cannot be armed"
    IN_FLIGHT = "cannot be disarmed in flight"
    MISSION_MODE = "the mission mode begins"
    NO_MISSION = "the mission mode is refused"
    RECEIVED = "a mission has been received"
    INFEASIBLE = "a mission cannot be flown"
    LEG = "an item is flown to"
    REACHED = "an item has been reached"
    CLIMBED = "a take-off is over"
    FINISHED = "the last item has been reached"
    OFF_LIST = "an item is not in the list"
    TAKEOFF = "off the ground"
    LANDED = "on the ground"
    GAVE_UP = "an upload has been given up"


@dataclass(frozen=True, slots=True)
class Flavour:
    """One autopilot's rules."""

    name: str
    autopilot: int
    """MAV_AUTOPILOT."""
    version: int
    """`flight_sw_version` of AUTOPILOT_VERSION."""
    capabilities: int
    """MAV_PROTOCOL_CAPABILITY flags: what this simulation can do of them."""
    modes: tuple[Mode, ...]
    """All flight modes; the first with a task is the one taken for it."""
    start: Task
    """Task of the mode after power-on."""
    home_item: bool
    """Item 0 of a mission is home: what is uploaded there is not flown to."""
    atomic: bool
    """A new mission takes over as a whole and is flown from its flagged item on; else its items are written
    over the old ones one by one, the flag means nothing and the target under way is kept."""
    reached_repeats: int
    """How often MISSION_ITEM_REACHED is sent, once a second."""
    after_mission: Task
    """What follows the last item."""
    bytewise: bool
    """Integer parameters travel as bytes."""
    parameters: Mapping[str, Value]
    """Parameters and their values before anything is set."""
    roles: Mapping[Role, str]
    """Names of the parameters that this simulation acts on."""
    texts: Mapping[Say, tuple[int, str]]
    """Severity and text of what it tells; an event without text is not told."""
    fixed_rates: frozenset[int]
    """Messages whose rate it does not let anyone set."""
    most_items: int
    """Longest mission."""
    target_frame: int
    """`coordinate_frame` of POSITION_TARGET_GLOBAL_INT."""
    target_mask: int
    """`type_mask` of POSITION_TARGET_GLOBAL_INT."""
    download_frames: bool
    """A download gives the plain frames (3) instead of those uploaded (6), and no `current` flag."""

    def mode_for(self, task: Task) -> Mode:
        """The mode in which the aircraft does this; the one for holding if there is none of its own."""
        hold = next(mode for mode in self.modes if mode.task is Task.HOLD)
        return next((mode for mode in self.modes if mode.task is task), hold)

    def mode_numbered(self, custom_mode: int) -> Mode | None:
        """The mode with this number; None if there is none."""
        return next((mode for mode in self.modes if mode.custom_mode == custom_mode), None)
