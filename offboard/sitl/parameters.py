"""Parameters of an autopilot: a table with names and types, and how they travel."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterable, Iterator, Mapping

from offboard.sitl.dialect import Message, mavlink

INT8 = mavlink.MAV_PARAM_TYPE_INT8
INT16 = mavlink.MAV_PARAM_TYPE_INT16
INT32 = mavlink.MAV_PARAM_TYPE_INT32
REAL32 = mavlink.MAV_PARAM_TYPE_REAL32
LIMITS = {INT8: 2**7, INT16: 2**15, INT32: 2**31}
"""Integers lie below this, and not below its negative."""

Value = tuple[int, float]
"""MAV_PARAM_TYPE and value of a parameter."""


class Parameters:
    """A table of parameters, in the order of their names.

    Parameters
    ----------
    table : mapping
        Type and value by name.
    changes : mapping
        Values other than the table's.
    bytewise : bool
        Integers travel as their bytes in the place of a float's (PX4), not as floats (ArduPilot).

    Raises
    ------
    ValueError
        If a change names an unknown parameter or has a value that does not fit.
    """

    def __init__(self, table: Mapping[str, Value], changes: Mapping[str, float], bytewise: bool) -> None:
        self._values: dict[str, Value] = dict(sorted(table.items()))
        self._bytewise = bytewise
        for name, value in changes.items():
            if not self.set(name, value):
                raise ValueError(f"parameter {name} = {value}: unknown, or out of the range of its type")

    def __len__(self) -> int:
        return len(self._values)

    def __contains__(self, name: object) -> bool:
        return name in self._values

    def __getitem__(self, name: str) -> float:
        return self._values[name][1]

    def set(self, name: str, value: float) -> bool:
        """Set a value; False if there is no such parameter or the value does not fit it."""
        if name not in self._values or not math.isfinite(value):
            return False
        kind = self._values[name][0]
        if kind != REAL32:
            value = round(value)
            if not -LIMITS[kind] <= value < LIMITS[kind]:
                return False
        self._values[name] = (kind, value)
        return True

    def taken(self, message: Message) -> str | None:
        """Do what a PARAM_SET asks; the parameter's name, None if nothing was changed.

        Notes
        -----
        The message names a type; what counts is the table's, as in both autopilots.
        """
        name = _name(message.param_id)
        if name not in self._values:
            return None
        kind, value = self._values[name][0], message.param_value
        if self._bytewise and kind != REAL32:
            value = struct.unpack("<i", struct.pack("<f", value))[0]
        return name if self.set(name, value) else None

    def message(self, name: str, index: int | None = None) -> Message:
        """PARAM_VALUE of a parameter; its own index unless another is given."""
        kind, value = self._values[name]
        if self._bytewise and kind != REAL32:
            value = struct.unpack("<f", struct.pack("<i", int(value)))[0]
        at = list(self._values).index(name) if index is None else index
        return mavlink.MAVLink_param_value_message(name.encode(), float(value), kind, len(self), at)

    def asked(self, message: Message) -> Message | None:
        """The answer to a PARAM_REQUEST_READ by name or index; None if there is no such parameter."""
        name = _name(message.param_id)
        if 0 <= message.param_index < len(self):
            name = list(self._values)[message.param_index]
        return self.message(name) if name in self._values else None

    def all(self) -> Iterator[Message]:
        """One PARAM_VALUE after the other."""
        return (self.message(name, index) for index, name in enumerate(list(self._values)))


def real(values: Iterable[tuple[str, float]]) -> dict[str, Value]:
    """A table of floats."""
    return {name: (REAL32, value) for name, value in values}


def _name(text: str | bytes) -> str:
    raw = text.encode() if isinstance(text, str) else text
    return raw.split(b"\0", 1)[0].decode("ascii", errors="replace")
