"""The check finds nothing in a good FMU, and finds what is wrong with a bad one."""

from __future__ import annotations

import shutil
import zipfile

import pytest

from fmu import flights
from fmu.check import FAILED, PASSED, SKIPPED, check
from fmu.cosimulation import CoSimulation
from fmu.errors import PlantError


@pytest.fixture(scope="module")
def findings(fmu_file, tmp_path_factory):
    """Of both FMUs as they are; without NASA's data, which have their own tests."""
    second = fmu_file.with_name(f"{fmu_file.stem}_fmi2.fmu")
    nowhere = tmp_path_factory.mktemp("none") / "absent"
    return list(check([fmu_file, second], nowhere))


def test_a_good_fmu_has_nothing_wrong(findings):
    assert [finding for finding in findings if finding.verdict == FAILED] == []
    assert {finding.check for finding in findings if finding.verdict == PASSED} >= {
        "schema and rules (fmpy)",
        "contents",
        "level trim, skywalker_x8",
        "climb, techpod",
        "determinism",
        "Model Exchange",
        "conservation",
        "twin, skywalker_x8",
        "the same bits",
    }


def test_what_cannot_be_checked_here_says_why(findings):
    skipped = [finding for finding in findings if finding.verdict == SKIPPED]
    assert "NASA check cases" in {finding.check for finding in skipped}
    assert all(finding.detail for finding in skipped)


class Biased(CoSimulation):
    """An FMU that is wrong by a little, and never twice in the same way."""

    reads = 0

    def read(self, names):
        self.reads += 1
        return [value + 0.02 * self.reads for value in super().read(names)]


class Deaf(CoSimulation):
    """An FMU that takes whatever it is given."""

    def write(self, values):
        super().write({name: value for name, value in values.items() if abs(value) < 1e5})


@pytest.mark.parametrize(
    ("flight", "kind"),
    [
        (flights.level_trims, Biased),
        (flights.turns_and_climbs, Biased),
        (flights.step_sizes, Biased),
        (flights.repeats, Biased),
        (flights.refusals, Deaf),
        (flights.conservation, Biased),
        (flights.against_the_twin, Biased),
    ],
)
def test_each_flight_can_fail(flight, kind, fmu_file):
    with kind(fmu_file) as unit:
        assert not any(seen.good for seen in flight(unit))


@pytest.mark.parametrize(
    ("old", "new", "where"),
    [
        (b'license="', b'licence="', "schema and rules (fmpy)"),
        (b'unit="rad/s"', b'unit="furlong"', "schema and rules (fmpy)"),
    ],
)
def test_a_broken_description_is_found(old, new, where, fmu_file, tmp_path):
    broken = tmp_path / "broken.fmu"
    with zipfile.ZipFile(fmu_file) as source, zipfile.ZipFile(broken, "w") as target:
        for name in source.namelist():
            data = source.read(name)
            target.writestr(name, data.replace(old, new, 1) if name == "modelDescription.xml" else data)
    first = next(iter(check([broken])))
    assert (first.check, first.verdict) == (where, FAILED)


def test_what_is_no_fmu_is_an_error(tmp_path, fmu_file):
    text = tmp_path / "text.fmu"
    text.write_text("not a zip")
    with pytest.raises(PlantError, match=r"text\.fmu"):
        list(check([text]))
    bare = tmp_path / "bare.fmu"
    shutil.copy(fmu_file, bare)
    with zipfile.ZipFile(fmu_file) as source, zipfile.ZipFile(bare, "w") as target:
        target.writestr("modelDescription.xml", source.read("modelDescription.xml"))
    with pytest.raises(PlantError, match=r"bare\.fmu"):
        list(check([bare]))
