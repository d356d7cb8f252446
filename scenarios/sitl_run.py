"""Runs simulated autopilots against the clock on the wall, and shows how they are doing."""

from __future__ import annotations

import select
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from offboard.errors import LinkError
from offboard.sitl.faulty import Faults, FaultyTransport
from offboard.sitl.transports import Exchange, TcpServer, Transport, Udp

if TYPE_CHECKING:
    from offboard.sitl.autopilot import Autopilot
    from scenarios.sitl_world import SitlWorld

STEP = 0.1
"""Longest step of the simulation [s]."""
LATEST = 0.02
"""Nor is it longer than this on the wall's clock [s], down to `FINEST`."""
FINEST = 0.01
BACKLOG = 0.5
"""Simulated time that is this late [s, wall clock] is given up: the simulation is slower than asked for."""
UDP_PORT, TCP_PORT, GROUND_PORT = 14580, 5760, 14550
"""Own ports of the first vehicle; where ground stations listen."""


@dataclass(frozen=True, slots=True)
class Ports:
    """How one vehicle is reached."""

    system_id: int
    target: int
    """UDP port that is sent to, where MAVSDK listens."""
    udp: int
    """Own UDP port."""
    tcp: int | None
    """Own TCP port; None if it could not be had."""


def connect(
    autopilot: Autopilot, number: int, port: int, host: str, faults: Faults | None = None
) -> tuple[Exchange, Ports]:
    """Give vehicle `number` (from 0) its ports: one system, one set of ports.

    Parameters
    ----------
    autopilot : Autopilot
        Whose ports they are.
    number : int
        Each number has UDP ports of its own one higher, and a TCP port ten higher, than the one before.
    port : int
        UDP port that the first vehicle sends to.
    host : str
        Where to.
    faults : Faults, optional
        How bad the UDP link is; TCP has none of them.

    Raises
    ------
    LinkError
        If no port can be had at all.
    """
    own = "127.0.0.1" if host in ("127.0.0.1", "localhost") else "0.0.0.0"
    targets = [(host, port + number), (host, GROUND_PORT)]
    try:
        udp = Udp(UDP_PORT + number, targets, own)
    except LinkError:
        udp = Udp(0, targets, own)
    bad = None if faults is None else FaultyTransport(udp, faults, number, time.monotonic)
    transports: list[Transport] = [bad or udp]
    tcp: TcpServer | None = None
    try:
        tcp = TcpServer(TCP_PORT + 10 * number, own)
        transports.append(tcp)
    except LinkError:
        pass
    ports = Ports(autopilot.settings.system_id, port + number, udp.port, tcp.port if tcp else None)
    return Exchange(autopilot, transports), ports


def serve(
    world: SitlWorld,
    exchanges: Sequence[Exchange],
    speed: float,
    show: Callable[[float, float], None],
    stopped: Callable[[], bool],
) -> None:
    """Simulate and talk until told to stop.

    Parameters
    ----------
    world : SitlWorld
        What is simulated.
    exchanges : sequence of Exchange
        Who is talked to.
    speed : float
        Times real time.
    show : callable
        Told about twice a second: simulated time [s], and times real time reached since the last call.
    stopped : callable
        True ends it.
    """
    step = min(STEP, max(FINEST, LATEST * speed))
    begun = shown_at = time.perf_counter()
    done = shown = lost = 0.0
    while not stopped():
        for exchange in exchanges:
            exchange.receive()
        now = time.perf_counter()
        if now - shown_at >= BACKLOG:
            show(done, (done - shown) / (now - shown_at))
            shown_at, shown = now, done
        late = (now - begun) - (done / speed + lost)
        if late < 0.0:
            sockets = [each for exchange in exchanges for each in exchange.sockets()]  # clients come and go
            select.select(sockets, [], [], min(-late, 0.05))
            continue
        if late > BACKLOG:
            lost += late
        world.advance(step)
        done += step
        for exchange in exchanges:
            exchange.send()
