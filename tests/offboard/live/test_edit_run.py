"""One edit on its way: whose answers count."""

from __future__ import annotations

from avoidance import Waypoint
from offboard.edits import EditAction
from offboard.frames import MapFrame
from offboard.live.autopilots import rules_of
from offboard.live.edit_run import EditRun, Wanted
from offboard.live.limits import EditTimes
from offboard.live.messages import Ask, Reply
from offboard.live.telemetry import Telemetry
from offboard.mission import MissionItem, MissionPlan
from offboard.mission_list import MissionList
from offboard.raw_mission import RawMission, compose

FRAME = MapFrame(14.39, 76.60, 600.0)


class Link:
    """Numbers requests, and sends nothing."""

    def __init__(self):
        self.now = 0.0
        self.asked = []

    def wall(self):
        return self.now

    def upload(self, items, current):
        self.asked.append(Ask.UPLOAD)
        return len(self.asked)

    def ask(self, what, *values):
        self.asked.append(what)
        return len(self.asked)


def begun():
    link = Link()
    raw = RawMission.of_plan(
        MissionPlan.of([MissionItem(*FRAME.to_geodetic(n, 0.0), 200.0) for n in (0, 3000)])
    )
    mission = MissionList.of(raw.plan(600.0), FRAME, 15.0)
    wanted = Wanted(mission, compose(raw, mission, 0, FRAME), None, Waypoint(0.0, 0.0, 200.0), 0)
    run = EditRun(link, rules_of(12), wanted, wanted.composed.items, EditTimes(), FRAME)
    telemetry = Telemetry()
    assert run.work(telemetry) is EditAction.SEND
    run.reply(Reply(Ask.UPLOAD, 1, ok=True))
    assert run.work(telemetry) is EditAction.SELECT
    return link, run, telemetry


def test_the_late_failure_of_an_attempt_is_not_held_against_the_next():
    link, run, telemetry = begun()
    link.now = 3.5
    assert run.work(telemetry) is EditAction.SEND
    run.reply(Reply(Ask.SELECT, 2, ok=False, why="TIMEOUT"))
    assert run.work(telemetry) is EditAction.WAIT


def test_an_upload_that_mavsdk_is_too_busy_for_is_sent_again_in_the_same_attempt():
    link, run, telemetry = begun()
    link.now = 3.5
    assert run.work(telemetry) is EditAction.SEND
    run.reply(Reply(Ask.UPLOAD, 3, ok=False, why="BUSY"))
    assert run.work(telemetry) is EditAction.WAIT
    assert link.asked[2:] == [Ask.UPLOAD]
    link.now = 3.6
    assert run.work(telemetry) is EditAction.WAIT
    assert link.asked[2:] == [Ask.UPLOAD, Ask.UPLOAD]
    run.reply(Reply(Ask.UPLOAD, 4, ok=True))
    assert run.work(telemetry) is EditAction.SELECT


def test_a_refusal_of_the_attempt_under_way_counts_at_once():
    link, run, telemetry = begun()
    run.reply(Reply(Ask.SELECT, 2, ok=False, why="DENIED"))
    assert run.work(telemetry) is EditAction.SEND
    assert link.asked == [Ask.UPLOAD, Ask.SELECT, Ask.UPLOAD]
