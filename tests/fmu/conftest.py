"""One FMU, built from the sources as they are, for all tests of this folder."""

from __future__ import annotations

import pytest

from fmu import FmuLibrary, FmuPlant
from fmu.build import build_fmu
from tests.fmu.users import make_users_fmu


@pytest.fixture(scope="session")
def fmu_file(tmp_path_factory):
    return build_fmu(tmp_path_factory.mktemp("fmu") / "sidestep_aircraft.fmu")


@pytest.fixture(scope="session")
def fmi2_file(fmu_file):
    """The FMI 2.0 file, which the same build writes beside it."""
    return fmu_file.with_name("sidestep_aircraft_fmi2.fmu")


@pytest.fixture(scope="session")
def library(fmu_file):
    with FmuLibrary.open(fmu_file) as opened:
        yield opened


@pytest.fixture(scope="session")
def users(tmp_path_factory):
    """Mapping of an FMU that pythonfmu makes."""
    return make_users_fmu(tmp_path_factory.mktemp("user"))


@pytest.fixture
def make_plant(library):
    """Plants that are closed at the end of the test."""
    made = []

    def make(**options) -> FmuPlant:
        made.append(FmuPlant(library, **options))
        return made[-1]

    yield make
    for plant in made:
        plant.close()
