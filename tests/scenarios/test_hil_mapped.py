"""A user's own FMU behind an autopilot: its mapping, what follows from the rest, mistakes by name."""

from __future__ import annotations

import math

import pytest

from fmu.library import PACKAGED, FmuLibrary
from fmu.mapping import MappingError
from offboard.hil.plant import NEUTRAL, Axes, Phase
from scenarios.hil_mapped import MappedHilPlant, load_hil_mapping
from scenarios.hil_plant import FmuHilPlant

STATE = {
    **{name: f"state.{name}" for name in ("north", "east", "altitude", "p", "q", "r")},
    **{f"velocity_{axis}": f"state.velocity_{axis}" for axis in ("north", "east", "down")},
    **{f"q{axis}": f"state.quaternion.{axis}" for axis in "wxyz"},
}
TOLD = {
    **{f"force_{axis}": f"sensor.specific_force.{axis}" for axis in "xyz"},
    **{name: f"sensor.{name}" for name in ("static_pressure", "differential_pressure", "temperature")},
    "airspeed": "state.airspeed",
    "phase": "flight.phase",
}
ANGLES = {"bank": "state.bank", "pitch": "state.pitch", "heading": "state.heading"}
COMMAND = """
[command]
roll = {variable = "command.aileron", scale = 2.272727272727273}
pitch = {variable = "command.elevator", scale = -2.272727272727273}
throttle = "command.throttle"
launch = "command.launch"
"wind.north" = "wind.north"
"wind.east" = "wind.east"
"""
START = '"command.mode" = 0\n"launch.mode" = 1\n"launch.speed" = 16\n"launch.pitch" = 0.2\n'


@pytest.fixture
def write(tmp_path):
    """A mapping of our own FMU, given what it tells."""

    def make(state, start=START, command=COMMAND):
        roles = "".join(f'{role} = "{variable}"\n' for role, variable in state.items())
        file = tmp_path / "mine.toml"
        file.write_text(f'fmu = "{PACKAGED.as_posix()}"\n[start]\n{start}\n[state]\n{roles}{command}')
        return file

    return make


def climb(plant, steps=500):
    """Full thrust from the catapult, a little nose up."""
    states = []
    for step in range(steps):
        plant.fly(Axes(0.02, 0.05, 0.0, 1.0))
        if step == 10:
            plant.launch()
        plant.step(0.004)
        states.append(plant.truth())
    return states


def test_it_flies_as_our_own_does(write):
    with (
        FmuLibrary.open() as library,
        MappedHilPlant(load_hil_mapping(write(STATE | TOLD)), 0.0, (1.0, 2.0)) as mapped,
        FmuHilPlant(library, aircraft="skywalker_x8", launch="catapult", wind=(1.0, 2.0)) as own,
    ):
        for theirs, ours in zip(climb(mapped), climb(own), strict=True):
            assert tuple(theirs) == pytest.approx(tuple(ours), abs=1e-5)
        assert mapped.phase is own.phase is Phase.FLYING


def test_what_the_fmu_does_not_tell_follows_from_the_rest(write):
    state = {name: variable for name, variable in STATE.items() if not name.startswith("qw")}
    state = {name: variable for name, variable in state.items() if name[0] != "q" or name == "q"} | ANGLES
    with (
        MappedHilPlant(load_hil_mapping(write(STATE | TOLD)), 100.0) as told,
        MappedHilPlant(load_hil_mapping(write(state)), 100.0) as guessed,
    ):
        exact, found = climb(told, 400)[-1], climb(guessed, 400)[-1]
        assert found[:14] == pytest.approx(exact[:14], abs=1e-6)
        assert found[14:17] == pytest.approx(exact[14:17], abs=0.3)
        assert found.airspeed == pytest.approx(exact.airspeed, rel=1e-6)
        assert guessed.phase is Phase.FLYING


def test_standing_feels_minus_g_and_a_restart_begins_anew(write):
    with MappedHilPlant(load_hil_mapping(write(STATE)), 0.0) as plant:
        plant.fly(NEUTRAL)
        plant.step(0.1)
        before = plant.truth()
        assert math.hypot(before.force_x, before.force_y, before.force_z) == pytest.approx(9.80665)
        first = climb(plant, 300)
        plant.restart()
        assert (plant.truth().time, plant.phase) == (0.0, Phase.STANDING)
        plant.fly(NEUTRAL)
        plant.step(0.1)
        assert climb(plant, 300) == first


def test_a_touchdown_is_noticed(write):
    start = '"command.mode" = 0\n"initial.altitude" = 6.0\n'
    command = COMMAND.replace('launch = "command.launch"\n', "")
    with MappedHilPlant(load_hil_mapping(write(STATE, start, command)), 0.0) as plant:
        for _ in range(3000):
            plant.fly(Axes(0.0, 0.0, 0.0, 0.0))
            plant.step(0.004)
        assert plant.phase is Phase.LANDED
        assert plant.contact_speed > 0.5


@pytest.mark.parametrize(
    ("state", "command", "words"),
    [
        (STATE | {"force_x": "sensor.specific_force.x"}, COMMAND, ["force_x without the others"]),
        ({k: v for k, v in STATE.items() if k != "qw"}, COMMAND, ["without the others", "state: needs"]),
        (STATE | {"hight": "state.altitude"}, COMMAND, ["state.hight is unknown"]),
        ({**STATE, "north": "nord"}, COMMAND, ["'nord'", "no such variable"]),
        (STATE, COMMAND.replace("throttle", "thrust"), ["command.throttle is missing", "thrust is unknown"]),
        (STATE, COMMAND.replace("command.aileron", "state.bank"), ["is no input"]),
    ],
)
def test_mistakes_are_named(state, command, words, write):
    with pytest.raises(MappingError) as caught:
        load_hil_mapping(write(state, command=command))
    for word in words:
        assert word in str(caught.value)


def test_wind_needs_its_roles(write):
    command = COMMAND.replace('"wind.north" = "wind.north"\n', "")
    mapping = load_hil_mapping(write(STATE, command=command))
    with pytest.raises(MappingError, match=r"wind\.north = 3"):
        MappedHilPlant(mapping, 0.0, (3.0, 0.0))
