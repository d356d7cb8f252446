"""ArduPilot's JSON protocol: packets, answers, and the conversation, against a real ArduPlane's."""

from __future__ import annotations

import json
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from offboard.hil.json_protocol import (
    Ignored,
    JsonSession,
    Repeat,
    Servos,
    Step,
    answer,
    pack_servos,
    parse_servos,
)
from offboard.hil.scripted_ardupilot import read_line
from tests.offboard.hil.fakes import AT_REST, recording


def exchanges():
    with recording("ardupilot_json.jsonl").open() as lines:
        return [json.loads(line) for line in lines]


def packet(frame, rate=200, channels=16):
    return pack_servos(Servos(rate, frame, tuple(range(1000, 1000 + channels))))


def kinds(session, packets, sender="a"):
    """What the session makes of (bytes, time) in turn, each step answered at once."""
    found = []
    for data, now in packets:
        verdict = session.take(data, sender, now)
        if isinstance(verdict, Step):
            session.answered(now)
        found.append(verdict)
    return found


def test_every_recorded_packet_is_read_and_written_back_byte_for_byte():
    for line in exchanges():
        data = bytes.fromhex(line["servo_hex"])
        assert pack_servos(parse_servos(data)) == data


def test_our_answers_have_the_form_of_those_that_arduplane_flew_by():
    number = r"-?\d+\.\d+"
    ours = answer(AT_REST, 1.0, 2.0, 3.0, 4.0).decode()
    form = re.sub(number, "#", ours).replace(',"airspeed":#', "")
    for line in exchanges():
        if line["reply"] is not None:
            assert re.sub(number, "#", line["reply"]) == form
    assert " " not in ours


def test_the_recorded_conversation_is_judged_as_it_went():
    session, steps, restarts = JsonSession(), 0, []
    for index, line in enumerate(exchanges(), 1):
        verdict = session.take(bytes.fromhex(line["servo_hex"]), "a", line["t_wall"])
        assert isinstance(verdict, Step) == (line["reply"] is not None)
        if isinstance(verdict, Step):
            session.answered(line["t_wall"] + (1.4 if index == 841 else 0.0))
            steps += 1
            if verdict.restart:
                restarts.append(index)
    assert (steps, restarts) == (1080, [882])


def test_recorded_steps_add_up_to_the_recorded_time():
    session, time = JsonSession(), 0.0
    for line in exchanges()[:230]:
        time += session.take(bytes.fromhex(line["servo_hex"]), "a", 0.0).duration
        assert time == pytest.approx(read_line(line["reply"])["timestamp"][0], abs=1e-6)


@pytest.mark.parametrize("channels", [16, 32])
def test_both_lengths(channels):
    data = packet(7, channels=channels)
    assert len(data) == 8 + 2 * channels
    assert parse_servos(data) == Servos(200, 7, tuple(range(1000, 1000 + channels)))


@given(st.binary(max_size=80))
def test_garbage_is_no_packet(data):
    assert JsonSession().take(data, "a", 0.0) == Ignored("garbage")


@pytest.mark.parametrize(
    "data", [packet(1)[:-1], packet(1) + b"\0", packet(1, rate=0), packet(1, rate=5), b"\x1a\x48"]
)
def test_packets_of_wrong_length_or_rate_are_garbage(data):
    assert JsonSession().take(data, "a", 0.0) == Ignored("garbage")


def test_a_repeated_packet_is_answered_again_only_if_its_answer_was_lost():
    session = JsonSession()
    found = kinds(session, [(packet(0), 0.0), (packet(0), 0.1), (packet(0), 1.0), (packet(0), 1.1)])
    assert found[1:] == [Ignored("duplicate"), Repeat(), Ignored("duplicate")]


def test_an_overtaken_packet_is_left_out():
    found = kinds(JsonSession(), [(packet(5), 0.0), (packet(6), 0.0), (packet(5), 0.0), (packet(7), 0.0)])
    assert found[2] == Ignored("late")
    assert [each.missed for each in found if isinstance(each, Step)] == [0, 0, 0]


def test_packets_that_never_came_are_counted_and_not_flown():
    found = kinds(JsonSession(), [(packet(5), 0.0), (packet(9), 0.0)])
    assert (found[1].missed, found[1].duration) == (3, 0.005)


@pytest.mark.parametrize(("frame", "sender"), [(0, "a"), (0, "b"), (3, "b")])
def test_a_firmware_that_starts_again_puts_the_plant_back(frame, sender):
    session = JsonSession()
    kinds(session, [(packet(5), 0.0), (packet(6), 0.0)])
    assert session.take(packet(frame), sender, 0.0).restart


def test_a_firmware_that_starts_again_before_its_second_packet():
    session = JsonSession()
    kinds(session, [(packet(0), 0.0)])
    assert session.take(packet(0), "b", 0.1).restart


def test_the_counter_may_wrap():
    found = kinds(JsonSession(), [(packet(2**32 - 2), 0.0), (packet(2**32 - 1), 0.0), (packet(1), 0.0)])
    assert [each.restart for each in found] == [False, False, False]
    assert found[2].missed == 1


def test_packing_refuses_other_numbers_of_channels():
    with pytest.raises(ValueError, match=r"len\(pwm\) = 8"):
        pack_servos(Servos(200, 0, (1500,) * 8))
