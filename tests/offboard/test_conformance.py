"""One suite for every `Vehicle`: in process, MAVSDK in lockstep, MAVSDK over UDP; PX4's and ArduPilot's ways.

The same scenario must give the same decisions on all of them. What may differ: a scan that falls on another
instant of the vehicle's clock (over UDP the world and the loop are not in step), so times agree within
`SECONDS` and waypoints within `METRES`.
"""

from __future__ import annotations

import contextlib
import math
import socket
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import pytest

from avoidance.agent import Agent
from avoidance.parameters import DEFAULT
from offboard.link import EditStatus, Vehicle
from offboard.live.connecting import connect
from offboard.live.starting import arm, fly_mission, open_vehicle
from offboard.live.waiting import WaitingClock
from offboard.mission import MissionItem
from offboard.pilot import Pilot, fly
from offboard.raw_mission import RawMission
from offboard.simulated import SimulatedVehicle
from offboard.sitl.autopilot import FLAVOURS
from offboard.sitl.transports import Exchange, Udp
from scenarios.hangar import Hangar, mission_plan
from scenarios.radar import SimulatedRadar
from scenarios.scenario import OWN, streams
from scenarios.sitl_run import serve
from scenarios.sitl_world import SitlWorld
from scenarios.world import World
from tests.offboard.live.kit import SMALL, flying

SECONDS = 3.0
METRES = 50.0
SPEED = 60.0
"""Times real time over UDP."""


@dataclass
class Flight:
    """A vehicle about to fly its mission, with what the loop needs."""

    vehicle: Vehicle
    pilot: Pilot
    clock: object


@contextlib.contextmanager
def in_process(_: str) -> Iterator[Flight]:
    with Hangar(SMALL, DEFAULT) as hangar:
        plant, performance = hangar.own_plant(SMALL.mission)
        vehicle = SimulatedVehicle(plant, hangar.frame, replace(performance, **LIVE_LIMITS))
        vehicle.upload_mission(mission_plan(SMALL.mission, hangar.frame))
        vehicle.start_mission()
        world = World(SMALL.obstacles, {OWN: vehicle})
        yield Flight(vehicle, pilot_of(vehicle, world), world)


@contextlib.contextmanager
def in_lockstep(autopilot: str) -> Iterator[Flight]:
    with flying(autopilot) as flight:
        pilot = Pilot(flight.vehicle, flight.radar, flight.agent)
        yield Flight(flight.vehicle, pilot, WaitingClock(flight.vehicle))


@contextlib.contextmanager
def over_udp(autopilot: str) -> Iterator[Flight]:
    port = free_port()
    with SitlWorld(SMALL, DEFAULT, FLAVOURS[autopilot], SMALL.fleet, retry=0.2 * SPEED) as world:
        own = next(iter(world.autopilots.values()))
        exchange = Exchange(own, [Udp(0, [("127.0.0.1", port)])])
        over = threading.Event()
        thread = threading.Thread(
            target=serve, args=(world, [exchange], SPEED, lambda *_: None, over.is_set), daemon=True
        )
        thread.start()
        try:
            with contextlib.closing(connect(f"udpin://127.0.0.1:{port}", 10.0)) as session:
                vehicle = open_vehicle(session, own.aircraft.frame)
                vehicle.upload_raw(RawMission.of_plan(mission_plan(SMALL.mission, own.aircraft.frame)))
                arm(vehicle)
                fly_mission(vehicle)
                vehicle.aboard.clock.restart()
                shown = World(SMALL.obstacles, {OWN: Here(vehicle)})
                yield Flight(vehicle, pilot_of(vehicle, shown), WaitingClockIn(vehicle, shown))
        finally:
            over.set()
            thread.join(5.0)
            exchange.close()


class Here:
    """A live vehicle where it is now, for a simulated radar about it."""

    finished = False

    def __init__(self, vehicle) -> None:
        self.state = vehicle.state
        self._vehicle = vehicle

    def advance(self, duration: float) -> None:
        self._vehicle.wait_until(self._vehicle.time + 0.5 * duration)


class WaitingClockIn(WaitingClock):
    """The vehicle's clock, with a world that looks at the vehicle when it has come so far."""

    def __init__(self, vehicle, world: World) -> None:
        super().__init__(vehicle)
        self._world = world

    def advance(self, period: float) -> None:
        super().advance(period)
        self._world.advance(1e-3)


VEHICLES: dict[str, Callable] = {"in process": in_process, "lockstep": in_lockstep, "UDP": over_udp}
CASES = [
    ("in process", "-"),
    *((how, which) for how in ("lockstep", "UDP") for which in ("px4", "ardupilot")),
]
LIVE_LIMITS = {"edit_time": 8.0, "tracking_error": 15.0, "roll_time": 1.0}
"""What a live vehicle does not know better; given to the one in process too."""


def pilot_of(vehicle: Vehicle, world: World) -> Pilot:
    radar = SimulatedRadar(world, SMALL.radar, streams(0)["radar"], OWN)
    return Pilot(vehicle, radar, Agent(vehicle.performance, DEFAULT, streams(0)["planner"]))


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@dataclass
class Outcome:
    """What a flight came to."""

    decisions: list[tuple[float, str, tuple[float, float]]]
    separation: float
    finished: bool
    edits: set[EditStatus]
    waypoints: int


def fly_it(how: str, which: str) -> Outcome:
    obstacle = SMALL.obstacles[0]
    decisions, nearest, edits = [], math.inf, set()
    with VEHICLES[how](which) as flight:
        for frame in fly([flight.pilot], flight.clock, 1.0):
            step = frame.steps[0]
            own, decision = step.state.ownship, step.decision
            nearest = min(nearest, math.hypot(own.north - obstacle.north, own.east - obstacle.east))
            edits.add(step.state.edit)
            if decision.route is not None:
                first = decision.route[0]
                decisions.append((own.time, decision.name, (first.north, first.east)))
        plan = flight.vehicle.download_mission()
        return Outcome(decisions, nearest, flight.vehicle.finished, edits, len(plan.mission_items))


@pytest.fixture(scope="module")
def outcomes() -> dict[tuple[str, str], Outcome]:
    found = {case: fly_it(*case) for case in CASES}
    print("\nvehicle     autopilot  decisions  first at  waypoint            separation  finished")
    for (how, which), o in found.items():
        time, name, (north, east) = o.decisions[0]
        print(
            f"{how:<11} {which:<10} {len(o.decisions)} {name:<8} {time:6.1f} s  "
            f"({north:7.1f}, {east:7.1f})  {o.separation:7.1f} m   {o.finished}"
        )
    return found


@pytest.mark.parametrize("case", CASES, ids=" ".join)
def test_the_same_scenario_gives_the_same_decisions_on_every_vehicle(outcomes, case):
    reference, here = outcomes["in process", "-"], outcomes[case]
    assert here.finished
    assert here.separation > SMALL.obstacles[0].safety_radius
    assert EditStatus.CONFIRMED in here.edits
    assert not here.edits & {EditStatus.REFUSED, EditStatus.TIMED_OUT}
    assert here.waypoints == reference.waypoints
    assert [name for _, name, _ in here.decisions] == [name for _, name, _ in reference.decisions]
    for (time, _, place), (expected_time, _, expected) in zip(
        here.decisions, reference.decisions, strict=True
    ):
        assert time == pytest.approx(expected_time, abs=SECONDS)
        assert math.dist(place, expected) < METRES


@pytest.mark.parametrize("case", [case for case in CASES if case[0] != "UDP"], ids=" ".join)
def test_mission_calls_mean_the_same_on_every_vehicle(case):
    with VEHICLES[case[0]](case[1]) as flight:
        vehicle = flight.vehicle
        assert vehicle.mission_progress().total == len(SMALL.mission)
        advance(flight, 5.0)
        vehicle.pause_mission()
        assert len(vehicle.route().waypoints) == 2
        vehicle.start_mission()
        advance(flight, 2.0)
        here = vehicle.state().ownship
        frame = vehicle.frame if isinstance(vehicle, SimulatedVehicle) else vehicle.aboard.frame
        latitude, longitude = frame.to_geodetic(here.north + 300.0, here.east + 200.0)
        vehicle.inject([MissionItem(latitude, longitude, 200.0)])
        advance(flight, 2.0)
        assert vehicle.state().edit is not EditStatus.PENDING
        target = vehicle.route().waypoints[0]
        assert target.north == pytest.approx(here.north + 300.0, abs=1.0)
        assert vehicle.mission_progress().total == len(SMALL.mission) + 1
        vehicle.set_current_mission_item(vehicle.mission_progress().total - 1)
        advance(flight, 1.0)
        assert len(vehicle.route().waypoints) == 1
        with pytest.raises(ValueError, match="index = 99"):
            vehicle.set_current_mission_item(99)


def advance(flight: Flight, seconds: float) -> None:
    flight.clock.advance(seconds)
