"""MAVLink frames in a stream of bytes, kept as they are: what a bridge forwards it does not re-encode."""

from __future__ import annotations

from typing import Any, NamedTuple

from offboard import framing
from offboard.framing import V2


class Frame(NamedTuple):
    """One MAVLink frame, version 1 or 2."""

    message: int
    """Message ID."""
    system: int
    """Sender's system ID."""
    data: bytes
    """All of it, signature included."""

    @property
    def payload(self) -> bytes:
        """The message's content, zeros at its end left out if version 2."""
        begin = 10 if self.data[0] == V2 else 6
        return self.data[begin : begin + self.data[1]]


class Writer:
    """MAVLink 2 frames from payloads in wire order; several times as fast as pymavlink's message objects.

    Parameters
    ----------
    message, crc_extra : int
        Message ID, and the constant that its checksum includes.
    mav : pymavlink MAVLink
        Gives system, component and the running sequence number.
    """

    def __init__(self, message: int, crc_extra: int, mav: Any) -> None:  # noqa: ANN401  (no types)
        from pymavlink.dialects.v20 import common  # noqa: PLC0415  (slow import)

        self._message = message.to_bytes(3, "little")
        self._extra = bytes([crc_extra])
        self._mav = mav
        self._crc = common.x25crc

    def frame(self, payload: bytes) -> bytes:
        """The whole frame; zeros at the payload's end are not sent, as MAVLink 2 wants it."""
        mav = self._mav
        payload = payload.rstrip(b"\0") or b"\0"
        body = bytes((len(payload), 0, 0, mav.seq, mav.srcSystem, mav.srcComponent)) + self._message + payload
        mav.seq = (mav.seq + 1) % 256
        crc: int = self._crc(body + self._extra).crc
        return bytes((V2,)) + body + crc.to_bytes(2, "little")


class Framer:
    """Cuts a stream into frames; garbage between them, and frames with a wrong checksum, are left out.

    Messages that pymavlink does not know pass unchecked.

    Examples
    --------
    >>> framer = Framer()
    >>> heartbeat = bytes.fromhex("fd09000001040100000000000000000c0000030238")
    >>> [frame.message for frame in framer.feed(b"noise" + heartbeat[:7]) + framer.feed(heartbeat[7:])]
    [0]
    >>> framer.skipped
    5
    """

    def __init__(self) -> None:
        from pymavlink.dialects.v20 import common  # noqa: PLC0415  (slow import)

        self._extra = {number: bytes([each.crc_extra]) for number, each in common.mavlink_map.items()}
        self._crc = common.x25crc
        self._cutter = framing.Framer(self._checked)
        self._bytes = 0

    @property
    def skipped(self) -> int:
        """Bytes left out so far."""
        return self._bytes - self._cutter.waiting

    def feed(self, data: bytes) -> list[Frame]:
        """The frames that are complete with these bytes."""
        frames = self._cutter.feed(data)
        self._bytes += len(data) - sum(len(frame.data) for frame in frames)
        return frames

    def _checked(self, data: bytes) -> Frame | None:
        if data[0] == V2:
            message, system, end = int.from_bytes(data[7:10], "little"), data[5], 10 + data[1]
        else:
            message, system, end = data[5], data[3], 6 + data[1]
        extra = self._extra.get(message)
        if extra is not None and self._crc(data[1:end] + extra).crc != data[end] | data[end + 1] << 8:
            return None
        return Frame(message, system, data)
