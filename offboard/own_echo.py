"""Ourselves among the traffic: a transponder that is received on board is no intruder. Pure."""

from __future__ import annotations

import math
from dataclasses import dataclass

from offboard.sightings import Sighting

NEAR = 60.0
"""An echo lies this near to the vehicle, and what it flies in a second: reports give their age so [m] ..."""
LEVEL = 60.0
"""... this near to its altitude, pressure against GPS [m] ..."""
ALIKE = 5.0
"""... and has its velocity within this [m/s]."""
REPORTS = 3
"""A newcomer that coincides so often in a row is an echo; until then it is held back ..."""
REPORTS_AFTER = 10
"""... and so often one that has not coincided: in a turn an old report does not."""
ELSEWHERE = 500.0
"""Who has been seen this far from the vehicle is somebody else, and comes near [m]."""
SAME_ADDRESS = 1000.0
"""Our own address counts only this near: addresses are set by hand, and set twice [m]."""
NO_ADDRESS = frozenset({0, 1194684})
"""ICAO addresses that say nothing: none, and the one that PX4 comes with."""


@dataclass(slots=True)
class _Count:
    """How a report's sender has been seen."""

    together: int = 0
    """Reports in a row that coincide."""
    apart: bool = False
    """It has not coincided at some time."""
    somebody: bool = False
    """It has been seen elsewhere."""
    last: float = -math.inf
    """Time of the last report that counted [s]."""


class OwnEcho:
    """Tells which reports of traffic are of ourselves.

    Parameters
    ----------
    address : int
        ICAO address of the own transponder; 0 if unknown.
    """

    def __init__(self, address: int = 0) -> None:
        self._address = 0 if address in NO_ADDRESS else address
        self._counts: dict[int, _Count] = {}

    def holds(self, report: Sighting, own: Sighting) -> bool:
        """True if a report is of the vehicle itself, or may well be.

        Parameters
        ----------
        report : Sighting
            Of some traffic.
        own : Sighting
            The vehicle itself: where it is, and how it moves.

        Notes
        -----
        Nobody appears out of nothing beside a vehicle with its velocity; if somebody does, no relative
        motion is what waiting for two more reports costs.
        """
        place = report.at(own.time)
        away = math.hypot(place.north - own.north, place.east - own.east)
        if self._address and report.id == self._address and away < SAME_ADDRESS:
            return True
        speed = math.hypot(own.velocity_north, own.velocity_east)
        unlike = math.hypot(
            report.velocity_north - own.velocity_north, report.velocity_east - own.velocity_east
        )
        level = abs(place.altitude - own.altitude) < LEVEL
        count = self._counts.setdefault(report.id, _Count())
        if not (away < NEAR + speed and level and unlike < ALIKE):
            count.together, count.apart = 0, True
            count.somebody |= away > ELSEWHERE
            return False
        if count.somebody:
            return False
        if report.time > count.last + 0.5:
            count.together += 1
            count.last = report.time
        needed = REPORTS_AFTER if count.apart else 1
        return count.together >= needed

    def sure(self, identity: int) -> bool:
        """True if one that `holds` has been told apart from a neighbour by now."""
        count = self._counts.get(identity)
        ours = self._address != 0 and identity == self._address
        return ours or (count is not None and count.together >= REPORTS)
