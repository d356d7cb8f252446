from __future__ import annotations

import dataclasses
import math

import pytest

from offboard.mission import CameraAction, MissionItem, MissionPlan, VehicleAction

GOOD = MissionItem(14.39, 76.60, 200.0)


def test_fields_and_numbers_are_mavsdks() -> None:
    mission = pytest.importorskip("mavsdk.plugins.mission.mission", reason="mavsdk is not installed")

    theirs = mission.MissionItem()
    assert {field.name for field in dataclasses.fields(MissionItem)} == set(vars(theirs))
    for ours, name in ((CameraAction, "CameraAction"), (VehicleAction, "VehicleAction")):
        other = getattr(mission.MissionItem, name)
        assert {member.name: member.value for member in ours} == {m.name: m.value for m in other}


def test_a_plan_that_can_be_flown_passes() -> None:
    MissionPlan.of([GOOD, dataclasses.replace(GOOD, speed_m_s=15.0, loiter_time_s=0.0)]).check()


def test_an_empty_plan_is_refused() -> None:
    with pytest.raises(ValueError, match="mission_items is empty"):
        MissionPlan.of([]).check()


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("latitude_deg", 90.1),
        ("latitude_deg", math.nan),
        ("longitude_deg", -181.0),
        ("relative_altitude_m", math.inf),
        ("speed_m_s", 0.0),
        ("acceptance_radius_m", -5.0),
        ("loiter_time_s", -1.0),
        ("loiter_time_s", math.inf),
    ],
)
def test_a_bad_value_is_named_with_its_item(field: str, value: float) -> None:
    bad = dataclasses.replace(GOOD, **{field: value})

    with pytest.raises(ValueError, match=f"item 1: {field} = {value}, must be"):
        MissionPlan.of([GOOD, bad]).check()


def test_all_mistakes_are_told_at_once() -> None:
    bad = dataclasses.replace(GOOD, latitude_deg=99.0, speed_m_s=-1.0)

    with pytest.raises(ValueError, match=r"item 0: latitude_deg.*item 0: speed_m_s.*item 1: latitude_deg"):
        MissionPlan.of([bad, bad]).check()
