from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from offboard.errors import PlanFileError
from offboard.mission import CameraAction, MissionItem, MissionPlan, VehicleAction
from offboard.plan_files import PlanFile, rally_of, read_plan, write_plan

ITEMS = (
    MissionItem(14.39, 76.60, 100.0, vehicle_action=VehicleAction.TAKEOFF),
    MissionItem(14.57, 76.61, 200.0, speed_m_s=17.5, acceptance_radius_m=100.0),
    MissionItem(15.02, 76.66, 200.0, loiter_time_s=90.0),
    MissionItem(15.29, 76.70, 180.0, yaw_deg=45.0),
    MissionItem(15.40, 76.70, 0.0, vehicle_action=VehicleAction.LAND),
)
CONTENT = PlanFile(MissionPlan(ITEMS), 14.39, 76.60, 600.0, 15.0)


def write(tmp_path: Path) -> Path:
    file = tmp_path / "mission.plan"
    write_plan(file, CONTENT)
    return file


def changed(file: Path, change: Callable[[dict[str, Any]], object]) -> Path:
    """The file with a change made to its JSON."""
    document = json.loads(file.read_text())
    change(document)
    file.write_text(json.dumps(document))
    return file


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    again = read_plan(write(tmp_path))

    assert repr(again) == repr(CONTENT)  # repr: NaN is not equal to itself


def test_the_file_has_all_that_qgroundcontrol_asks_for(tmp_path: Path) -> None:
    document = json.loads(write(tmp_path).read_text())

    assert {"fileType", "version", "groundStation", "mission", "geoFence", "rallyPoints"} <= set(document)
    mission = document["mission"]
    required = {"plannedHomePosition", "items", "firmwareType", "vehicleType", "cruiseSpeed", "hoverSpeed"}
    assert required < set(mission)
    assert mission["plannedHomePosition"] == [14.39, 76.60, 600.0]
    assert [item["doJumpId"] for item in mission["items"]] == [1, 2, 3, 4, 5, 6]
    assert [item["command"] for item in mission["items"]] == [22, 16, 178, 19, 16, 21]
    for item in mission["items"]:
        assert item["type"] == "SimpleItem"
        assert item["autoContinue"] is True
        assert len(item["params"]) == 7
        if item["command"] != 178:
            assert (item["frame"], item["AltitudeMode"]) == (3, 1)
            assert item["params"][6] == item["Altitude"]
            assert item["AMSLAltAboveTerrain"] is None


def test_no_file_is_left_behind_by_a_plan_that_cannot_be_written(tmp_path: Path) -> None:
    photo = MissionItem(14.39, 76.60, 100.0, camera_action=CameraAction.TAKE_PHOTO)
    infinite = PlanFile(MissionPlan(ITEMS), 14.39, 76.60, math.inf, 15.0)

    with pytest.raises(PlanFileError, match=r"a\.plan: item 1: camera_action") as error:
        write_plan(tmp_path / "a.plan", PlanFile(MissionPlan((ITEMS[0], photo)), 14.39, 76.60, 0.0, 15.0))
    with pytest.raises(PlanFileError, match="cannot be written"):
        write_plan(tmp_path / "b.plan", infinite)
    with pytest.raises(PlanFileError, match="cannot be written"):
        write_plan(tmp_path / "nowhere" / "c.plan", CONTENT)

    assert error.value.item == 1
    assert list(tmp_path.iterdir()) == []


def test_altitudes_above_sea_level_and_old_coordinates_are_understood(tmp_path: Path) -> None:
    def change(document: dict[str, Any]) -> None:
        item = document["mission"]["items"][1]
        item["frame"] = 0
        item["coordinate"] = [*item["params"][4:6], 850.0]
        item["params"] = item["params"][:4]

    item = read_plan(changed(write(tmp_path), change)).plan.mission_items[1]

    assert (item.latitude_deg, item.relative_altitude_m) == (14.57, 250.0)


def test_a_speed_before_the_first_item_is_the_cruise_speed(tmp_path: Path) -> None:
    def change(document: dict[str, Any]) -> None:
        items = document["mission"]["items"]
        items.insert(0, items[2])

    assert read_plan(changed(write(tmp_path), change)).cruise_speed_m_s == 17.5


def set_item(index: int, **values: object) -> Callable[[dict[str, Any]], object]:
    return lambda document: document["mission"]["items"][index].update(values)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.update(fileType="Waypoints"), r'fileType must be "Plan"'),
        (lambda d: d.update(version=2), "version = 2, must be 1"),
        (lambda d: d["mission"].update(version=1), "version is not 2"),
        (lambda d: d["mission"].pop("items"), r"mission\.items is missing"),
        (lambda d: d["mission"].update(items=[]), "holds nothing to fly to"),
        (lambda d: d["mission"].update(plannedHomePosition=[1.0]), "plannedHomePosition = .*3 numbers"),
        (lambda d: d["geoFence"].update(circles=[{}]), "geoFence: a circle has no centre"),
        (lambda d: d["geoFence"].update(polygons=[{"polygon": [[1, 2]]}]), "at least 3 corners"),
        (set_item(1, type="ComplexItem", complexItemType="survey"), "item 1: type = survey"),
        (set_item(3, command=205), "item 3: command = 205 cannot be flown"),
        (set_item(4, frame=10), "item 4: frame = 10"),
        (set_item(1, params=[0, 0, 0, "x", 14.0, 76.0, 200.0]), "item 1: params"),
        (set_item(1, params=[0, 0, 0, None, 14.0, None, 200.0]), "item 1: longitude_deg = nan"),
        (set_item(1, params=[0, 0, 0, None, 94.0, 76.0, 200.0]), "item 1: latitude_deg = 94"),
        (set_item(4, params=[0, 0, 0, None, 94.0, 76.0, 200.0]), "item 4: latitude_deg = 94"),
        (set_item(2, params=[0, -2, -1, 0, 0, 0, 0]), "item 2: speed = -2.0, must be above 0"),
        (set_item(1, command="waypoint"), "item 1: command = waypoint"),
    ],
)
def test_faults_are_named_with_file_and_item(
    tmp_path: Path, change: Callable[[dict[str, Any]], object], message: str
) -> None:
    file = changed(write(tmp_path), change)

    with pytest.raises(PlanFileError, match=message) as error:
        read_plan(file)
    assert str(error.value).startswith(str(file))


def test_what_is_no_json_or_not_there_is_said_so(tmp_path: Path) -> None:
    file = tmp_path / "broken.plan"
    file.write_text('{"fileType": "Plan",\n "version": }')

    with pytest.raises(PlanFileError, match=r"is not JSON: .* in line 2"):
        read_plan(file)
    with pytest.raises(PlanFileError, match="cannot be read"):
        read_plan(tmp_path / "absent.plan")


@pytest.mark.parametrize("place", [[200.0, 76.6, 60.0], [14.4, -181.0, 60.0], [14.4, 76.6, float("nan")]])
def test_rally_points_that_are_nowhere_are_told(tmp_path: Path, place: list[float]) -> None:
    with pytest.raises(PlanFileError, match=r"rallyPoints = .*latitude"):
        rally_of(tmp_path / "m.plan", {"version": 2, "points": [place]})
