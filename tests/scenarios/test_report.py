"""The report says what the files say, and stays readable whatever they hold."""

import json
import re

import numpy as np
import pytest

from scenarios.errors import RunDirectoryError
from scenarios.report import write_report
from scenarios.report_data import read
from scenarios.report_geometry import encounters, extremes, inside, nearest, passes, simplified
from scenarios.report_maps import stretch
from tests.scenarios.report_run import write_run

THREE = ((10_000.0, 300.0, 1000.0), (35_000.0, 2_000.0, 600.0), (50_000.0, 3_000.0, 1500.0))


def page_of(directory):
    return write_report(directory).read_text(encoding="utf-8")


def json_of(page, name):
    return json.loads(re.search(f'id="{name}">(.*?)</script>', page, re.S)[1])


def trace(plot, role):
    return next(t for t in plot["data"] if t["meta"]["role"] == role)


def words_of(page):
    return re.sub(r"<script.*?</script>|<style.*?</style>", "", page, flags=re.S)


def test_counts_are_those_of_the_files(tmp_path):
    directory = write_run(tmp_path, obstacles=THREE)
    page = page_of(directory)
    data = json_of(page, "run-data")
    assert (data["spheres"], data["waypoints"], data["decisions"]) == (3, 3, 3)
    assert data["summary"] == json.loads((directory / "summary.json").read_text())
    assert page.count("<tr data-decision=") == 3


def test_distances_are_computed_from_the_tracks(tmp_path):
    run = read(write_run(tmp_path, obstacles=THREE))
    closest = passes(run)
    assert min(p.distance for p in closest) == pytest.approx(run.summary["min_separation_m"], abs=1e-3)
    for p in closest:
        assert np.linalg.norm(p.own - p.other) == pytest.approx(p.distance, abs=1e-3)
    near = nearest(run)
    assert (near.distance - near.required).min() == pytest.approx(run.summary["min_margin_m"], abs=0.1)


def test_spheres_are_drawn_to_size(tmp_path):
    plots = json_of(page_of(write_run(tmp_path, obstacles=THREE)), "plots")
    spheres = trace(plots["top-view"], "spheres")
    rings, outline = [], []
    for x, y in zip([*spheres["x"], None], [*spheres["y"], None], strict=True):
        if x is None:
            rings.append(np.array(outline))
            outline = []
        else:
            outline.append((y, x))
    assert len(rings) == len(THREE)
    for ring, (north, east, radius) in zip(rings, THREE, strict=True):
        away = np.linalg.norm(ring * 1e3 - (north, east), axis=1)
        np.testing.assert_allclose(away, radius, atol=0.1)


@pytest.mark.parametrize(
    ("summary", "tone", "words"),
    [
        ({}, "safe", "Flown safely"),
        ({"violations": 1}, "entered", "A safety sphere was entered once"),
        ({"violations": 3, "completed": False}, "entered", "entered 3 times"),
        ({"completed": False}, "unfinished", "Mission not completed"),
    ],
)
def test_verdict(tmp_path, summary, tone, words):
    page = words_of(page_of(write_run(tmp_path, **summary)))
    header = re.search(r'<header class="verdict (\w+)".*?</header>', page, re.S)
    assert header[1] == tone
    assert words in header[0]


def test_empty_world_has_a_report(tmp_path):
    page = page_of(
        write_run(tmp_path, obstacles=(), detour=False, optimum_length_m=None, real_time_factor=None)
    )
    words = words_of(page)
    assert json_of(page, "run-data")["spheres"] == 0
    assert "separation" not in json_of(page, "plots")
    assert "There was no obstacle" in words
    assert not re.search(r"\b(None|nan|inf|NaN)\b", words)


def test_collision_without_decisions_is_shown_close_up(tmp_path):
    page = page_of(write_run(tmp_path, detour=False))
    assert 'class="encounter"' in page
    assert "ENTERED" in page
    assert json_of(page, "run-data")["summary"]["violations"] == 1


def test_obstacle_that_never_appeared_is_on_the_map_only(tmp_path):
    directory = write_run(tmp_path, detour=False)
    text = (directory / "obstacles.csv").read_text().replace(",0.000\n", ",99999.000\n")
    (directory / "obstacles.csv").write_text(text)
    run = read(directory)
    assert passes(run) == []
    page = page_of(directory)
    assert json_of(page, "run-data")["spheres"] == 1
    assert "appears at 99,999 s" in page


def test_rally_points_are_drawn_with_the_numbers_that_decisions_give_them(tmp_path):
    directory = write_run(tmp_path)
    with (directory / "scenario.toml").open("a", encoding="utf-8") as file:
        file.writelines(f"\n[[rally]]\nnorth_m = {north}\neast_m = 500.0\n" for north in (4000.0, 9000.0))
    page = page_of(directory)
    drawn = trace(json_of(page, "plots")["top-view"], "rally")
    assert (drawn["text"], drawn["x"], drawn["y"]) == (["R1", "R2"], [0.5, 0.5], [4.0, 9.0])
    assert "where to wait if no way is free" in words_of(page)
    assert "where to wait" not in words_of(page_of(write_run(tmp_path / "none")))


def test_traffic_is_met_where_it_was(tmp_path):
    run = read(write_run(tmp_path, obstacles=(), detour=False, traffic=True))
    (meeting,) = passes(run)
    track, times = run.hazards[0].places, run.track.times
    k = int(np.argmin(np.abs(times - meeting.time)))
    assert np.linalg.norm(track[k] - meeting.other) < 15.0
    page = page_of(tmp_path)
    assert len(trace(json_of(page, "plots")["top-view"], "traffic")["x"]) >= 2


def test_hostile_words_are_escaped(tmp_path):
    page = page_of(write_run(tmp_path, version="<script>alert(1)</script>"))
    assert "<script>alert" not in page
    assert "&lt;ahead&gt; &amp; near" in page


def test_disagreement_of_the_files_is_shown(tmp_path):
    assert 'id="doubts"' not in page_of(write_run(tmp_path))
    assert "path_length_m: summary.json says 1.0" in page_of(write_run(tmp_path, path_length_m=1.0))


def test_nothing_is_fetched(tmp_path):
    page = page_of(write_run(tmp_path))
    assert not re.search(r'(src|href)\s*=\s*["\'](?!data:)', words_of(page))
    assert "@import" not in page.split("<script", 1)[0]


def test_at_most_twelve_close_ups_and_the_rest_is_counted(tmp_path):
    many = tuple((3_000.0 + 2_900.0 * i, (3_000.0 + 2_900.0 * i) / 15.0, 150.0) for i in range(19))
    directory = write_run(tmp_path, obstacles=many, detour=False)
    run = read(directory)
    groups = encounters(run, passes(run))
    page = page_of(directory)
    assert page.count('class="encounter"') == min(12, len(groups))
    assert all((group.high - group.low).max() <= 25_000.0 for group in groups)
    assert sorted(p.hazard.id for group in groups for p in group.passes) == list(range(1, 20))


def test_writing_again_changes_nothing_and_leaves_nothing_else(tmp_path):
    directory = write_run(tmp_path)
    first = page_of(directory)
    files = sorted(path.name for path in directory.iterdir())
    assert page_of(directory) == first
    assert sorted(path.name for path in directory.iterdir()) == files


@pytest.mark.parametrize(
    "name", ["summary.json", "track.csv", "obstacles.csv", "decisions.jsonl", "scenario.toml"]
)
def test_missing_file_is_named_and_the_old_report_stays(tmp_path, name):
    directory = write_run(tmp_path)
    before = page_of(directory)
    (directory / name).unlink()
    with pytest.raises(RunDirectoryError, match=re.escape(name)):
        write_report(directory)
    assert (directory / "report.html").read_text(encoding="utf-8") == before


def test_damaged_decision_is_named_by_line(tmp_path):
    directory = write_run(tmp_path, obstacles=THREE)
    lines = (directory / "decisions.jsonl").read_text().splitlines()
    lines[1] = lines[1].replace('"east_m"', '"west_m"')
    (directory / "decisions.jsonl").write_text("\n".join(lines))
    with pytest.raises(RunDirectoryError, match="line 2"):
        write_report(directory)


def test_overview_is_stretched_only_where_it_must_be(tmp_path):
    long = read(write_run(tmp_path / "long", obstacles=(), detour=False))
    assert stretch(long) == 10.0
    wide = write_run(tmp_path / "wide", obstacles=((10_000.0, 30_000.0, 1000.0),), detour=False)
    assert stretch(read(wide)) == 1.0


def test_thinned_curve_keeps_its_extremes():
    rng = np.random.default_rng(3)
    values = rng.normal(size=50_000)
    values[31_234] = 40.0
    k = extremes([values], buckets=500)
    assert len(k) <= 1_002
    assert {0, 31_234, 49_999, int(np.argmin(values))} <= set(k.tolist())


def test_simplified_line_stays_within_tolerance():
    angle = np.linspace(0.0, 6.0, 3_000)
    points = np.column_stack([1000.0 * np.sin(angle), 900.0 * angle])
    k = simplified(points, 2.0)
    rebuilt = np.interp(points[:, 1], points[k, 1], points[k, 0])
    assert len(k) < 100
    assert np.abs(rebuilt - points[:, 0]).max() < 2.0 * 2.0  # across the line at most 2 m; steepest slope 1.1


def test_line_is_cut_at_a_window():
    points = np.column_stack([np.arange(20.0), np.zeros(20)])
    points[10] = np.nan
    pieces = inside(points, np.array([4.5, -1.0]), np.array([14.5, 1.0]))
    assert [piece[:, 0].tolist() for piece in pieces] == [[4, 5, 6, 7, 8, 9], [11, 12, 13, 14, 15]]
