"""What a live vehicle does when things go wrong: none leaves it on a colliding leg without an alarm."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from offboard.link import EditStatus
from offboard.sitl.modes import Task
from scenarios.scenario import Point
from tests.offboard.live.kit import SMALL, flying

BOTH = pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])


def fallen_back(autopilot):
    """The uploaded mission fits, one with a detour does not."""
    return flying(autopilot, most_items=4 + (autopilot == "ardupilot"))


def detours(vehicle) -> list:
    return [entry.waypoint for entry in vehicle.mission.entries if entry.injected]


def separation(frames) -> float:
    obstacle = SMALL.obstacles[0]
    places = [frame.steps[0].state.ownship for frame in frames]
    return min(math.hypot(own.north - obstacle.north, own.east - obstacle.east) for own in places)


@BOTH
def test_an_edit_is_flown_and_confirmed(autopilot):
    with flying(autopilot) as flight:
        frames = flight.fly(1000.0)
    assert flight.vehicle.finished
    assert [record.status for record in flight.vehicle.editor.records] == [EditStatus.CONFIRMED]
    assert separation(frames) > SMALL.obstacles[0].safety_radius
    assert flight.said("alarm") == ""


@BOTH
def test_a_human_wins_and_gives_back(autopilot):
    with flying(autopilot) as flight:
        flight.fly(20.0)
        flight.simulation.set_mode(Task.PILOT)
        flight.fly(40.0)
        taken = flight.said("alarm")
        assert "someone else flies" in taken
        assert "not flown" in taken  # the obstacle ahead: the human is told
        assert flight.vehicle.editor.records == []
        flight.simulation.set_mode(Task.MISSION)
        flight.fly(20.0)
    assert [record.status for record in flight.vehicle.editor.records] == [EditStatus.CONFIRMED]
    assert len(detours(flight.vehicle)) == 1


@BOTH
def test_a_lost_link_is_an_alarm_and_the_detour_follows_when_it_is_back(autopilot):
    with flying(autopilot) as flight:
        flight.fly(20.0)
        flight.simulation.silent = True
        flight.vehicle.aboard.session.patience = 0.002
        flight.fly(40.0)
        assert "the link is lost" in flight.said("alarm")
        assert "not flown, for the link is lost" in flight.said("alarm")
        flight.simulation.silent = False
        flight.vehicle.aboard.session.patience = 0.5
        flight.fly(20.0)
    assert flight.vehicle.link_losses == 1
    assert "the link is back" in flight.said("warning")
    assert len(detours(flight.vehicle)) == 1


@BOTH
def test_an_edit_that_the_link_loses_is_not_lost_silently(autopilot):
    with flying(autopilot) as flight:
        flight.fly(37.0)
        flight.simulation.silent = True
        flight.vehicle.aboard.session.patience = 0.002
        flight.fly(20.0)
        statuses = [record.status for record in flight.vehicle.editor.records]
    assert EditStatus.CONFIRMED not in statuses
    assert "the link is lost" in flight.said("alarm")


@BOTH
def test_a_restarted_autopilot_is_an_alarm_and_a_human_must_start_again(autopilot):
    with flying(autopilot) as flight:
        flight.fly(30.0)
        before = flight.vehicle.time
        flight.simulation.autopilot.restart()
        flight.fly(5.0)
        assert "restarted" in flight.said("alarm")
        assert flight.vehicle.time >= before  # our clock does not go back
        assert not flight.vehicle.watch.ours


@BOTH
def test_a_mission_changed_by_someone_else_is_taken_over(autopilot):
    with flying(autopilot) as flight:
        flight.fly(10.0)
        theirs = flight.simulation.mission()[:-2]
        flight.simulation.autopilot.load_mission(theirs[1:] if autopilot == "ardupilot" else theirs)
        flight.fly(8.0)
    assert "someone else has changed the mission" in flight.said("warning")
    assert len(flight.vehicle.mission.uploaded) == len(SMALL.mission) - 1


@BOTH
def test_a_mission_of_as_many_items_that_someone_else_puts_aboard_is_noticed(autopilot):
    """ArduPilot's total is the same, and it has no checksum: what it says when it takes a mission tells."""
    with flying(autopilot) as flight:
        flight.fly(10.0)
        theirs = list(flight.simulation.mission())
        theirs[-2] = replace(theirs[-2], x=theirs[-2].x + 20_000)
        flight.simulation.put_aboard(theirs)
        flight.fly(8.0)
        assert flight.said("warning").count("someone else has changed the mission") == 1
        moved = flight.vehicle.mission.uploaded[2].waypoint
        assert moved.north == pytest.approx(SMALL.mission[-1].north + 222.0, abs=3.0)
        flight.fly(60.0)
    assert [record.status for record in flight.vehicle.editor.records] == [EditStatus.CONFIRMED]
    assert flight.said("alarm") == ""


@BOTH
def test_a_mission_that_cannot_be_flown_is_an_alarm_and_the_watch_goes_on(autopilot):
    with flying(autopilot) as flight:
        flight.fly(10.0)
        theirs = list(flight.simulation.mission())
        theirs[-2:] = [replace(theirs[-2], z=float("nan"))]
        flight.simulation.put_aboard(theirs)
        flight.fly(8.0)
        assert "no edit can be made (the mission cannot be flown: item" in flight.said("alarm")
        assert flight.vehicle.watch.ours


@BOTH
def test_our_own_edits_are_nobody_else_s_mission(autopilot):
    with flying(autopilot) as flight:
        flight.fly(90.0)
    assert [record.status for record in flight.vehicle.editor.records] == [EditStatus.CONFIRMED]
    assert flight.said("warning") == ""


@BOTH
def test_an_edit_of_a_mission_of_three_hundred_items(autopilot):
    """More than fit into a byte, in the list as well as in the number of the item that is flown to."""
    long = replace(SMALL, mission=tuple(Point(60.0 * number, 0.0, 200.0) for number in range(300)))
    with flying(autopilot, long) as flight:
        assert flight.vehicle.performance.edit_time > 15.0  # a long list takes its time
        flight.vehicle.set_current_mission_item(258)
        flight.fly(60.0)
        assert [record.status for record in flight.vehicle.editor.records] == [EditStatus.CONFIRMED]
        assert len(detours(flight.vehicle)) == 1
        assert flight.vehicle.mission_progress().current == 258
        assert flight.simulation.autopilot.captain.current == 259 + (
            autopilot == "ardupilot"
        )  # an anchor first
    assert flight.said("alarm") == ""


@BOTH
def test_disarmed_in_flight_nothing_is_commanded(autopilot):
    with flying(autopilot) as flight:
        flight.fly(20.0)
        flight.simulation.force_disarm()
        flight.fly(4.0)
    assert "disarmed" in flight.said("alarm")
    assert not flight.vehicle.watch.ours


@BOTH
def test_a_refused_edit_falls_back_to_the_new_waypoint(autopilot):
    with fallen_back(autopilot) as flight:
        flight.fly(60.0)
        own = flight.vehicle.aboard.ownship()
    assert flight.vehicle.editor.fallbacks >= 1
    assert flight.vehicle.editor.records[0].status is EditStatus.REFUSED
    assert "refused an edit" in flight.said("alarm")
    assert abs(own.course) > math.radians(2.0)  # no longer towards the obstacle


@BOTH
def test_a_human_who_holds_while_we_have_fallen_back_wins(autopilot):
    with fallen_back(autopilot) as flight:
        flight.fly_until(lambda: flight.vehicle.editor.fallen_back, 60.0)
        flight.fly(2.0)
        flight.simulation.hold_here()
        flight.fly(30.0)
        assert "someone else has sent the vehicle" in flight.said("alarm")
        assert flight.vehicle.watch.human
        edits = len(flight.vehicle.editor.records)
        flight.fly(30.0)
        assert len(flight.vehicle.editor.records) == edits
        flight.simulation.set_mode(Task.MISSION)
        flight.fly(3.0)
    assert not flight.vehicle.watch.human
    assert "the mission is flown again" in flight.said("info")


@BOTH
def test_in_the_fall_back_another_mode_takes_over_as_the_alarm_says(autopilot):
    with fallen_back(autopilot) as flight:
        flight.fly_until(lambda: flight.vehicle.editor.fallen_back, 60.0)
        flight.fly(2.0)
        assert ("any mode but Hold takes over" in flight.said("alarm")) == (autopilot == "px4")
        flight.simulation.set_mode(Task.RETURN)
        flight.fly(3.0)
        assert flight.vehicle.watch.human
        edits = len(flight.vehicle.editor.records)
        flight.fly(20.0)
    assert len(flight.vehicle.editor.records) == edits


@BOTH
def test_a_human_s_hold_after_a_fall_back_that_was_never_flown_is_his(autopilot):
    """PX4's Hold is the mode that we have asked for, but it does not lead to our place."""
    with fallen_back(autopilot) as flight:
        flight.simulation.deaf_to = frozenset({192, 43000})
        flight.fly_until(lambda: flight.vehicle.editor.fallen_back, 60.0)
        assert not flight.vehicle.watch.human
        flight.simulation.set_mode(Task.HOLD)
        flight.fly(4.0)
        assert flight.vehicle.watch.human
        edits = len(flight.vehicle.editor.records)
        flight.fly(20.0)
        assert len(flight.vehicle.editor.records) == edits
    assert "nothing is commanded until the mission mode is back" in flight.said("alarm")


def test_px4_that_drops_our_edit_to_hold_is_retried_once_then_it_is_a_humans():
    with flying("px4") as flight:
        flight.fly(20.0)
        flight.simulation.autopilot.parameters.set("MIS_TKO_LAND_REQ", 2)
        flight.fly(60.0)
    assert flight.said("warning").count("our edit made the vehicle go to Hold") == 1
    assert "someone else flies" in flight.said("alarm") or flight.vehicle.editor.fallbacks >= 1


@BOTH
def test_a_dry_run_touches_nothing(autopilot):
    with flying(autopilot, touch=False) as flight:
        simulation = flight.simulation
        simulation.send_start()
        before = simulation.mission()
        flight.fly(60.0)
        assert simulation.mission() == before
    assert "(dry run)" in flight.said("info")
