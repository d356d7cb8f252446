"""The watch over a vehicle: who flies it, and whether it is heard and placed."""

from __future__ import annotations

import pytest

from offboard.live.autopilots import Mode, rules_of
from offboard.live.messages import Message
from offboard.live.telemetry import Telemetry
from offboard.live.watch import Seen, Watch

HEARTBEAT = {"autopilot": 12, "base_mode": 128, "custom_mode": 4 << 16 | 4 << 24}
PLACE = {"lat": 143900000, "lon": 766000000, "relative_alt": 0, "alt": 0, "vx": 0, "vy": 0, "vz": 0}


def seen(heartbeats, positions, until):
    """What a watch notices, second by second, of a vehicle heard and placed at such times [s]."""
    telemetry, watch = Telemetry(), Watch(rules_of(12), disarmed=False)
    found = []
    for now in range(until):
        if now in heartbeats:
            telemetry.feed(Message("HEARTBEAT", HEARTBEAT, arrived=now))
        if now in positions:
            fields = {**PLACE, "time_boot_ms": 1000 * (now + 1)}
            telemetry.feed(Message("GLOBAL_POSITION_INT", fields, arrived=now))
        found += [(now, what) for what in watch.look(telemetry, now, now)]
    return found


def test_a_vehicle_that_is_heard_but_tells_no_position_is_noticed_once():
    found = seen(range(30), {*range(10), *range(20, 30)}, 30)
    assert found == [(13, Seen.NO_POSITION), (20, Seen.POSITION_BACK)]


def test_a_lost_link_is_no_second_alarm_and_the_position_may_follow_the_first_heartbeat():
    heard = {*range(10), *range(20, 30)}
    found = seen(heard, heard - {20, 21}, 30)
    assert found == [(13, Seen.LINK_LOST), (20, Seen.LINK_BACK)]


MISSION, HOLD, MANUAL = 4 << 16 | 4 << 24, 4 << 16 | 3 << 24, 1 << 16


class Watched:
    """A PX4 that is heard once a second, and the watch over it."""

    def __init__(self):
        self.telemetry, self.watch = Telemetry(), Watch(rules_of(12), disarmed=False)
        self.time = 0.0

    def shows(self, mode, *, armed=True):
        """What is noticed when it shows a mode."""
        self.time += 1.0
        fields = {"autopilot": 12, "base_mode": 128 * armed, "custom_mode": mode}
        self.telemetry.feed(Message("HEARTBEAT", fields, arrived=self.time))
        self.telemetry.placed = self.time
        return self.watch.look(self.telemetry, self.time, self.time)


def test_a_hold_soon_after_our_edit_is_retried_once_and_then_a_human_s():
    one = Watched()
    assert one.shows(MISSION) == []
    one.watch.edited(one.time)
    assert one.shows(HOLD) == [Seen.DROPPED]
    one.watch.edited(one.time, again=True)
    assert one.shows(HOLD) == []  # the retry is on its way
    assert one.watch.ours
    assert one.shows(MISSION) == []
    assert one.shows(HOLD) == [Seen.TAKEN]
    assert not one.watch.ours


@pytest.mark.parametrize(("mode", "later"), [(MANUAL, 0), (HOLD, 3)], ids=["another mode", "too late"])
def test_any_other_change_is_a_human_s_until_the_mission_is_back(mode, later):
    one = Watched()
    one.shows(MISSION)
    one.watch.edited(one.time)
    for _ in range(later):
        one.shows(MISSION)
    assert one.shows(mode) == [Seen.TAKEN]
    assert one.shows(mode) == []
    assert one.shows(HOLD) == []
    assert one.shows(MISSION) == [Seen.GIVEN_BACK]
    assert one.watch.ours


def test_a_mode_that_we_have_asked_for_is_nobody_else_s():
    one = Watched()
    one.shows(MISSION)
    one.watch.expect(Mode.HOLD, Mode.MISSION)
    assert one.shows(MISSION) == []
    assert one.shows(HOLD) == []
    assert one.shows(MISSION) == [Seen.TAKEN]


def test_who_takes_it_in_the_mode_that_we_have_asked_for_keeps_it():
    one = Watched()
    one.shows(MISSION)
    one.watch.expect(Mode.HOLD, Mode.MISSION)
    one.shows(HOLD)
    one.watch.taken()
    assert one.shows(HOLD) == []
    assert not one.watch.ours
    assert one.shows(MISSION) == [Seen.GIVEN_BACK]


def test_disarmed_and_armed_are_noticed_once():
    one = Watched()
    one.shows(MISSION)
    assert one.shows(MISSION, armed=False) == [Seen.DISARMED]
    assert one.shows(MANUAL, armed=False) == []
    assert not one.watch.ours
    assert one.shows(MISSION) == [Seen.ARMED]


def test_a_mission_that_differs_for_a_moment_is_not_believed():
    watch = Watch(rules_of(12))
    found = [watch.mission_differs(wall != 2.0, wall) for wall in (0.0, 1.0, 2.0, 3.0, 4.0, 5.5, 6.0)]
    assert found == [False, False, False, False, False, True, False]
