"""Frames out of bytes, with whatever else is in them."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from offboard.framing import Framer
from offboard.sitl.dialect import Codec, mavlink

CODEC = Codec(9)


def frames(count):
    codec = Codec(9)
    return [
        codec.pack(mavlink.MAVLink_attitude_message(number, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6))
        for number in range(count)
    ]


def numbers(messages):
    return [message.time_boot_ms for message in messages]


@given(st.lists(st.integers(1, 80), max_size=10))
def test_frames_cut_anywhere_come_out_whole(cuts):
    data, framer, found = b"".join(frames(5)), Framer(CODEC.decode), []
    for cut in cuts:
        found += framer.feed(data[:cut])
        data = data[cut:]
    found += framer.feed(data)
    assert numbers(found) == [0, 1, 2, 3, 4]


@given(st.lists(st.binary(max_size=300), min_size=4, max_size=4))
def test_garbage_between_frames_swallows_none_of_them(garbage):
    data = b"".join(part for pair in zip(garbage, frames(4), strict=True) for part in pair)
    framer = Framer(CODEC.decode)
    found = framer.feed(data + bytes(600))
    assert numbers(found) == [0, 1, 2, 3]


def test_a_forged_length_does_not_hold_up_what_follows():
    true = frames(10)
    forged = bytes((0xFD, 255, 0, 0, 1, 1, 1, 0, 0, 0))
    framer = Framer(CODEC.decode)
    assert numbers(framer.feed(forged + b"".join(true))) == list(range(10))


def test_both_versions_of_the_protocol_are_read():
    old = mavlink.MAVLink(None, srcSystem=1, srcComponent=1)
    heartbeat = mavlink.MAVLink_heartbeat_message(1, 3, 4, 5, 6, 3).pack(old, force_mavlink1=True)
    assert heartbeat[0] == 0xFE
    found = Framer(CODEC.decode).feed(heartbeat + frames(1)[0])
    assert [message.get_type() for message in found] == ["HEARTBEAT", "ATTITUDE"]
