"""Mission files without loss: what a `.plan` or WPL file holds is there after a round trip."""

from __future__ import annotations

import json
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from offboard.errors import PlanFileError
from offboard.mission_files import MissionFile, lost_in_wpl, read_mission_file, write_mission_file
from offboard.plan_items import FileItem

PLAN = {
    "fileType": "Plan",
    "version": 1,
    "groundStation": "QGroundControl",
    "somethingNew": {"kept": [1, None, "x"]},
    "mission": {
        "version": 2,
        "firmwareType": 12,
        "vehicleType": 1,
        "cruiseSpeed": 18,
        "plannedHomePosition": [14.39, 76.6, 600],
        "items": [
            {
                "type": "SimpleItem",
                "command": 22,
                "frame": 3,
                "params": [15, 0, 0, None, 14.391, 76.6, 50],
                "autoContinue": True,
                "doJumpId": 1,
            },
            {
                "type": "SimpleItem",
                "command": 206,  # camera trigger distance: unknown to us
                "frame": 2,
                "params": [25, 0, 1, 0, 0, 0, 0],
                "autoContinue": True,
                "doJumpId": 2,
            },
            {
                "type": "ComplexItem",
                "complexItemType": "survey",
                "TransectStyleComplexItem": {
                    "Items": [
                        {
                            "type": "SimpleItem",
                            "command": 16,
                            "frame": 3,
                            "params": [0, 0, 0, None, 14.4, 76.61, 80],
                            "autoContinue": True,
                            "doJumpId": 3,
                        }
                    ]
                },
            },
            {
                "type": "ComplexItem",
                "complexItemType": "fwLandingPattern",
                "landingApproachCoordinate": [14.40, 76.62, 40],
                "landCoordinate": [14.39, 76.62, 0],
                "loiterRadius": 80,
                "loiterClockwise": False,
                "altitudesAreRelative": True,
            },
        ],
    },
    "geoFence": {
        "version": 2,
        "polygons": [],
        "circles": [{"version": 1, "inclusion": True, "circle": {"center": [14.39, 76.6], "radius": 9000.0}}],
    },
    "rallyPoints": {"version": 2, "points": [[14.38, 76.6, 60]]},
}


@pytest.fixture
def plan(tmp_path):
    file = tmp_path / "a.plan"
    file.write_text(json.dumps(PLAN))
    return file


def test_a_plan_is_written_as_it_was_read(plan, tmp_path):
    content = read_mission_file(plan)
    write_mission_file(tmp_path / "b.plan", content)
    assert json.loads((tmp_path / "b.plan").read_text()) == PLAN


def test_a_plan_is_sent_as_all_its_items(plan):
    content = read_mission_file(plan)
    assert [item.command for item in content.items] == [22, 206, 16, 189, 31, 21]
    assert content.items[4].params[1] == -80.0  # to the left
    assert content.rally == ((14.38, 76.6, 60.0),)
    assert content.geofence.circles[0].radius_m == 9000.0
    mission = content.mission()
    assert [mission.items[i].command for i in mission.flown_to] == [22, 16, 31, 21]
    assert (mission.items[2].x, mission.items[2].frame) == (144000000, 6)


def test_a_plan_as_wpl_keeps_every_item_and_names_what_it_loses(plan, tmp_path):
    content = read_mission_file(plan)
    write_mission_file(tmp_path / "b.waypoints", content)
    again = read_mission_file(tmp_path / "b.waypoints")
    assert repr(again.items) == repr(content.items)  # NaN is not equal to itself
    assert again.home == content.home
    assert lost_in_wpl(content) == ["the geofence", "the rally points"]


finite = st.floats(-1e6, 1e6, width=32) | st.just(math.nan)
items = st.builds(
    FileItem,
    command=st.integers(0, 300),
    frame=st.sampled_from([0, 2, 3, 6, 10]),
    params=st.tuples(
        finite, finite, finite, finite, st.floats(-90, 90), st.floats(-180, 180), st.floats(-9, 9000)
    ),
    autocontinue=st.booleans(),
)


@settings(max_examples=40, deadline=None)
@given(st.lists(items, min_size=1, max_size=8), st.sampled_from([".plan", ".waypoints"]))
def test_any_items_survive_the_round_trip(tmp_path_factory, some, suffix):
    folder = tmp_path_factory.mktemp("files")
    content = MissionFile(tuple(some), (14.39, 76.6, 600.0))
    write_mission_file(folder / f"a{suffix}", content)
    again = read_mission_file(folder / f"a{suffix}")
    assert repr(again.items) == repr(content.items)
    write_mission_file(folder / f"b{suffix}", again)
    assert (folder / f"b{suffix}").read_text() == (folder / f"a{suffix}").read_text()


WPL = "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t14.39\t76.6\t600\t1\n"


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("QGC WPL 120\n", "must be 'QGC WPL 110'"),
        (WPL + "1\t0\t3\t16\t0\t0\t0\n", "item 1: has 7 columns"),
        (WPL + "2\t0\t3\t16\t0\t0\t0\t0\t14.4\t76.6\t200\t1\n", "item 1: is numbered 2"),
        (WPL + "1\t0\t3\t16\t0\t0\t0\t0\tx\t76.6\t200\t1\n", "item 1: .* no number"),
        (WPL + "1\t0\t3\t16\t0\t0\t0\t0\t94.4\t76.6\t200\t1\n", "item 1: latitude_deg = 94.4"),
        (WPL + "1\t0\t3\t16\t0\t0\tinf\t0\t14.4\t76.6\t200\t1\n", "item 1: holds an infinite"),
    ],
)
def test_what_is_wrong_with_a_wpl_file_is_said_with_the_item(tmp_path, text, problem):
    file = tmp_path / "a.waypoints"
    file.write_text(text)
    with pytest.raises(PlanFileError, match=problem):
        read_mission_file(file)


def test_an_unknown_complex_item_is_refused_with_its_index(plan):
    document = json.loads(plan.read_text())
    document["mission"]["items"][2] = {"type": "ComplexItem", "complexItemType": "origami"}
    plan.write_text(json.dumps(document))
    with pytest.raises(PlanFileError, match=r"item 2: complexItemType = origami"):
        read_mission_file(plan)
