"""The FMU as the plant in the loop: it stands still, its IMU obeys physics, it lands."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fmu.library import FmuLibrary
from offboard.hil.attitude import euler, to_body
from offboard.hil.plant import NEUTRAL, Axes, Phase
from offboard.hil.scripted import Believed, ScriptedPilot, Task
from offboard.hil.simulation import LaunchRule, Simulation
from scenarios.hil_plant import FmuHilPlant

STEP = 0.004
BANK = math.radians(30.0)


@pytest.fixture(scope="module")
def library():
    with FmuLibrary.open() as opened:
        yield opened


@pytest.fixture
def make(library):
    made = []

    def build(aircraft="skywalker_x8", **options):
        made.append(FmuHilPlant(library, aircraft=aircraft, **options))
        return made[-1]

    yield build
    for plant in made:
        plant.close()


def believed(truth):
    bank, pitch, heading = euler(truth.qw, truth.qx, truth.qy, truth.qz)
    return Believed(
        truth.time, bank, pitch, heading, truth.p, truth.q, truth.r,
        truth.altitude, -truth.velocity_down, truth.airspeed,
    )  # fmt: skip


def fly(plant, tasks, until):
    """The true states of a flight by the scripted pilot who knows the truth."""
    simulation, pilot = Simulation(plant, LaunchRule(delay=0.1)), ScriptedPilot(tasks)
    states = []
    while simulation.truth.time < until and simulation.phase is not Phase.LANDED:
        states.append(simulation.step(pilot.fly(believed(simulation.truth)), STEP))
    return simulation, states


@pytest.mark.parametrize("wind", [(0.0, 0.0), (-6.0, 3.0)])
@pytest.mark.parametrize("launch", ["runway", "catapult"])
def test_on_the_ground_it_stands_and_feels_minus_g(launch, wind, make):
    plant = make(launch=launch, wind=wind)
    simulation, before = Simulation(plant), plant.truth()
    for _ in range(2500):
        simulation.step(NEUTRAL, STEP)
    after = simulation.truth
    assert simulation.phase is Phase.STANDING
    assert after[1:13] == before[1:13]
    force = (after.force_x, after.force_y, after.force_z)
    assert force == pytest.approx(to_body(after, (0.0, 0.0, -9.81)), rel=1e-6)
    assert all(map(math.isfinite, after))


def test_a_run_up_that_is_broken_off_ends_at_rest(make):
    simulation = Simulation(make(), LaunchRule(delay=0.0))
    for axes, steps in ((Axes(0.0, 0.0, 0.0, 0.8), 500), (NEUTRAL, 12_500)):
        for _ in range(steps):
            simulation.step(axes, STEP)
    rest = simulation.truth
    for _ in range(500):
        simulation.step(NEUTRAL, STEP)
    assert simulation.phase is Phase.LAUNCHING
    assert rest.north > 1.0
    assert simulation.truth == rest._replace(time=simulation.truth.time)


@pytest.mark.parametrize("launch", ["runway", "catapult"])
def test_take_off_climb_and_touchdown(launch, make):
    tasks = (Task(until=14.0, altitude=15.0), Task(until=math.inf, altitude=-1.0))
    simulation, states = fly(make(launch=launch), tasks, 60.0)
    assert simulation.phase is Phase.LANDED
    assert max(state.altitude for state in states) > 12.0
    assert simulation.truth.altitude == 0.0
    assert 0.3 < simulation.plant.contact_speed < 2.5
    at_rest = simulation.truth
    simulation.step(NEUTRAL, STEP)
    assert simulation.truth == at_rest._replace(time=simulation.truth.time)


def test_a_restart_is_the_same_flight_again(make):
    tasks = (Task(until=math.inf, altitude=30.0),)
    plant = make(launch="catapult")
    first = fly(plant, tasks, 3.0)[1]
    plant.restart()
    assert plant.truth().time == 0.0
    assert fly(plant, tasks, 3.0)[1] == first


def turn(make, aircraft):
    """The last second of a level turn at 30° of bank, as columns by name."""
    plant = make(aircraft, launch="air")
    _, states = fly(plant, (Task(until=math.inf, altitude=100.0, bank=BANK),), 60.0)
    columns = np.array(states[-250:])
    return {name: columns[:, index] for index, name in enumerate(states[0]._fields)}


@pytest.mark.parametrize("aircraft", ["skywalker_x8", "techpod"])
def test_a_steady_turn_feels_what_circular_motion_says(aircraft, make):
    """Specific force: centripetal acceleration less gravity; rates: the turn, in the body."""
    seen = turn(make, aircraft)
    course = np.unwrap(np.arctan2(seen["velocity_east"], seen["velocity_north"]))
    rate = (course[-1] - course[0]) / (seen["time"][-1] - seen["time"][0])
    speed = np.hypot(seen["velocity_north"], seen["velocity_east"]).mean()
    force = np.sqrt(seen["force_x"] ** 2 + seen["force_y"] ** 2 + seen["force_z"] ** 2).mean()
    assert force == pytest.approx(math.hypot(9.81, speed * rate), rel=0.01)
    bank, pitch, _ = euler(*(seen[name][-1] for name in ("qw", "qx", "qy", "qz")))
    assert bank == pytest.approx(BANK, rel=0.01)
    assert seen["q"].mean() == pytest.approx(rate * math.sin(bank) * math.cos(pitch), rel=0.01)
    assert seen["r"].mean() == pytest.approx(rate * math.cos(bank) * math.cos(pitch), rel=0.01)
    assert seen["p"].mean() == pytest.approx(-rate * math.sin(pitch), rel=0.01, abs=0.01 * rate)


def test_a_coordinated_turn_is_that_of_the_textbook(make):
    """With a rudder that keeps the ball centred: n = 1/cos φ, turn rate = g tan φ / V."""
    plant = make("techpod", launch="air")
    simulation, pilot = Simulation(plant), ScriptedPilot((Task(math.inf, altitude=100.0, bank=BANK),))
    rudder, states = 0.0, []
    while simulation.truth.time < 60.0:
        truth = simulation.truth
        rudder = min(max(rudder - 0.05 * STEP * truth.force_y, -1.0), 1.0)
        axes = pilot.fly(believed(truth))._replace(yaw=rudder - 0.03 * truth.force_y)
        states.append(simulation.step(axes, STEP))
    late = states[-250:]
    speed = math.hypot(late[-1].velocity_north, late[-1].velocity_east)
    rate = np.mean([math.hypot(each.q, each.r) for each in late])
    assert abs(late[-1].force_y) < 0.05
    assert -np.mean([each.force_z for each in late]) == pytest.approx(9.81 / math.cos(BANK), rel=0.01)
    assert rate == pytest.approx(9.81 * math.tan(BANK) / speed, rel=0.01)


def test_an_unknown_launch_is_refused(library):
    with pytest.raises(ValueError, match="launch='slingshot'"):
        FmuHilPlant(library, aircraft="skywalker_x8", launch="slingshot")
