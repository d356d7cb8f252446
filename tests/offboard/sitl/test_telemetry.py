"""What the autopilot tells of itself, how often, and with which time."""

from __future__ import annotations

import math

import pytest

from offboard.sitl.dialect import mavlink
from tests.offboard.fake_plant import HOME
from tests.offboard.sitl.station import Station, autopilot, item, mission, ready

EVERY_TEN_SECONDS = {
    "HEARTBEAT": 10,
    "SYS_STATUS": 10,
    "EXTENDED_SYS_STATE": 10,
    "ATTITUDE": 50,
    "GLOBAL_POSITION_INT": 50,
    "VFR_HUD": 20,
    "MISSION_CURRENT": 10,
    "SYSTEM_TIME": 10,
    "GPS_RAW_INT": 10,
    "BATTERY_STATUS": 5,
    "HOME_POSITION": 5,
}


def test_messages_come_at_their_rates_in_simulated_time():
    ground = Station(autopilot())
    ground.fly(0.1)
    told = [m.get_type() for m in ground.fly(10.0)]
    assert {name: told.count(name) for name in EVERY_TEN_SECONDS} == EVERY_TEN_SECONDS


def test_stamps_are_simulated_time():
    ground = Station(autopilot(start_time=1_600_000_000.0))
    ground.fly(12.0)
    last = ground.last("SYSTEM_TIME")
    assert last.time_unix_usec - 1e3 * last.time_boot_ms == pytest.approx(1.6e15, abs=1e3)
    assert 11_000 <= last.time_boot_ms <= 12_000
    assert ground.last("GLOBAL_POSITION_INT").time_boot_ms <= 12_000


def test_the_clock_is_told_last_in_a_step():
    ground = Station(autopilot())
    ground.command(511, 2.0, 1e5)
    for _ in range(20):
        ground.pilot.step(0.1)
        assert ground.read()[-1].get_type() == "SYSTEM_TIME"


def test_position_and_motion_are_those_of_the_plant():
    ground = ready()
    ground.fly(30.0)
    own, told = ground.pilot.aircraft.ownship(), ground.last("GLOBAL_POSITION_INT")
    north, east = HOME.to_map(told.lat * 1e-7, told.lon * 1e-7)
    assert math.hypot(north - own.north, east - own.east) < 15.0 * 0.25
    assert told.relative_alt == 200_000
    assert told.alt == 800_000
    assert (told.vx, told.vy, told.vz) == (1500, 0, 0)
    assert ground.last("VFR_HUD").airspeed == pytest.approx(15.0)
    assert ground.last("EXTENDED_SYS_STATE").landed_state == mavlink.MAV_LANDED_STATE_IN_AIR


@pytest.mark.parametrize(("flavour", "unbroken"), [("ardupilot", True), ("px4", False)])
def test_the_fence_that_nobody_set_is_as_healthy_as_the_autopilot_says(flavour, unbroken):
    """Of the recorded ones ArduPlane sets the bit of health without the bit of presence, PX4 neither."""
    ground = Station(autopilot(flavour))
    ground.fly(3.0)
    told, bit = ground.last("SYS_STATUS"), mavlink.MAV_SYS_STATUS_GEOFENCE
    assert not told.onboard_control_sensors_present & bit
    assert bool(told.onboard_control_sensors_health & bit) == unbroken


def test_it_stands_still_until_it_is_launched():
    ground = Station(autopilot())
    ground.fly(5.0)
    told = ground.last("GLOBAL_POSITION_INT")
    assert (told.vx, told.vy, told.vz) == (0, 0, 0)
    assert ground.last("EXTENDED_SYS_STATE").landed_state == mavlink.MAV_LANDED_STATE_ON_GROUND
    assert ground.pilot.aircraft.state.time == 0.0


def test_the_target_is_told_in_both_ways():
    ground = ready()
    ground.fly(30.0)
    target, output = ground.last("POSITION_TARGET_GLOBAL_INT"), ground.last("NAV_CONTROLLER_OUTPUT")
    assert (target.lat_int, target.lon_int) == (mission()[1].x, mission()[1].y)
    assert output.target_bearing == 0
    assert output.wp_dist == pytest.approx(2000.0 - 15.0 * 30.0, abs=20.0)
    assert output.xtrack_error == pytest.approx(0.0, abs=0.5)


@pytest.mark.parametrize(
    ("number", "name"), [(148, "AUTOPILOT_VERSION"), (242, "HOME_POSITION"), (49, "GPS_GLOBAL_ORIGIN")]
)
def test_messages_come_when_asked_for(number, name):
    ground = Station(autopilot())
    ground.send(mavlink.MAVLink_command_long_message(1, 1, 512, 0, number, 0, 0, 0, 0, 0, 0))
    answers = {m.get_type(): m for m in ground.read()}
    assert answers["COMMAND_ACK"].result == 0
    assert name in answers


def test_unknown_messages_are_refused():
    ground = Station(autopilot())
    assert ground.command(512, 9999.0) == mavlink.MAV_RESULT_FAILED
    assert ground.command(511, 9999.0, 1e6) == mavlink.MAV_RESULT_FAILED


def test_home_is_home():
    ground = Station(autopilot())
    ground.fly(0.1)
    home = ground.last("HOME_POSITION")
    assert (home.latitude, home.longitude, home.altitude) == (143_900_000, 766_000_000, 600_000)


def test_rates_can_be_changed_stopped_and_asked_for():
    ground = Station(autopilot())
    ground.fly(1.0)
    assert ground.command(511, 30.0, 5e5) == 0
    assert ground.command(511, 33.0, -1.0) == 0
    ground.fly(0.5)
    told = [m.get_type() for m in ground.fly(10.0)]
    assert (told.count("ATTITUDE"), told.count("GLOBAL_POSITION_INT")) == (20, 0)
    ground.send(mavlink.MAVLink_command_long_message(1, 1, 510, 0, 30, 0, 0, 0, 0, 0, 0))
    assert [m.interval_us for m in ground.read("MESSAGE_INTERVAL")] == [500_000]
    assert ground.command(511, 33.0, 0.0) == 0
    ground.fly(0.5)
    assert [m.get_type() for m in ground.fly(2.0)].count("GLOBAL_POSITION_INT") == 10


def test_the_old_way_to_ask_for_rates_works():
    ground = Station(autopilot("ardupilot"))
    ground.send(mavlink.MAVLink_request_data_stream_message(1, 1, mavlink.MAV_DATA_STREAM_EXTRA1, 10, 1))
    ground.fly(0.5)
    assert [m.get_type() for m in ground.fly(5.0)].count("ATTITUDE") == 50


def test_ping_and_timesync_are_answered():
    ground = Station(autopilot())
    ground.fly(2.0)
    ground.send(mavlink.MAVLink_ping_message(5, 9, 0, 0), mavlink.MAVLink_timesync_message(0, 77))
    ping, sync = ground.read("PING", "TIMESYNC")
    assert (ping.seq, ping.target_system, ping.target_component) == (9, 245, 190)
    assert (sync.tc1, sync.ts1) == (pytest.approx(2e9), 77)


def test_a_restart_begins_the_clock_again_and_keeps_the_mission():
    ground = ready("ardupilot")
    ground.fly(20.0)
    ground.pilot.restart()
    ground.fly(1.0)
    assert ground.last("SYSTEM_TIME").time_boot_ms <= 1000
    assert ground.last("HEARTBEAT").custom_mode == 0
    assert ground.last("HEARTBEAT").base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED
    assert len(ground.download()) == 4


def test_frames_are_numbered_per_link():
    pilot = autopilot()
    pilot.open(1)
    pilot.open(2)
    for _ in range(30):
        pilot.step(0.1)
    for link in (1, 2):
        numbers = [frame[4] for frame in pilot.frames(link)]
        assert numbers == [number % 256 for number in range(len(numbers))]


def test_a_link_that_nobody_empties_does_not_grow_for_ever(monkeypatch):
    monkeypatch.setattr("offboard.sitl.links.LONGEST_QUEUE", 10)
    ground = Station(autopilot())
    for _ in range(50):
        ground.pilot.step(0.1)
    assert len(ground.pilot.frames(0)) == 10


def test_jumps_changes_of_speed_and_turns_are_flown():
    ground = Station(autopilot(parameters={"MIS_TKO_LAND_REQ": 0.0}))
    ground.fly(0.1)
    items = [
        item(0, 500.0, 0.0, 200.0),
        item(1, 0.0, 0.0, 200.0, command=178, parameters=(0.0, 20.0, -1.0, 0.0)),
        item(2, 1000.0, 0.0, 200.0),
        item(3, 0.0, 0.0, 0.0, command=177, parameters=(0.0, 2.0, 0.0, 0.0)),
        item(4, 2000.0, 0.0, 200.0, command=19, parameters=(30.0, 0.0, 70.0, 0.0)),
        item(5, 3000.0, 0.0, 200.0),
    ]
    assert ground.upload(items)[0] == 0
    ground.start()
    told = ground.fly_until(lambda: ground.pilot.captain.mission_over)
    reached = [m.seq for m in told if m.get_type() == "MISSION_ITEM_REACHED"]
    order = [seq for before, seq in zip([None, *reached], reached, strict=False) if seq != before]
    assert order == [0, 2, 0, 2, 0, 2, 4, 5]
    assert ground.pilot.captain.mission_state == 5
    speeds = {round(m.airspeed) for m in told if m.get_type() == "VFR_HUD"}
    assert speeds == {15, 20}
