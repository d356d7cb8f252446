"""The vehicle's clock: what silence, standing still and unread messages do to it and to the own position."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise

import pytest

from avoidance import Performance
from offboard.frames import MapFrame
from offboard.live.aboard import Aboard
from offboard.live.autopilots import rules_of
from offboard.live.limits import EditTimes
from offboard.live.messages import Message
from offboard.live.telemetry import Telemetry
from offboard.live.vehicle_clock import VehicleClock

FRAME = MapFrame(14.39, 76.60, 600.0)
RADIUS, SPEED = 60.0, 15.0


def running(rate, until=6.0):
    """A clock that has been heard every tenth of a second."""
    clock = VehicleClock(100.0, 0.0)
    for tenth in range(1, round(until * 10) + 1):
        clock.heard(100.0 + rate * tenth / 10.0, tenth / 10.0)
    return clock, 100.0 + rate * until, until


def test_a_real_vehicle_s_time_goes_on_in_silence_and_fits_when_it_is_back():
    clock, newest, wall = running(1.0)
    clock.heard(newest, wall + 10.0)
    assert clock.now() == pytest.approx(14.0)
    clock.heard(newest + 10.5, wall + 10.5)
    assert clock.now() == pytest.approx(16.5)
    assert clock.ours(newest + 10.5) == pytest.approx(16.5)


def test_a_fast_simulation_that_stands_still_is_not_far_ahead():
    clock, newest, wall = running(20.0)
    before = clock.now()
    clock.heard(newest, wall + 3.0)
    assert clock.now() == pytest.approx(before + 1.0)


def test_after_standing_still_the_clock_goes_on_with_the_vehicle():
    clock, newest, wall = running(1.0)
    clock.heard(newest, wall + 12.0)
    shown = clock.now()
    clock.heard(newest + 0.1, wall + 12.1)
    clock.heard(newest + 1.1, wall + 13.1)
    assert clock.now() == pytest.approx(shown + 1.0)
    assert clock.ours(newest + 1.1) == pytest.approx(clock.now())


@dataclass
class Circling:
    """A vehicle that circles, the link to it, and whoever listens."""

    rate: float
    time: float = 100.0
    clock_on_wall: float = 0.0
    telemetry: Telemetry = field(default_factory=Telemetry)

    def __post_init__(self):
        self.tell()
        performance = Performance(SPEED, 0.5, 1.0, 100.0, 15.0)
        clock = VehicleClock(self.time, 0.0)
        self.aboard = Aboard(self, self.telemetry, rules_of(12), FRAME, performance, EditTimes(), {}, clock)

    def wall(self):
        return self.clock_on_wall

    def tell(self):
        angle = SPEED / RADIUS * self.time
        lat, lon = FRAME.to_geodetic(RADIUS * math.cos(angle), RADIUS * math.sin(angle))
        fields = {
            "time_boot_ms": round(1e3 * self.time),
            "lat": round(1e7 * lat),
            "lon": round(1e7 * lon),
            "relative_alt": 200_000,
            "alt": 800_000,
            "vx": round(-100.0 * SPEED * math.sin(angle)),
            "vy": round(100.0 * SPEED * math.cos(angle)),
            "vz": 0,
            "hdg": 0,
        }
        self.telemetry.feed(Message("GLOBAL_POSITION_INT", fields, arrived=self.clock_on_wall))

    def go_on(self, wall, *, stands=False, listening=True):
        """Let a tenth of a second of the wall's pass after the other; the own position at each."""
        found = []
        for _ in range(round(wall * 10)):
            self.clock_on_wall += 0.1
            if not stands:
                self.time += 0.1 * self.rate
                self.tell()
            if listening:
                self.aboard.clock.heard(self.telemetry.fix.time, self.clock_on_wall)
            own = self.aboard.ownship()
            found.append((own.time, own.north, own.east))
        return found

    def error(self):
        own, angle = self.aboard.ownship(), SPEED / RADIUS * self.time
        return math.hypot(own.north - RADIUS * math.cos(angle), own.east - RADIUS * math.sin(angle))


@pytest.mark.parametrize("rate", [1.0, 20.0])
def test_the_own_position_does_not_jump_when_a_simulation_stands_still(rate):
    vehicle = Circling(rate)
    vehicle.go_on(5.0)
    seen = vehicle.go_on(4.0, stands=True) + vehicle.go_on(3.0)
    jumps = [math.dist(a[1:], b[1:]) - SPEED * (b[0] - a[0]) for a, b in pairwise(seen)]
    assert max(jumps) < 2.1 * SPEED  # it was shown two seconds further on than it was
    assert vehicle.error() < 1.0
    assert all(a[0] <= b[0] for a, b in pairwise(seen))


def test_messages_that_nobody_has_read_yet_are_no_silence():
    vehicle = Circling(20.0)
    vehicle.go_on(5.0)
    before = vehicle.aboard.time
    vehicle.go_on(4.0, stands=True, listening=False)
    assert vehicle.aboard.time == before
    vehicle.go_on(0.1)
    assert vehicle.error() < 1.0
