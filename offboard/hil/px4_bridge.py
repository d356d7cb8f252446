"""The plant behind PX4: in lockstep over TCP, in real time over a serial port."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass

from offboard.hil.channels import Airframe
from offboard.hil.errors import LinkLost
from offboard.hil.pipes import Pipe, TcpServer, UdpLinks
from offboard.hil.plant import NEUTRAL, Truth
from offboard.hil.px4_protocol import Heard, Px4Link
from offboard.hil.sensors import Sensors
from offboard.hil.simulation import Simulation
from offboard.hil.timing import Metronome

RATE = 250.0
"""HIL_SENSOR per simulated second, as PX4's own simulators have it [Hz]."""
STATE_EVERY = 5
"""Steps from one HIL_STATE_QUATERNION to the next."""
HEARTBEAT_PERIOD = 1.0
"""Between two HEARTBEAT to hardware [s]."""
_SLICE = 0.2


@dataclass(slots=True)
class Px4Counts:
    """What came over the link."""

    steps: int = 0
    answers: int = 0
    """HIL_ACTUATOR_CONTROLS that were taken."""
    stale: int = 0
    """… that were not: late or sent twice."""
    stalls: int = 0
    """Answers that took more than a second."""
    connections: int = 0


class Px4Bridge:
    """Sends PX4 what its sensors would read, and moves the surfaces as it says.

    Parameters
    ----------
    simulation : Simulation
        The plant.
    sensors : Sensors
        What is measured.
    airframe : Airframe
        What PX4's outputs move.
    link : Px4Link
        The protocol.
    speed : float
        Simulated over real time; 0: as fast as PX4 answers.
    rate : float
        Steps per simulated second [Hz].
    """

    def __init__(
        self,
        simulation: Simulation,
        sensors: Sensors,
        airframe: Airframe,
        link: Px4Link,
        *,
        speed: float = 1.0,
        rate: float = RATE,
    ) -> None:
        self.simulation = simulation
        self.link = link
        self.counts = Px4Counts()
        self.connected = False
        self.armed = False
        self._sensors = sensors
        self._airframe = airframe
        self._speed = speed
        self._period = 1.0 / rate
        self.metronome = Metronome(self._period, speed or 1.0)
        self._axes = NEUTRAL
        self._lockstep = False
        self._steps = 0

    def serve(self, server: TcpServer) -> Iterator[bool]:
        """Lockstep over TCP for ever, one connection after another.

        Yields True after each step, False while nothing moves. A connection that ends puts the plant back to
        its start: the firmware has stopped, and the next one begins at its own time zero.
        """
        while True:
            pipe = server.accept(_SLICE)
            if pipe is None:
                yield False
                continue
            self.begin()
            try:
                yield from self.converse(pipe)
            except LinkLost:
                self.connected = False
                yield False
            finally:
                pipe.close()

    def begin(self) -> None:
        """A new connection."""
        if self.counts.steps:
            self.simulation.restart()
        self._sensors.restart()
        self.link.forget()
        self.counts.connections += 1
        self.connected, self.armed, self._lockstep = True, False, False
        self._axes = NEUTRAL
        self._steps = 0
        self.metronome.restart()

    def converse(self, pipe: Pipe) -> Iterator[bool]:
        """One connection in lockstep; ends with `LinkLost`."""
        while True:
            if self._speed or not self._lockstep:
                if (remaining := self.metronome.remaining()) > 0.0:
                    time.sleep(min(remaining, _SLICE))
                    continue
                self.metronome.beat()
            sent = self.send_step(pipe)
            if self._lockstep:
                yield from self._await(pipe, sent)
            else:
                self._take(self._hear(pipe, 0.0), None)
            yield True

    def send_step(self, pipe: Pipe) -> int:
        """One step of the plant, and what is measured after it; its time [µs]."""
        timing = self.simulation.timing
        truth = self.simulation.step(self._axes, self._period)
        data = self._measure(truth)
        pipe.write(data)
        timing.lap("transport")
        self.counts.steps += 1
        return round(truth.time * 1e6)

    def drive(self, pipe: Pipe, links: UdpLinks | None = None) -> Iterator[bool]:
        """Real time over a pipe for ever: steps at their times, MAVLink bridged to `links` meanwhile.

        Yields True after each step; `metronome.punctuality` tells how late they were. Ends with `LinkLost`.
        """
        self.simulation.timing.start()
        self._measure(self.simulation.truth)  # what is computed once is computed before time begins
        self.begin()
        next_heartbeat = 0.0
        while True:
            while (remaining := self.metronome.remaining()) > 0.0:
                self._relay(pipe, links, remaining)
            self.metronome.beat()
            if self.simulation.truth.time >= next_heartbeat:
                next_heartbeat += HEARTBEAT_PERIOD
                pipe.write(self.link.heartbeat())
            self.send_step(pipe)
            self._relay(pipe, links, 0.0)
            yield True

    def _relay(self, pipe: Pipe, links: UdpLinks | None, timeout: float) -> None:
        heard = self._hear(pipe, timeout)
        self._take(heard, None)
        if links is None:
            return
        if heard.others:
            links.send(b"".join(frame.data for frame in heard.others))
        if said := links.receive():
            pipe.write(said)

    def _measure(self, truth: Truth) -> bytes:
        timing = self.simulation.timing
        reading = self._sensors.read(truth)
        fix = self._sensors.fix(truth)
        timing.lap("sensors")
        parts = [self.link.sensor(reading)]
        if fix is not None:
            parts.append(self.link.gps(fix))
        self._steps += 1
        if self._steps % STATE_EVERY == 0:
            geodesy = self._sensors.geodesy
            place = geodesy.at(truth.north, truth.east)
            parts.append(self.link.state(truth, place, geodesy.frame.altitude_m + truth.altitude))
        timing.lap("protocol")
        return b"".join(parts)

    def _hear(self, pipe: Pipe, timeout: float) -> Heard:
        timing = self.simulation.timing
        timing.start()
        data = pipe.read(timeout)
        timing.lap("autopilot" if timeout else "transport")
        heard = self.link.hear(data)
        timing.lap("protocol")
        return heard

    def _take(self, heard: Heard, sent: int | None) -> bool:
        """Follow the actuators; in lockstep only those that answer the time `sent` [µs]. True if one does."""
        answered = False
        for actuators in heard.actuators:
            if sent is not None and (answered or actuators.time_usec < sent):
                self.counts.stale += 1
                continue
            self._axes = self._airframe.axes(actuators.controls)
            self.armed = actuators.armed
            self._lockstep = self._lockstep or actuators.lockstep
            self.counts.answers += 1
            answered = True
        return answered

    def _await(self, pipe: Pipe, sent: int) -> Iterator[bool]:
        """Wait for the answer to the step of a time [µs]; yields False before each time it really waits."""
        begun, patience, stalled = time.monotonic(), 0.0, False
        while not self._take(self._hear(pipe, patience), sent):
            if not stalled and time.monotonic() - begun > 1.0:
                stalled = True
                self.counts.stalls += 1
            patience = _SLICE
            yield False
