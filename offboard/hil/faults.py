"""Failures of sensors: what, from when to when, how much.

Text form, several separated by semicolons: `NAME@START[-END][:VALUE,VALUE,VALUE]`, seconds since the start::

    gps-lost@60-90; airspeed-blocked@120; accel-bias@30:0.5,0,0; gyro-bias@30:0,0.02,0
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

from offboard.hil.errors import OptionError

FAULTS: Mapping[str, tuple[int, str]] = {
    "gps-lost": (0, "no fix, no satellites"),
    "airspeed-blocked": (0, "the pitot tube keeps the pressure it has at that moment"),
    "mag-lost": (0, "the magnetometer is silent"),
    "baro-lost": (0, "the barometer is silent"),
    "accel-bias": (3, "a step of the accelerometer's bias, body axes [m/s²]"),
    "gyro-bias": (3, "a step of the gyro's bias, body axes [rad/s]"),
}
"""Known faults: how many values they take, and what happens."""
_FORM = re.compile(
    r"(?P<name>[a-z-]+)@(?P<start>[0-9.]+)(?:-(?P<end>[0-9.]+))?(?::(?P<values>[-+0-9.e,\s]+))?"
)


@dataclass(frozen=True, slots=True)
class Fault:
    """One failure."""

    name: str
    """A key of `FAULTS`."""
    start: float
    """Since the start of the flight [s]."""
    end: float = math.inf
    """When it is over [s]."""
    values: tuple[float, ...] = ()
    """How much, where the fault has an amount."""

    def active(self, time: float) -> bool:
        """True while it lasts."""
        return self.start <= time < self.end


def parse_faults(text: str, known: Mapping[str, tuple[int, str]] = FAULTS) -> tuple[Fault, ...]:
    """Faults from their text form.

    Raises
    ------
    OptionError
        With every part that cannot be understood.
    """
    mistakes: list[str] = []
    found = [_fault(part.strip(), known, mistakes) for part in text.split(";") if part.strip()]
    if mistakes:
        raise OptionError("--faults", mistakes)
    return tuple(fault for fault in found if fault is not None)


def _fault(part: str, known: Mapping[str, tuple[int, str]], mistakes: list[str]) -> Fault | None:
    match = _FORM.fullmatch(part)
    if match is None:
        mistakes.append(f"{part!r} must be NAME@START[-END][:VALUE,…], such as gps-lost@60-90")
        return None
    name = match["name"]
    if name not in known:
        mistakes.append(f"{name!r} is unknown here; known: {', '.join(known)}")
        return None
    try:
        start, end = float(match["start"]), float(match["end"] or math.inf)
        values = tuple(float(value) for value in (match["values"] or "").split(",") if value.strip())
    except ValueError as error:
        mistakes.append(f"{part!r}: {error}")
        return None
    if not start < end:
        mistakes.append(f"{part!r}: ends at {end:g} s, before it starts at {start:g} s")
    count = known[name][0]
    if len(values) != count:
        mistakes.append(f"{part!r}: {name} takes {count or 'no'} values, not {len(values)}")
    return Fault(name, start, end, values)
