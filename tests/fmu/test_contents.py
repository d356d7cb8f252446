"""What is said about the FMUs is what is in them, in words and in the documentation."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from fmu.contents import contents, variable_tables
from fmu.mapped import MappedPlant
from fmu.mapping import load_mapping
from fmu.variables import TABLE

DOCS = Path(__file__).parents[2] / "docs"


def test_both_versions_are_described(fmu_file):
    second = fmu_file.with_name(f"{fmu_file.stem}_fmi2.fmu")
    for file, version in ((fmu_file, "3.0"), (second, "2.0")):
        words = contents(file)
        assert words["FMI"].startswith(f"{version}")
        assert words["FMI"].endswith("Co-Simulation and Model Exchange")
        inputs = sum(row.causality == "input" for row in TABLE)
        assert int(re.search(r"(\d+) input", words["variables"])[1]) >= inputs


def test_every_variable_is_documented():
    """If this fails: sidestep fmu info --variables > docs/aircraft-variables.md"""
    assert (DOCS / "aircraft-variables.md").read_text(encoding="utf-8") == variable_tables()


def test_every_name_in_the_handbook_exists():
    text = (DOCS / "aircraft.md").read_text(encoding="utf-8")
    heads = "aircraft|battery|command|environment|flight|initial|launch|state|turbulence|wind"
    found = re.findall(rf"`((?:{heads})\.[a-z_.]+[a-z_])`", text)
    names = {name for name in found if not name.endswith(".csv")}
    assert len(names) > 15
    assert names <= {row.name for row in TABLE}


def test_the_handbooks_mapping_flies(fmu_file, tmp_path):
    text = (DOCS / "aircraft.md").read_text(encoding="utf-8")
    mapping = tmp_path / "my_aircraft.toml"
    mapping.write_text(re.search(r"```toml\n(fmu = .*?)```", text, re.DOTALL)[1], encoding="utf-8")
    shutil.copy(fmu_file, tmp_path / "sidestep_aircraft.fmu")
    with MappedPlant(load_mapping(mapping)) as plant:
        plant.fly_leg(0, 0, 1000, 0, altitude=250, airspeed=15)
        plant.step(1.0)
        assert plant.state.north == pytest.approx(15.0, abs=0.1)
        assert plant.state.altitude == pytest.approx(250.0, abs=0.1)
