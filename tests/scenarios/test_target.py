"""Where a run may be written: previous runs are replaced, nothing else is, and no flight is in vain."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from scenarios.errors import RunDirectoryError
from scenarios.load import load
from scenarios.record import write_run
from scenarios.target import (
    FILE_OF_A_LINK,
    FILES_OF_A_PLANT,
    FILES_OF_A_RUN,
    check_target,
    free_directory,
    is_run,
)
from tests.scenarios.flights import encounter


@pytest.fixture(scope="module")
def run_directory(tmp_path_factory):
    directory = tmp_path_factory.mktemp("runs") / "one"
    write_run(directory, *encounter())
    return directory


def test_a_previous_run_is_replaced_and_nothing_else_is(run_directory, tmp_path):
    write_run(tmp_path / "run", *encounter())
    (tmp_path / "run" / "report.html").write_text("old")
    write_run(tmp_path / "run", *encounter())
    assert is_run(tmp_path / "run")
    assert not (tmp_path / "run" / "report.html").exists()
    other = tmp_path / "precious"
    other.mkdir()
    (other / "thesis.tex").write_text("...")
    with pytest.raises(RunDirectoryError, match="holds no previous run"):
        write_run(other, *encounter())
    assert [p.name for p in other.iterdir()] == ["thesis.tex"]
    with pytest.raises(RunDirectoryError, match="is a file"):
        check_target(other / "thesis.tex")


@pytest.mark.parametrize("extra", ["notes.txt", ".git", "report.html"])
def test_a_run_with_anything_beside_it_is_left_alone(run_directory, tmp_path, extra):
    copy = tmp_path / "copy"
    shutil.copytree(run_directory, copy)
    (copy / extra / "mine").mkdir(parents=True)
    with pytest.raises(RunDirectoryError, match=f"holds '{extra}' besides a previous run"):
        write_run(copy, *encounter())
    assert (copy / extra / "mine").is_dir()


def test_every_file_that_is_written_belongs_to_a_run(run_directory):
    written = {file.name for file in run_directory.iterdir()}
    assert written | {"report.html", FILE_OF_A_LINK, *FILES_OF_A_PLANT} == FILES_OF_A_RUN


@pytest.mark.parametrize("length", [200, 255])
def test_a_name_may_be_as_long_as_the_file_system_allows(tmp_path, length):
    write_run(tmp_path / ("x" * length), *encounter())
    write_run(tmp_path / ("x" * length), *encounter())
    assert [len(file.name) for file in tmp_path.iterdir()] == [length]


@pytest.mark.parametrize("path", ["x" * 300, "new/" + "x" * 300, "x" * 300 + "/new", ("y" * 250 + "/") * 20])
def test_a_name_that_is_too_long_is_refused_before_the_flight(tmp_path, path):
    with pytest.raises(RunDirectoryError, match="cannot be written to"):
        check_target(tmp_path / path)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("link", ["", "there", "there/deep", "run"])
def test_links_are_followed_and_stay(tmp_path, link):
    """From the top: a link to nothing, into a directory to be made, and to a previous run."""
    real = tmp_path / "real"
    if link == "run":
        write_run(real, *encounter())
    (tmp_path / "link").symlink_to(real, target_is_directory=True)
    below = "" if link == "run" else link
    check_target(tmp_path / "link" / below)
    write_run(tmp_path / "link" / below, *encounter())
    assert (tmp_path / "link").is_symlink()
    assert is_run(real / below)
    assert sorted(file.name for file in tmp_path.iterdir()) == ["link", "real"]


def test_links_to_themselves_are_refused(tmp_path):
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    for path in ("loop", "loop/run"):
        with pytest.raises(RunDirectoryError):
            check_target(tmp_path / path)


def empty_mount_points():
    if not Path("/proc/self/mounts").exists():
        return []
    mounts = [Path(line.split()[1]) for line in Path("/proc/self/mounts").read_text().splitlines()]
    return [p for p in mounts if os.access(p, os.R_OK) and p.is_dir() and not any(p.iterdir())]


@pytest.mark.skipif(not empty_mount_points(), reason="no empty directory is mounted here")
def test_a_mount_point_is_refused_before_the_flight():
    with pytest.raises(RunDirectoryError, match="cannot be written to"):
        check_target(empty_mount_points()[0])


def test_checking_changes_nothing(run_directory, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(run_directory, copy)
    check_target(copy)
    check_target(tmp_path / "new" / "one")
    assert [file.name for file in tmp_path.iterdir()] == ["copy"]
    assert is_run(copy)


def test_free_directories_are_numbered(tmp_path):
    scenario = load("single")
    first = free_directory(scenario, 3, tmp_path)
    assert first.name == "single-3-1"
    first.mkdir()
    assert free_directory(scenario, 3, tmp_path).name == "single-3-2"
