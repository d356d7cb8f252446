"""Where the bytes go: UDP and TCP sockets, a serial port, and UDP links for ground stations."""

from __future__ import annotations

import contextlib
import re
import select
import socket
import time
from collections.abc import Sequence
from typing import Any, Protocol, Self

from offboard.errors import LinkError
from offboard.hil.errors import LinkLost, OptionError

_CHUNK = 65536
_AT_ONCE = 64
"""Most datagrams read in one go: who floods a port does not hold up the steps."""
_MOST_PEERS = 32
"""More ground stations than this are not answered."""
_LINK = re.compile(r"udp(?:out)?:(?://)?(?P<host>[^:/]+):(?P<port>\d+)")


class Pipe(Protocol):
    """A connection that carries a stream of bytes."""

    def read(self, timeout: float) -> bytes:
        """What has arrived, waiting up to `timeout` [s] for the first byte; b"" if nothing has.

        Raises
        ------
        LinkLost
            If the other side has gone.
        """

    def write(self, data: bytes) -> None:
        """Send all of it.

        Raises
        ------
        LinkLost
            If the other side has gone.
        """

    def close(self) -> None:
        """Free it; a second call does nothing."""


class TcpServer:
    """Waits on a TCP port for the autopilot to connect.

    Raises
    ------
    LinkError
        If the port is taken.
    """

    def __init__(self, port: int, host: str = "127.0.0.1") -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        _bind(self._socket, host, port, "TCP")
        self._socket.listen(1)
        self.port: int = self._socket.getsockname()[1]

    def accept(self, timeout: float) -> SocketPipe | None:
        """The autopilot's connection; None if it has not come within `timeout` [s]."""
        if not select.select([self._socket], [], [], max(timeout, 0.0))[0]:
            return None
        connection, _ = self._socket.accept()
        return SocketPipe(connection)

    def close(self) -> None:
        """Stop listening."""
        self._socket.close()


class SocketPipe:
    """A connected TCP socket."""

    def __init__(self, connection: socket.socket) -> None:
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        connection.setblocking(False)
        self._socket = connection

    def read(self, timeout: float) -> bytes:
        """See `Pipe`."""
        try:
            data = self._socket.recv(_CHUNK)
        except BlockingIOError:
            if timeout <= 0.0 or not select.select([self._socket], [], [], timeout)[0]:
                return b""
            return self.read(0.0)
        except OSError as error:
            raise LinkLost(f"the connection broke: {error}") from error
        if not data:
            raise LinkLost("the autopilot has closed the connection")
        return data

    def write(self, data: bytes) -> None:
        """See `Pipe`."""
        try:
            while data:
                try:
                    data = data[self._socket.send(data) :]
                except BlockingIOError:
                    select.select([], [self._socket], [], 1.0)
        except OSError as error:
            raise LinkLost(f"the connection broke: {error}") from error

    def close(self) -> None:
        """See `Pipe`."""
        self._socket.close()


class SerialPipe:
    """A serial port, given as DEVICE:BAUD.

    Raises
    ------
    OptionError
        If this is no device and baud rate.
    LinkError
        If it cannot be opened.
    """

    def __init__(self, spec: str) -> None:
        import serial  # noqa: PLC0415  (needed for hardware only)

        device, colon, baud = spec.rpartition(":")
        if not colon or not baud.isdigit():
            raise OptionError("--serial", [f"{spec!r} must be DEVICE:BAUD, such as /dev/ttyACM0:921600"])
        try:
            self._port: Any = serial.Serial(device, int(baud), timeout=0.0, write_timeout=1.0)
        except (OSError, ValueError) as error:
            raise LinkError(f"--serial {spec}: {error}") from error

    def read(self, timeout: float) -> bytes:
        """See `Pipe`."""
        try:
            data = bytes(self._port.read(_CHUNK))
            if data or timeout <= 0.0:
                return data
            if hasattr(self._port, "fileno"):
                select.select([self._port.fileno()], [], [], timeout)
            else:  # Windows cannot wait for a port and a time limit at once
                time.sleep(min(timeout, 0.001))
            return bytes(self._port.read(_CHUNK))
        except OSError as error:
            raise LinkLost(f"the serial port has gone: {error}") from error

    def write(self, data: bytes) -> None:
        """See `Pipe`."""
        try:
            self._port.write(data)
        except OSError as error:
            raise LinkLost(f"the serial port has gone: {error}") from error

    def close(self) -> None:
        """See `Pipe`."""
        self._port.close()


class UdpLinks:
    """MAVLink for ground stations over UDP: sent to fixed addresses and to whoever has answered.

    Parameters
    ----------
    addresses : sequence of (host, port)
        Where everything is sent from the start.
    """

    def __init__(self, addresses: Sequence[tuple[str, int]]) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("0.0.0.0", 0))
        self._socket.setblocking(False)
        self._peers: dict[tuple[str, int], None] = dict.fromkeys(addresses)

    def send(self, data: bytes) -> None:
        """To every peer; one that cannot be reached misses it."""
        for peer in self._peers:
            with contextlib.suppress(OSError):
                self._socket.sendto(data, peer)

    def receive(self) -> bytes:
        """What has come from all peers, in the order of arrival; never waits."""
        parts: list[bytes] = []
        for _ in range(_AT_ONCE):
            try:
                data, peer = self._socket.recvfrom(_CHUNK)
            except BlockingIOError:
                break
            except ConnectionError:  # a peer's port was closed: its answer to our last datagram
                continue
            if peer in self._peers or len(self._peers) < _MOST_PEERS:
                self._peers[peer] = None
                parts.append(data)
        return b"".join(parts)

    def close(self) -> None:
        """Free the socket."""
        self._socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class UdpPort:
    """A UDP port that answers whoever sends.

    Raises
    ------
    LinkError
        If the port is taken.
    """

    def __init__(self, port: int, host: str = "127.0.0.1") -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        _bind(self._socket, host, port, "UDP")
        self._socket.setblocking(False)
        self.port: int = self._socket.getsockname()[1]

    def receive(self, timeout: float) -> tuple[bytes, Any] | None:
        """One datagram and its sender; None if none has come within `timeout` [s]."""
        try:
            return self._socket.recvfrom(_CHUNK)
        except BlockingIOError:
            if timeout <= 0.0 or not select.select([self._socket], [], [], timeout)[0]:
                return None
            return self.receive(0.0)
        except ConnectionError:  # the sender's port is closed: it has stopped
            return None

    def send(self, data: bytes, peer: Any) -> None:  # noqa: ANN401  (an address, as the socket gave it)
        """Answer."""
        with contextlib.suppress(ConnectionError):
            self._socket.sendto(data, peer)

    def close(self) -> None:
        """Free the port."""
        self._socket.close()


def parse_links(text: str) -> list[tuple[str, int]]:
    """Addresses from `udp://HOST:PORT[,udp://HOST:PORT]`.

    Raises
    ------
    OptionError
        If one cannot be understood.
    """
    addresses = []
    for part in (each.strip() for each in text.split(",")):
        match = _LINK.fullmatch(part)
        if match is None or not 0 < int(match["port"]) < 65536:
            raise OptionError("--mission-link", [f"{part!r} must be udp://HOST:PORT"])
        addresses.append((match["host"], int(match["port"])))
    return addresses


def _bind(endpoint: socket.socket, host: str, port: int, kind: str) -> None:
    try:
        endpoint.bind((host, port))
    except (OSError, OverflowError) as error:
        endpoint.close()
        raise LinkError(f"{kind} port {port} on {host} cannot be opened: {error}") from error
