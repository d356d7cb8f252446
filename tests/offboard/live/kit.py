"""A simulated autopilot in a small world, MAVSDK in step with it, and the hands of other people on it."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

from avoidance.agent import Agent
from avoidance.parameters import DEFAULT
from offboard.framing import Framer
from offboard.link import Radar
from offboard.live.lockstep import connect_in_step
from offboard.live.starting import arm, fly_mission, open_vehicle
from offboard.live.vehicle import LiveVehicle
from offboard.live.waiting import WaitingClock
from offboard.pilot import Frame, Pilot, fly
from offboard.raw_mission import RawMission
from offboard.sitl.autopilot import FLAVOURS
from offboard.sitl.dialect import Codec, mavlink
from offboard.sitl.modes import Task
from scenarios.hangar import mission_plan
from scenarios.radar import SimulatedRadar
from scenarios.scenario import OWN, Home, Obstacle, Point, RadarSettings, Scenario, VehicleSettings, streams
from scenarios.sitl_world import SitlWorld

SMALL = Scenario(
    name="small",
    home=Home(14.39, 76.60, 600.0),
    mission=(Point(0.0, 0.0, 200.0), Point(4000.0, 0.0, 200.0), Point(4000.0, 1500.0, 200.0)),
    obstacles=(Obstacle(1, 2400.0, 60.0, 200.0, 200.0),),
    radar=RadarSettings(range=1800.0),
    vehicle=VehicleSettings(fidelity="kinematic"),
)
"""Two legs, with an obstacle of 200 m on the first: five minutes of flight."""


STEP = 0.2
"""Of the simulation [s]."""


class Simulation:
    """The autopilot as MAVSDK sees it, and a second link for everybody else."""

    def __init__(self, world: SitlWorld) -> None:
        self.world = world
        self.autopilot = next(iter(world.autopilots.values()))
        self.silent = False
        """True loses everything in both directions."""
        self.deaf_to: frozenset[int] = frozenset()
        """Commands of ours that get lost."""
        self._station = Codec(255, 190)
        self._framer = Framer(self._station.decode)
        self.autopilot.open(0)

    def step(self, duration: float) -> None:
        self.world.advance(duration)

    def feed(self, data: bytes) -> None:
        if self.silent:
            return
        for message in self._framer.feed(data):
            if getattr(message, "command", -1) not in self.deaf_to:
                self.autopilot.feed(bytes(message.get_msgbuf()))

    def flush(self) -> bytes:
        data = self.autopilot.flush()
        return b"" if self.silent else data

    def send(self, message: object) -> None:
        """Another ground station says something."""
        self.autopilot.feed(self._station.pack(message), link=1)
        self.autopilot.flush(1)

    def set_mode(self, task: Task) -> None:
        """Another ground station changes the mode."""
        number = self.autopilot.flavour.mode_for(task).custom_mode
        self.send(mavlink.MAVLink_set_mode_message(1, 1, number))

    def set_current(self, seq: int) -> None:
        """Another ground station chooses the item that is flown to."""
        self.send(mavlink.MAVLink_mission_set_current_message(1, 1, seq))

    def hold_here(self) -> None:
        """Another ground station's button for it: DO_REPOSITION to where the vehicle is."""
        nan = float("nan")
        self.send(mavlink.MAVLink_command_long_message(1, 1, 192, 0, -1.0, 1.0, 0.0, nan, nan, nan, nan))

    def put_aboard(self, items: list) -> None:
        """Another ground station's upload has come to its end."""
        if self.autopilot.flavour.atomic:
            self.autopilot.uploaded(items, self.autopilot.captain.current)
        else:
            self.autopilot.overwritten(items, complete=True)
        self.autopilot._missions.store(0, items)

    def mission(self) -> tuple:
        """What is in the autopilot's memory."""
        return self.autopilot.captain.items

    def send_start(self) -> None:
        """Another ground station arms and starts the mission."""
        self.send(mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
        self.set_mode(Task.MISSION)

    def force_disarm(self) -> None:
        """Another ground station disarms in flight."""
        self.send(mavlink.MAVLink_command_long_message(1, 1, 400, 0, 0.0, 21196.0, 0.0, 0.0, 0.0, 0.0, 0.0))


@dataclass
class Flying:
    """A vehicle on its mission, and everything around it."""

    simulation: Simulation
    vehicle: LiveVehicle
    radar: Radar
    agent: Agent

    def fly(self, seconds: float) -> list[Frame]:
        """Fly on for a while, or to the end."""
        frames = []
        until = self.vehicle.time + seconds
        for frame in fly([Pilot(self.vehicle, self.radar, self.agent)], WaitingClock(self.vehicle), 1.0):
            frames.append(frame)
            if self.vehicle.time >= until:
                break
        return frames

    def fly_until(self, ready: Callable[[], bool], seconds: float) -> None:
        """Fly on until something is so; an error if it is not within a while."""
        until = self.vehicle.time + seconds
        for _ in fly([Pilot(self.vehicle, self.radar, self.agent)], WaitingClock(self.vehicle), 1.0):
            if ready():
                return
            if self.vehicle.time >= until:
                break
        raise AssertionError(f"not within {seconds:g} s")

    def said(self, severity: str) -> str:
        """All that has been told so far."""
        return "\n".join(e.text for e in self.vehicle.aboard.events if e.severity == severity)


@contextlib.contextmanager
def flying(
    autopilot: str,
    scenario: Scenario = SMALL,
    settings: Mapping[str, float] | None = None,
    *,
    most_items: int | None = None,
    touch: bool = True,
) -> Iterator[Flying]:
    """A vehicle that has just begun its mission."""
    flavour = FLAVOURS[autopilot]
    if most_items is not None:
        flavour = replace(flavour, most_items=most_items)
    with SitlWorld(scenario, DEFAULT, flavour, scenario.fleet, settings=settings) as world:
        simulation = Simulation(world)
        session = connect_in_step(simulation, STEP)
        with contextlib.closing(session):
            frame = simulation.autopilot.aircraft.frame
            vehicle = open_vehicle(session, frame, touch=touch)
            if touch:
                vehicle.upload_raw(RawMission.of_plan(mission_plan(scenario.mission, frame)))
                arm(vehicle)
                fly_mission(vehicle)
            else:
                vehicle.adopt_mission()
            vehicle.aboard.clock.restart()
            radar = SimulatedRadar(world.world, scenario.radar, streams(0)["radar"], OWN)
            agent = Agent(vehicle.performance, DEFAULT, streams(0)["planner"])
            yield Flying(simulation, vehicle, radar, agent)
