"""Signs what MAVSDK says, and lets in what is signed: it stands between MAVSDK and the outside.

MAVSDK's bytes are handed over inside the process (`raw://`), not by a port: nobody else on this computer can
put unsigned frames in behind the signing.
"""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Hashable

from offboard.errors import LinkError
from offboard.live.outside import Outside, opener
from offboard.signing import Sender, SigningPipe

WAKE = 0.2
"""The reader looks so often whether it is to end [s]."""
REOPEN = 1.0
"""A link that has gone is opened anew after this time, and again [s]."""
MOST_STRANGERS = 64
"""Half a frame is kept of so many addresses from which nothing true has come."""


class Relay:
    """Carries frames between MAVSDK and the outside, signed there, a thread for each direction.

    A link that goes (TCP, serial) is opened anew once a second until the relay is closed.

    Parameters
    ----------
    url : str
        Of the outside, see `opener`.
    key : bytes
        Secret key of 32 bytes.
    deliver : callable
        Takes the frames that were let in, without their signatures; called in the reader's thread.
    clock : callable
        Unix time [s].

    Raises
    ------
    InputError
        If the URL is none.
    LinkError
        If it cannot be opened.
    """

    def __init__(
        self, url: str, key: bytes, deliver: Callable[[bytes], None], clock: Callable[[], float] = time.time
    ) -> None:
        self.accepted = 0
        """Times that something signed with the key has come."""
        self.dropped = 0
        """Frames that were not let in: unsigned, wrongly signed, or old."""
        self._key = key
        self._clock = clock
        self._deliver = deliver
        self._out = SigningPipe(key, clock)
        self._heard: dict[Sender, int] = {}
        self._known: dict[Hashable, SigningPipe] = {}
        self._strangers: dict[Hashable, SigningPipe] = {}
        self._open = opener(url)
        self._outside: Outside | None = self._open()
        self._sent: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self._over = threading.Event()
        self._threads = [threading.Thread(target=run, daemon=True) for run in (self._inwards, self._outwards)]
        for thread in self._threads:
            thread.start()

    def send(self, data: bytes) -> None:
        """Sign bytes of MAVSDK and send them; does not wait."""
        self._sent.put(data)

    def close(self) -> None:
        """Stop carrying, and free the link; nothing is delivered afterwards. A second call does nothing."""
        self._over.set()
        self._sent.put(None)
        for thread in self._threads:
            thread.join()
        if self._outside is not None:
            self._outside.close()
            self._outside = None

    def _outwards(self) -> None:
        while (data := self._sent.get()) is not None:
            outside, frames = self._outside, self._out.sign(data)
            if outside is not None and frames:
                outside.send(frames)

    def _inwards(self) -> None:
        while not self._over.is_set():
            if self._outside is None:
                self._reopen()
                continue
            try:
                received = self._outside.receive(WAKE)
            except OSError:
                outside, self._outside = self._outside, None
                outside.close()
                continue
            if received is not None:
                self._let_in(self._outside, *received)

    def _reopen(self) -> None:
        if self._over.wait(REOPEN):
            return
        self._known.clear()
        self._strangers.clear()
        try:
            self._outside = self._open()
        except LinkError:  # not there yet
            return

    def _let_in(self, outside: Outside, source: Hashable, data: bytes) -> None:
        """Hand over what is signed; each source has its own half frames, and all have the same past."""
        pipe = self._known.get(source) or self._strangers.get(source)
        if pipe is None:
            if len(self._strangers) >= MOST_STRANGERS:
                del self._strangers[next(iter(self._strangers))]
            pipe = self._strangers[source] = SigningPipe(self._key, self._clock, heard=self._heard)
        before = pipe.dropped
        frames = pipe.verify(data)
        self.dropped += pipe.dropped - before
        if not frames:
            return
        self.accepted += 1
        if self._strangers.pop(source, None) is not None:
            self._known[source] = pipe
            outside.trust(source)
        self._deliver(frames)
