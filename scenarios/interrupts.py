"""Stopping early with everything written: Ctrl-C, and SIGTERM as services and other processes send it."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator
from types import FrameType


@contextlib.contextmanager
def stop_on_interrupt() -> Iterator[list[int]]:
    """Note the first Ctrl-C and the first SIGTERM: the list is not empty then. The same again stops hard.

    One of each is no hurry: Ctrl-C reaches all processes of a terminal, and the first of them then asks the
    others by SIGTERM to end.
    """
    stop: list[int] = []
    both = (signal.SIGINT, signal.SIGTERM)

    def note(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
        stop.append(number)
        signal.signal(number, signal.default_int_handler)

    before = [signal.signal(each, note) for each in both]
    try:
        yield stop
    finally:
        for each, handler in zip(both, before, strict=True):
            signal.signal(each, handler)
