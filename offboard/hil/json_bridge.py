"""The plant behind ArduPilot: its JSON protocol over UDP, in lockstep."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from offboard.hil.channels import Airframe
from offboard.hil.faults import FAULTS, Fault
from offboard.hil.geodesy import Geodesy, true_north
from offboard.hil.json_protocol import Ignored, JsonSession, Repeat, Step, answer
from offboard.hil.pipes import UdpPort
from offboard.hil.plant import Truth
from offboard.hil.simulation import Simulation
from offboard.hil.timing import Punctuality

KNOWN_FAULTS = {name: FAULTS[name] for name in ("airspeed-blocked", "accel-bias", "gyro-bias")}
"""Failures that can be told over this protocol; ArduPilot simulates the other sensors itself."""


@dataclass(slots=True)
class JsonCounts:
    """What came over the port."""

    steps: int = 0
    duplicate: int = 0
    """Packets that came again although their answer was on its way."""
    repeated: int = 0
    """Answers sent once more because the first had been lost."""
    late: int = 0
    """Packets that others had overtaken."""
    garbage: int = 0
    """Datagrams that are no servo packets."""
    missed: int = 0
    """Packets that never came."""


class JsonBridge:
    """Answers ArduPilot's servo packets with the motion of the plant.

    Parameters
    ----------
    simulation : Simulation
        The plant.
    port : UdpPort
        Where ArduPilot sends.
    airframe : Airframe
        What its channels move.
    geodesy : Geodesy
        The map about home.
    faults : sequence of Fault
        Of `KNOWN_FAULTS`.
    """

    def __init__(
        self,
        simulation: Simulation,
        port: UdpPort,
        airframe: Airframe,
        geodesy: Geodesy,
        faults: Sequence[Fault] = (),
    ) -> None:
        self.simulation = simulation
        self.counts = JsonCounts()
        self.connected = False
        """True once ArduPilot has spoken."""
        self._port = port
        self._airframe = airframe
        self._geodesy = geodesy
        self._faults = tuple(faults)
        self._session = JsonSession()
        self._last = b""
        self._trapped: float | None = None

    @property
    def punctuality(self) -> Punctuality | None:
        """ArduPilot keeps the time, so there is none to be late for."""
        return None

    def serve(self, patience: float = 0.2) -> Iterator[bool]:
        """Answer for ever; yields after each datagram (True), and after waiting for one in vain (False)."""
        while True:
            yield self.poll(patience)

    def poll(self, timeout: float) -> bool:
        """Deal with one datagram; False if none has come within `timeout` [s]."""
        timing = self.simulation.timing
        timing.start()
        received = self._port.receive(timeout)
        timing.lap("autopilot" if timeout else "transport")
        if received is None:
            return False
        data, sender = received
        self._answer(data, sender)
        return True

    def _answer(self, data: bytes, sender: object) -> None:
        timing, counts = self.simulation.timing, self.counts
        match self._session.take(data, sender, time.monotonic()):
            case Ignored(why):
                setattr(counts, why, getattr(counts, why) + 1)
            case Repeat():
                counts.repeated += 1
                self._port.send(self._last, sender)
            case Step() as step:
                self.connected = True
                if step.restart:
                    self.simulation.restart()
                    self._trapped = None
                counts.steps += 1
                counts.missed += step.missed
                axes = self._airframe.axes_of_pwm(step.servos.pwm)
                timing.lap("protocol")
                truth = self.simulation.step(axes, step.duration)
                self._last = self._line(truth)
                timing.lap("protocol")
                self._port.send(self._last, sender)
                self._session.answered(time.monotonic())
                timing.lap("transport")

    def _line(self, truth: Truth) -> bytes:
        place = self._geodesy.at(truth.north, truth.east)
        north, east = self._geodesy.ardupilot_offset(place)
        felt = true_north(truth, place.convergence)
        airspeed = felt.airspeed
        if self._faults:
            felt = self._with_bias(felt)
            airspeed = self._blocked(felt)
        return answer(felt, felt.time, north, east, airspeed)

    def _with_bias(self, truth: Truth) -> Truth:
        for fault in self._faults:
            if not fault.active(truth.time):
                continue
            if fault.name == "accel-bias":
                x, y, z = fault.values
                truth = truth._replace(
                    force_x=truth.force_x + x, force_y=truth.force_y + y, force_z=truth.force_z + z
                )
            elif fault.name == "gyro-bias":
                p, q, r = fault.values
                truth = truth._replace(p=truth.p + p, q=truth.q + q, r=truth.r + r)
        return truth

    def _blocked(self, truth: Truth) -> float:
        """What the pitot tube makes of the airspeed: a blocked one keeps its total pressure."""
        total = truth.static_pressure + truth.differential_pressure
        if not any(f.name == "airspeed-blocked" and f.active(truth.time) for f in self._faults):
            self._trapped = None
            return truth.airspeed
        self._trapped = total if self._trapped is None else self._trapped
        pressure = max(self._trapped - truth.static_pressure, 0.0)
        if truth.differential_pressure <= 0.0 or truth.airspeed <= 0.0:
            return math.sqrt(2.0 * pressure / 1.225)
        return truth.airspeed * math.sqrt(pressure / truth.differential_pressure)
