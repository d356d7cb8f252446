"""Flight modes: how each autopilot numbers them, and what the aircraft does in them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Task(Enum):
    """What the aircraft does."""

    PILOT = "a pilot flies"
    """Straight ahead at this altitude: nobody moves the stick."""
    HOLD = "hold"
    """Circle here."""
    MISSION = "mission"
    """Fly the mission."""
    GUIDED = "guided"
    """Circle about a place that was given."""
    TAKEOFF = "take-off"
    """Climb away, then circle."""
    RETURN = "return"
    """Fly home and circle there."""
    LAND = "land"
    """Come down."""


@dataclass(frozen=True, slots=True)
class Mode:
    """One flight mode of an autopilot."""

    name: str
    """As ground stations show it."""
    custom_mode: int
    """Its number in HEARTBEAT."""
    task: Task
    """What the aircraft does in it."""
    base_mode: int
    """Flags in HEARTBEAT while disarmed."""
