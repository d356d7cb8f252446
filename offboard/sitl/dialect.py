"""MAVLink messages to and from bytes: the one place that names the dialect."""

from __future__ import annotations

import struct
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

__all__ = ["Codec", "Extended", "Message", "mavlink"]

Message = Any
"""A message of pymavlink: it has no types of its own."""


class Codec:
    """Frames of one sender on one link: numbers those it packs, checks those it decodes.

    Parameters
    ----------
    system_id, component_id : int
        Of the sender.
    """

    def __init__(self, system_id: int, component_id: int = mavlink.MAV_COMP_ID_AUTOPILOT1) -> None:
        self._mav = mavlink.MAVLink(None, srcSystem=system_id, srcComponent=component_id)

    def pack(self, message: Message) -> bytes:
        """The frame of a message."""
        frame: bytes = message.pack(self._mav)
        self._mav.seq = (self._mav.seq + 1) % 256
        return frame

    def decode(self, frame: bytes) -> Message | None:
        """What a frame says; None if its checksum is wrong or nobody knows the message."""
        try:
            message = self._mav.decode(bytearray(frame))
        except mavlink.MAVError:
            return None
        return None if isinstance(message, mavlink.MAVLink_unknown) else message


class Extended:
    """A message with extension fields that this pymavlink does not know, such as PX4's `mission_id`.

    Parameters
    ----------
    message : Message
        The message as far as it is known.
    *extension : int
        The fields behind it, unsigned, of four bytes each. They do not enter the checksum's seed.
    """

    def __init__(self, message: Message, *extension: int) -> None:
        self._message = message
        self._extension = struct.pack(f"<{len(extension)}I", *extension)

    def pack(self, mav: mavlink.MAVLink) -> bytes:
        """The frame."""
        message = self._message
        fields = [getattr(message, name) for name in message.ordered_fieldnames]
        payload = message.unpacker.pack(*fields) + self._extension
        frame: bytes = message._pack(mav, message.crc_extra, payload)
        return frame
