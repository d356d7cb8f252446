"""MAVLink 2 signing, checked against pymavlink's own."""

from __future__ import annotations

import hashlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from offboard.errors import InputError
from offboard.signing import EPOCH, SigningPipe, load_key
from offboard.sitl.dialect import Codec, mavlink
from tests.offboard.sitl.station import autopilot

KEY = bytes(range(32))
NOW = 1_700_000_000.0


def pipe(key=KEY, now=NOW, **others):
    return SigningPipe(key, lambda: now, **others)


def reference(key=KEY):
    """pymavlink, which signs all it sends and takes nothing else."""
    mav = mavlink.MAVLink(None, srcSystem=7, srcComponent=1)
    mav.signing.secret_key = key
    mav.signing.sign_outgoing = True
    mav.signing.timestamp = round((NOW - EPOCH) * 1e5)
    return mav


def attitude(roll=0.1):
    return mavlink.MAVLink_attitude_message(1, roll, 0.2, 0.3, 0.4, 0.5, 0.6)


@given(st.floats(width=32, allow_nan=False), st.integers(0, 255))
def test_what_we_sign_pymavlink_takes(roll, link_id):
    signed = pipe(link_id=link_id).sign(Codec(9).pack(attitude(roll)))
    message = reference().decode(bytearray(signed))
    assert message.get_signed()
    assert message.roll == roll


@given(st.floats(width=32, allow_nan=False))
def test_what_pymavlink_signs_we_take(roll):
    frame = pipe().verify(attitude(roll).pack(reference()))
    assert Codec(1).decode(frame).roll == roll


def test_messages_that_no_dialect_knows_pass():
    frame = bytearray(Codec(9).pack(attitude()))
    frame[7:10] = (0xFF, 0xFF, 0x7F)
    signed = pipe().sign(bytes(frame))
    assert pipe().verify(signed) == bytes(frame)


def test_unsigned_wrongly_signed_old_and_repeated_frames_are_dropped():
    plain = Codec(9).pack(attitude())
    receiver = pipe()
    assert receiver.verify(plain) == b""
    assert receiver.verify(pipe(key=bytes(32)).sign(plain)) == b""
    assert receiver.verify(pipe(now=NOW - 61.0).sign(plain)) == b""
    signed = pipe().sign(plain)
    assert receiver.verify(signed) == plain
    assert receiver.verify(signed) == b""
    assert receiver.dropped >= 4


def test_a_frame_is_old_on_every_link_of_a_receiver():
    heard = {}
    one, two = pipe(heard=heard), pipe(heard=heard)
    signed = pipe().sign(Codec(9).pack(attitude()))
    assert one.verify(signed)
    assert two.verify(signed) == b""


@given(st.binary(max_size=400), st.integers(0, 60), st.integers(1, 255))
def test_one_wrong_bit_is_enough(garbage, place, change):
    signed = bytearray(pipe().sign(Codec(9).pack(attitude())))
    signed[place % len(signed)] ^= change
    assert pipe().verify(bytes(signed) + garbage) == b""


def test_times_of_signatures_rise_though_the_clock_stands():
    sender = pipe()
    frames = [sender.sign(Codec(9).pack(attitude())) for _ in range(3)]
    receiver = pipe()
    assert all(receiver.verify(frame) for frame in frames)


def test_the_autopilot_takes_and_sends_signed_frames_only():
    pilot = autopilot("px4", signing_key=KEY, signing_clock=lambda: NOW)
    arm = Codec(245, 190).pack(mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0))
    pilot.feed(arm)
    pilot.feed(pipe(key=bytes(32)).sign(arm))
    assert not pilot.captain.armed
    pilot.feed(pipe().sign(arm))
    assert pilot.captain.armed
    sent = pilot.flush()
    frames = pipe().verify(sent)
    assert frames
    assert len(sent) - len(frames) == 13 * sum(1 for _ in pilot_frames(frames))


def pilot_frames(data):
    from offboard.framing import Framer  # noqa: PLC0415

    return Framer(Codec(1).decode).feed(data)


def test_keys_from_files(tmp_path):
    digits, phrase, empty = (tmp_path / name for name in ("digits", "phrase", "empty"))
    digits.write_text(KEY.hex() + "\n")
    phrase.write_text("correct horse\n")
    empty.write_text("\n")
    assert load_key(digits) == KEY
    assert load_key(phrase) == hashlib.sha256(b"correct horse").digest()
    for file in (empty, tmp_path / "missing"):
        with pytest.raises(InputError, match=file.name):
            load_key(file)


def test_keys_and_links_of_the_wrong_size_are_refused():
    with pytest.raises(ValueError, match="31 bytes"):
        SigningPipe(bytes(31), lambda: 0.0)
    with pytest.raises(ValueError, match="link_id = 256"):
        SigningPipe(KEY, lambda: 0.0, 256)
