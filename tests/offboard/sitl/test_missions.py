"""The mission protocol: up, down, in part, with errors, with losses."""

from __future__ import annotations

import math

import pytest

from offboard.sitl.dialect import mavlink
from tests.offboard.fake_plant import HOME
from tests.offboard.sitl.station import POINTS, Station, autopilot, item, mission, ready

KINDS = ("px4", "ardupilot")
FENCE, RALLY = mavlink.MAV_MISSION_TYPE_FENCE, mavlink.MAV_MISSION_TYPE_RALLY


def station(kind="px4", **settings):
    return Station(autopilot(kind, **settings))


def places(items):
    return [(m.command, m.x, m.y, m.z) for m in items]


@pytest.mark.parametrize("kind", KINDS)
def test_what_goes_up_comes_down(kind):
    ground = station(kind)
    items = mission(kind)
    assert ground.upload(items)[0] == mavlink.MAV_MISSION_ACCEPTED
    down = ground.download()
    first = 1 if kind == "ardupilot" else 0
    assert places(down[first:]) == places(items[first:])
    assert [m.current for m in down] == ([0] * 4 if kind == "ardupilot" else [1, 0, 0])
    assert {m.frame for m in down[first:]} == {3 if kind == "ardupilot" else 6}


def test_px4_asks_for_integers_once_it_knows_them():
    asked = [m.get_type() for m in station("px4").upload(mission())[1]]
    assert asked == ["MISSION_REQUEST", "MISSION_REQUEST_INT", "MISSION_REQUEST_INT"]
    asked = [m.get_type() for m in station("ardupilot").upload(mission("ardupilot"))[1]]
    assert set(asked) == {"MISSION_REQUEST"}


def test_px4_asks_otherwise_when_told_that_it_asks_wrongly():
    ground = station("px4")
    ground.send(mavlink.MAVLink_mission_count_message(1, 1, 2, 0))
    assert [m.get_type() for m in ground.read("MISSION_REQUEST")]
    ground.send(mavlink.MAVLink_mission_ack_message(1, 1, mavlink.MAV_MISSION_UNSUPPORTED, 0))
    assert [m.seq for m in ground.read("MISSION_REQUEST_INT")] == [0]


def float_item(message):
    m = message
    return mavlink.MAVLink_mission_item_message(
        1, 1, m.seq, m.frame, m.command, m.current, 1, 0, 0, 0, 0, m.x * 1e-7, m.y * 1e-7, m.z, 0
    )


@pytest.mark.parametrize("kind", KINDS)
def test_items_in_floats_go_both_ways(kind):
    ground = station(kind)
    items = mission(kind)
    assert ground.upload([float_item(m) for m in items])[0] == 0
    ground.send(mavlink.MAVLink_mission_request_message(1, 1, len(items) - 1, 0))
    (last,) = ground.read("MISSION_ITEM")
    assert last.x == pytest.approx(items[-1].x * 1e-7, abs=2e-6)  # a float has 24 bits
    assert last.y == pytest.approx(items[-1].y * 1e-7, abs=1e-5)


@pytest.mark.parametrize(
    ("change", "result"),
    [
        ({"command": 9999}, mavlink.MAV_MISSION_UNSUPPORTED),
        ({"frame": 1}, mavlink.MAV_MISSION_UNSUPPORTED_FRAME),
        ({"x": 910_000_000}, mavlink.MAV_MISSION_INVALID_PARAM5_X),
        ({"y": -1_810_000_000}, mavlink.MAV_MISSION_INVALID_PARAM6_Y),
        ({"z": math.nan}, mavlink.MAV_MISSION_INVALID_PARAM7),
        ({"z": 1e6}, mavlink.MAV_MISSION_INVALID_PARAM7),
        ({"param2": math.inf}, mavlink.MAV_MISSION_INVALID_PARAM2),
        ({"seq": 77}, mavlink.MAV_MISSION_INVALID_SEQUENCE),
    ],
)
def test_items_that_cannot_be_flown_are_refused(change, result):
    ground = station("px4")
    items = mission()
    ground.send(mavlink.MAVLink_mission_count_message(1, 1, 3, 0), items[0])
    for name, value in change.items():
        setattr(items[1], name, value)
    ground.read()
    ground.send(items[1])
    assert [m.type for m in ground.read("MISSION_ACK")] == [result]
    assert ground.pilot.captain.items == ()


def test_ardupilot_wants_every_parameter_given():
    nan = (math.nan, 0.0, 0.0, 0.0)
    for kind, result in (("px4", 0), ("ardupilot", mavlink.MAV_MISSION_INVALID_PARAM1)):
        items = [item(seq, *place, parameters=nan) for seq, place in enumerate(POINTS)]
        assert station(kind).upload(items)[0] == result


def test_a_float_item_without_a_place_is_refused():
    wrong = float_item(mission()[0])
    wrong.x = math.nan
    assert station("px4").upload([wrong])[0] == mavlink.MAV_MISSION_INVALID_PARAM5_X


@pytest.mark.parametrize("kind", KINDS)
def test_too_many_items_are_refused(kind):
    ground = station(kind)
    ground.send(mavlink.MAVLink_mission_count_message(1, 1, 60_000, 0))
    assert [m.type for m in ground.read("MISSION_ACK")] == [mavlink.MAV_MISSION_NO_SPACE]


@pytest.mark.parametrize("kind", KINDS)
def test_a_list_can_be_cleared(kind):
    ground = station(kind)
    ground.upload(mission(kind))
    ground.send(mavlink.MAVLink_mission_clear_all_message(1, 1, 0))
    assert [m.type for m in ground.read("MISSION_ACK")] == [0]
    assert ground.download() == []
    assert ground.pilot.captain.total == 0


def test_asking_for_what_is_not_there_is_answered():
    ground = station("px4")
    ground.send(mavlink.MAVLink_mission_request_int_message(1, 1, 5, 0))
    assert [m.type for m in ground.read("MISSION_ACK")] == [mavlink.MAV_MISSION_INVALID_SEQUENCE]


def test_a_part_of_the_list_comes_down():
    ground = station("px4")
    ground.upload(mission())
    ground.send(mavlink.MAVLink_mission_request_partial_list_message(1, 1, 1, -1, 0))
    assert [m.seq for m in ground.read("MISSION_ITEM_INT")] == [1, 2]
    ground.send(mavlink.MAVLink_mission_request_partial_list_message(1, 1, 2, 9, 0))
    assert [m.type for m in ground.read("MISSION_ACK")] == [mavlink.MAV_MISSION_INVALID_SEQUENCE]


def test_a_part_of_the_list_goes_up_to_ardupilot_only():
    for kind, answer in (("px4", "MISSION_ACK"), ("ardupilot", "MISSION_REQUEST")):
        ground = station(kind)
        ground.upload(mission(kind))
        ground.send(mavlink.MAVLink_mission_write_partial_list_message(1, 1, 2, 2, 0))
        assert [m.get_type() for m in ground.read("MISSION_ACK", "MISSION_REQUEST")] == [answer]
    ground.send(item(2, 500.0, 500.0, 150.0))
    assert [m.type for m in ground.read("MISSION_ACK")] == [0]
    assert [m.z for m in ground.download()] == [600.0, 200.0, 150.0, 200.0]


def test_an_upload_broken_off_leaves_ardupilot_with_a_mixed_list():
    for kind, left in (("px4", [200.0] * 3), ("ardupilot", [600.0, 99.0, 200.0, 200.0])):
        ground = station(kind)
        ground.upload(mission(kind))
        new = [item(seq, 10.0, 10.0, 99.0) for seq in range(len(left))]
        ground.send(mavlink.MAVLink_mission_count_message(1, 1, len(left), 0), *new[:2])
        ground.send(mavlink.MAVLink_mission_ack_message(1, 1, mavlink.MAV_MISSION_OPERATION_CANCELLED, 0))
        ground.read()
        assert [m.z for m in ground.download()] == left


def test_what_gets_lost_is_asked_for_again():
    ground = station("px4")
    items = mission()
    ground.send(mavlink.MAVLink_mission_count_message(1, 1, 3, 0))
    ground.read()
    again = [m.seq for m in ground.fly(1.0) if m.get_type() == "MISSION_REQUEST"]
    assert again == [0] * 5  # every 0.2 s
    ground.send(items[0], items[0], items[2], items[1], items[2])
    assert [m.type for m in ground.read("MISSION_ACK")] == [0]


def test_a_lost_acknowledgement_is_given_again():
    ground = station("px4")
    items = mission()
    ground.upload(items)
    ground.send(items[-1])
    assert [m.type for m in ground.read("MISSION_ACK")] == [0]
    ground.send(items[0])
    assert ground.read("MISSION_ACK") == []


def test_over_a_link_that_loses_messages_the_end_is_acknowledged_more_than_once():
    ground = station("px4")
    ground.send(mavlink.MAVLink_mission_count_message(1, 1, 3, 0))
    ground.fly(0.3)  # what was asked for does not come at once
    ground.send(*mission())
    ground.read()
    assert len([m for m in ground.fly(3.0) if m.get_type() == "MISSION_ACK"]) == 3
    ground.upload(mission())
    ground.send(mavlink.MAVLink_mission_set_current_message(1, 1, 1))  # has heard it
    assert [m for m in ground.fly(3.0) if m.get_type() == "MISSION_ACK"] == []


def test_a_count_that_comes_twice_begins_once():
    ground = station("px4")
    count = mavlink.MAVLink_mission_count_message(1, 1, 3, 0)
    ground.send(count, count, *mission())
    assert [m.type for m in ground.read("MISSION_ACK")] == [0]


def test_an_upload_that_goes_silent_is_given_up():
    ground = station("px4")
    ground.send(mavlink.MAVLink_mission_count_message(1, 1, 3, 0))
    told = ground.fly(6.0)
    assert [m.type for m in told if m.get_type() == "MISSION_ACK"] == [15]
    assert ground.upload(mission())[0] == 0


def test_two_stations_do_not_mix_their_uploads():
    pilot = autopilot("px4")
    one, two = Station(pilot, link=1), Station(pilot, link=2, system=255)
    one.send(mavlink.MAVLink_mission_count_message(1, 1, 3, 0))
    two.send(mavlink.MAVLink_mission_count_message(1, 1, 3, 0), mission()[0])
    assert [m.type for m in two.read("MISSION_ACK")] == [mavlink.MAV_MISSION_ERROR]
    one.read()
    one.send(*mission())
    assert [m.type for m in one.read("MISSION_ACK")] == [0]


def test_geofence_and_rally_points_are_kept_apart():
    ground = station("px4")
    fence = [
        item(seq, *place, command=5001, kind=FENCE, parameters=(3.0, 0, 0, 0))
        for seq, place in enumerate(POINTS)
    ]
    rally = [item(0, 100.0, 0.0, 60.0, command=5100, kind=RALLY)]
    assert ground.upload(mission())[0] == 0
    assert ground.upload(fence, FENCE)[0] == 0
    assert ground.upload(rally, RALLY)[0] == 0
    assert [len(ground.download(kind)) for kind in (0, FENCE, RALLY)] == [3, 3, 1]
    ground.send(mavlink.MAVLink_mission_clear_all_message(1, 1, mavlink.MAV_MISSION_TYPE_ALL))
    assert [len(ground.download(kind)) for kind in (0, FENCE, RALLY)] == [0, 0, 0]


def test_the_same_list_with_another_flag_is_no_new_mission():
    ground = ready("px4")
    ground.fly(20.0)
    assert ground.upload(mission(flagged=0))[0] == 0
    assert ground.pilot.captain.current == 1


def test_an_altitude_above_sea_level_is_told_from_one_above_home():
    ground = station("px4", parameters={"MIS_TKO_LAND_REQ": 0.0})
    items = [item(seq, *place, frame=5) for seq, place in enumerate(POINTS)]
    ground.upload(items)
    ground.start()
    ground.fly(0.2)
    assert ground.pilot.captain.flight.leg.target.waypoint.altitude == pytest.approx(200.0 - HOME.altitude_m)
