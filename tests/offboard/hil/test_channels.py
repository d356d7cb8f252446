"""Channel orders: each packaged airframe, signs, mixing, and what is wrong with a file."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from offboard.hil.channels import airframe_names, load_airframe
from offboard.hil.errors import OptionError
from offboard.hil.plant import NEUTRAL, Axes

SHARE = st.floats(-1.0, 1.0)


def test_the_airframes_that_users_need_are_there():
    assert {"px4-10041", "px4-1030", "px4-1033", "px4-x8"} <= set(airframe_names("px4"))
    assert {"ardupilot-plane", "ardupilot-x8"} <= set(airframe_names("ardupilot"))


@pytest.mark.parametrize("name", airframe_names())
@given(roll=SHARE, pitch=SHARE, yaw=SHARE, throttle=st.floats(0.0, 1.0))
def test_what_an_autopilot_asks_for_is_what_is_flown(name, roll, pitch, yaw, throttle):
    airframe = load_airframe(name)
    elevons = name.endswith("x8")
    asked = Axes(roll / 2, pitch / 2, 0.0 if elevons else yaw, throttle)
    assert airframe.axes(airframe.values_for(asked)) == pytest.approx(asked)
    for count in (16, 32):
        assert airframe.axes_of_pwm(airframe.pwm_for(asked, count)) == pytest.approx(asked, abs=2e-3)


@pytest.mark.parametrize(
    ("name", "channel", "axis"),
    [
        ("px4-10041", 1, "roll"),
        ("px4-10041", 2, "pitch"),
        ("px4-10041", 3, "yaw"),
        ("px4-10041", 4, "throttle"),
        ("px4-1030", 3, "yaw"),
        ("px4-1030", 5, "throttle"),
        ("px4-1033", 8, "pitch"),
        ("ardupilot-plane", 1, "roll"),
        ("ardupilot-plane", 2, "pitch"),
        ("ardupilot-plane", 3, "throttle"),
        ("ardupilot-plane", 4, "yaw"),
    ],
)
def test_order_of_channels(name, channel, axis):
    values = [0.0] * 16
    values[channel - 1] = 1.0
    assert load_airframe(name).axes(values) == NEUTRAL._replace(**{axis: 1.0})


@pytest.mark.parametrize(("name", "left", "right"), [("px4-x8", 1, 2), ("px4-1030", 6, 7)])
def test_a_raised_left_surface_and_a_lowered_right_one_roll_left(name, left, right):
    values = [0.0] * 16
    values[left - 1], values[right - 1] = 1.0, -1.0
    assert load_airframe(name).axes(values) == NEUTRAL._replace(roll=-1.0)


def test_disarmed_and_missing_outputs_are_neutral():
    airframe = load_airframe("px4-10041")
    assert airframe.axes([math.nan, math.nan, math.nan, math.nan]) == NEUTRAL
    assert airframe.axes([]) == NEUTRAL
    assert load_airframe("ardupilot-plane").axes_of_pwm([0] * 16) == NEUTRAL


def test_outputs_beyond_their_range_do_no_more_than_full():
    assert load_airframe("px4-10041").axes([3.0, -3.0, 0.0, 2.0]) == Axes(1.0, -1.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('autopilot = "x"\n', ["autopilot = 'x'", "output is missing"]),
        ('autopilot = "px4"\n[[output]]\nchannel = 0\ndrives = {roll = 1}\n', ["channel = 0"]),
        ('autopilot = "px4"\n[[output]]\nchannel = 1\ndrives = {bank = 1, roll = "a"}\n', ["bank", "'a'"]),
        ('autopilot = "px4"\n[[output]]\nchannel = 1\ndrives = {roll = 1, throttle = 1}\n', ["engine"]),
        ('autopilot = "px4"\n' + 2 * '[[output]]\nchannel = 1\ndrives = {yaw = 1}\n',
         ["channel = 1 is given twice"]),
        ('autopilot = "px4"\noutputs = 1\n[[output]]\nchannel = 1\n', ["outputs is unknown", "= None"]),
        ("autopilot = \n", ["line 1"]),
    ],
)  # fmt: skip
def test_a_bad_file_is_refused_with_every_mistake(text, words, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(text)
    with pytest.raises(OptionError) as caught:
        load_airframe(str(file))
    for word in ["mine.toml", *words]:
        assert word in str(caught.value)


def test_an_unknown_name_says_what_is_known():
    with pytest.raises(OptionError, match=r"'concorde' is unknown.*px4-10041"):
        load_airframe("concorde")
