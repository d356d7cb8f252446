"""MAVLink frames out of a stream of bytes, whatever else is in it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

V1, V2 = 0xFE, 0xFD
"""First byte of a frame, by version of the protocol."""
SIGNED = 0x01
"""Incompatibility flag of a frame that carries a signature; any other flag is unknown to us."""
SIGNATURE_LENGTH = 13
LONGEST = 12 + 255 + SIGNATURE_LENGTH
"""No frame has more bytes."""

T = TypeVar("T")


class Framer(Generic[T]):
    """Cuts frames out of a byte stream and gives each to whoever can tell a true one.

    What is not accepted costs one byte, not the length that it claims: a forged header cannot swallow the
    true frames behind it.

    Parameters
    ----------
    accept : callable
        From the bytes of a supposed frame to what they mean; None if they are no frame after all.
    """

    def __init__(self, accept: Callable[[bytes], T | None]) -> None:
        self._accept = accept
        self._left = b""

    @property
    def waiting(self) -> int:
        """Bytes of a frame that is not complete yet."""
        return len(self._left)

    def feed(self, data: bytes) -> list[T]:
        """What the frames that are complete now mean, in their order."""
        buffer = self._left + data
        found: list[T] = []
        start = 0
        while start < len(buffer):
            if buffer[start] not in (V1, V2):
                start = _next_start(buffer, start + 1)
                continue
            length = _length(buffer, start)
            if length is None or start + length > len(buffer):
                break
            meaning = self._accept(buffer[start : start + length]) if length else None
            if meaning is None:
                start += 1
            else:
                found.append(meaning)
                start += length
        self._left = buffer[start:]
        return found


def _next_start(buffer: bytes, start: int) -> int:
    """Where the next frame may begin."""
    places = [place for mark in (V1, V2) if (place := buffer.find(mark, start)) >= 0]
    return min(places, default=len(buffer))


def _length(buffer: bytes, start: int) -> int | None:
    """Length of the frame that begins here; 0 if none can, None if too little of it is known."""
    left = len(buffer) - start
    if buffer[start] == V1:
        return 8 + buffer[start + 1] if left > 1 else None
    if left < 3:
        return None
    flags = buffer[start + 2]
    if flags & ~SIGNED:
        return 0
    return 12 + buffer[start + 1] + (SIGNATURE_LENGTH if flags & SIGNED else 0)
