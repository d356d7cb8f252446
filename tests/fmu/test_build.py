"""Building the FMU: whole or not at all, the same bytes every time, valid for others."""

from __future__ import annotations

import importlib.util
import os
import shutil
import sys
import zipfile
from pathlib import Path

import pytest

from fmu import BuildError, FmuLibrary, FmuPlant
from fmu import build as building
from fmu.build import build_fmu, main, platform_tuple


@pytest.mark.parametrize("version", ["fmu_file", "fmi2_file"])
def test_fmpy_finds_no_fault(version, request):
    from fmpy.validation import validate_fmu  # noqa: PLC0415

    assert validate_fmu(str(request.getfixturevalue(version))) == []


def test_fmpy_simulates_it_alone(fmu_file):
    from fmpy import simulate_fmu  # noqa: PLC0415

    result = simulate_fmu(
        str(fmu_file), stop_time=10.0, output_interval=1.0, output=["state.north", "state.altitude"]
    )
    assert result["state.north"][-1] == pytest.approx(150.0, abs=1e-6)
    assert result["state.altitude"][-1] == pytest.approx(200.0, abs=1e-6)


def test_holds_library_sources_and_description(fmu_file):
    tuple_, suffix = platform_tuple()
    names = zipfile.ZipFile(fmu_file).namelist()
    assert names[0] == "modelDescription.xml"
    assert f"binaries/{tuple_}/sidestep_aircraft{suffix}" in names
    assert {"sources/buildDescription.xml", "sources/variables.h", "sources/airframe.c"} <= set(names)


def test_the_same_sources_give_the_same_bytes(fmu_file, tmp_path):
    assert build_fmu(tmp_path / "again.fmu").read_bytes() == fmu_file.read_bytes()


@pytest.mark.parametrize("command", [["/nonexistent/cc"], [sys.executable, "-c", "raise SystemExit('no')"]])
def test_a_failing_compiler_leaves_nothing(command, tmp_path):
    with pytest.raises(BuildError):
        build_fmu(tmp_path / "a.fmu", command)
    assert list(tmp_path.iterdir()) == []


def test_a_failing_build_keeps_the_old_file(tmp_path):
    target = tmp_path / "a.fmu"
    target.write_bytes(b"old")
    with pytest.raises(BuildError):
        build_fmu(target, ["/nonexistent/cc"])
    assert target.read_bytes() == b"old"


def test_without_any_compiler_the_message_helps(monkeypatch, capsys, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(building.importlib.util, "find_spec", lambda _name: None)
    assert main(["-o", str(tmp_path / "a.fmu")]) == 3
    assert "pip install ziglang" in capsys.readouterr().err


def test_without_a_compiler_ziglang_is_used(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(building.importlib.util, "find_spec", lambda name: name)
    assert building.compiler() == [sys.executable, "-m", "ziglang", "cc"]


def orbit(file):
    """Bits of half a minute of turning, gusty flight."""
    with (
        FmuLibrary.open(file) as library,
        FmuPlant(library, parameters={"turbulence.wind_speed": 4.0}) as plant,
    ):
        plant.fly_orbit(0, 100, 80, 1, 230, 16)
        states = []
        for _ in range(30):
            plant.step(1.0)
            states.append((*plant.state, plant.get("battery.energy")))
        return states


@pytest.mark.skipif(importlib.util.find_spec("ziglang") is None, reason="ziglang is not installed")
def test_zig_gives_the_same_bits(fmu_file, tmp_path):
    other = build_fmu(tmp_path / "zig.fmu", building.zig(platform_tuple()[0]))
    assert orbit(other) == orbit(fmu_file)


@pytest.mark.parametrize("version", ["fmu_file", "fmi2_file"])
def test_it_is_rebuilt_from_its_own_sources(version, request, monkeypatch, tmp_path):
    """fmpy compiles what lies in the zip, and the result flies the same flight."""
    beside = Path(sys.executable).parent
    monkeypatch.setenv("PATH", f"{beside}{os.pathsep}{os.environ['PATH']}")
    if shutil.which("cmake") is None:
        pytest.skip("cmake, which fmpy compiles with, is not installed")
    from fmpy import extract, read_model_description, simulate_fmu  # noqa: PLC0415
    from fmpy.build import build_platform_binary  # noqa: PLC0415

    file = request.getfixturevalue(version)
    folder = Path(extract(str(file), str(tmp_path / "unzipped")))
    shutil.rmtree(folder / "binaries")
    if read_model_description(folder).fmiVersion == "2.0":
        (folder / "binaries" / building.FMI2_PLATFORMS[platform_tuple()[0]]).mkdir(parents=True)
    build_platform_binary(folder)
    flights = [
        simulate_fmu(str(source), stop_time=5.0, start_values={"command.mode": 2}, output=["state.bank"])
        for source in (folder, file)
    ]
    assert flights[0].tobytes() == flights[1].tobytes()


def test_only_files_with_every_platform_count_as_such(fmu_file, tmp_path):
    assert not building.carries_all(fmu_file)
    assert not building.carries_all(tmp_path / "none.fmu")
    everywhere = tmp_path / "all.fmu"
    files = building.sources()
    libraries = dict.fromkeys(building.TARGETS, b"library")
    building._write_zip(everywhere, building._content_fmi3(files, libraries))
    assert building.carries_all(everywhere)


def test_all_platforms_need_zig(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(building.importlib.util, "find_spec", lambda _name: None)
    assert main(["--all", "-o", str(tmp_path / "a.fmu")]) == 3
    assert "ziglang" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
