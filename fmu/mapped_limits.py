"""What the avoidance must know of a user's aircraft: the table `[limits]` of a mapping."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

_KEYS: dict[str, tuple[str, float | None, float, float]] = {
    "max_bank": ("max_bank_deg", None, 1.0, 80.0),
    "roll_time": ("roll_time_s", None, 0.0, 60.0),
    "min_airspeed": ("min_airspeed_m_s", None, 1.0, 100.0),
    "max_airspeed": ("max_airspeed_m_s", None, 1.0, 100.0),
    "tracking_error": ("tracking_error_m", 10.0, 0.0, 1_000.0),
    "capture_distance": ("capture_distance_m", 250.0, 0.0, 100_000.0),
}
"""Key of each field, its default (none: it must be given), least and largest value."""


@dataclass(frozen=True, slots=True)
class MappedLimits:
    """What a user's aircraft can do."""

    max_bank: float
    """Bank at which it turns, at most [rad]."""
    roll_time: float
    """Time to reach a commanded bank [s]."""
    min_airspeed: float
    """Slowest airspeed that it can be told [m/s]."""
    max_airspeed: float
    """Fastest airspeed that it can be told [m/s]."""
    tracking_error: float
    """Largest distance from a straight leg once it is captured [m]."""
    capture_distance: float
    """Distance along a new leg until it is captured within that [m]."""


def read_limits(table: Mapping[str, object], mistakes: list[str]) -> MappedLimits | None:
    """The limits in SI units and radians; None, and what is wrong in the list of mistakes, if there are none.

    Parameters
    ----------
    table : mapping
        As it stands in the file.
    mistakes : list of str
        What is wrong is added to it, with key, value and range.
    """
    before = len(mistakes)
    keys = [key for key, *_ in _KEYS.values()]
    mistakes += [f"limits.{key} is unknown; known: {', '.join(keys)}" for key in table if key not in keys]
    values = {}
    for field, (key, default, least, largest) in _KEYS.items():
        value = table.get(key, default)
        if value is None:
            mistakes.append(f"limits.{key} is missing")
        elif isinstance(value, bool) or not isinstance(value, (int, float)) or not least <= value <= largest:
            mistakes.append(f"limits.{key} = {value!r} must be at least {least:g} and at most {largest:g}")
        else:
            values[field] = float(value)
    if len(mistakes) == before and values["min_airspeed"] > values["max_airspeed"]:
        mistakes.append(f"limits.min_airspeed_m_s = {values['min_airspeed']:g} is above max_airspeed_m_s")
    if len(mistakes) > before:
        return None
    return MappedLimits(**values | {"max_bank": math.radians(values["max_bank"])})
