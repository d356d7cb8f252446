"""Parameters: read, set, and refused."""

from __future__ import annotations

import struct

import pytest

from offboard.sitl.dialect import mavlink
from tests.offboard.sitl.station import Station, autopilot


def value_of(message):
    if message.param_type == mavlink.MAV_PARAM_TYPE_REAL32:
        return message.param_value
    return struct.unpack("<i", struct.pack("<f", message.param_value))[0]


@pytest.mark.parametrize("kind", ["px4", "ardupilot"])
def test_the_list_is_whole_and_in_order(kind):
    ground = Station(autopilot(kind))
    ground.send(mavlink.MAVLink_param_request_list_message(1, 1))
    told = ground.read("PARAM_VALUE")
    assert [m.param_index for m in told] == list(range(len(told)))
    assert {m.param_count for m in told} == {len(told)}
    assert [m.param_id for m in told] == sorted(m.param_id for m in told)


def test_those_of_the_aircraft_are_the_aircraft_s():
    assert autopilot("px4").parameters["FW_AIRSPD_TRIM"] == 15.0
    assert autopilot("px4").parameters["FW_R_LIM"] == 30.0
    assert autopilot("px4", system_id=7).parameters["MAV_SYS_ID"] == 7
    assert autopilot("ardupilot").parameters["WP_RADIUS"] == 100


def test_integers_travel_as_bytes_with_px4_and_as_floats_with_ardupilot():
    px4, ardupilot = Station(autopilot("px4")), Station(autopilot("ardupilot"))
    for ground, name in ((px4, b"MIS_TKO_LAND_REQ"), (ardupilot, b"WP_RADIUS")):
        ground.send(mavlink.MAVLink_param_request_read_message(1, 1, name, -1))
    (wanted,), (radius,) = px4.read("PARAM_VALUE"), ardupilot.read("PARAM_VALUE")
    assert value_of(wanted) == 2
    assert radius.param_value == 100.0


def test_a_change_is_told_on_every_link():
    pilot = autopilot("px4")
    one, two = Station(pilot, 1), Station(pilot, 2)
    one.parameter("NAV_LOITER_RAD", 120.0)
    assert [m.param_value for m in one.read("PARAM_VALUE")] == [120.0]
    assert [m.param_value for m in two.read("PARAM_VALUE")] == [120.0]


@pytest.mark.parametrize(("name", "value"), [("NO_SUCH", 1.0), ("NAV_LOITER_RAD", float("nan"))])
def test_what_does_not_fit_is_not_set(name, value):
    ground = Station(autopilot("px4"))
    ground.parameter(name, value)
    assert ground.read("PARAM_VALUE") == []


def test_wrong_settings_are_refused_with_their_names():
    with pytest.raises(ValueError, match="NO_SUCH = 1"):
        autopilot("px4", parameters={"NO_SUCH": 1.0})
    with pytest.raises(ValueError, match="WP_RADIUS = 40000"):
        autopilot("ardupilot", parameters={"WP_RADIUS": 40_000.0})
    with pytest.raises(ValueError, match="system_id = 0"):
        autopilot(system_id=0)


def test_one_can_be_read_by_its_number():
    ground = Station(autopilot("px4"))
    ground.send(mavlink.MAVLink_param_request_read_message(1, 1, b"", 0))
    ground.send(mavlink.MAVLink_param_request_read_message(1, 1, b"", 9999))
    assert [m.param_index for m in ground.read("PARAM_VALUE")] == [0]
