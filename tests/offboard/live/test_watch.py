"""The watch over a vehicle: when it is heard, but tells no position."""

from __future__ import annotations

from offboard.live.autopilots import rules_of
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
