"""Whatever comes in: never a crash, never taken for the truth."""

from __future__ import annotations

import math

from hypothesis import given, settings
from hypothesis import strategies as st

from offboard.sitl.dialect import Codec, mavlink
from tests.offboard.fake_plant import FakePlant
from tests.offboard.sitl.station import Station, autopilot, mission, ready

ANY_FLOAT = st.floats(width=32)
KNOWN = sorted(number for number in mavlink.mavlink_map if number < 65536)


class StrictPlant(FakePlant):
    """Refuses what the FMU would refuse."""

    def fly_leg(self, *leg):
        *line, altitude, airspeed = leg
        assert all(abs(number) <= 1e7 for number in line)
        assert -1000.0 <= altitude <= 20_000.0
        assert 1.0 <= airspeed <= 100.0
        super().fly_leg(*leg)

    def fly_orbit(self, north, east, radius, direction, altitude, airspeed):
        assert 1.0 <= radius <= 1e7
        assert direction in (-1, 1)
        self.fly_leg(north, east, north, east, altitude, airspeed)
        super().fly_orbit(north, east, radius, direction, altitude, airspeed)


def flying(kind="px4"):
    return ready(kind, plant=StrictPlant())


def shown(pilot):
    """What matters of an autopilot."""
    captain = pilot.captain
    return captain.mode, captain.armed, captain.items, captain.current, captain.aircraft.aim


@settings(max_examples=40)
@given(st.lists(st.binary(max_size=200), max_size=8))
def test_garbage_changes_nothing(chunks):
    ground = flying("px4")
    before = shown(ground.pilot)
    for chunk in chunks:
        ground.pilot.feed(chunk)
    assert shown(ground.pilot) == before


@given(st.integers(0, 200), st.integers(1, 255))
def test_a_wrong_byte_makes_a_frame_worth_nothing(place, change):
    pilot = autopilot()
    frame = bytearray(
        Codec(245).pack(mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1, 2, 3, 4, 5, 6, 7))
    )
    frame[place % len(frame)] ^= change
    pilot.feed(bytes(frame))
    assert not pilot.captain.armed


@given(st.integers(0, 44))
def test_half_a_frame_is_none(length):
    pilot = autopilot()
    frame = Codec(245).pack(mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1, 2, 3, 4, 5, 6, 7))
    pilot.feed(frame[: min(length, len(frame) - 1)])
    assert not pilot.captain.armed


def test_nobody_else_is_the_autopilot():
    pilot = autopilot()
    arm = mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0)
    pilot.feed(Codec(1, 1).pack(arm))  # says that it is the autopilot itself
    elsewhere = mavlink.MAVLink_command_long_message(2, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0)
    pilot.feed(Codec(245).pack(elsewhere))  # for another system
    camera = mavlink.MAVLink_command_long_message(1, 100, 400, 0, 1, 0, 0, 0, 0, 0, 0)
    pilot.feed(Codec(245).pack(camera))  # for another component
    assert not pilot.captain.armed


def test_what_another_vehicle_tells_of_itself_is_not_ours():
    ground = flying("px4")
    before = shown(ground.pilot)
    other = Codec(2, 1)
    for message in (
        mavlink.MAVLink_heartbeat_message(1, 12, 0, 0, 3, 3),
        mavlink.MAVLink_mission_current_message(7, 9, 3, 1),
        mavlink.MAVLink_mission_item_reached_message(5),
        mavlink.MAVLink_global_position_int_message(0, 1, 2, 3, 4, 5, 6, 7, 8),
    ):
        ground.pilot.feed(other.pack(message))
    assert shown(ground.pilot) == before


@settings(max_examples=30)
@given(st.sampled_from(KNOWN), st.data())
def test_any_message_with_any_content_is_survived(number, data):
    """Every message of the dialect, its payload at random, addressed to us where it has an address."""
    kind = mavlink.mavlink_map[number]
    payload = bytearray(data.draw(st.binary(min_size=kind.unpacker.size, max_size=kind.unpacker.size)))
    frame = bytearray((0xFD, len(payload), 0, 0, 0, 245, 190, number & 0xFF, number >> 8, 0)) + payload
    checksum = mavlink.x25crc(frame[1:])
    checksum.accumulate(bytes((kind.crc_extra,)))
    frame += checksum.crc.to_bytes(2, "little")
    message = Codec(1).decode(bytes(frame))
    ground = flying("px4")
    if message is not None:
        for name in ("target_system", "target_component"):
            if hasattr(message, name):
                setattr(message, name, 1)
        ground.send(message)
    ground.fly(1.0)
    state = ground.pilot.aircraft.state
    assert math.isfinite(state.north)
    assert math.isfinite(state.altitude)


@settings(max_examples=30)
@given(
    st.sampled_from(("px4", "ardupilot")),
    st.sampled_from((16, 17, 20, 21, 22, 176, 178, 179, 192, 193, 224, 246, 300, 400, 511, 512, 520, 65535)),
    st.lists(ANY_FLOAT, min_size=7, max_size=7),
)
def test_commands_with_any_numbers_are_answered_and_survived(kind, number, values):
    ground = flying(kind)
    ground.read()
    result = ground.command(number, *values)
    ground.fly(2.0)
    assert result is not None
    state = ground.pilot.aircraft.state
    assert all(math.isfinite(value) for value in (state.north, state.east, state.altitude))
    assert abs(state.north) < 1e4


@settings(max_examples=40)
@given(st.integers(0, 65535), st.lists(st.integers(0, 65535), max_size=6))
def test_any_counts_and_sequences_leave_the_mission_whole(count, sequence):
    ground = Station(autopilot("px4"))
    ground.upload(mission())
    ground.send(mavlink.MAVLink_mission_count_message(1, 1, count, 0))
    for seq in sequence:
        (one,) = mission()[:1]
        one.seq = seq
        ground.send(one)
    assert len(ground.pilot.captain.items) in {0 if count == 0 else 3, count}


@settings(max_examples=30)
@given(st.lists(ANY_FLOAT, min_size=3, max_size=3))
def test_places_that_are_none_are_not_flown_to(values):
    ground = flying("ardupilot")
    x, y, z = values
    guided = mavlink.MAVLink_mission_item_message(1, 1, 0, 3, 16, 2, 1, 0, 0, 0, 0, x, y, z, 0)
    ground.send(guided)
    ground.fly(0.3)
    aim = ground.pilot.aircraft.aim
    assert all(math.isfinite(number) for number in (aim if isinstance(aim, tuple) else (aim.north, aim.east)))


WILD_ITEMS = st.tuples(
    st.sampled_from((16, 17, 18, 19, 20, 21, 22, 31, 177, 178)),
    st.sampled_from((0, 2, 3, 5, 6)),
    st.lists(ANY_FLOAT | st.floats(-5.0, 5.0, width=32), min_size=4, max_size=4),
    st.integers(-910_000_000, 910_000_000) | st.integers(143_800_000, 144_000_000),
    st.integers(-1_810_000_000, 1_810_000_000) | st.integers(765_900_000, 766_100_000),
    ANY_FLOAT | st.floats(-100.0, 300.0, width=32),
)


@settings(max_examples=40)
@given(st.sampled_from(("px4", "ardupilot")), st.lists(WILD_ITEMS, min_size=1, max_size=6), st.integers(0, 6))
def test_any_mission_is_refused_or_survived(kind, wild, current):
    """Zero-length legs, jumps to themselves, circles of no size, places at the other end of the world."""
    ground = flying(kind)
    items = [
        mavlink.MAVLink_mission_item_int_message(1, 1, seq, frame, command, 0, 1, *numbers, x, y, z, 0)
        for seq, (command, frame, numbers, x, y, z) in enumerate(wild)
    ]
    result, _ = ground.upload(items)
    ground.send(mavlink.MAVLink_mission_set_current_message(1, 1, current))
    ground.fly(3.0)
    assert result is not None
    assert math.isfinite(ground.pilot.aircraft.state.north)
