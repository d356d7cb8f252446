"""The encounter as a system file: valid, and flown by an importer that is not ours."""

from __future__ import annotations

import importlib
import zipfile

import pytest
from fmpy.ssp.ssd import read_ssd

from fmu.build import PACKAGED_FMI2
from fmu.cosimulation import CoSimulation
from fmu.errors import PlantError
from fmu.ssp import DISTANCE, INTRUDER, OUTPUTS, OWN, PARAMETER_SET, STEP, WIRES, main, write_encounter

UNTIL = 100.0
"""Time that is flown [s]; the two meet after some 133 s."""


@pytest.fixture(scope="module")
def second(fmu_file):
    """The FMI 2.0 FMU; it is built with the other."""
    return fmu_file.with_name(f"{fmu_file.stem}_fmi2.fmu")


@pytest.fixture(scope="module")
def encounter(second, tmp_path_factory):
    return write_encounter(tmp_path_factory.mktemp("ssp") / "encounter.ssp", second)


def test_the_system_structure_is_valid_and_complete(encounter, second):
    structure = read_ssd(str(encounter), validate=True)
    components = {component.name: component for component in structure.system.elements}
    assert set(components) == {"own", "intruder"}
    wires = {
        (each.startElement, each.startConnector, each.endElement, each.endConnector)
        for each in structure.system.connections
    }
    assert wires == set(WIRES)
    with zipfile.ZipFile(encounter) as archive:
        for component in components.values():
            assert archive.read(component.source) == second.read_bytes()


def flown_here(second):
    """The same encounter, stepped here: each step uses what the outputs were before it."""
    units = {"own": CoSimulation(second, OWN), "intruder": CoSimulation(second, INTRUDER)}
    try:
        for _ in range(round(UNTIL / STEP)):
            for start, output, end, variable in WIRES:
                units[end].write({variable: units[start].read([output])[0]})
            for unit in units.values():
                unit.step(STEP)
        return {name: unit.read(OUTPUTS) for name, unit in units.items()}
    finally:
        for unit in units.values():
            unit.close()


@pytest.mark.importer
def test_an_independent_importer_flies_it(encounter, second):
    """ecos (Eidskrem Hatledal): own reading of SSP and FMI, in C++."""
    try:
        ecos = importlib.import_module("ecospy")
    except ImportError:
        pytest.skip("ecospy is not installed (extra ssp)")
    except OSError as error:
        pytest.skip(f"ecospy does not load, it needs oneTBB (Debian: libtbb12): {error}")
    with ecos.EcosSimulation(STEP, ssp_path=str(encounter)) as simulation:
        simulation.init(parameter_set=PARAMETER_SET)
        simulation.step(round(UNTIL / STEP))
        there = {
            name: [simulation.get_real(f"{name}::{output}") for output in OUTPUTS]
            for name in ("own", "intruder")
        }
    here = flown_here(second)
    north = OUTPUTS.index("state.north")
    assert there["own"][north] == pytest.approx(15.0 * UNTIL, abs=1.0)
    assert there["intruder"][north] == pytest.approx(DISTANCE - 15.0 * UNTIL, abs=1.0)
    for name, values in there.items():
        assert values == pytest.approx(here[name], abs=1e-6), name


def test_without_the_fmu_nothing_is_written(tmp_path):
    target = tmp_path / "encounter.ssp"
    with pytest.raises(PlantError, match="absent"):
        write_encounter(target, tmp_path / "absent.fmu")
    assert list(tmp_path.iterdir()) == []


def test_the_command_writes_and_says_where(tmp_path, capsys):
    if not PACKAGED_FMI2.is_file():
        pytest.skip(f"no {PACKAGED_FMI2.name}: python -m fmu.build")
    target = tmp_path / "encounter.ssp"
    assert main(["-o", str(target)]) == 0
    assert capsys.readouterr().out == f"{target}\n"
    assert zipfile.is_zipfile(target)
    assert main(["-o", str(tmp_path / "no" / "encounter.ssp")]) == 3
