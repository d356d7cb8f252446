"""MAVSDK and a simulated autopilot in one process, in step: bytes are passed by hand, time is simulated.

Nothing depends on the clock on the wall but MAVSDK's own time limits, so that flights can be compared.
"""

from __future__ import annotations

import queue
import threading
import time
from typing import TYPE_CHECKING, Protocol

from offboard.errors import LinkError
from offboard.live.connecting import quiet_mavsdk
from offboard.live.messages import Ask, Message, Reply
from offboard.live.session import MavsdkSession
from offboard.raw_mission import RawItem

if TYPE_CHECKING:
    from mavsdk import Mavsdk, System

SYSTEM_TIME = 2
"""Message ID; each step ends with one."""
PATIENCE = 0.5
"""A message that does not come back within this wall time has been dropped [s]."""
ANSWER = 0.2
"""Time stands still for an answer of MAVSDK up to this wall time [s]."""


class Simulation(Protocol):
    """A simulated autopilot, `offboard.sitl.autopilot.Autopilot` or one in a world."""

    def step(self, duration: float) -> None:
        """Let `duration` seconds pass."""

    def feed(self, data: bytes) -> None:
        """Bytes for the autopilot."""

    def flush(self) -> bytes:
        """Bytes from the autopilot."""


class Bridge:
    """Carries bytes between MAVSDK and a simulation, a queue and a thread for each direction.

    Parameters
    ----------
    mavsdk : Mavsdk
        With a `raw://` connection.
    simulation : Simulation
        The other side.
    duration : float
        Length of a step [s].
    """

    def __init__(self, mavsdk: Mavsdk, simulation: Simulation, duration: float) -> None:
        self.time = 0.0
        """Simulated time [s]."""
        self._mavsdk = mavsdk
        self._simulation = simulation
        self.duration = duration
        """Length of a step [s]."""
        self._steps = 0
        self._turn = threading.Lock()
        self._up: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self._down: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self._threads = [
            threading.Thread(target=run, daemon=True) for run in (self._upwards, self._downwards)
        ]
        mavsdk.subscribe_raw_bytes_to_be_sent(self._up.put)
        for thread in self._threads:
            thread.start()

    def step(self) -> None:
        """Let the simulation do one step, and hand over what it says."""
        with self._turn:
            self._steps += 1
            self.time = self._steps * self.duration
            self._simulation.step(self.duration)
            self._hand_over()

    def close(self) -> None:
        """Stop carrying."""
        self._up.put(None)
        self._down.put(None)
        for thread in self._threads:
            thread.join(timeout=2.0)

    def _hand_over(self) -> None:
        if data := self._simulation.flush():
            self._down.put(data)

    def _upwards(self) -> None:
        """From MAVSDK to the simulation, which answers at once."""
        while (data := self._up.get()) is not None:
            with self._turn:
                self._simulation.feed(data)
                self._hand_over()

    def _downwards(self) -> None:
        """From the simulation to MAVSDK."""
        while (data := self._down.get()) is not None:
            self._mavsdk.pass_received_raw_bytes(data)


class LockstepSession(MavsdkSession):
    """A `Session` that owns the simulation's time: waiting for something lets it pass, in steps.

    Each step ends when its SYSTEM_TIME has come back through MAVSDK; while an answer is outstanding time
    stands still.
    """

    def __init__(self, mavsdk: Mavsdk, system: System, bridge: Bridge) -> None:
        self.patience = PATIENCE
        """Wall time that a step's SYSTEM_TIME has to come back [s]."""
        self._bridge = bridge
        self._open: set[int] = set()
        super().__init__(mavsdk, system)

    def poll(self, timeout: float = 0.0) -> list[Message | Reply]:
        """Everything that has come in; if there is nothing and one may wait, one step is flown first."""
        found = self._taken()
        until = time.monotonic() + ANSWER
        while self._open and time.monotonic() < until:
            found += self._taken(0.001)
        if timeout > 0.0 and not found:
            found += self._stepped()
        return found

    def upload(self, items: tuple[RawItem, ...], current: int) -> int:
        """Replace the mission."""
        token = super().upload(items, current)
        self._open.add(token)
        return token

    def put(self, what: Ask, items: tuple[RawItem, ...]) -> int:
        """Replace the geofence or the rally points."""
        token = super().put(what, items)
        self._open.add(token)
        return token

    def ask(self, what: Ask, *values: float) -> int:
        """Ask for something."""
        token = super().ask(what, *values)
        self._open.add(token)
        return token

    def keep_step(self) -> None:
        """Ask for a SYSTEM_TIME in each step."""
        super().request_rate(SYSTEM_TIME, 1.0 / self._bridge.duration)

    def request_rate(self, message_id: int, rate: float) -> None:
        """Ask for a message so many times a second; SYSTEM_TIME comes with each step."""
        if message_id == SYSTEM_TIME:
            self.keep_step()
        else:
            super().request_rate(message_id, rate)

    def wall(self) -> float:
        """Simulated time."""
        return self._bridge.time

    def close(self) -> None:
        """End the connection."""
        self._bridge.close()
        super().close()

    def _taken(self, timeout: float = 0.0) -> list[Message | Reply]:
        found = super().poll(timeout)
        self._open -= {one.token for one in found if isinstance(one, Reply)}
        return found

    def _stepped(self) -> list[Message | Reply]:
        """What one step has brought, up to its SYSTEM_TIME."""
        found: list[Message | Reply] = []
        self._bridge.step()
        begun = time.monotonic()
        while time.monotonic() < begun + self.patience:
            for one in self._taken(0.005):
                found.append(one)
                if (
                    isinstance(one, Message)
                    and one.name == "SYSTEM_TIME"
                    and one.arrived >= self._bridge.time
                ):
                    return found
        return found


def connect_in_step(simulation: Simulation, duration: float = 0.1) -> LockstepSession:
    """Connect MAVSDK to a simulation in this process.

    Parameters
    ----------
    simulation : Simulation
        The autopilot.
    duration : float
        Length of a step [s].

    Raises
    ------
    LinkError
        If it sends no heartbeat within five simulated seconds.
    """
    mavsdk = quiet_mavsdk()
    mavsdk.add_any_connection("raw://")
    bridge = Bridge(mavsdk, simulation, duration)
    for _ in range(round(5.0 / duration)):
        bridge.step()
        if (system := mavsdk.first_autopilot(0.05)) is not None:
            session = LockstepSession(mavsdk, system, bridge)
            session.keep_step()
            return session
    bridge.close()
    mavsdk.destroy()
    raise LinkError("the simulation sends no heartbeat")
