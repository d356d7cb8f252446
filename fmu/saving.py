"""The state of an instance as bytes, and back: bit for bit, in the same instance or in another."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fmu.library import FmuInstance

WARNING = 1
"""Highest FMI status with which a run goes on."""


@dataclass(frozen=True, slots=True, eq=False)
class SavedPlant:
    """A moment of a flight; made by `FmuPlant.save`, taken by `FmuPlant.restore` of any plant of the FMU."""

    model: bytes
    """The model's state as it serialises it."""
    nanoseconds: int
    """Since the start."""
    command: tuple[float, ...] = ()
    """Leg or orbit being flown."""
    values: Mapping[str, float] = field(default_factory=dict)
    """What the plant was started with and commanded since, by variable name."""


def serialise(instance: FmuInstance) -> bytes:
    """The model's state.

    Raises
    ------
    PlantError
        If the instance has been freed.
    """
    functions, handle = instance.library.functions, instance.live("save")
    state, size = ctypes.c_void_p(), ctypes.c_size_t()
    if functions.fmi3GetFMUState(handle, ctypes.byref(state)) > WARNING:
        raise instance.failure("save")
    try:
        functions.fmi3SerializedFMUStateSize(handle, state, ctypes.byref(size))
        data = (ctypes.c_uint8 * size.value)()
        if functions.fmi3SerializeFMUState(handle, state, data, size) > WARNING:
            raise instance.failure("save")
        return bytes(data)
    finally:
        functions.fmi3FreeFMUState(handle, ctypes.byref(state))


def deserialise(instance: FmuInstance, data: bytes) -> None:
    """Put the model into a state that `serialise` gave.

    Raises
    ------
    ValueError
        If it is no state of this model, or damaged; nothing has changed then.
    PlantError
        If the instance has been freed.
    """
    functions, handle = instance.library.functions, instance.live("restore")
    state, size = ctypes.c_void_p(), len(data)
    array = (ctypes.c_uint8 * size).from_buffer_copy(data)
    if functions.fmi3DeserializeFMUState(handle, array, size, ctypes.byref(state)) > WARNING:
        raise ValueError(f"saved: {instance.library.said()}")
    try:
        if functions.fmi3SetFMUState(handle, state) > WARNING:
            raise ValueError(f"saved: {instance.library.said()}")
    finally:
        functions.fmi3FreeFMUState(handle, ctypes.byref(state))
