"""The live vehicle in front of recordings of PX4 and of ArduPlane: what they did, and what we make of it."""

from __future__ import annotations

import contextlib
import math

import pytest

from avoidance import Detour, Waypoint
from offboard.link import EditStatus
from offboard.live.lockstep import connect_in_step
from offboard.live.starting import open_vehicle
from offboard.raw_mission import RawItem, RawMission
from tests.offboard.live.recorded import Recorded
from tests.offboard.sitl.recording import FOLDER

pytestmark = pytest.mark.skipif(
    not FOLDER.is_dir(), reason="recordings of real autopilots lie beside the repository, not in it"
)


@contextlib.contextmanager
def watching(name, begin, *, gates=True, adopt=True):
    """A vehicle on its recorded mission, in flight."""
    peer = Recorded(name, begin, gates=gates)
    with contextlib.closing(connect_in_step(peer, 0.1)) as session:
        vehicle = open_vehicle(session)
        if adopt:
            vehicle.adopt_mission()
        yield peer, vehicle


def sent(peer):
    """The first mission that the recorded ground station has sent, as it did."""
    return [
        RawItem(i.command, i.frame, (i.param1, i.param2, i.param3, i.param4), i.x, i.y, i.z)
        for i in peer.sent[0]
    ]


def wait_for(vehicle, ready, seconds=30.0):
    assert vehicle.wait_for(ready, seconds)


def inject(peer, vehicle):
    """The recorded edit, as ours: the waypoint that the recorded ground station put in, when it did."""
    wait_for(vehicle, lambda: peer.waits)
    upload = peer._uploads[peer._next]
    item = upload.items[upload.flagged]
    north, east = vehicle.aboard.frame.to_map(item.x / 1e7, item.y / 1e7)
    new = Waypoint(north, east, item.z)
    vehicle.begin(Detour(why="as recorded", route=(new, *vehicle.route().waypoints), waypoint=new))
    return new


def said(vehicle, severity):
    return "\n".join(event.text for event in vehicle.aboard.events if event.severity == severity)


def done(vehicle):
    return lambda: bool(vehicle.editor.records)


@pytest.mark.parametrize(("name", "begin"), [("px4_inject", 46.0), ("ardupilot_inject", 51.0)])
def test_an_edit_is_confirmed_flown_and_passed(name, begin):
    with watching(name, begin) as (peer, vehicle):
        new = inject(peer, vehicle)
        wait_for(vehicle, done(vehicle), 5.0)
        assert vehicle.editor.records[0].status is EditStatus.CONFIRMED
        assert vehicle.route().waypoints[0] == new
        wait_for(vehicle, lambda: vehicle.route().waypoints[0] != new, 40.0)
        assert vehicle.route().waypoints[0].item is not None  # it has passed it, and flies on
        assert said(vehicle, "alarm") == ""
        assert not vehicle.editor.busy  # its ground track was seen to fit


def test_px4_that_finds_the_mission_infeasible_is_told_once_more_and_flies():
    with watching("px4_infeasible_hold", 46.0) as (peer, vehicle):
        inject(peer, vehicle)
        wait_for(vehicle, lambda: EditStatus.CONFIRMED in [r.status for r in vehicle.editor.records], 20.0)
        vehicle.wait_until(vehicle.time + 3.0)
        statuses = [record.status for record in vehicle.editor.records]
        assert statuses[-1] is EditStatus.CONFIRMED
        assert len(statuses) == 2
        assert "our edit made the vehicle go to Hold" in said(vehicle, "warning")
        assert "PX4: No valid mission available, loitering" in said(vehicle, "warning")
        assert vehicle.watch.ours


def test_arduplane_that_flies_on_towards_its_old_target_is_not_taken_for_flying_the_edit():
    """The list was taken and the item's number fits, before and after: the target tells."""
    with watching("ardupilot_flag_ignored", 51.0) as (peer, vehicle):
        inject(peer, vehicle)
        begun = vehicle.time
        wait_for(vehicle, done(vehicle), 20.0)
        assert vehicle.editor.records[0].status is EditStatus.TIMED_OUT
        assert vehicle.time - begun == pytest.approx(vehicle.aboard.times.attempt * 2, abs=1.0)
        assert "did not confirm an edit" in said(vehicle, "alarm")


@pytest.mark.parametrize(("name", "begin"), [("px4_mission_plugin", 47.0), ("ardupilot_inject", 51.0)])
def test_a_mission_that_someone_else_puts_aboard_is_taken_over(name, begin):
    with watching(name, begin, gates=False) as (_, vehicle):
        before = len(vehicle.mission.uploaded)
        wait_for(vehicle, lambda: "someone else has changed" in said(vehicle, "warning"), 20.0)
        wait_for(vehicle, lambda: len(vehicle.mission.uploaded) != before, 5.0)
        assert len(vehicle.mission.uploaded) == before + 1
        assert said(vehicle, "alarm") == ""


def test_arduplane_that_has_swallowed_the_first_waypoint_for_home_is_seen_as_it_is():
    """Somebody else's upload without a home: its first item became home, and nobody was told."""
    with watching("ardupilot_home_swallowed", 31.0, gates=False) as (peer, vehicle):
        wanted = RawMission.of(sent(peer))
        assert len(wanted.flown_to) == 3
        assert not vehicle.has_mission(wanted)  # a dry run of it is refused
        assert vehicle.has_mission(RawMission.of(wanted.items[1:]))
        first, second = vehicle.route().waypoints
        assert (first.north, first.east) == pytest.approx((800.0, 600.0), abs=2.0)
        wait_for(vehicle, lambda: vehicle.route().waypoints[0] == second, 60.0)
        own = vehicle.aboard.ownship()
        assert math.hypot(own.north - first.north, own.east - first.east) < 90.0
        assert said(vehicle, "alarm") == ""
        assert not vehicle.editor.busy  # it was seen to fly where the list says


def test_what_we_put_aboard_of_that_mission_begins_with_home():
    """The same waypoints as ours: the list that goes out has one item more, and all of them are flown to."""
    with watching("ardupilot_home_swallowed", 29.0, adopt=False) as (peer, vehicle):
        wait_for(vehicle, lambda: peer.waits)
        wanted = RawMission.of(sent(peer))
        vehicle.upload_raw(wanted)
        home, *rest = peer.items
        assert (home.x, home.y) == pytest.approx((473977419, 85455940), abs=20)
        assert [(item.x, item.y) for item in rest] == [(item.x, item.y) for item in wanted.items]
        assert vehicle.has_mission(wanted)
