"""The other end of a link by its URL, as MAVSDK writes it, for when MAVSDK does not open it itself."""

from __future__ import annotations

import re
import select
import socket
from collections.abc import Callable, Hashable
from typing import Any, Protocol

from offboard.errors import InputError, LinkError

BLOCK = 65536
"""Most bytes read at once."""
MOST_PEERS = 8
"""A UDP port answers so many addresses, those from which something true has come last."""
PATIENCE = 5.0
"""A TCP connection is made, and takes what is sent, within this time [s]."""

_NETWORK = re.compile(r"(?P<kind>udpin|udpout|tcpout)://(?P<host>[^:/\s]+):(?P<port>\d{1,5})")
_SERIAL = re.compile(r"serial://(?P<device>\S+):(?P<baud>\d{1,8})")

Received = tuple[Hashable, bytes]
"""Who has sent, and what."""


class Outside(Protocol):
    """A way out. Every method but `send` belongs to one thread, `send` to another."""

    def receive(self, timeout: float) -> Received | None:
        """What has come, waiting up to `timeout` [s]; None if nothing has.

        Raises
        ------
        OSError
            If the other side has gone.
        """

    def trust(self, source: Hashable) -> None:
        """Something true has come from there: it is to be answered."""

    def send(self, data: bytes) -> None:
        """Send frames; what cannot be sent is lost."""

    def close(self) -> None:
        """Free it."""


class Udp:
    """A UDP port that answers those it trusts.

    Parameters
    ----------
    bind : (host, port)
        Own address.
    peer : (host, port), optional
        Who is sent to without having sent anything.
    """

    def __init__(self, bind: tuple[str, int], peer: tuple[str, int] | None = None) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._fixed = None if peer is None else (socket.gethostbyname(peer[0]), peer[1])
            self._socket.bind(bind)
        except (OSError, OverflowError):
            self._socket.close()
            raise
        self._socket.setblocking(False)
        self._peers: tuple[Any, ...] = () if self._fixed is None else (self._fixed,)
        self.port: int = self._socket.getsockname()[1]

    def receive(self, timeout: float) -> Received | None:
        """See `Outside`; one datagram."""
        if not select.select([self._socket], [], [], timeout)[0]:
            return None
        try:
            data, source = self._socket.recvfrom(BLOCK)
        except (ConnectionError, BlockingIOError):  # nobody listens where we sent to; a bad checksum
            return None
        return source, data

    def trust(self, source: Hashable) -> None:
        """See `Outside`."""
        if source not in self._peers:
            fixed = () if self._fixed is None else (self._fixed,)
            others = self._peers[len(fixed) :][-(MOST_PEERS - len(fixed) - 1) :]
            self._peers = (*fixed, *others, source)

    def send(self, data: bytes) -> None:
        """See `Outside`."""
        for peer in self._peers:
            try:
                self._socket.sendto(data, peer)
            except OSError:  # this one misses it, the next may not
                continue

    def close(self) -> None:
        """See `Outside`."""
        self._socket.close()


class Tcp:
    """A TCP connection that we make."""

    def __init__(self, host: str, port: int) -> None:
        self._socket = socket.create_connection((host, port), timeout=PATIENCE)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def receive(self, timeout: float) -> Received | None:
        """See `Outside`."""
        if not select.select([self._socket], [], [], timeout)[0]:
            return None
        data = self._socket.recv(BLOCK)
        if not data:
            raise ConnectionResetError("the other side has closed the connection")
        return None, data

    def trust(self, source: Hashable) -> None:
        """See `Outside`; there is only one to answer."""

    def send(self, data: bytes) -> None:
        """See `Outside`; a connection that does not take it is ended, for half a frame may be in it."""
        try:
            self._socket.sendall(data)
        except OSError:
            try:
                self._socket.shutdown(socket.SHUT_RDWR)
            except OSError:  # it has gone already
                return

    def close(self) -> None:
        """See `Outside`."""
        self._socket.close()


class Serial:
    """A serial port."""

    def __init__(self, device: str, baud: int) -> None:
        import serial  # noqa: PLC0415  (needed for hardware only)

        self._port: Any = serial.Serial(device, baud, write_timeout=1.0)

    def receive(self, timeout: float) -> Received | None:
        """See `Outside`."""
        if self._port.timeout != timeout:
            self._port.timeout = timeout
        data = bytes(self._port.read(1))
        if data and (more := self._port.in_waiting):
            data += bytes(self._port.read(more))
        return (None, data) if data else None

    def trust(self, source: Hashable) -> None:
        """See `Outside`; there is only one to answer."""

    def send(self, data: bytes) -> None:
        """See `Outside`."""
        try:
            self._port.write(data)
        except (OSError, TypeError):  # gone, or closed meanwhile (no handle is left): the reader will see it
            return

    def close(self) -> None:
        """See `Outside`."""
        self._port.close()


def opener(url: str) -> Callable[[], Outside]:
    """What opens a URL, each time anew.

    Parameters
    ----------
    url : str
        udpin://HOST:PORT, udpout://HOST:PORT, tcpout://HOST:PORT or serial://DEVICE:BAUD.

    Raises
    ------
    InputError
        If it is none of these.
    """
    if (serial := _SERIAL.fullmatch(url)) is not None:
        device, baud = serial["device"], int(serial["baud"])
        return lambda: _open(url, lambda: Serial(device, baud))
    network = _NETWORK.fullmatch(url)
    if network is None or not 0 < int(network["port"]) < 65536:
        raise InputError(
            f"{url} cannot be opened with a signing key; it must be udpin://HOST:PORT, udpout://HOST:PORT, "
            "tcpout://HOST:PORT or serial://DEVICE:BAUD"
        )
    kind, address = network["kind"], (network["host"], int(network["port"]))
    make: dict[str, Callable[[], Outside]] = {
        "udpin": lambda: Udp(address),
        "udpout": lambda: Udp(("0.0.0.0", 0), address),
        "tcpout": lambda: Tcp(*address),
    }
    return lambda: _open(url, make[kind])


def _open(url: str, make: Callable[[], Outside]) -> Outside:
    try:
        return make()
    except (OSError, ValueError) as error:
        raise LinkError(f"{url} cannot be opened: {error}") from error
