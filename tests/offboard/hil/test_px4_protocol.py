"""PX4's simulator API: what real PX4 said is understood, what we say has the form that it flew by."""

from __future__ import annotations

import json
import math

import pytest
from pymavlink.dialects.v20 import common

from offboard.frames import MapFrame
from offboard.hil.channels import load_airframe
from offboard.hil.geodesy import Geodesy, Place
from offboard.hil.px4_protocol import COMMAND_LONG, HEARTBEAT, Px4Link, pressure_altitude
from offboard.hil.sensors import ACCEL, BARO, DIFFERENTIAL, GYRO, MAG, Fix, Reading
from tests.offboard.hil.fakes import AT_REST, recording

READING = Reading(
    1.5, (0.1, 0.2, -9.8), (0.01, 0.02, 0.03), (0.2, 0.01, 0.4), 101325.0, 12.25, 288.15, ACCEL | GYRO
)
FIX = Fix(1.4, True, 47.397742, 8.545594, 488.0, 3.0, 4.0, -0.5, 0.5, 0.8, 12)


def lines(direction):
    with recording("px4_sim_tcp.jsonl").open() as file:
        found = [json.loads(line) for line in file]
    return [(line["name"], line["t_sim_us"], bytes.fromhex(line["hex"])) for line in found
            if line["dir"] == direction]  # fmt: skip


def decoded(data):
    (message,) = common.MAVLink(None).parse_buffer(data)
    return message


def test_everything_that_real_px4_said_is_understood():
    link, actuators, others = Px4Link(), [], []
    for _, _, data in lines("px4>plant"):
        heard = link.hear(data)
        actuators += heard.actuators
        others += [frame.message for frame in heard.others]
        assert heard.systems == {4}
    assert (len(actuators), others) == (990, [COMMAND_LONG, HEARTBEAT])
    assert (link.skipped, link.broken) == (0, 0)
    assert all(each.lockstep for each in actuators)
    assert not any(any(each.controls) for each in actuators if not each.armed)


def test_each_recorded_answer_carries_the_time_of_its_sensor():
    link = Px4Link()
    for name, time, data in lines("px4>plant"):
        if name == "HIL_ACTUATOR_CONTROLS":
            assert link.hear(data).actuators[0].time_usec == time


def test_the_channel_order_of_10041_flies_the_recorded_turn_to_the_right():
    airframe, link = load_airframe("px4-10041"), Px4Link()
    axes = [
        airframe.axes(heard.actuators[0].controls)
        for name, time, data in lines("px4>plant")
        if name == "HIL_ACTUATOR_CONTROLS" and 40_900_000 <= time <= 41_200_000
        for heard in [link.hear(data)]
    ]
    assert max(each.roll for each in axes) > 0.05
    assert all(0.2 < each.throttle < 0.9 for each in axes)


def test_our_frames_have_the_form_of_those_that_px4_flew_by():
    """The same messages, from the same system and component, with the same fields filled."""
    link = Px4Link()
    place = Geodesy(MapFrame(47.397742, 8.545594)).at(0.0, 0.0)
    ours = {
        "HIL_SENSOR": link.sensor(READING._replace(updated=ACCEL | GYRO | MAG | DIFFERENTIAL | BARO)),
        "HIL_GPS": link.gps(FIX),
        "HIL_STATE_QUATERNION": link.state(AT_REST, place, 488.0),
    }
    seen = set()
    for name, _, data in lines("plant>px4"):
        theirs, mine = decoded(data), decoded(ours[name])
        assert (theirs.get_srcSystem(), theirs.get_srcComponent()) == (
            mine.get_srcSystem(),
            mine.get_srcComponent(),
        )
        assert theirs.get_fieldnames() == mine.get_fieldnames()
        seen.add((name, getattr(theirs, "fields_updated", None)))
    groups = ACCEL | GYRO
    assert {updated for name, updated in seen if name == "HIL_SENSOR"} == {
        groups, groups | MAG, groups | DIFFERENTIAL | BARO, groups | MAG | DIFFERENTIAL | BARO,
    }  # fmt: skip


def test_a_sensor_message_in_px4s_units():
    message = decoded(Px4Link().sensor(READING))
    assert message.time_usec == 1_500_000
    assert (message.xacc, message.yacc, message.zacc) == pytest.approx((0.1, 0.2, -9.8))
    assert (message.xgyro, message.ygyro, message.zgyro) == pytest.approx((0.01, 0.02, 0.03))
    assert message.abs_pressure == pytest.approx(1013.25)
    assert message.diff_pressure == pytest.approx(0.1225)
    assert message.temperature == pytest.approx(15.0)
    assert message.pressure_alt == pytest.approx(0.0, abs=0.01)
    assert (message.fields_updated, message.id) == (0x3F, 0)


def test_a_gps_message_in_px4s_units():
    message = decoded(Px4Link().gps(FIX))
    assert (message.lat, message.lon, message.alt) == (473977420, 85455940, 488000)
    assert (message.vn, message.ve, message.vd, message.vel) == (300, 400, -50, 500)
    assert message.cog == round(math.degrees(math.atan2(4, 3)) * 100)
    assert (message.fix_type, message.eph, message.epv, message.satellites_visible) == (3, 50, 80, 12)
    lost = decoded(Px4Link().gps(FIX._replace(valid=False, horizontal=99.99, satellites=0)))
    assert (lost.fix_type, lost.eph, lost.satellites_visible) == (0, 9999, 0)


def test_the_true_state_is_turned_to_true_north():
    truth = AT_REST._replace(velocity_north=10.0, airspeed=10.0)
    message = decoded(Px4Link().state(truth, Place(47.0, 8.0, math.radians(2.0)), 100.0))
    assert (message.vx, message.vy) == (round(1000 * math.cos(0.0349066)), round(1000 * math.sin(0.0349066)))
    assert message.attitude_quaternion[3] == pytest.approx(math.sin(math.radians(1.0)))
    assert message.zacc == -1000


@pytest.mark.parametrize(("pressure", "altitude"), [(101325.0, 0.0), (89874.6, 1000.0), (54019.9, 5000.0)])
def test_pressure_altitude_of_the_standard_atmosphere(pressure, altitude):
    assert pressure_altitude(pressure) == pytest.approx(altitude, abs=0.5)


def test_a_cut_actuator_frame_is_not_flown():
    (_, _, data) = next(line for line in lines("px4>plant") if line[0] == "HIL_ACTUATOR_CONTROLS")
    assert Px4Link().hear(data[:-1]).actuators == []
    assert Px4Link().hear(data[:-1] + b"\0" + data).actuators != []
