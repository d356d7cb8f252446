"""Returns from messages, and from lines on a UDP port."""

from __future__ import annotations

import json
import math
import socket

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from avoidance import Ownship
from offboard.errors import LinkError
from offboard.frames import MapFrame
from offboard.link import VehicleState
from offboard.live.facts import Attitude
from offboard.live.messages import Message
from offboard.live.telemetry import Telemetry
from offboard.sitl.sensors import body_frd
from offboard.udp_radar import UdpRadar, sighting_of
from offboard.wire_radar import WireRadar, to_ned

FRAME = MapFrame(14.39, 76.60, 600.0)
OWN = Ownship(10.0, 1000.0, 500.0, 200.0, 15.0, 0.0, airspeed=15.0)
STATE = VehicleState(OWN)


def telemetry(roll=0.0, pitch=0.0, yaw=0.0) -> Telemetry:
    known = Telemetry()
    latitude, longitude = FRAME.to_geodetic(OWN.north, OWN.east)
    place = {
        "lat": round(latitude * 1e7),
        "lon": round(longitude * 1e7),
        "alt": 800_000,
        "relative_alt": 200_000,
    }
    known.feed(
        Message(
            "GLOBAL_POSITION_INT", {**place, "time_boot_ms": 10_000, "vx": 1500, "vy": 0, "vz": 0, "hdg": 0}
        )
    )
    known.feed(Message("ATTITUDE", {"time_boot_ms": 10_000, "roll": roll, "pitch": pitch, "yaw": yaw}))
    return known


def radar(alarms: list[str], safety_radius: float = 1000.0) -> WireRadar:
    return WireRadar(FRAME, lambda time: time, safety_radius, alarms.append)


@settings(max_examples=50, deadline=None)
@given(st.floats(-1, 1), st.floats(-1, 1), st.floats(-3, 3), *[st.floats(-9000, 9000)] * 3)
def test_body_axes_turn_back_to_where_the_obstacle_is(roll, pitch, yaw, north, east, up):
    class State:
        bank, heading = roll, yaw

    state = State()
    state.north, state.east, state.altitude, state.pitch = 0.0, 0.0, 0.0, pitch
    ned = to_ned(Attitude(0.0, roll, pitch, yaw), *body_frd(state, north, east, up))
    assert ned == pytest.approx((north, east, -up), abs=1e-6)


def test_an_obstacle_in_body_axes_becomes_a_return_on_the_map():
    alarms: list[str] = []
    wire = radar(alarms)
    fields = {"frame": 12, "obstacle_id": 7, "x": 3000.0, "y": 400.0, "z": -50.0, "time_boot_ms": 10_000}
    wire.take(Message("OBSTACLE_DISTANCE_3D", fields), telemetry(yaw=math.pi / 2))
    scan = wire.scan(STATE, 10.0)
    assert scan.ids.tolist() == [7]
    assert scan.positions[0] == pytest.approx([600.0, 3500.0, 250.0], abs=0.1)


def test_traffic_is_moved_on_at_its_velocity():
    wire = radar([])
    latitude, longitude = FRAME.to_geodetic(9000.0, 0.0)
    fields = {
        "ICAO_address": 77,
        "lat": round(latitude * 1e7),
        "lon": round(longitude * 1e7),
        "altitude": 800_000,
        "heading": 18_000,
        "hor_velocity": 2000,
        "ver_velocity": 0,
        "flags": 1 + 2 + 4 + 8,
        "tslc": 2,
    }
    wire.take(Message("ADSB_VEHICLE", fields), telemetry())
    position = wire.scan(STATE, 10.0).positions[0]
    assert position == pytest.approx([8960.0, 0.0, 200.0], abs=0.1)


def test_sectors_are_used_only_where_they_reach_beyond_the_safety_radius():
    alarms: list[str] = []
    fields = {
        "max_distance": 60_000,
        "increment": 5,
        "angle_offset": 0.0,
        "frame": 12,
        "distances": [65_535, 50_000],
    }
    message = Message("OBSTACLE_DISTANCE", fields)
    far, near = radar(alarms), radar([], safety_radius=100.0)
    far.take(message, telemetry())
    near.take(message, telemetry())
    assert not len(far.scan(STATE, 10.0).ids)
    assert "600 m, less than the safety radius" in alarms[0]
    place = near.scan(STATE, 10.0).positions[0]
    angle = math.radians(5.0)
    assert place[:2] == pytest.approx(
        [1000.0 + 500.0 * math.cos(angle), 500.0 + 500.0 * math.sin(angle)], abs=0.1
    )


def test_a_collision_warning_has_no_place_and_is_an_alarm():
    alarms: list[str] = []
    wire = radar(alarms)
    wire.take(Message("COLLISION", {"threat_level": 2, "time_to_minimum_delta": 12.0}), telemetry())
    assert "collision in 12 s" in alarms[0]
    assert not len(wire.scan(STATE, 10.0).ids)


def test_nonsense_becomes_no_return():
    wire = radar([])
    for fields in (
        {"frame": 12, "obstacle_id": 1, "x": None, "y": 0.0, "z": 0.0},
        {"frame": 12, "obstacle_id": 1, "x": 1e30, "y": 0.0, "z": 0.0},
        {},
    ):
        wire.take(Message("OBSTACLE_DISTANCE_3D", fields), telemetry())
    wire.take(Message("ADSB_VEHICLE", {"flags": 3, "lat": 2**31 - 1, "lon": 0}), telemetry())
    wire.take(Message("OBSTACLE_DISTANCE", {"distances": "x", "max_distance": 65535}), telemetry())
    assert not len(wire.scan(STATE, 10.0).ids)


def test_lines_on_a_udp_port_become_returns_until_they_are_old():
    alarms: list[str] = []
    source = UdpRadar(0, FRAME, alarms.append)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        rows = [
            {"id": 8, "range_m": 2000, "bearing_deg": 90, "safety_radius_m": 400},
            {"id": 9, "north_m": 1, "east_m": 2},
        ]
        data = "\n".join(json.dumps(row) for row in rows) + "\nrubbish\n"
        sender.sendto(data.encode(), ("127.0.0.1", source.port))
        scan = source.scan(STATE, 10.0)
    assert scan.ids.tolist() == [8, 9]
    assert scan.positions[0] == pytest.approx([1000.0, 2500.0, 200.0], abs=1e-6)
    assert scan.radii[0] == 400.0
    assert "rubbish" in alarms[0]
    with pytest.raises(LinkError, match=str(source.port)):
        UdpRadar(source.port, FRAME, alarms.append)
    source.close()


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        (b"[1]", "is no object"),
        (b'{"id": -1, "north_m": 0, "east_m": 0}', "id = -1"),
        (b'{"id": 1}', "exactly one of these"),
        (b'{"id": 1, "north_m": "x", "east_m": 0}', "north_m = x"),
        (b'{"id": 1, "north_m": 0, "east_m": 0, "safety_radius_m": 0}', "safety_radius_m = 0"),
        (b'{"id": 1, "range_m": -5, "bearing_deg": 0}', "range_m = -5"),
    ],
)
def test_what_is_wrong_with_a_line_is_said(line, problem):
    with pytest.raises(ValueError, match=problem):
        sighting_of(line, OWN, FRAME)


def test_our_own_transponder_is_no_traffic_and_that_is_told_once():
    notes: list[str] = []
    wire = WireRadar(FRAME, lambda time: time, 1000.0, notes.append, note=notes.append)
    known = telemetry()
    latitude, longitude = FRAME.to_geodetic(OWN.north, OWN.east)
    fields = {
        "ICAO_address": 0xABC123, "lat": round(latitude * 1e7), "lon": round(longitude * 1e7),
        "altitude": 800_000, "heading": 0, "hor_velocity": 1500, "ver_velocity": 0, "flags": 15,
    }  # fmt: skip
    for age in (3, 2, 1, 0):
        back = FRAME.to_geodetic(OWN.north - 15.0 * age, OWN.east)
        place = {"lat": round(back[0] * 1e7), "lon": round(back[1] * 1e7), "tslc": age}
        wire.take(Message("ADSB_VEHICLE", {**fields, **place}), known)
    assert len(wire.scan(STATE, 10.0).ids) == 0
    assert notes == ["ADSB_VEHICLE ABC123 is this vehicle itself: it is not taken for traffic"]
    wire.take(Message("ADSB_VEHICLE", {**fields, "ICAO_address": 5, "heading": 18000, "tslc": 0}), known)
    assert wire.scan(STATE, 10.0).ids.tolist() == [5]
