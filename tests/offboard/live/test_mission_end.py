"""When the watch ends: not before the vehicle has come to its last waypoint."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest

from avoidance import Performance
from offboard.frames import MapFrame
from offboard.live.autopilots import rules_of
from offboard.live.facts import MissionShown
from offboard.live.mission_end import at_end, end_radius
from offboard.mission import MissionItem, MissionPlan
from offboard.mission_list import MissionList
from offboard.raw_mission import LOITER_UNLIMITED, RawItem, RawMission, compose

FRAME = MapFrame(14.39, 76.60, 600.0)
RAW = RawMission.of_plan(
    MissionPlan.of([MissionItem(*FRAME.to_geodetic(north, 0.0), 200.0) for north in (0.0, 3000.0, 6000.0)])
)
MISSION = MissionList.of(RAW.plan(600.0), FRAME, 15.0)


def flying(north, current, reached, state=3, **parameters):
    """A PX4 on the way north, with what it shows."""
    return SimpleNamespace(
        telemetry=SimpleNamespace(mission=MissionShown(current, 4, state), reached=reached),
        rules=rules_of(12),
        performance=Performance(15.0, 0.5, 1.0, 100.0, 15.0),
        parameters=parameters,
        ownship=lambda: SimpleNamespace(north=north, east=0.0),
    )


@pytest.mark.parametrize(
    ("north", "current", "reached", "state", "over"),
    [
        (5950.0, 2, 1, 3, False),
        (5950.0, 2, 2, 3, True),
        (3500.0, 2, 2, 3, False),  # said of another item, in a list that was longer
        (5950.0, 3, 2, 3, True),  # it circles at the end
        (5950.0, 2, 1, 5, True),
    ],
)
def test_the_end_is_where_the_last_waypoint_is(north, current, reached, state, over):
    composed = compose(RAW, MISSION, 0, FRAME)
    assert at_end(flying(north, current, reached, state), MISSION, composed) == over


@pytest.mark.parametrize(("given", "metres"), [(math.nan, 103.0), (0.0, 103.0), (-200.0, 235.0)])
def test_a_circle_of_no_radius_is_as_wide_as_the_vehicle_s_parameter_says(given, metres):
    last = RawItem(LOITER_UNLIMITED, 6, (0.0, 0.0, given, 0.0))
    assert end_radius(flying(0.0, 0, 0, NAV_LOITER_RAD=80.0), last) == pytest.approx(metres)
