"""When a flight was outside its geofence, and where the fence goes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from offboard.geofence import FenceType
from offboard.plan_files import read_plan
from scenarios.errors import ScenarioError
from scenarios.fence import FenceArea, allowed, breaches
from scenarios.load import parse
from scenarios.record import write_run
from scenarios.recorded import differences, read_run
from scenarios.report import write_report
from scenarios.toml_text import to_toml
from scenarios.track import Track
from tests.scenarios.flights import flown

BOX = FenceArea(True, corners=((0.0, -500.0), (1000.0, -500.0), (1000.0, 500.0), (0.0, 500.0)))
HOLE = FenceArea(False, centre=(500.0, 0.0), radius=100.0)
FENCED = """
mission = [{north_m = 0.0, east_m = 0.0}, {north_m = 3000.0, east_m = 0.0}]
[vehicle]
fidelity = "kinematic"
[[geofence]]
type = "include"
polygon = [{north_m = -900.0, east_m = -900.0}, {north_m = 9000.0, east_m = -900.0},
    {north_m = 9000.0, east_m = 900.0}, {north_m = -900.0, east_m = 900.0}]
[[geofence]]
type = "exclude"
centre = {north_m = 1500.0, east_m = 0.0}
radius_m = 300.0
"""


def line(*points) -> Track:
    positions = np.array([(north, east, 200.0) for north, east in points])
    still = np.zeros(len(points))
    return Track("own", np.arange(float(len(points))), positions, still, still, still)


@pytest.mark.parametrize(
    ("track", "outside"),
    [
        (line((200, 0), (300, 0)), []),
        (line((100, 0), (900, 0)), [(0.375, 0.625)]),  # through the hole between two samples
        (line((100, 100.5), (900, 100.5)), []),
        (line((500, 0), (500, 400)), [(0.0, 0.25)]),  # begins in the hole
        (line((900, 0), (1100, 0), (1100, 200), (900, 200)), [(0.5, 2.5)]),  # one time, not three
        (line((900, 400), (1100, 400), (900, 400)), [(0.5, 1.5)]),
    ],
)
def test_times_outside(track, outside):
    assert breaches(track, (BOX, HOLE)) == [pytest.approx(pair) for pair in outside]


def test_inside_one_of_several_is_enough_and_no_fence_allows_all():
    other = replace(BOX, corners=tuple((north + 900.0, east) for north, east in BOX.corners))
    assert breaches(line((100, 0), (1800, 0)), (BOX, other)) == []
    assert breaches(line((100, 0), (1e6, 0)), ()) == []


coordinate = st.floats(-1500.0, 1500.0)


@given(st.lists(st.tuples(coordinate, coordinate), min_size=2, max_size=4))
def test_agrees_with_sampling(points):
    found = breaches(line(*points), (BOX, HOLE))
    times = np.linspace(0.0, len(points) - 1.0, 2000)
    samples = np.column_stack(
        [np.interp(times, range(len(points)), axis) for axis in zip(*points, strict=True)]
    )
    share = float(np.mean(~allowed((BOX, HOLE), samples)))
    assert sum(end - begin for begin, end in found) == pytest.approx(
        share * times[-1], abs=0.01 * len(points)
    )


def test_a_fence_survives_its_file_and_mistakes_are_told():
    scenario = parse(FENCED)
    assert parse(to_toml(scenario), "scenario") == scenario
    with pytest.raises(ScenarioError, match="polygon, or centre and radius_m"):
        parse(FENCED.replace("radius_m = 300.0", ""))
    with pytest.raises(ScenarioError, match="waypoint 2 lies outside the geofence"):
        parse(FENCED.replace("north_m = 3000.0", "north_m = 1600.0"))
    with pytest.raises(ScenarioError, match="waypoints 1, 2 lie outside the geofence"):
        parse(FENCED.replace("radius_m = 300.0", "radius_m = 30000.0"))
    rally = "\n[[rally]]\nnorth_m = 30000.0\neast_m = 0.0\naltitude_m = 200.0\n"
    with pytest.raises(ScenarioError, match="rally #1: lies outside the geofence"):
        parse(FENCED + rally)
    corners = "polygon = [" + ", ".join(f"{{north_m = {n}.0, east_m = {2 * n}.0}}" for n in (0, 7, 9)) + "]"
    thin = FENCED.replace("centre = {north_m = 1500.0, east_m = 0.0}", corners).replace(
        "radius_m = 300.0", ""
    )
    with pytest.raises(ScenarioError, match="geofence #2, polygon: encloses nothing"):
        parse(thin)
    globe = FENCED.replace(
        "centre = {north_m = 1500.0, east_m = 0.0}", "centre = {latitude_deg = 14.4, longitude_deg = 76.6}"
    )
    assert parse(globe).geofence[1].centre == pytest.approx((1106.0, 0.0), abs=5.0)


def test_a_breach_is_judged_recorded_drawn_and_in_the_plan(tmp_path):
    result, judged = flown(parse(FENCED), avoidance=False)
    assert judged.summary["fence_breaches"] == 1
    assert judged.summary["outside_fence_s"] == pytest.approx(40.0, abs=0.1)
    assert not judged.safe
    write_run(tmp_path / "run", result, judged, write_report)
    assert differences(read_run(tmp_path / "run")) == []
    fence = read_plan(tmp_path / "run" / "mission.plan").geofence
    assert [len(p.points) for p in fence.polygons] == [4]
    assert [(c.radius_m, c.fence_type) for c in fence.circles] == [(300.0, FenceType.EXCLUSION)]
    page = (tmp_path / "run" / "report.html").read_text()
    assert "The geofence was left" in page
