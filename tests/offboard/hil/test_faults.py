"""Failures in their text form."""

from __future__ import annotations

import math

import pytest

from offboard.hil.errors import OptionError
from offboard.hil.faults import Fault, parse_faults
from offboard.hil.json_bridge import KNOWN_FAULTS


def test_the_text_form():
    text = "gps-lost@60-90; airspeed-blocked@12.5 ;accel-bias@30:0.5,0,-1e-2"
    assert parse_faults(text) == (
        Fault("gps-lost", 60.0, 90.0),
        Fault("airspeed-blocked", 12.5),
        Fault("accel-bias", 30.0, math.inf, (0.5, 0.0, -0.01)),
    )
    assert parse_faults("") == ()


def test_while_it_lasts():
    fault = Fault("gps-lost", 1.0, 2.0)
    assert [fault.active(time) for time in (0.9, 1.0, 1.9, 2.0)] == [False, True, True, False]


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("gps-lost", "NAME@START"),
        ("gps-los@1", "'gps-los' is unknown"),
        ("gps-lost@5-2", "ends at 2 s"),
        ("gps-lost@1:3", "takes no values"),
        ("accel-bias@1:1,2", "takes 3 values, not 2"),
        ("accel-bias@1..2:1,2,3", "1..2"),
    ],
)
def test_mistakes_are_named(text, word):
    with pytest.raises(OptionError, match=word):
        parse_faults(text)


def test_every_mistake_at_once_and_only_what_the_protocol_can_tell():
    with pytest.raises(OptionError, match=r"gps-lost.*mag-lost"):
        parse_faults("gps-lost@1; mag-lost@2", KNOWN_FAULTS)
