from __future__ import annotations

import dataclasses
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from avoidance import Detour, Hold, Keep, Replace, Resume, Waypoint
from offboard.errors import LinkError
from offboard.link import EditStatus, Plant, Vehicle
from offboard.mission import MissionItem, MissionPlan, VehicleAction
from offboard.simulated import SimulatedVehicle
from tests.offboard.fake_plant import HOME, PERFORMANCE, FakePlant

CORNERS = ((0.0, 0.0), (4000.0, 0.0), (4000.0, 4000.0), (8000.0, 4000.0))


def item_at(north: float, east: float, **fields: float) -> MissionItem:
    return MissionItem(*HOME.to_geodetic(north, east), relative_altitude_m=200.0, **fields)


def vehicle_on(*items: MissionItem, started: bool = True) -> SimulatedVehicle:
    vehicle = SimulatedVehicle(FakePlant(), HOME, PERFORMANCE)
    vehicle.upload_mission(MissionPlan.of(items or [item_at(*corner) for corner in CORNERS]))
    if started:
        vehicle.start_mission()
    return vehicle


def plant_of(vehicle: SimulatedVehicle) -> FakePlant:
    assert isinstance(vehicle.plant, FakePlant)
    return vehicle.plant


def fly_on(vehicle: SimulatedVehicle, seconds: float) -> None:
    for _ in range(round(seconds)):
        vehicle.advance(1.0)


def nearest(vehicle: SimulatedVehicle, place: tuple[float, float]) -> float:
    return min(math.dist(place, point) for point in plant_of(vehicle).track)


def test_it_is_a_vehicle_on_a_plant() -> None:
    plant: Plant = FakePlant()
    vehicle: Vehicle = SimulatedVehicle(plant, HOME, PERFORMANCE)

    assert vehicle.performance is PERFORMANCE
    assert not vehicle.finished


def test_it_flies_the_mission_to_its_end_and_stays_there() -> None:
    vehicle = vehicle_on()
    assert vehicle.mission_progress().current == 1  # it begins at the first item

    fly_on(vehicle, 12_000 / 15 + 60)

    assert vehicle.finished
    assert vehicle.is_mission_finished()
    assert (vehicle.mission_progress().current, vehicle.mission_progress().total) == (4, 4)
    assert all(nearest(vehicle, corner) < 100.0 for corner in CORNERS)
    assert vehicle.route().waypoints == ()
    assert plant_of(vehicle).command[0] == "orbit"
    fly_on(vehicle, 60)
    assert math.dist(plant_of(vehicle).track[-1], CORNERS[-1]) < 150.0


def test_the_plant_is_commanded_and_the_route_rebuilt_only_when_the_leg_changes() -> None:
    vehicle = vehicle_on()
    before, commands = vehicle.route(), len(plant_of(vehicle).commands)

    fly_on(vehicle, 200)
    assert len(plant_of(vehicle).commands) == commands
    assert vehicle.route() is before

    fly_on(vehicle, 100)
    assert len(plant_of(vehicle).commands) == commands + 1
    assert vehicle.route().origin == before.waypoints[0]
    assert vehicle.route().waypoints == before.waypoints[1:]


def test_the_state_is_the_plants() -> None:
    vehicle = vehicle_on()
    fly_on(vehicle, 20)

    ownship, state = vehicle.state().ownship, plant_of(vehicle).state

    for name in ("time", "north", "east", "altitude", "velocity_north", "heading", "bank", "airspeed"):
        assert getattr(ownship, name) == getattr(state, name)


def test_speed_altitude_and_acceptance_radius_of_the_items_are_flown() -> None:
    high = dataclasses.replace(item_at(4000.0, 0.0, acceptance_radius_m=500.0), relative_altitude_m=260.0)
    vehicle = vehicle_on(item_at(0.0, 0.0, speed_m_s=20.0), high, item_at(9000.0, 0.0))

    kind, leg = plant_of(vehicle).command
    assert (kind, leg[-2:]) == ("leg", (260.0, 20.0))
    fly_on(vehicle, 174)
    assert vehicle.mission_progress().current == 1
    fly_on(vehicle, 3)
    assert vehicle.mission_progress().current == 2  # 500 m before the item, not 100 m


def test_loiter_time_is_orbited_about_the_item() -> None:
    vehicle = vehicle_on(item_at(0.0, 0.0), item_at(2000.0, 0.0, loiter_time_s=120.0), item_at(4000.0, 0.0))

    fly_on(vehicle, 130)
    kind, orbit = plant_of(vehicle).command
    assert kind == "orbit"
    assert math.dist(orbit[:2], (2000.0, 0.0)) < 0.01
    assert orbit[2] >= 1.5 * PERFORMANCE.turn_radius
    fly_on(vehicle, 115)
    assert vehicle.mission_progress().current == 1
    fly_on(vehicle, 10)
    assert vehicle.mission_progress().current == 2
    assert plant_of(vehicle).command[0] == "leg"


def test_pause_orbits_in_place_and_start_goes_on_from_there() -> None:
    vehicle = vehicle_on()
    fly_on(vehicle, 100)
    here = plant_of(vehicle).track[-1]

    vehicle.pause_mission()
    fly_on(vehicle, 300)
    assert math.dist(plant_of(vehicle).track[-1], here) < 4.0 * PERFORMANCE.turn_radius
    assert vehicle.mission_progress().current == 1

    vehicle.start_mission()
    fly_on(vehicle, 250)
    assert vehicle.mission_progress().current == 2


def test_upload_starts_over_and_waits_for_the_start() -> None:
    vehicle = vehicle_on()
    fly_on(vehicle, 300)

    vehicle.upload_mission(MissionPlan.of([item_at(9000.0, 0.0)]))

    assert plant_of(vehicle).command[0] == "orbit"
    assert (vehicle.mission_progress().current, vehicle.mission_progress().total) == (0, 1)
    vehicle.start_mission()
    assert plant_of(vehicle).command[0] == "leg"


def test_set_current_flies_there_from_here() -> None:
    vehicle = vehicle_on()
    fly_on(vehicle, 100)

    vehicle.set_current_mission_item(3)

    here = plant_of(vehicle).track[-1]
    _, leg = plant_of(vehicle).command
    assert leg[:2] == here
    assert math.dist(leg[2:4], CORNERS[3]) < 0.01
    with pytest.raises(ValueError, match="index = 4, must be between 0 and 3"):
        vehicle.set_current_mission_item(4)


def test_injected_items_are_flown_first_and_downloaded() -> None:
    vehicle = vehicle_on()
    fly_on(vehicle, 100)
    extra = item_at(2500.0, 800.0, acceptance_radius_m=50.0)

    vehicle.inject([extra])

    assert vehicle.download_mission().mission_items[1] is extra
    assert vehicle.mission_progress().total == 5
    fly_on(vehicle, 300)
    assert nearest(vehicle, (2500.0, 800.0)) < 50.0
    assert nearest(vehicle, CORNERS[1]) < 100.0


def detour_by(vehicle: SimulatedVehicle, north: float, east: float) -> Detour:
    new = Waypoint(north, east, 200.0)
    return Detour(why="blocked", waypoint=new, route=(new, *vehicle.route().waypoints))


def test_a_detour_is_flown_from_here_and_the_mission_kept() -> None:
    vehicle = vehicle_on()
    before = vehicle.download_mission().mission_items
    fly_on(vehicle, 60)
    assert vehicle.state().edit is EditStatus.IDLE

    vehicle.begin(detour_by(vehicle, 2000.0, 700.0))

    assert vehicle.state().edit is EditStatus.CONFIRMED
    assert (vehicle.route().origin.north, vehicle.route().origin.east) == plant_of(vehicle).track[-1]
    after = vehicle.download_mission().mission_items
    assert [item for item in after if item in before] == list(before)
    fly_on(vehicle, 1000)
    assert vehicle.finished
    assert nearest(vehicle, (2000.0, 700.0)) < 100.0
    assert all(nearest(vehicle, corner) < 100.0 for corner in CORNERS)


def test_a_new_waypoint_where_the_vehicle_already_is_is_confirmed_and_passed() -> None:
    vehicle = vehicle_on()
    fly_on(vehicle, 60)
    north, east = plant_of(vehicle).track[-1]

    vehicle.begin(detour_by(vehicle, north + 50.0, east))

    assert vehicle.state().edit is EditStatus.CONFIRMED
    assert (vehicle.mission_progress().current, vehicle.mission_progress().total) == (2, 5)


def test_a_finished_mission_can_be_made_longer() -> None:
    vehicle = vehicle_on(item_at(0.0, 0.0))
    assert vehicle.finished

    vehicle.inject([item_at(3000.0, 0.0)])
    assert not vehicle.finished
    fly_on(vehicle, 220)

    assert vehicle.finished


def test_a_decision_that_leaves_the_current_target_leaves_the_leg() -> None:
    vehicle = vehicle_on()
    fly_on(vehicle, 60)
    commands, origin = len(plant_of(vehicle).commands), vehicle.route().origin
    first, *rest = vehicle.route().waypoints
    later = Waypoint(4000.0, 2000.0, 200.0)

    vehicle.begin(Detour(why="blocked later", waypoint=later, route=(first, later, *rest)))
    vehicle.begin(Keep(why="free"))

    assert len(plant_of(vehicle).commands) == commands
    assert vehicle.route().origin == origin
    assert vehicle.route().waypoints == (first, later, *rest)


def test_the_last_item_can_be_replaced_or_skipped() -> None:
    vehicle = vehicle_on()
    *kept, last = vehicle.route().waypoints
    moved = dataclasses.replace(last, east=5500.0, moved=True)

    vehicle.begin(Replace(why="inside a sphere", waypoint=moved, route=(*kept, moved)))
    assert vehicle.route().waypoints[-1] == moved
    vehicle.begin(Replace(why="no way at all", waypoint=None, route=()))

    assert vehicle.finished
    assert vehicle.mission is not None
    assert vehicle.mission.skipped == (1, 2, 3)


def hold_at(north: float, east: float) -> Hold:
    return Hold(why="no way", centre=Waypoint(north, east, 200.0), radius=90.0, direction=-1)


def test_a_hold_orbits_until_a_later_decision_has_a_route() -> None:
    vehicle = vehicle_on()
    fly_on(vehicle, 100)
    hold = hold_at(1400.0, 100.0)

    vehicle.begin(hold)
    commands = len(plant_of(vehicle).commands)
    for _ in range(200):
        vehicle.advance(1.0)
        vehicle.begin(hold)
        vehicle.begin(Keep(why="still no way"))
    assert len(plant_of(vehicle).commands) == commands
    assert math.dist(plant_of(vehicle).track[-1], (1400.0, 100.0)) == pytest.approx(90.0, abs=10.0)

    assert (vehicle.route().origin.north, vehicle.route().origin.east) == plant_of(vehicle).track[-1]
    vehicle.begin(Resume(why="free again", route=vehicle.route().waypoints))
    _, leg = plant_of(vehicle).command
    assert leg[:2] == plant_of(vehicle).track[-1]
    fly_on(vehicle, 1000)
    assert vehicle.finished


def test_no_decision_ends_a_pause() -> None:
    vehicle = vehicle_on()
    fly_on(vehicle, 60)
    vehicle.pause_mission()
    commands = len(plant_of(vehicle).commands)

    vehicle.begin(hold_at(0.0, 0.0))
    vehicle.begin(detour_by(vehicle, 2000.0, 700.0))

    assert len(plant_of(vehicle).commands) == commands
    assert vehicle.mission_progress().total == 5
    vehicle.start_mission()
    assert plant_of(vehicle).command[0] == "leg"


def test_wrong_calls_say_what_is_wrong() -> None:
    bare = SimulatedVehicle(FakePlant(), HOME, PERFORMANCE)
    for call in (bare.start_mission, bare.download_mission, lambda: bare.inject([item_at(0.0, 0.0)])):
        with pytest.raises(LinkError, match="no mission has been uploaded"):
            call()
    with pytest.raises(ValueError, match="item 0: latitude_deg"):
        bare.upload_mission(MissionPlan.of([MissionItem(99.0, 0.0, 200.0)]))
    landing = dataclasses.replace(item_at(0.0, 0.0), vehicle_action=VehicleAction.LAND)
    with pytest.raises(ValueError, match="item 1: vehicle_action = LAND"):
        bare.upload_mission(MissionPlan.of([item_at(0.0, 0.0), landing]))
    assert bare.mission is None


PLACE = st.tuples(st.floats(-3000.0, 3000.0), st.floats(-3000.0, 3000.0))


@settings(max_examples=20, deadline=None)
@given(st.lists(PLACE, min_size=1, max_size=4), PLACE, st.integers(0, 120), st.integers(0, 60))
def test_any_mission_with_any_detour_and_hold_is_finished(
    places: list[tuple[float, float]], detour: tuple[float, float], wait: int, hold: int
) -> None:
    vehicle = vehicle_on(*(item_at(*place) for place in places))
    fly_on(vehicle, wait)
    if not vehicle.finished:
        vehicle.begin(hold_at(*places[0]))
        fly_on(vehicle, hold)
        vehicle.begin(detour_by(vehicle, *detour))
    total = sum(math.dist(a, b) for a, b in zip([(0.0, 0.0), *places], places, strict=False))

    fly_on(vehicle, (total + 20_000.0) / 15.0 * 1.5 + 600.0)

    assert vehicle.finished
