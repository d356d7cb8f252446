"""What a vehicle tells of itself: what cannot be is not believed, and nothing that comes ends the watch."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from offboard.live.messages import Message
from offboard.live.telemetry import Telemetry

PLACE = {
    "lat": 143900000,
    "lon": 1799999000,
    "relative_alt": 200_000,
    "alt": 800_000,
    "vx": 1500,
    "vy": 0,
    "vz": 0,
}


def told(*changes):
    """Telemetry after a position each tenth of a second, some of its fields changed."""
    telemetry = Telemetry()
    for number, change in enumerate(changes):
        fields = {**PLACE, "time_boot_ms": 1000 + 100 * number, **change}
        telemetry.feed(Message("GLOBAL_POSITION_INT", fields, arrived=100.0 + 0.1 * number))
    return telemetry


@pytest.mark.parametrize("glitch", [{"lat": 244900000}, {"lon": 766000000}, {"lat": -890000000}])
def test_a_position_where_no_vehicle_can_have_come_to_is_left_out(glitch):
    telemetry = told({}, glitch, {})
    assert [fix.latitude_deg for fix in telemetry.fixes] == [14.39, 14.39]
    assert telemetry.restarts == 0


def test_one_that_stays_away_is_believed_once_it_could_have_come_there():
    there = {"lat": PLACE["lat"] + 450_000}  # 5 km off
    telemetry = told({}, *[there] * 100)
    assert telemetry.fix.latitude_deg == pytest.approx(14.435)
    assert telemetry.placed > 107.0


def test_on_the_other_side_of_the_date_line_is_near():
    assert told({}, {"lon": -1799999000}).fix.longitude_deg == pytest.approx(-179.9999)


def test_a_target_on_the_other_side_of_the_earth_is_none():
    telemetry = told({})
    target = {"lat_int": -143900000, "lon_int": -1000}
    telemetry.feed(Message("POSITION_TARGET_GLOBAL_INT", target))
    assert telemetry.target is None


VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**63), 2**64),
    st.floats(),
    st.text(max_size=5),
    st.lists(st.floats()),
)
FIELDS = (
    "lat", "lon", "relative_alt", "alt", "vx", "vy", "vz", "hdg", "time_boot_ms", "roll", "pitch", "yaw",
    "airspeed", "seq", "total", "mission_state", "mission_id", "lat_int", "lon_int", "landed_state",
    "severity", "text", "latitude", "longitude", "altitude", "battery_remaining", "autopilot",
    "custom_mode", "base_mode",
)  # fmt: skip


NAMES = st.sampled_from(sorted(Telemetry._TAKE))
CONTENTS = st.dictionaries(st.sampled_from(FIELDS), VALUES, max_size=12)


@settings(max_examples=150, deadline=None)
@given(st.lists(st.tuples(NAMES, CONTENTS), max_size=20))
def test_whatever_comes_nothing_ends_it_and_no_position_is_nowhere(messages):
    telemetry = told({})
    for name, fields in messages:
        base = PLACE if name == "GLOBAL_POSITION_INT" else {}
        telemetry.feed(Message(name, {**base, **fields}))
    fix = telemetry.fix
    assert all(map(math.isfinite, (fix.time, fix.latitude_deg, fix.longitude_deg, fix.altitude)))
    assert all(map(math.isfinite, (fix.velocity_north, fix.velocity_east, fix.climb_rate)))
    assert telemetry.attitude is None or math.isfinite(telemetry.attitude.yaw)
    assert not math.isinf(telemetry.airspeed)
