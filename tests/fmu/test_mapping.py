"""A user's own FMU as plant: flown through its mapping; what is wrong with a mapping is named."""

from __future__ import annotations

import math
import shutil
import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from avoidance import Performance
from fmu.errors import PlantError
from fmu.mapped import MappedPlant
from fmu.mapping import COMMAND_ROLES, STATE_ROLES, MappingError, load_mapping
from offboard.frames import MapFrame
from offboard.link import Plant
from offboard.mission import MissionItem, MissionPlan
from offboard.simulated import SimulatedVehicle

OWN = "\n".join(
    ['fmu = "own.fmu"', "[start]", '"initial.altitude" = 250', '"command.altitude" = 250', "[state]"]
    + [f'{role} = "state.{role}"' for role in STATE_ROLES]
    + ["[command]", 'mode = "command.mode"']
    + [f'"{role}" = "command.{role}"' for role in COMMAND_ROLES]
    + [f'"wind.{axis}" = "wind.{axis}"' for axis in ("north", "east", "down")]
)


@pytest.fixture
def own(fmu_file, tmp_path):
    """Our own FMU beside a mapping, as a user would have it."""
    shutil.copy(fmu_file, tmp_path / "own.fmu")
    file = tmp_path / "own.toml"
    file.write_text(OWN)
    return file


def test_our_own_fmu_through_a_mapping_flies_as_it_does_directly(own, make_plant):
    direct = make_plant(altitude=250)
    with MappedPlant(load_mapping(own)) as plant:
        for each in (direct, plant):
            each.fly_leg(-100, 300, 5000, 4000, 270, 16)
        for _ in range(20):
            direct.step(1.0)
            plant.step(1.0)
        for role in STATE_ROLES:
            assert getattr(plant.state, role) == getattr(direct.state, role), role
        for each in (direct, plant):
            each.fly_orbit(0, 100, 80, -1, 260, 14)
            each.set_wind(2.0, -1.0)
            each.step(5.0)
        assert plant.state.north == direct.state.north
        assert plant.state.time == 25.0


def test_a_users_fmu_flies_legs_and_orbits_in_its_own_units(users):
    with MappedPlant(load_mapping(users)) as plant:
        assert plant.state.altitude == pytest.approx(600 * 0.3048 - 100)
        plant.fly_leg(0, 200, 1000, 200, 120, 20)
        for _ in range(40):
            plant.step(1.0)
        state = plant.state
        assert state.east == pytest.approx(200, abs=1.0)
        assert state.altitude == pytest.approx(120, abs=0.1)
        assert state.airspeed == pytest.approx(20)
        assert abs(state.heading) < 0.02
        plant.fly_orbit(state.north, 300, 100, 1, 110, 15)
        centre = state.north
        for _ in range(60):
            plant.step(1.0)
        assert math.hypot(plant.state.north - centre, plant.state.east - 300) == pytest.approx(100, abs=3)
        assert plant.state.altitude == pytest.approx(110, abs=0.1)


def test_a_users_fmu_flies_a_mission_behind_the_vehicle_interface(users):
    frame = MapFrame(14.39, 76.60, 600.0)
    performance = Performance(
        airspeed=15.0, max_bank=0.5, roll_time=1.0, acceptance_radius=60.0, tracking_error=5.0
    )
    with MappedPlant(load_mapping(users)) as unit:
        plant: Plant = unit
        vehicle = SimulatedVehicle(plant, frame, performance)
        points = [frame.to_geodetic(north, east) for north, east in ((0, 0), (600, 0), (600, 500))]
        vehicle.upload_mission(MissionPlan.of([MissionItem(*point, 100.0) for point in points]))
        vehicle.start_mission()
        while not vehicle.finished:
            vehicle.advance(1.0)
            assert plant.state.time < 120
    # 600 m and 500 m, less what the acceptance radius cuts off
    assert plant.state.time == pytest.approx((600 + 500) / 15, abs=8)


def test_wind_reaches_the_users_fmu_or_is_refused(users, tmp_path):
    with MappedPlant(load_mapping(users)) as plant:
        plant.fly_leg(0, 0, 1000, 0, 100, 15)
        plant.set_wind(3.0, 0.0)
        plant.step(1.0)
        assert plant.state.velocity_north == pytest.approx(18.0)
        with pytest.raises(ValueError, match=r"wind\.down = 1"):
            plant.set_wind(0.0, 0.0, 1.0)


NORTH = 'north = "state.north"'


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (NORTH, 'north = "state.nroth"', ("state.nroth", "north'?")),
        (NORTH, "north = 3", ("state.north", "3")),
        (NORTH, 'north = {variable = "state.north", scale = 0}', ("state.north.scale", "0")),
        (NORTH, 'north = {variable = "state.north", factor = 2}', ("state.north.factor",)),
        (NORTH, 'nord = "state.north"', ("state.nord is unknown", "state.north is missing")),
        ('mode = "command.mode"', 'mode = "state.north"', ("command.mode", "state.north", "output")),
        ('"initial.altitude" = 250', '"initial.altitud" = 250', ("start.initial.altitud = 250",)),
        ('"initial.altitude" = 250', '"initial.altitude" = "high"', ("start.initial.altitude", "high")),
        ('fmu = "own.fmu"', "fmu = 1", ("fmu = 1",)),
        ('fmu = "own.fmu"', 'fmu = "own.fmu"\nsteps = 1', ("steps is unknown",)),
        ('fmu = "own.fmu"', 'fmu = "own.fmu"\n[modes]\n', ("modes is unknown",)),
        ('fmu = "own.fmu"', 'fmu = "own.fmu"\n[mode]\ncircle = 1\n', ("mode.circle is unknown",)),
    ],
)  # fmt: skip
def test_mistakes_are_named_with_file_key_and_value(own, old, new, words):
    own.write_text(OWN.replace(old, new, 1))
    with pytest.raises(MappingError) as caught:
        load_mapping(own)
    for word in ("own.toml", *words):
        assert word in str(caught.value)


def test_all_mistakes_are_told_at_once(own):
    own.write_text(OWN.replace('"state.north"', '"a"').replace('"state.east"', '"b"'))
    with pytest.raises(MappingError) as caught:
        load_mapping(own)
    assert len(caught.value.mistakes) == 2


def test_an_fmu_for_model_exchange_only_is_refused(own):
    """Our own with the Co-Simulation taken out of its description."""
    folder = own.parent / "unpacked"
    with zipfile.ZipFile(own.with_suffix(".fmu")) as archive:
        archive.extractall(folder)
    description = folder / "modelDescription.xml"
    tree = ET.parse(description)
    root = tree.getroot()
    interface = root.find("CoSimulation")
    root.remove(interface)
    if root.find("ModelExchange") is None:
        root.insert(0, ET.Element("ModelExchange", modelIdentifier=interface.attrib["modelIdentifier"]))
    tree.write(description)
    packed = shutil.make_archive(str(own.parent / "me"), "zip", folder)
    Path(packed).replace(own.with_suffix(".fmu"))
    with pytest.raises(MappingError, match=r"own\.fmu.*Model Exchange only"):
        load_mapping(own)


def test_a_missing_fmu_is_named(own):
    own.with_suffix(".fmu").unlink()
    with pytest.raises(PlantError, match=r"own\.fmu"):
        load_mapping(own)


def test_what_the_fmu_refuses_is_told_in_its_own_words(own):
    with pytest.raises(ValueError, match=r"initial\.altitude"):
        MappedPlant(load_mapping(own), {"initial.altitude": 1e9})
    with MappedPlant(load_mapping(own)) as plant:
        with pytest.raises(ValueError, match=r"command\.airspeed"):
            plant.fly_leg(0, 0, 1, 1, 200, 1e6)
        with pytest.raises(ValueError, match=r"leg\.from_north = nan"):
            plant.fly_leg(math.nan, 0, 1, 1, 200, 15)
        with pytest.raises(ValueError, match="direction"):
            plant.fly_orbit(0, 0, 50, 0, 200, 15)
        with pytest.raises(ValueError, match="duration"):
            plant.step(0)
