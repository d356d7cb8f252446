"""Scenario files: what is accepted, and what is said of mistakes."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from scenarios.errors import ScenarioError
from scenarios.load import catalogue_names, load, parse
from scenarios.scenario import Scenario, scatter, streams
from scenarios.toml_text import to_toml

MISSION = """
[[mission]]
north_m = 0.0
east_m = 0.0
[[mission]]
north_m = 10000.0
east_m = 0.0
"""


def complaints(text: str) -> str:
    with pytest.raises(ScenarioError) as caught:
        parse(text, "mine.toml")
    assert str(caught.value).startswith("mine.toml: ")
    return str(caught.value)


def test_default_scenario_is_the_paper_s_table_4():
    """Sec. 5.1 with the misprints of WP2 and WP3 put right, and the obstacles of Table 4."""
    scenario = load("table4")
    legs = [
        math.dist((a.north, a.east), (b.north, b.east))
        for a, b in zip(scenario.mission, scenario.mission[1:], strict=False)
    ]
    assert sum(legs) == pytest.approx(431_633.19, abs=0.01)  # SPEC: the legs sum to 431,633 m (Tables 3, 4)
    assert [(o.north, o.east, o.safety_radius) for o in scenario.obstacles] == [
        (60000, 7000, 1000),
        (135000, 12000, 1000),
        (290400, 17300, 1000),
        (290200, 17400, 1000),
        (290000, 17500, 1000),
    ]
    assert (scenario.home.latitude_deg, scenario.home.longitude_deg) == (14.39, 76.60)
    assert scenario.limit == pytest.approx(2 * 431_633.19 / 15.0, abs=0.01)


def test_catalogue_holds_the_scenarios_of_the_first_flight():
    assert catalogue_names()[0] == "table4"
    assert {"clear", "single", "four", "hill", "random"} <= set(catalogue_names())


@pytest.mark.parametrize("name", catalogue_names())
def test_catalogue_loads_describes_itself_and_survives_writing(name: str):
    scenario = load(name)
    assert scenario.name == name
    assert scenario.description
    assert parse(to_toml(scenario)) == scenario


def test_everything_survives_writing():
    text = """
    name = "all"
    description = "quotes \\" and \\\\ and ü and 😀 and \\u007f"
    start_time_utc = 2021-06-01T12:00:00+02:00
    time_limit_s = 5000.0
    obstacles = [{id = 7, latitude_deg = 14.45, longitude_deg = 76.6, kind = "mast", appears_at_s = 30.0}]
    wind = {north_m_s = 3.0, east_m_s = -4.0, turbulence = "light"}
    radar = {range_m = 8000.0, range_noise_m = 50.0, bearing_noise_deg = 1.0, field_of_view_deg = 120.0}
    vehicle = {fidelity = "kinematic", airspeed_m_s = 16.0, acceptance_radius_m = 50.0, heading_deg = 20.0}
    random = {count = 3}
    [[traffic]]
    speed_m_s = 40.0
    motion = "point"
    violation_radius_m = 500.0
    starts_at_s = 1.0
    waypoints = [{north_m = 9000.0, east_m = 1.5}, {north_m = 0.0, east_m = 3.0, altitude_m = 150.0}]
    """
    scenario = parse(text + MISSION)
    assert parse(to_toml(scenario)) == scenario
    drawn = scatter(scenario, streams(1)["world"])
    assert parse(to_toml(drawn)) == drawn
    assert scenario.start_time_utc.isoformat() == "2021-06-01T10:00:00+00:00"
    assert {o.id for o in drawn.obstacles} == {2, 3, 4, 7}  # 7 was given, and 1 went to the traffic


def test_defaults_are_enough_for_a_bare_mission():
    scenario = parse(MISSION, "bare.toml")
    assert (scenario.name, scenario.obstacles, scenario.wind.speed) == ("bare", (), 0.0)
    assert {p.altitude for p in scenario.mission} == {200.0}


def test_obstacles_without_altitude_stand_at_the_mission_s():
    scenario = parse(
        "obstacles = [{north_m = 5000, east_m = 0}]\n"
        + MISSION.replace("north_m = 10000.0", "north_m = 10000.0\naltitude_m = 450.0")
    )
    assert scenario.obstacles[0].altitude == 450.0


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("wind = {north_m_s = nan}", "wind.north_m_s = nan: must be a finite number"),
        ("wind = {north_m_s = 9.0, east_m_s = 9.0}", "allowed are at most 12 m/s"),
        ('wind = {turbulence = "strong"}', "wind.turbulence = 'strong'"),
        ("bogus = 1", "bogus = 1: unknown key"),
        ("radar = {rang_m = 5.0}", "did you mean range_m?"),
        ("radar = {detection_probability = 0.0}", "greater than 0 and at most 1"),
        ("radar = {range_m = -1.0}", "radar.range_m = -1.0: must be greater than 0 and at most 500000"),
        ("vehicle = {fidelity = 'good'}", "must be '6dof' or 'kinematic'"),
        ("vehicle = {aircraft = 'glider'}", "known: skywalker_x8, techpod"),
        ("vehicle = {airspeed_m_s = 50.0}", "at least 12 and at most 22"),
        ("name = 'a b'", "name = 'a b'"),
        ("time_limit_s = inf", "time_limit_s = inf"),
        ("start_time_utc = 2020-03-21T02:30:00", "offset"),
        (
            "start_time_utc = 0001-01-01T00:00:00+05:00",
            "start_time_utc = '0001-01-01 00:00:00+05:00': must lie within the years 1 to 9999 in UTC",
        ),
        ("start_time_utc = 9999-12-31T23:00:00-05:00", "must lie within the years 1 to 9999 in UTC"),
        (
            "obstacles = [{latitude_deg = 23.5, longitude_deg = 76.6}]",
            "obstacles #1: latitude_deg = 23.5, longitude_deg = 76.6 is beyond the map, which reaches 1,",
        ),
        (
            "obstacles = [{latitude_deg = -14.39, longitude_deg = -103.4}]",
            "obstacles #1: latitude_deg = -14.39",
        ),
        (
            "traffic = [{waypoints = [{north_m = 1, east_m = 0}, {latitude_deg = 80, longitude_deg = 0}]}]",
            "traffic #1, waypoints #2: latitude_deg = 80",
        ),
        ("a = 1\nb = " + "[" * 1500 + "]" * 1500, "not valid TOML: nested too deeply (at line 2)"),
        ("a" + ".a" * 3000 + " = 1", "a = ...: unknown key"),
        ("a = " + "9" * 5000, "not valid TOML"),
        ("a = 0x" + "f" * 5000, "a = ...: unknown key"),
        ("time_limit_s = " + "9" * 400, "time_limit_s"),
        ("start_time_utc = 'now'", "must be a date and time with offset"),
        ("random = {sigma_m = 1.0}", "random.sigma_m = 1.0: must be at least 500"),
        ("obstacles = [{north_m = 1.0}]", "obstacles #1: needs north_m and east_m"),
        ("obstacles = [{north_m = 1, east_m = 2, latitude_deg = 3}]", "obstacles #1: needs"),
        ("obstacles = [{north_m = 9e9, east_m = 0}]", "at least -1000000 and at most 1000000"),
        (
            "obstacles = [{north_m = 5e3, east_m = 0, safety_radius_m = -5}]",
            "obstacles #1, safety_radius_m = -5: must be greater than 0 and at most 50000",
        ),
        ("obstacles = [{north_m = 900.0, east_m = 0.0}]", "the start is inside its sphere"),
        ("obstacles = [{id = 1, north_m = 5e3, east_m = 0}, {id = 1, north_m = 5e3, east_m = 9}]", "twice"),
        ("traffic = [{waypoints = [{north_m = 1, east_m = 1}]}]", "has 1 entries and needs at least 2"),
        (
            "traffic = [{speed_m_s = 60, waypoints = [{north_m = 1, east_m = 0}, {north_m = 9, east_m=0}]}]",
            'unless motion = "point"',
        ),
    ],
)
def test_a_mistake_is_told_with_key_value_and_range(line: str, expected: str):
    assert expected in complaints(line + "\n" + MISSION)


@pytest.mark.parametrize("text", ["", "mission = []", "name = 'x'"])
def test_a_mission_is_needed(text: str):
    assert "mission" in complaints(text)


def test_two_waypoints_on_one_spot_are_refused():
    again = MISSION + "[[mission]]\nnorth_m = 10000.0\neast_m = 0.0\n"
    assert "mission #3: lies on the waypoint before it" in complaints(again)


def test_all_mistakes_come_at_once_also_those_between_fields():
    text = complaints(
        "bogus = 1\nwind = {north_m_s = nan}\n"
        "obstacles = [{north_m = 5e3, east_m = 0, safety_radius_m = -5}, {north_m = 900.0, east_m = 0}]\n"
        + MISSION
    )
    assert "4 mistakes" in text
    assert "obstacles #2, safety_radius_m = 1000.0: the start is inside its sphere: 900 m" in text


def test_invalid_toml_says_where():
    assert "not valid TOML" in complaints("a = = 1")
    assert "line 2" in complaints("a = 1\nb = = 1")


@pytest.mark.parametrize(("appears", "period"), [(0.0, 1.0), (0.001, 1.0), (1.0, 1.0), (5.0, 10.0)])
def test_the_start_may_not_be_inside_what_appears_within_the_first_sweep(appears: float, period: float):
    text = f"obstacles = [{{north_m = 10.0, east_m = 0.0, appears_at_s = {appears}}}]\n"
    assert "the start is inside" in complaints(f"radar = {{period_s = {period}}}\n" + text + MISSION)


def test_a_pop_up_over_the_start_is_no_mistake():
    scenario = parse("obstacles = [{north_m = 10.0, east_m = 0.0, appears_at_s = 1.1}]\n" + MISSION)
    assert scenario.obstacles[0].appears_at == 1.1


def test_unknown_names_and_missing_files(tmp_path):
    with pytest.raises(ScenarioError, match=r"did you mean 'table4'\? Known: table4, circle"):
        load("tabel4")
    with pytest.raises(ScenarioError, match="no such file"):
        load(tmp_path / "none.toml")
    with pytest.raises(ScenarioError, match="directory"):
        load(str(tmp_path) + "/")
    (tmp_path / "field.plan").write_text("{}")
    with pytest.raises(ScenarioError, match=r"is a mission; sidestep plan convert .*field.plan field.toml"):
        load(tmp_path / "field.plan")
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ScenarioError, match="not a text file"):
        load(tmp_path / "binary.toml")
    with pytest.raises(ScenarioError, match=r"cannot be read|no such file"):
        load(tmp_path / ("x" * 300 + ".toml"))
    with pytest.raises(ScenarioError, match=r"cannot be read|unknown scenario"):
        load("x" * 300)


def test_every_mistake_of_a_place_is_told_with_the_others():
    far = "obstacles = [{latitude_deg = 80, longitude_deg = 0}, {north_m = 900, east_m = 0}]\n"
    text = complaints("start_time_utc = 0001-01-01T00:00:00+05:00\n" + far + MISSION)
    assert "3 mistakes" in text
    assert "obstacles #1: latitude_deg = 80" in text
    assert "obstacles #2, safety_radius_m = 1000.0: the start is inside" in text


def test_a_byte_order_mark_does_no_harm(tmp_path):
    (tmp_path / "windows.toml").write_text(MISSION, encoding="utf-8-sig")
    assert load(tmp_path / "windows.toml").name == "windows"


@pytest.mark.parametrize(
    ("stem", "name"),
    [("my flight ü", "my-flight-"), ("_draft", "draft"), ("ü", "scenario"), ("x" * 200, "x" * 64)],
)
def test_a_name_made_of_the_file_s_can_be_written(tmp_path, stem: str, name: str):
    (tmp_path / f"{stem}.toml").write_text(MISSION)
    scenario = load(tmp_path / f"{stem}.toml")
    assert scenario.name == name
    assert parse(to_toml(scenario)) == scenario


def test_a_file_may_be_named_like_anything(tmp_path):
    (tmp_path / "my flight.toml").write_text('name = "mine"\n' + MISSION)
    assert load(tmp_path / "my flight.toml").name == "mine"


def test_scenarios_compare_by_value():
    one: Scenario = load("single")
    assert replace(one, time_limit=1.0) != one
