"""The ways to the outside: each with its own frame numbers, streams, and signatures."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from offboard.framing import Framer
from offboard.signing import Sender, SigningPipe
from offboard.sitl.dialect import Codec, Message, Packed
from offboard.sitl.streams import Streams

LONGEST_QUEUE = 20_000
"""Frames that wait for a link which nobody empties; older ones are dropped."""


class Link:
    """One way to the outside: its own frame numbers, streams and left-over bytes."""

    def __init__(self, system_id: int, pipe: SigningPipe | None) -> None:
        self.codec = Codec(system_id)
        self.streams = Streams()
        self.out: list[bytes] = []
        self._framer = Framer(self.codec.decode)
        self._pipe = pipe

    def messages(self, data: bytes) -> list[Message]:
        """What has come in."""
        return self._framer.feed(data if self._pipe is None else self._pipe.verify(data))

    def put(self, packed: Packed) -> None:
        """Keep a message for the next time that somebody asks for what is to be sent."""
        frame = self.codec.stamp(packed)
        self.out.append(frame if self._pipe is None else self._pipe.sign(frame))
        del self.out[:-LONGEST_QUEUE]


class Links:
    """All links of one autopilot, by number; one begins when it is first spoken of.

    Parameters
    ----------
    system_id : int
        Of the autopilot.
    key : bytes or None
        Frames are signed with it, and must be.
    clock : callable
        Unix time for signatures [s].
    """

    def __init__(self, system_id: int, key: bytes | None, clock: Callable[[], float]) -> None:
        self._system_id = system_id
        self._key = key
        self._clock = clock
        self._links: dict[int, Link] = {}
        self._heard: dict[Sender, int] = {}

    def __getitem__(self, number: int) -> Link:
        if number not in self._links:
            pipe = None
            if self._key is not None:
                pipe = SigningPipe(self._key, self._clock, number & 0xFF, self._heard)
            self._links[number] = Link(self._system_id, pipe)
        return self._links[number]

    def __iter__(self) -> Iterator[Link]:
        return iter(self._links.values())

    def close(self, number: int) -> None:
        """Forget a link."""
        self._links.pop(number, None)

    def send(self, number: int, message: Message) -> None:
        """Send a message on one link."""
        link = self[number]
        link.put(link.codec.prepare(message))

    def broadcast(self, message: Message) -> None:
        """Send a message on every link."""
        packed = None
        for link in self:
            packed = packed or link.codec.prepare(message)
            link.put(packed)
