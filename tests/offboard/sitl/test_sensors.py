"""Radar returns and traffic on the wire, turned back into places on the map."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from offboard.sitl.dialect import mavlink
from offboard.sitl.sensors import Report, Return, body_frd, show_radar, show_traffic
from tests.offboard.fake_plant import HOME, FakeState
from tests.offboard.sitl.station import Station, autopilot

ANGLE = st.floats(-math.pi, math.pi)
SMALL = st.floats(-1.0, 1.0)


def back_on_the_map(state, forward, right, down):
    """North, east, altitude of a place in body axes (the matrix of Stevens & Lewis 2003, Eq. 1.3-20)."""
    cy, sy = math.cos(state.heading), math.sin(state.heading)
    cp, sp = math.cos(state.pitch), math.sin(state.pitch)
    cr, sr = math.cos(state.bank), math.sin(state.bank)
    matrix = (
        (cp * cy, sr * sp * cy - cr * sy, cr * sp * cy + sr * sy),
        (cp * sy, sr * sp * sy + cr * cy, cr * sp * sy - sr * cy),
        (-sp, sr * cp, cr * cp),
    )
    n, e, d = (sum(a * b for a, b in zip(row, (forward, right, down), strict=True)) for row in matrix)
    return state.north + n, state.east + e, state.altitude - d


@given(ANGLE, SMALL, SMALL, st.floats(-1e4, 1e4), st.floats(-1e4, 1e4), st.floats(-500.0, 500.0))
def test_body_axes_turn_back(heading, pitch, bank, north, east, altitude):
    state = FakeState(north=100.0, east=-50.0, heading=heading, pitch=pitch, bank=bank)
    again = back_on_the_map(state, *body_frd(state, north, east, altitude))
    assert again == pytest.approx((north, east, altitude), abs=1e-6)


def test_forward_right_and_down_are_what_they_say():
    state = FakeState(heading=0.5 * math.pi)  # to the east
    assert body_frd(state, 0.0, 1000.0, 200.0) == pytest.approx((1000.0, 0.0, 0.0), abs=1e-9)
    assert body_frd(state, -1000.0, 0.0, 200.0) == pytest.approx((0.0, 1000.0, 0.0), abs=1e-9)
    assert body_frd(state, 0.0, 0.0, 150.0) == pytest.approx((0.0, 0.0, 50.0), abs=1e-9)


def test_a_sweep_goes_out_with_the_attitude_it_was_taken_at():
    pilot = autopilot()
    ground = Station(pilot)
    pilot.aircraft.plant.state.bank = 0.4
    pilot.aircraft.plant.state.heading = 1.0
    pilot.step(0.1)
    ground.read()
    show_radar(pilot, [Return(3, 5000.0, 300.0, 180.0), Return(10**9, 1.0, 2.0, 3.0)], 10_000.0)
    attitude, position, first, second = ground.read()
    assert attitude.time_boot_ms == position.time_boot_ms == first.time_boot_ms == 100
    assert (first.obstacle_id, second.obstacle_id) == (3, 0xFFFF)
    assert (first.frame, first.max_distance) == (mavlink.MAV_FRAME_BODY_FRD, 10_000.0)
    state = FakeState(
        north=0.0, east=0.0, altitude=200.0, heading=attitude.yaw, pitch=attitude.pitch, bank=attitude.roll
    )
    place = back_on_the_map(state, first.x, first.y, first.z)
    assert place == pytest.approx((5000.0, 300.0, 180.0), abs=0.01)


def test_an_empty_sweep_says_nothing():
    ground = Station(autopilot())
    show_radar(ground.pilot, [], 10_000.0)
    assert ground.read() == []


def test_traffic_reports_where_it_is_and_how_it_moves():
    ground = Station(autopilot())
    show_traffic(ground.pilot, [Report(77, 3000.0, -4000.0, 220.0, -10.0, 10.0, -1.5)])
    (told,) = ground.read("ADSB_VEHICLE")
    assert told.ICAO_address == 77
    assert HOME.to_map(told.lat * 1e-7, told.lon * 1e-7) == pytest.approx((3000.0, -4000.0), abs=0.02)
    assert (told.altitude, told.altitude_type) == (820_000, mavlink.ADSB_ALTITUDE_TYPE_GEOMETRIC)
    assert (told.heading, told.hor_velocity, told.ver_velocity) == (13_500, 1414, -150)
    assert told.callsign == "UAV77"
    assert told.flags & mavlink.ADSB_FLAGS_VALID_VELOCITY
