"""Loading the FMU."""

from __future__ import annotations

import zipfile

import pytest

from fmu import FmuLibrary, FmuPlant, PlantError


def test_a_missing_file_says_how_to_build_it(tmp_path):
    with pytest.raises(PlantError, match=r"python -m fmu\.build"):
        FmuLibrary.open(tmp_path / "none.fmu")


def test_a_file_that_is_no_fmu_is_refused(tmp_path):
    path = tmp_path / "bad.fmu"
    path.write_bytes(b"not a zip")
    with pytest.raises(PlantError, match=r"bad\.fmu"):
        FmuLibrary.open(path)


@pytest.mark.parametrize(
    ("others", "words"), [((), "nor for any other"), (("riscv64-linux",), "only for riscv64-linux")]
)
def test_an_fmu_for_other_machines_says_so(fmu_file, tmp_path, others, words):
    path = tmp_path / "elsewhere.fmu"
    with zipfile.ZipFile(fmu_file) as whole, zipfile.ZipFile(path, "w") as bare:
        for name in whole.namelist():
            if not name.startswith("binaries/"):
                bare.writestr(name, whole.read(name))
        for platform in others:
            bare.writestr(f"binaries/{platform}/sidestep_aircraft.so", b"")
    with pytest.raises(PlantError, match=rf"no library for this machine \(.*\), {words}; build it here"):
        FmuLibrary.open(path)


def test_closing_frees_instances_and_files(fmu_file):
    library = FmuLibrary.open(fmu_file)
    plant = FmuPlant(library)
    folder = library._folder
    library.close()
    library.close()
    assert not folder.exists()
    with pytest.raises(PlantError, match="closed"):
        plant.step(1.0)
    with pytest.raises(PlantError, match="closed"):
        FmuPlant(library)
