"""UDP and TCP for a simulated autopilot, without blocking and without threads."""

from __future__ import annotations

import contextlib
import socket
import time
from collections.abc import Iterable, Sequence
from typing import Protocol

from offboard.errors import LinkError
from offboard.sitl.autopilot import Autopilot

SILENCE = 30.0
"""A UDP peer that came by itself is forgotten after it has been silent so long [s, wall clock]."""
AT_ONCE = 500
"""Most datagrams read in one go: whoever floods us does not stop the simulation."""
MOST_PEERS = 64
"""Most peers of a port; more are not listened to."""
MOST_CLIENTS = 40
"""Most clients of a TCP port: twenty vehicles stay below what `select` can wait on."""
BLOCK = 65536
"""Most bytes read at once."""

Address = tuple[str, int]


class Transport(Protocol):
    """Carries bytes between an autopilot and any number of peers."""

    def receive(self) -> list[tuple[Address, bytes]]:
        """What has come in, with who sent it; does not wait."""

    def send(self, peer: Address, frames: Sequence[bytes]) -> None:
        """Send frames to a peer; what cannot be sent is lost."""

    def peers(self) -> Iterable[Address]:
        """Everyone who is to be sent to."""

    def sockets(self) -> list[socket.socket]:
        """What to wait on."""

    def close(self) -> None:
        """Close everything."""


class Udp:
    """One UDP port: sends to given addresses from the start, and to whoever else sends something.

    Parameters
    ----------
    port : int
        Own port; 0 takes a free one.
    targets : sequence of (host, port)
        Who is sent to without having asked: where MAVSDK or a ground station listens.
    host : str
        Own address.

    Raises
    ------
    LinkError
        If the port cannot be had.
    """

    def __init__(self, port: int = 0, targets: Sequence[Address] = (), host: str = "127.0.0.1") -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._targets = tuple(targets)
        self._heard: dict[Address, float] = {}
        with contextlib.suppress(OSError):
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        try:
            self._socket.bind((host, port))
        except (OSError, OverflowError) as error:
            self._socket.close()
            raise LinkError(f"UDP port {port} on {host} cannot be had: {error}") from error
        self._socket.setblocking(False)
        self.port: int = self._socket.getsockname()[1]

    def receive(self) -> list[tuple[Address, bytes]]:
        """The datagrams that have come in."""
        found: list[tuple[Address, bytes]] = []
        for _ in range(AT_ONCE):
            try:
                data, address = self._socket.recvfrom(BLOCK)
            except ConnectionResetError:  # so Windows tells that nobody listens where we sent to
                continue
            except OSError:
                break
            if address in self._heard or len(self._heard) < MOST_PEERS:
                self._heard[address] = time.monotonic()
                found.append((address, data))
        return found

    def send(self, peer: Address, frames: Sequence[bytes]) -> None:
        """One datagram per frame, so that what gets lost is one frame."""
        for frame in frames:
            with contextlib.suppress(OSError):
                self._socket.sendto(frame, peer)

    def peers(self) -> Iterable[Address]:
        """The targets, and who has been heard of lately."""
        oldest = time.monotonic() - SILENCE
        for address in [a for a, heard in self._heard.items() if heard < oldest]:
            del self._heard[address]
        return (*self._targets, *(address for address in self._heard if address not in self._targets))

    def sockets(self) -> list[socket.socket]:
        """The one."""
        return [self._socket]

    def close(self) -> None:
        """Close the port."""
        self._socket.close()


class TcpServer:
    """A TCP port to which anyone may connect.

    Parameters
    ----------
    port : int
        Own port; 0 takes a free one.
    host : str
        Own address.

    Raises
    ------
    LinkError
        If the port cannot be had.
    """

    def __init__(self, port: int = 0, host: str = "127.0.0.1") -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._clients: dict[Address, socket.socket] = {}
        try:
            self._socket.bind((host, port))
        except (OSError, OverflowError) as error:
            self._socket.close()
            raise LinkError(f"TCP port {port} on {host} cannot be had: {error}") from error
        self._socket.listen()
        self._socket.setblocking(False)
        self.port: int = self._socket.getsockname()[1]

    def receive(self) -> list[tuple[Address, bytes]]:
        """What the clients have sent; new ones are let in, gone ones forgotten."""
        with contextlib.suppress(OSError):  # none left, or one that has given up meanwhile
            while len(self._clients) < MOST_CLIENTS:
                client, address = self._socket.accept()
                client.setblocking(False)
                client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self._clients[address] = client
        found: list[tuple[Address, bytes]] = []
        for address, client in list(self._clients.items()):
            try:
                data = client.recv(BLOCK)
            except (BlockingIOError, InterruptedError):
                continue
            except OSError:
                data = b""
            if data:
                found.append((address, data))
            else:
                self._drop(address)
        return found

    def send(self, peer: Address, frames: Sequence[bytes]) -> None:
        """Send all frames, or drop a client that does not read them."""
        client = self._clients.get(peer)
        if client is None:
            return
        data = b"".join(frames)
        try:
            if client.send(data) < len(data):
                self._drop(peer)
        except OSError:
            self._drop(peer)

    def peers(self) -> Iterable[Address]:
        """The clients."""
        return tuple(self._clients)

    def sockets(self) -> list[socket.socket]:
        """The port and its clients."""
        return [self._socket, *self._clients.values()]

    def close(self) -> None:
        """Close the port and all connections."""
        for address in list(self._clients):
            self._drop(address)
        self._socket.close()

    def _drop(self, address: Address) -> None:
        self._clients.pop(address).close()


class Exchange:
    """Joins an autopilot with its transports: every peer of each is a link of its own.

    Parameters
    ----------
    autopilot : Autopilot
        Whose bytes they are.
    transports : sequence of Transport
        How they travel.
    """

    def __init__(self, autopilot: Autopilot, transports: Sequence[Transport]) -> None:
        self.autopilot = autopilot
        self._transports = tuple(transports)
        self._links: dict[tuple[int, Address], int] = {}
        self._speakers: set[tuple[int, Address]] = set()
        self._count = 0

    def receive(self) -> None:
        """Feed the autopilot with what has come in, and send what it answers."""
        for number, transport in enumerate(self._transports):
            for peer, data in transport.receive():
                self.autopilot.feed(data, self._link(number, peer))
                self._speakers.add((number, peer))
        self.send()

    def send(self) -> None:
        """Send what the autopilot has to say; links whose peer has gone are closed."""
        present = set()
        for number, transport in enumerate(self._transports):
            for peer in transport.peers():
                present.add((number, peer))
                frames = self.autopilot.frames(self._link(number, peer))
                if frames:
                    transport.send(peer, frames)
        for key in [key for key in self._links if key not in present]:
            self.autopilot.close(self._links.pop(key))
            self._speakers.discard(key)

    def sockets(self) -> list[socket.socket]:
        """What to wait on."""
        return [each for transport in self._transports for each in transport.sockets()]

    def close(self) -> None:
        """Close all transports."""
        for transport in self._transports:
            transport.close()

    @property
    def heard(self) -> int:
        """How many peers have said anything."""
        return len(self._speakers & self._links.keys())

    def _link(self, number: int, peer: Address) -> int:
        key = (number, peer)
        if key not in self._links:
            self._count += 1
            self._links[key] = self._count
        return self._links[key]
