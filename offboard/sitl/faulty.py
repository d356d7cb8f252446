"""A bad link, on purpose: frames get lost, come late, twice, out of order, or not at all for a while."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from socket import socket

import numpy as np

from offboard.sitl.transports import Address, Transport


@dataclass(frozen=True, slots=True)
class Faults:
    """How bad a link is, either way."""

    loss: float = 0.0
    """Chance that a frame is lost."""
    duplication: float = 0.0
    """Chance that a frame comes twice."""
    delay: tuple[float, float] = (0.0, 0.0)
    """Least and greatest delay of a frame [s]; each has its own, so frames overtake one another."""
    outages: tuple[tuple[float, float], ...] = ()
    """From when to when nothing comes through [s since the link's start]."""

    def __post_init__(self) -> None:
        """Refuse chances outside 0 to 1 and delays that are none, with a `ValueError`."""
        for name, chance in (("loss", self.loss), ("duplication", self.duplication)):
            if not 0.0 <= chance <= 1.0:
                raise ValueError(f"{name} = {chance}, must be between 0 and 1")
        least, greatest = self.delay
        if not 0.0 <= least <= greatest < float("inf"):
            raise ValueError(f"delay = {self.delay}, must be two numbers from 0 on, the lesser first")


class FaultyChannel:
    """One direction of a bad link: a pure queue, without a clock of its own.

    Parameters
    ----------
    faults : Faults
        How bad it is.
    rng : Generator
        What happens is a function of it and of the calls.

    Examples
    --------
    >>> channel = FaultyChannel(Faults(delay=(1.0, 1.0)), np.random.default_rng(0))
    >>> channel.put(b"a", 0.0)
    >>> channel.take(0.5), channel.take(1.0)
    ([], [b'a'])
    """

    def __init__(self, faults: Faults, rng: np.random.Generator) -> None:
        self._faults = faults
        self._rng = rng
        self._waiting: list[tuple[float, int, bytes]] = []
        self._order = itertools.count()
        self.lost = 0
        """Frames that did not come through."""

    def put(self, frame: bytes, now: float) -> None:
        """Send a frame at time `now` [s]."""
        faults, rng = self._faults, self._rng
        if any(begin <= now < end for begin, end in faults.outages) or rng.random() < faults.loss:
            self.lost += 1
            return
        for _ in range(2 if rng.random() < faults.duplication else 1):
            arrival = now + rng.uniform(*faults.delay)
            heapq.heappush(self._waiting, (arrival, next(self._order), frame))

    def take(self, now: float) -> list[bytes]:
        """The frames that have arrived by `now` [s], in the order of their arrival."""
        found = []
        while self._waiting and self._waiting[0][0] <= now:
            found.append(heapq.heappop(self._waiting)[2])
        return found


class FaultyTransport:
    """A transport behind a bad link: every peer has two faulty channels.

    Parameters
    ----------
    transport : Transport
        The good one.
    faults : Faults
        How bad the link is.
    seed : int
        All chance comes from it.
    clock : callable
        Time [s].
    """

    def __init__(self, transport: Transport, faults: Faults, seed: int, clock: Callable[[], float]) -> None:
        self._transport = transport
        self._faults = faults
        self._seeds = np.random.SeedSequence(seed)
        self._clock = clock
        self._begun = clock()
        self._channels: dict[Address, tuple[FaultyChannel, FaultyChannel]] = {}

    def receive(self) -> list[tuple[Address, bytes]]:
        """What has come through by now; what has been held back for the peers goes out."""
        now = self._clock() - self._begun
        for peer, data in self._transport.receive():
            self._pair(peer)[0].put(data, now)
        found = []
        for peer, (inward, outward) in self._channels.items():
            found += [(peer, data) for data in inward.take(now)]
            if arrived := outward.take(now):
                self._transport.send(peer, arrived)
        return found

    def send(self, peer: Address, frames: Sequence[bytes]) -> None:
        """Send frames, each with its own fate."""
        now, outward = self._clock() - self._begun, self._pair(peer)[1]
        for frame in frames:
            outward.put(frame, now)
        if arrived := outward.take(now):
            self._transport.send(peer, arrived)

    def peers(self) -> Iterable[Address]:
        """Those of the good one."""
        return self._transport.peers()

    def sockets(self) -> list[socket]:
        """Those of the good one."""
        return self._transport.sockets()

    def close(self) -> None:
        """Close the good one."""
        self._transport.close()

    def _pair(self, peer: Address) -> tuple[FaultyChannel, FaultyChannel]:
        if peer not in self._channels:
            first, second = (np.random.default_rng(seed) for seed in self._seeds.spawn(2))
            self._channels[peer] = (FaultyChannel(self._faults, first), FaultyChannel(self._faults, second))
        return self._channels[peer]
