"""The simulated autopilot against recordings of the real ones: told the same, does it answer the same?"""

from __future__ import annotations

import functools
import re

import pytest

from offboard.sitl.dialect import Codec, mavlink
from tests.offboard.sitl.recording import FOLDER, STATION, frames, replay

pytestmark = pytest.mark.skipif(
    not FOLDER.is_dir(), reason="recordings of real autopilots lie beside the repository, not in it"
)
FLIGHTS = {
    "px4_inject": {"speed": 12.0},
    "px4_infeasible_hold": {"speed": 12.0, "system": 2},
    "px4_mission_plugin": {"speed": 12.0, "system": 3},
    "ardupilot_inject": {"speed": 23.0, "warm_up": 21.0},
    "ardupilot_flag_ignored": {"speed": 23.0, "warm_up": 21.0},
    "ardupilot_home_swallowed": {"speed": 23.0, "warm_up": 21.0},
}
"""Ground speed of the recorded flight, its system ID, and how long ArduPlane could not be armed."""


@functools.cache
def flown(name):
    return replay(name, **FLIGHTS[name])


@pytest.mark.parametrize("name", FLIGHTS)
def test_every_request_is_answered_as_it_was(name):
    both = flown(name)
    assert both.answers("ours") == both.answers("recorded")


def currents(both, side):
    told = [(m.seq, m.total, m.mission_state, m.mission_mode) for m in both.at(side, "MISSION_CURRENT", 0.0)]
    return [now for before, now in zip([None, *told], told, strict=False) if now != before]


@pytest.mark.parametrize("name", [name for name in FLIGHTS if name != "px4_infeasible_hold"])
def test_the_current_item_goes_the_same_way(name):
    both = flown(name)
    recorded, ours = currents(both, "recorded"), iter(currents(both, "ours"))
    assert [each for each in recorded if each in ours] == recorded  # in this order


def text(message):
    return (message.severity, re.sub(r"[\d.]+", "#", message.text))


@pytest.mark.parametrize("kind", ["px4", "ardupilot"])
def test_nothing_is_said_that_the_real_one_does_not_say(kind):
    both = [flown(name) for name in FLIGHTS if name.startswith(kind)]
    known = {text(m) for each in both for m in each.at("recorded", "STATUSTEXT", 0.0)}
    said = {text(m) for each in both for m in each.at("ours", "STATUSTEXT", 0.0)}
    assert said
    assert said <= known


def target(both, side, begin, end):
    return {(m.lat_int, m.lon_int) for m in both.at(side, "POSITION_TARGET_GLOBAL_INT", begin, end)}


def near(one, other):
    return all(abs(a - b) < 1000 for a, b in zip(one, other, strict=True))  # 1000e-7 deg: ten metres


@pytest.mark.parametrize(
    ("name", "begin", "end"),
    [
        ("px4_inject", 58.0, 80.0),  # the injected item, from the upload on
        ("px4_mission_plugin", 59.0, 65.0),  # back to item 1
        ("px4_mission_plugin", 67.0, 90.0),  # put right
        ("ardupilot_inject", 59.0, 80.0),
        ("ardupilot_flag_ignored", 59.0, 67.0),  # the old target, flag or not
        ("ardupilot_flag_ignored", 69.0, 80.0),
        ("ardupilot_home_swallowed", 32.0, 60.0),  # straight to the second waypoint
    ],
)
def test_it_flies_to_the_same_place(name, begin, end):
    both = flown(name)
    (recorded,) = target(both, "recorded", begin, end)
    (ours,) = target(both, "ours", begin, end)
    assert near(ours, recorded)


def test_px4_drops_to_hold_within_a_second_and_resumes():
    both = flown("px4_infeasible_hold")
    for side in ("recorded", "ours"):
        modes = [m.custom_mode for m in both.at(side, "HEARTBEAT", 56.1, 57.2) if m.autopilot == 12]
        assert modes[-1] == 50593792
        assert both.at(side, "MISSION_CURRENT", 56.2, 57.4)[-1].mission_state == 1
        assert both.at(side, "HEARTBEAT", 70.0)[-1].custom_mode == 67371008


def recorded_lengths(name, number):
    """Payload lengths of a message as the real autopilot sent it."""
    found = (frame for _, frame in frames(name) if frame[7:10] == bytes((number, 0, 0)))
    return {frame[1] for frame in found if frame[5] != STATION}


@pytest.mark.parametrize("number", [42, 44, 47], ids=["MISSION_CURRENT", "MISSION_COUNT", "MISSION_ACK"])
def test_px4_sends_its_extensions(number):
    pilot = flown("px4_inject").pilot
    station = Codec(STATION, 190)
    pilot.frames()
    pilot.feed(station.pack(mavlink.MAVLink_mission_request_list_message(1, 1, 0)))
    pilot.feed(station.pack(mavlink.MAVLink_mission_set_current_message(1, 1, 4)))
    pilot.feed(station.pack(mavlink.MAVLink_mission_request_int_message(1, 1, 99, 0)))
    (frame,) = [each for each in pilot.frames() if each[7] == number]
    assert frame[1] in recorded_lengths("px4_inject", number)
