"""Building the FMU: whole or not at all, the same bytes every time, valid for others."""

from __future__ import annotations

import sys
import zipfile

import pytest

from fmu import BuildError
from fmu import build as building
from fmu.build import build_fmu, main, platform_tuple


def test_fmpy_finds_no_fault(fmu_file):
    from fmpy.validation import validate_fmu  # noqa: PLC0415

    assert validate_fmu(str(fmu_file)) == []


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
