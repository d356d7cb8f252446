"""Loading the FMU."""

from __future__ import annotations

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
