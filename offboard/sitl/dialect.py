"""MAVLink messages to and from bytes: the one place that names the dialect."""

from __future__ import annotations

import struct
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

__all__ = ["Codec", "Extended", "Message", "Packed", "mavlink"]

Message = Any
"""A message of pymavlink: it has no types of its own."""


Packed = tuple[bytes, int]
"""A frame without number and checksum, and the seed of its checksum."""


class Codec:
    """Frames of one sender on one link: numbers those it packs, checks those it decodes.

    Parameters
    ----------
    system_id, component_id : int
        Of the sender.
    """

    def __init__(self, system_id: int, component_id: int = mavlink.MAV_COMP_ID_AUTOPILOT1) -> None:
        self._mav = mavlink.MAVLink(None, srcSystem=system_id, srcComponent=component_id)
        self._sequence = 0

    def prepare(self, message: Message) -> Packed:
        """A message as bytes, to be sent on several links of the same sender."""
        frame: bytes = message.pack(self._mav)
        return frame[:-2], message.crc_extra

    def stamp(self, packed: Packed) -> bytes:
        """The frame of a prepared message, with this link's number."""
        frame = bytearray(packed[0])
        frame[4] = self._sequence
        self._sequence = (self._sequence + 1) % 256
        checksum = mavlink.x25crc(frame[1:])
        checksum.accumulate(bytes((packed[1],)))
        return bytes(frame) + struct.pack("<H", checksum.crc)

    def pack(self, message: Message) -> bytes:
        """The frame of a message."""
        return self.stamp(self.prepare(message))

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
        self.crc_extra: int = message.crc_extra
        self._extension = struct.pack(f"<{len(extension)}I", *extension)

    def pack(self, mav: mavlink.MAVLink) -> bytes:
        """The frame."""
        message = self._message
        fields = [getattr(message, name) for name in message.ordered_fieldnames]
        payload = message.unpacker.pack(*fields) + self._extension
        frame: bytes = message._pack(mav, message.crc_extra, payload)
        return frame
