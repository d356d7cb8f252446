"""Any FMU by the standard's own calls: both versions alike, errors in the FMU's words."""

from __future__ import annotations

import pytest

from fmu.cosimulation import CoSimulation, read_description
from fmu.errors import PlantError


@pytest.fixture(params=["3.0", "2.0"])
def file(request, fmu_file):
    return fmu_file if request.param == "3.0" else fmu_file.with_name(f"{fmu_file.stem}_fmi2.fmu")


def test_reads_and_writes_numbers_of_every_type(file):
    names = ["state.altitude", "command.mode", "state.stalled", "initial.altitude"]
    with CoSimulation(file, {"initial.altitude": 321, "command.mode": 2.0}) as unit:
        assert unit.read(names) == [321.0, 2.0, 0.0, 321.0]
        unit.write({"command.mode": 1, "command.altitude": 330.0})
        unit.step(5.0)
        assert unit.time == 5.0
        assert unit.read(names)[0] > 325


def test_time_does_not_drift(file):
    with CoSimulation(file) as unit:
        for _ in range(1000):
            unit.step(0.1)
        assert unit.time == 100.0
        assert unit.read(["time"]) == [100.0]


def test_begins_again_as_if_new(file):
    with CoSimulation(file) as fresh, CoSimulation(file, {"command.altitude": 300.0}) as used:
        used.step(10.0)
        used.restart({})
        for unit in (fresh, used):
            unit.step(3.0)
        assert used.time == 3.0
        assert used.read(used.outputs) == fresh.read(fresh.outputs)


def test_wrong_calls_are_answered_in_words(file):
    with pytest.raises(ValueError, match=r"aircraft\.mass"):
        CoSimulation(file, {"aircraft.mass": -1.0})
    with CoSimulation(file) as unit:
        with pytest.raises(ValueError, match="nonsense"):
            unit.read(["nonsense"])
        with pytest.raises(ValueError, match="nonsense"):
            unit.write({"nonsense": 1.0})
        with pytest.raises(PlantError, match="step"):
            unit.step(-1.0)
        with pytest.raises(PlantError, match=r"trim|airspeed"):
            unit.restart({"initial.airspeed": 5.0})


def test_what_is_no_fmu_is_named(tmp_path):
    with pytest.raises(PlantError, match=r"absent\.fmu"):
        read_description(tmp_path / "absent.fmu")
    text = tmp_path / "text.fmu"
    text.write_text("no zip")
    with pytest.raises(PlantError, match=r"text\.fmu"):
        CoSimulation(text)
