"""The avoidance core: radar scans in, decisions out. No I/O, no clock, no threads."""

from avoidance.types import (
    Contact,
    Decision,
    Detour,
    Hold,
    Keep,
    Ownship,
    Performance,
    RadarScan,
    Replace,
    Reroute,
    Resume,
    Route,
    Rung,
    Search,
    Threat,
    Waypoint,
)

__all__ = [
    "Contact",
    "Decision",
    "Detour",
    "Hold",
    "Keep",
    "Ownship",
    "Performance",
    "RadarScan",
    "Replace",
    "Reroute",
    "Resume",
    "Route",
    "Rung",
    "Search",
    "Threat",
    "Waypoint",
]
