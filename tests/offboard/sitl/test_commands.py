"""Commands, modes, take-off and landing."""

from __future__ import annotations

import math

import pytest

from offboard.sitl.aircraft import Phase
from offboard.sitl.dialect import mavlink
from tests.offboard.fake_plant import HOME, FakePlant
from tests.offboard.sitl.recording import Thrown
from tests.offboard.sitl.station import Station, autopilot, distance, item, mission, ready

KINDS = ("px4", "ardupilot")
HOLD = {"px4": (4, 3), "ardupilot": (12, 0)}
TAKEOFF = {"px4": (4, 2), "ardupilot": (13, 0)}
RETURN = {"px4": (4, 5), "ardupilot": (11, 0)}


def mode(station):
    return station.pilot.captain.mode.name


@pytest.mark.parametrize("kind", KINDS)
def test_every_mode_can_be_set_and_is_shown(kind):
    ground = ready(kind)
    for each in ground.pilot.flavour.modes:
        if each.name == "Takeoff":  # is over at once at this altitude
            continue
        number = each.custom_mode
        main, sub = (number >> 16 & 0xFF, number >> 24) if kind == "px4" else (number, 0)
        assert ground.command(176, 1.0, main, sub) == 0
        ground.fly(0.2)
        assert ground.last("HEARTBEAT").custom_mode == number
    assert ground.command(176, 1.0, 99.0, 0.0) == mavlink.MAV_RESULT_DENIED


@pytest.mark.parametrize("kind", KINDS)
def test_hold_circles_here_and_the_mission_goes_on_where_it_was(kind):
    ground = ready(kind)
    ground.fly(30.0)
    seq, state = ground.pilot.captain.current, ground.pilot.aircraft.state
    here = (state.north, state.east)
    assert ground.command(176, 1.0, *HOLD[kind]) == 0
    ground.fly(60.0)
    assert distance(ground.pilot, *here) < 250.0
    assert ground.command(300) == 0
    ground.fly(1.0)
    assert ground.pilot.captain.current == seq
    assert ground.pilot.captain.mission_state == 3


@pytest.mark.parametrize("kind", KINDS)
def test_the_mission_mode_is_refused_without_a_mission(kind):
    ground = Station(autopilot(kind))
    ground.fly(0.1)
    modes = {"px4": (4, 4), "ardupilot": (10, 0)}
    result = {"px4": mavlink.MAV_RESULT_TEMPORARILY_REJECTED, "ardupilot": mavlink.MAV_RESULT_FAILED}
    assert ground.command(176, 1.0, *modes[kind]) == result[kind]


@pytest.mark.parametrize("kind", KINDS)
def test_goto_circles_about_the_place(kind):
    ground = ready(kind)
    latitude, longitude = HOME.to_geodetic(1000.0, 1000.0)
    x, y = round(latitude * 1e7), round(longitude * 1e7)
    reposition = mavlink.MAVLink_command_int_message(1, 1, 5, 192, 0, 0, -1, 1, 0, math.nan, x, y, 850.0)
    ground.send(reposition)
    assert [m.result for m in ground.read("COMMAND_ACK")] == [0]
    ground.fly(200.0)
    assert mode(ground) == {"px4": "Hold", "ardupilot": "GUIDED"}[kind]
    assert 40.0 < distance(ground.pilot, 1000.0, 1000.0) < 120.0
    assert ground.pilot.aircraft.state.altitude == pytest.approx(250.0, abs=1.0)


@pytest.mark.parametrize("kind", KINDS)
def test_return_circles_about_home(kind):
    ground = ready(kind)
    ground.fly(60.0)
    assert ground.command(176, 1.0, *RETURN[kind]) == 0
    ground.fly(200.0)
    assert distance(ground.pilot, 0.0, 0.0) < 150.0


def test_speed_is_changed_and_given_back():
    ground = ready()
    assert ground.command(178, 0.0, 18.0, -1.0) == 0
    ground.fly(2.0)
    assert ground.pilot.aircraft.state.airspeed == 18.0
    assert ground.command(178, 0.0, 500.0, -1.0) == 0
    ground.fly(2.0)
    assert ground.pilot.aircraft.state.airspeed == 24.0  # 1.6 times cruise
    assert ground.command(178, 0.0, -2.0, -1.0) == 0
    ground.fly(2.0)
    assert ground.pilot.aircraft.state.airspeed == 15.0
    assert ground.command(178, 0.0, -7.0, -1.0) == mavlink.MAV_RESULT_DENIED


def test_pause_and_continue():
    ground = ready()
    assert ground.command(193, 0.0) == 0
    assert mode(ground) == "Hold"
    assert ground.command(193, 1.0) == 0
    assert mode(ground) == "Mission"


@pytest.mark.parametrize("kind", KINDS)
def test_it_is_disarmed_in_flight_by_force_only(kind):
    ground = ready(kind)
    ground.fly(5.0)
    assert ground.command(400, 0.0, 0.0) == mavlink.MAV_RESULT_TEMPORARILY_REJECTED
    assert ground.pilot.captain.armed
    assert ground.command(400, 0.0, 21196.0) == 0
    ground.fly_until(lambda: ground.pilot.aircraft.phase is Phase.LANDED, 200.0)
    assert not ground.last("HEARTBEAT").base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED


def test_it_cannot_be_armed_until_it_has_warmed_up():
    ground = Station(autopilot("ardupilot", warm_up=5.0))
    ground.fly(1.0)
    assert ground.command(400, 1.0) == mavlink.MAV_RESULT_FAILED
    assert "Gyros" in ground.last("STATUSTEXT").text
    ground.fly(5.0)
    assert ground.command(400, 1.0) == 0


def on_ground(kind):
    plant = FakePlant()
    plant.state.altitude = 0.0
    return Station(autopilot(kind, plant=plant, launcher=Thrown()))


@pytest.mark.parametrize("kind", KINDS)
def test_a_take_off_without_a_mission(kind):
    ground = on_ground(kind)
    assert ground.command(400, 1.0) == 0
    ground.fly(5.0)
    assert ground.pilot.aircraft.phase is Phase.HELD
    assert ground.command(176, 1.0, *TAKEOFF[kind]) == 0
    ground.fly(60.0)
    assert ground.pilot.aircraft.state.altitude == pytest.approx(50.0, abs=2.1)
    assert mode(ground) == {"px4": "Hold", "ardupilot": "TAKEOFF"}[kind]


@pytest.mark.parametrize("kind", KINDS)
def test_from_the_ground_to_the_ground(kind):
    ground = on_ground(kind)
    first = mission("ardupilot")[:1] if kind == "ardupilot" else []
    places = [(300.0, 0.0, 40.0), (1000.0, 0.0, 60.0), (0.0, 0.0, 0.0)]
    flown = zip(places, (22, 16, 21), strict=True)
    items = first + [item(seq, *p, command=c) for seq, (p, c) in enumerate(flown, start=len(first))]
    assert ground.upload(items)[0] == 0
    assert ground.start(kind) == (0, 0)
    ground.fly_until(lambda: ground.pilot.aircraft.phase is Phase.LANDED, 600.0)
    ground.fly(1.0)
    captain = ground.pilot.captain
    assert (captain.armed, int(captain.mission_state)) == (False, 5)
    assert distance(ground.pilot, 0.0, 0.0) < 100.0
    assert ground.command(400, 1.0) != 0  # what has landed does not start again


@pytest.mark.parametrize("kind", KINDS)
def test_set_current_outside_the_list_changes_nothing(kind):
    ground = ready(kind)
    before = ground.pilot.captain.current
    ground.send(mavlink.MAVLink_mission_set_current_message(1, 1, 40))
    assert ground.command(224, 40.0) == mavlink.MAV_RESULT_DENIED
    assert ground.pilot.captain.current == before


def test_unknown_commands_are_refused_as_such():
    assert ready().command(31999) == mavlink.MAV_RESULT_UNSUPPORTED


def test_what_follows_the_last_waypoint():
    for kind, name in (("px4", "Hold"), ("ardupilot", "RTL")):
        ground = Station(autopilot(kind, parameters={"MIS_TKO_LAND_REQ": 0.0} if kind == "px4" else {}))
        items = [*mission(kind)[:-1]]
        assert ground.upload(items)[0] == 0
        ground.start(kind)
        ground.fly_until(lambda ground=ground: ground.pilot.captain.mission_over)
        assert mode(ground) == name
        assert ground.pilot.captain.mission_state == 5


def test_a_restart_can_be_ordered_on_the_ground_only():
    ground = ready()
    assert ground.command(246, 1.0) == mavlink.MAV_RESULT_DENIED
    held = Station(autopilot())
    held.fly(5.0)
    assert held.command(246, 1.0) == 0
    assert held.pilot.aircraft.clock == 0.0
