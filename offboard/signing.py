"""MAVLink 2 signing as a byte pipe: in front of what cannot sign by itself.

MAVSDK has no interface for signing. Its bytes go through a `SigningPipe` on their way out, and what comes
in goes through it too: what is not signed with the key, or is old, does not come out at the other end.

Notes
-----
https://mavlink.io/en/guide/message_signing.html: a signature is the link's number, 48 bits of time in units
of 10 µs since 2015-01-01 UTC, and the first 48 bits of SHA-256 over key, frame, number and time. The
checksum of a frame has a seed of its own for each message; here it is brought up to date without knowing
it: the checksum is linear, so setting or clearing a flag changes it by what depends on the flag and the
length alone. Any message can pass, also one that no dialect of ours knows.
"""

from __future__ import annotations

import hashlib
import hmac
import re
from collections.abc import Callable
from pathlib import Path

from offboard.errors import InputError
from offboard.framing import SIGNATURE_LENGTH, SIGNED, V2, Framer

KEY_LENGTH = 32
EPOCH = 1_420_070_400.0
"""2015-01-01 00:00 UTC in Unix time [s]."""
TICK = 1e-5
"""Unit of a signature's time [s]."""
OLDEST = round(60.0 / TICK)
"""A sender not heard before may be behind by no more than this [10 µs]."""

Sender = tuple[int, int, int]
"""Link number, system and component."""


def load_key(file: Path) -> bytes:
    """The secret key in a file: 64 hexadecimal digits, or a passphrase of which SHA-256 is the key.

    QGroundControl and MAVProxy make their keys from passphrases in the same way.

    Raises
    ------
    InputError
        If the file cannot be read, or is empty.
    """
    try:
        text = file.read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{file}: the signing key cannot be read: {error}") from error
    if not text:
        raise InputError(f"{file}: the signing key is empty; put 64 hexadecimal digits or a passphrase there")
    if re.fullmatch(r"[0-9a-fA-F]{64}", text):
        return bytes.fromhex(text)
    return hashlib.sha256(text.encode()).digest()


class SigningPipe:
    """Signs what goes out, lets in what is signed.

    Parameters
    ----------
    key : bytes
        Secret key of 32 bytes.
    clock : callable
        Unix time [s]; signatures never go back even if it does.
    link_id : int
        Number of this link, 0 to 255.
    heard : dict, optional
        Latest time of each sender, shared by pipes of one receiver: what came in on one link is then old
        on another.

    Raises
    ------
    ValueError
        If key or link number have no such size.
    """

    def __init__(
        self,
        key: bytes,
        clock: Callable[[], float],
        link_id: int = 0,
        heard: dict[Sender, int] | None = None,
    ) -> None:
        if len(key) != KEY_LENGTH:
            raise ValueError(f"key has {len(key)} bytes, must have {KEY_LENGTH}")
        if not 0 <= link_id <= 255:
            raise ValueError(f"link_id = {link_id}, must be between 0 and 255")
        self.dropped = 0
        """Frames that were not let in: unsigned, wrongly signed, or old."""
        self._key = key
        self._clock = clock
        self._link_id = link_id
        self._time = 0
        self._heard: dict[Sender, int] = {} if heard is None else heard
        self._out = Framer(self._signed)
        self._in = Framer(self._verified)

    def sign(self, data: bytes) -> bytes:
        """Frames as they come from inside; signed frames."""
        return b"".join(self._out.feed(data))

    def verify(self, data: bytes) -> bytes:
        """Bytes as they come from outside; the frames that are signed with the key, without signatures."""
        return b"".join(self._in.feed(data))

    def _signed(self, frame: bytes) -> bytes | None:
        """A frame with our signature; None for MAVLink 1, which cannot be signed."""
        if frame[0] != V2:
            return None
        if frame[2] & SIGNED:
            return frame
        self._time = max(self._time + 1, self._ticks())
        flagged = _with_flag(frame, SIGNED)
        ending = bytes((self._link_id,)) + self._time.to_bytes(6, "little")
        return flagged + ending + self._signature(flagged + ending)

    def _verified(self, frame: bytes) -> bytes | None:
        """A frame without its signature, if that is ours and not old."""
        if frame[0] != V2 or not frame[2] & SIGNED:
            self.dropped += 1
            return None
        body, given = frame[:-6], frame[-6:]
        if not hmac.compare_digest(self._signature(body), given):
            self.dropped += 1
            return None
        sender, time = (body[-7], frame[5], frame[6]), int.from_bytes(body[-6:], "little")
        last = self._heard.get(sender)
        newest = max(self._time, self._ticks())
        if time <= last if last is not None else time < newest - OLDEST:
            self.dropped += 1
            return b""
        self._heard[sender] = time
        self._time = max(self._time, time)
        return _with_flag(frame[:-SIGNATURE_LENGTH], 0)

    def _ticks(self) -> int:
        return round((self._clock() - EPOCH) / TICK)

    def _signature(self, data: bytes) -> bytes:
        return hashlib.sha256(self._key + data).digest()[:6]


def _with_flag(frame: bytes, flags: int) -> bytes:
    """A frame without signature with other incompatibility flags, and its checksum brought up to date."""
    change = frame[2] ^ flags
    # What is summed: everything from the length byte on but the checksum, and one byte of seed.
    difference = bytes((0, change)) + bytes(len(frame) - 4)
    checksum = int.from_bytes(frame[-2:], "little") ^ _crc(difference)
    return frame[:2] + bytes((flags,)) + frame[3:-2] + checksum.to_bytes(2, "little")


def _crc(data: bytes) -> int:
    """CRC-16/MCRF4XX of a difference of messages: begun at 0, for the beginning cancels."""
    value = 0
    for byte in data:
        mixed = (byte ^ value) & 0xFF
        mixed = (mixed ^ (mixed << 4)) & 0xFF
        value = (value >> 8) ^ (mixed << 8) ^ (mixed << 3) ^ (mixed >> 4)
    return value
