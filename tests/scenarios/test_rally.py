"""Rally points: from a scenario or a plan file to the core, and back into files."""

from __future__ import annotations

import pytest

from offboard.frames import MapFrame
from offboard.mission_files import read_mission_file
from offboard.plan_files import read_plan
from scenarios.load import load
from scenarios.plan_convert import convert, scenario_of_file
from scenarios.rally import core_rally, rally_data, rally_points
from scenarios.scenario import Point

TEXT = """
home = {latitude_deg = 14.39, longitude_deg = 76.6, altitude_m = 600.0}
mission = [{north_m = 0, east_m = 0, altitude_m = 150}, {north_m = 5000, east_m = 0, altitude_m = 180}]

[[rally]]
north_m = 1000.0
east_m = -2000.0
altitude_m = 90.0

[[rally]]
latitude_deg = 14.40
longitude_deg = 76.61
"""


@pytest.fixture
def scenario(tmp_path):
    file = tmp_path / "with-rally.toml"
    file.write_text(TEXT)
    return load(file)


def test_a_rally_point_without_an_altitude_has_that_of_the_highest_waypoint(scenario):
    assert scenario.rally[0] == Point(1000.0, -2000.0, 90.0)
    assert scenario.rally[1].altitude == 180.0
    assert [point.altitude for point in core_rally(scenario.rally)] == [90.0, 180.0]


def test_to_a_plan_and_back_they_are_the_same(scenario, tmp_path):
    (tmp_path / "again.toml").write_text(TEXT)
    assert convert(str(tmp_path / "again.toml"), tmp_path / "m.plan") == []
    content = read_mission_file(tmp_path / "m.plan")
    back = scenario_of_file(content, "m")
    for one, other in zip(back.rally, scenario.rally, strict=True):
        assert (one.north, one.east, one.altitude) == pytest.approx(
            (other.north, other.east, other.altitude), abs=0.01
        )
    assert read_plan(tmp_path / "m.plan").rally == content.rally


def test_to_toml_and_back_they_are_the_same(scenario, tmp_path):
    convert(str(tmp_path / "with-rally.toml"), tmp_path / "again.toml")
    assert load(tmp_path / "again.toml").rally == scenario.rally


def test_the_map_and_the_globe():
    frame = MapFrame(14.39, 76.6, 600.0)
    points = (Point(1000.0, -2000.0, 90.0),)
    assert rally_points(rally_data(points, frame), frame) == points
