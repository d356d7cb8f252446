from __future__ import annotations

from collections.abc import Sequence

from avoidance import Decision, Detour, Keep, Ownship, RadarScan, Route, Waypoint
from offboard.link import VehicleState
from offboard.mission import MissionItem, MissionPlan
from offboard.pilot import Pilot, fly
from offboard.simulated import SimulatedVehicle
from tests.offboard.fake_plant import HOME, PERFORMANCE, FakePlant


class EmptySky:
    def scan(self, state: VehicleState, now: float) -> RadarScan:
        return RadarScan.of(now, [])


class OnceRound:
    """Decides on one detour, at a given time; remembers when it was asked."""

    def __init__(self, at: float) -> None:
        self.at = at
        self.asked: list[float] = []

    def decide(self, ownship: Ownship, route: Route, scan: RadarScan) -> Decision:
        self.asked.append(scan.time)
        if scan.time != self.at:
            return Keep(why="free")
        new = Waypoint(600.0, 300.0, 200.0)
        return Detour(why="test", waypoint=new, route=(new, *route.waypoints))


class SteppedTime:
    def __init__(self, vehicles: Sequence[SimulatedVehicle]) -> None:
        self.now = 0.0
        self.vehicles = vehicles

    def advance(self, period: float) -> None:
        for vehicle in self.vehicles:
            vehicle.advance(period)
        self.now += period


def started(*norths: float) -> SimulatedVehicle:
    items = [MissionItem(*HOME.to_geodetic(north, 0.0), 200.0) for north in norths]
    vehicle = SimulatedVehicle(FakePlant(), HOME, PERFORMANCE)
    vehicle.upload_mission(MissionPlan.of(items))
    vehicle.start_mission()
    return vehicle


def test_one_vehicle_is_flown_to_its_end_with_one_decision_a_scan() -> None:
    vehicle, agent = started(0.0, 1500.0), OnceRound(at=10.0)

    frames = list(fly([Pilot(vehicle, EmptySky(), agent)], SteppedTime([vehicle]), 1.0))

    assert vehicle.finished
    assert agent.asked == [frame.time for frame in frames]
    assert [type(frame.steps[0].decision) for frame in frames].count(Detour) == 1
    assert vehicle.mission_progress().total == 3
    assert max(place[1] for place in vehicle.plant.track) > 200.0


def test_a_formation_flies_until_the_last_has_finished_and_the_first_decides_no_more() -> None:
    short, long = started(0.0, 500.0), started(0.0, 1500.0)
    first, second = OnceRound(at=-1.0), OnceRound(at=-1.0)
    pilots = [Pilot(short, EmptySky(), first), Pilot(long, EmptySky(), second)]

    frames = list(fly(pilots, SteppedTime([short, long]), 1.0))

    assert short.finished
    assert long.finished
    assert all(len(frame.steps) == 2 for frame in frames)
    assert len(first.asked) < len(second.asked) == len(frames)
    assert frames[-1].steps[0].decision == Keep(why="The mission is finished.")


def test_time_moves_only_between_frames() -> None:
    vehicle = started(0.0, 1500.0)
    flight = fly([Pilot(vehicle, EmptySky(), OnceRound(at=-1.0))], SteppedTime([vehicle]), 0.5)

    times = [next(flight).time for _ in range(3)]

    assert times == [0.0, 0.5, 1.0]
    assert vehicle.state().ownship.time == 1.0


def test_a_mission_already_finished_gives_no_frame() -> None:
    vehicle = started(0.0)

    assert list(fly([Pilot(vehicle, EmptySky(), OnceRound(at=0.0))], SteppedTime([vehicle]), 1.0)) == []
