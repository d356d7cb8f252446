"""Frames out of a stream, whatever stands between them, however it is cut."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import common

from offboard.hil.framing import Framer


def frames(count=3, **options):
    mav = common.MAVLink(None, srcSystem=9, srcComponent=1)
    mav.robust_parsing = True
    return [
        bytes(common.MAVLink_heartbeat_message(1, 12, 0, number, 0, 3).pack(mav, **options))
        for number in range(count)
    ]


@given(cuts=st.lists(st.integers(0, 80), max_size=6))
def test_however_the_stream_is_cut(cuts):
    stream = b"".join(frames())
    places = sorted({min(cut, len(stream)) for cut in cuts} | {0, len(stream)})
    framer = Framer()
    found = [f.data for a, b in pairwise(places) for f in framer.feed(stream[a:b])]
    assert found == frames()


@given(garbage=st.binary(max_size=40).filter(lambda data: b"\xfd" not in data and b"\xfe" not in data))
def test_garbage_before_and_between_is_left_out(garbage):
    framer = Framer()
    one, two, three = frames()
    found = framer.feed(garbage + one + garbage + two + three)
    assert [frame.data for frame in found] == [one, two, three]
    assert framer.skipped == 2 * len(garbage)


@given(st.binary(max_size=300))
def test_any_bytes_do_no_harm(data):
    framer = Framer()
    framer.feed(data)
    follow = b"\0" * 600 + frames()[0]
    assert framer.feed(follow)[-1].data == frames()[0]


def test_a_damaged_frame_does_not_take_the_next_one_with_it():
    one, two, _ = frames()
    damaged = one[:12] + bytes([one[12] ^ 0xFF]) + one[13:]
    assert [frame.data for frame in Framer().feed(damaged + two)] == [two]


def test_version_1_passes_as_well():
    data = frames(force_mavlink1=True)
    found = Framer().feed(b"".join(data))
    assert [(frame.message, frame.system) for frame in found] == [(0, 9)] * 3


def test_messages_that_nobody_knows_and_signed_ones_pass_as_they_are():
    unknown = bytes([0xFD, 1, 0, 0, 0, 5, 1, 0xFF, 0xFF, 0x7F, 42, 0, 0])
    signed = bytes([0xFD, 1, 1, 0, 0, 5, 1, 0xFF, 0xFF, 0x7F, 42, 0, 0]) + bytes(13)
    assert [frame.data for frame in Framer().feed(unknown + signed)] == [unknown, signed]
