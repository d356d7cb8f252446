"""A whole firmware by script: the simulated MAVLink autopilot, flying by ArduPilot's JSON protocol.

To the plant it is ArduPilot, to MAVSDK and ground stations a vehicle with a mission: so the whole chain, from
avoidance to surfaces, runs where no firmware is at hand. As a process of its own::

    python -m offboard.hil.scripted_firmware UDP_OF_PLANT UDP_OF_MAVSDK LAT,LON,ALT SPEED
"""

from __future__ import annotations

import math
import sys
import time
from typing import NamedTuple

from avoidance import Performance
from offboard.errors import LinkError
from offboard.frames import MapFrame
from offboard.hil.attitude import euler
from offboard.hil.channels import load_airframe
from offboard.hil.geodesy import METRES_PER_DEGREE
from offboard.hil.scripted import ScriptedPilot, Task
from offboard.hil.scripted_ardupilot import ScriptedArduPilot
from offboard.sitl.aircraft import Aircraft, Phase
from offboard.sitl.ardupilot import ARDUPILOT
from offboard.sitl.autopilot import Autopilot, Settings
from offboard.sitl.transports import Exchange, Udp

RATE = 50
"""Steps of the plant per second [Hz]."""
STEP = 2 / RATE
"""Of the autopilot: a whole number of the plant's, or its clock would run ahead of the plant's [s]."""
CAN = Performance(
    airspeed=15.0, max_bank=math.radians(30.0), roll_time=1.5, acceptance_radius=60.0, tracking_error=15.0
)
"""What the scripted controllers make of an aircraft like the Skywalker X8."""
_SIGHT = 60.0
"""A line is approached as if to a point this far along it [m]."""
_IDLE = Task(until=math.inf, armed=False)


class Seen(NamedTuple):
    """The plant's state as this firmware knows it; an `offboard.link.PlantState`."""

    time: float
    north: float
    east: float
    altitude: float
    velocity_north: float
    velocity_east: float
    climb_rate: float
    airspeed: float
    heading: float
    bank: float
    pitch: float


class DistantPlant:
    """The plant at the other end of the JSON protocol, flown by legs and orbits; an `offboard.link.Plant`.

    Parameters
    ----------
    port : int
        UDP port of the plant on this machine.
    frame : MapFrame
        The map about home.
    """

    def __init__(self, port: int, frame: MapFrame) -> None:
        self._frame = frame
        self._link = ScriptedArduPilot(
            port, load_airframe("ardupilot-plane"), ScriptedPilot((_IDLE,)), rate=RATE
        )
        self._leg: tuple[float, ...] | None = None
        self._orbit: tuple[float, ...] | None = None
        self._launched = False
        self.step(1.0 / RATE)

    @property
    def state(self) -> Seen:
        """State after the last step."""
        felt = self._link.felt
        north, east = self._position(*felt["position"][:2])
        bank, pitch, heading = euler(*felt["quaternion"])
        vn, ve, vd = felt["velocity"]
        airspeed, altitude = felt["airspeed"][0], -felt["position"][2]
        return Seen(felt["timestamp"][0], north, east, altitude, vn, ve, -vd, airspeed, heading, bank, pitch)

    def launch(self) -> None:
        """Open the throttle; the plant decides when that is enough."""
        self._launched = True
        self._link.pilot.runway = self.state.heading

    def fly_leg(
        self,
        from_north: float,
        from_east: float,
        to_north: float,
        to_east: float,
        altitude: float,
        airspeed: float,
    ) -> None:
        """Follow the line through two points [m]."""
        course = math.atan2(to_east - from_east, to_north - from_north)
        self._leg, self._orbit = (from_north, from_east, course, altitude, airspeed), None

    def fly_orbit(
        self, north: float, east: float, radius: float, direction: int, altitude: float, airspeed: float
    ) -> None:
        """Circle a point [m]; +1 is clockwise seen from above."""
        self._leg, self._orbit = None, (north, east, radius, direction, altitude, airspeed)

    def set_wind(self, north: float, east: float, down: float = 0.0) -> None:
        """The wind is the plant's affair."""

    def step(self, duration: float) -> None:
        """Fly on, packet by packet.

        Raises
        ------
        LinkError
            If the plant does not answer within ten seconds.
        """
        for _ in range(round(duration * RATE)):
            self._link.pilot.tasks = (self._task(),)
            for _ in range(10):
                self._link.send()
                if self._link.receive(1.0) is not None:
                    break
            else:
                raise LinkError("the plant does not answer")

    def close(self) -> None:
        """Free the socket."""
        self._link.close()

    def _task(self) -> Task:
        """What the pilot is to fly now; nothing before the launch and without a command."""
        if not self._launched:
            return _IDLE
        here = self.state
        if self._leg is not None:
            course, altitude, airspeed = _along(self._leg, here), *self._leg[3:]
        elif self._orbit is not None:
            course, altitude, airspeed = _around(self._orbit, here), *self._orbit[4:]
        else:
            return _IDLE
        track = math.atan2(here.velocity_east, here.velocity_north)
        drift = math.remainder(track - here.heading, math.tau) if here.airspeed > 8.0 else 0.0
        return Task(math.inf, heading=course - drift, altitude=max(altitude, 0.0), airspeed=airspeed)

    def _position(self, north: float, east: float) -> tuple[float, float]:
        """Map metres from ArduPilot's: by its arithmetic to degrees, by ours to the map."""
        latitude = self._frame.latitude_deg + north / METRES_PER_DEGREE
        middle = math.radians(0.5 * (latitude + self._frame.latitude_deg))
        longitude = self._frame.longitude_deg + east / METRES_PER_DEGREE / math.cos(middle)
        return self._frame.to_map(latitude, longitude)


def _along(leg: tuple[float, ...], here: Seen) -> float:
    """Course that leads back to a line [rad]."""
    north, east, course = leg[:3]
    off = (here.east - east) * math.cos(course) - (here.north - north) * math.sin(course)
    return course - math.atan(off / _SIGHT)


def _around(orbit: tuple[float, ...], here: Seen) -> float:
    """Course that leads back to a circle [rad]; a little ahead of it, for the bank takes a while."""
    north, east, radius, direction = orbit[:4]
    out = math.atan2(here.east - east, here.north - north)
    outside = math.hypot(here.east - east, here.north - north) - radius
    ahead = 0.8 * here.airspeed / max(radius, 1.0)
    return out + direction * (0.5 * math.pi + math.atan(outside / _SIGHT) + ahead)


def main(arguments: list[str]) -> None:
    """Fly until the plant has gone."""
    plant_port, mavsdk_port, place, speed = arguments
    frame = MapFrame(*(float(part) for part in place.split(",")))
    plant = DistantPlant(int(plant_port), frame)
    aircraft = Aircraft(plant, frame, CAN, launcher=plant)
    autopilot = Autopilot(aircraft, Settings(flavour=ARDUPILOT))
    exchange = Exchange(autopilot, [Udp(0, [("127.0.0.1", int(mavsdk_port))])])
    period, due = STEP / float(speed), time.monotonic()
    try:
        while True:
            exchange.receive()
            if aircraft.phase is not Phase.FLYING:
                plant.step(STEP)
            autopilot.step(STEP)
            exchange.send()
            due = max(due + period, time.monotonic() - 0.5)
            time.sleep(max(due - time.monotonic(), 0.0))
    except LinkError:
        return
    finally:
        exchange.close()
        plant.close()


if __name__ == "__main__":
    main(sys.argv[1:])
