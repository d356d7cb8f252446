"""The guarantee of docs/guarantee.md: with everything seen in time, nothing that stands still is entered.

A sample is flown; `GUARANTEE=ci` flies hundreds of worlds, `GUARANTEE=thorough` thousands (CONTRIBUTING.md).
"""

from __future__ import annotations

import os

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from scenarios.fence import FenceArea
from tests.avoidance.guarded import Disc, PopUp, Walls, World, fly

WORLDS_FLOWN = {"quick": (30, 2), "ci": (300, 15), "thorough": (3000, 150)}
"""On the kinematic fidelity, and on 6-DOF."""
CHOSEN = os.environ.get("GUARANTEE", "quick")


def flown(count: int) -> settings:
    """So many worlds: the same ones in the quick mode, else those of `--hypothesis-seed`, or new ones."""
    return settings(
        max_examples=count,
        derandomize=CHOSEN == "quick",
        deadline=None,
        database=None,
        suppress_health_check=[HealthCheck.too_slow],
        print_blob=True,
    )


def by_fifty(low: int, high: int) -> st.SearchStrategy[float]:
    """Multiples of 50 m, nearest to nought first."""
    return st.integers(low // 50, high // 50).map(lambda k: 50.0 * k)


RADII = st.one_of(by_fifty(200, 1500), st.sampled_from([100.0, 20.0]))
DISCS = st.builds(Disc, by_fifty(1500, 11_000), by_fifty(-3500, 3500), RADII)
WALLS = st.builds(
    Walls,
    north=by_fifty(1500, 8000),
    east=by_fifty(-1500, 1500),
    bearing_deg=st.sampled_from([0.0, 10.0, -20.0, 45.0, 90.0, -90.0, 135.0, 180.0]),
    width=st.integers(5, 60).map(lambda k: 10.0 * k),
    length=by_fifty(500, 6000),
    radius=by_fifty(300, 1200),
    closed=st.booleans(),
    open_side=st.sampled_from([0, 0, -1, 1]),
)
POP_UPS = st.builds(
    PopUp,
    time=st.integers(5, 900).map(float),
    bearing_deg=st.integers(-18, 18).map(lambda k: 10.0 * k),
    further=by_fifty(0, 2000),
    radius=RADII,
)
MISSIONS = st.one_of(
    st.just(((12_000.0, 0.0),)),
    st.lists(
        st.tuples(by_fifty(2000, 11_000), by_fifty(-4000, 4000)), min_size=1, max_size=3, unique=True
    ).map(tuple),
)


def box(south: float, west: float, height: float, width: float) -> FenceArea:
    """A rectangle to stay out of."""
    north, east = south + height, west + width
    return FenceArea(False, ((south, west), (north, west), (north, east), (south, east)))


def field(notch: float, width: float) -> FenceArea:
    """A rectangle to stay in, with a notch cut into it from the left."""
    west = ((-2000.0, -width), (5000.0, -width), (5000.0, notch), (6000.0, notch), (6000.0, -width))
    return FenceArea(True, (*west, (14_000.0, -width), (14_000.0, 4000.0), (-2000.0, 4000.0)))


BOXES = st.builds(box, by_fifty(1000, 9000), by_fifty(-4000, 3000), by_fifty(50, 4000), by_fifty(50, 4000))
FIELDS = st.builds(field, by_fifty(-1500, 2500), by_fifty(1600, 4000))
CIRCLES = st.builds(
    lambda north, east, radius: FenceArea(False, centre=(north, east), radius=radius),
    by_fifty(1500, 10_000),
    by_fifty(-3000, 3000),
    by_fifty(100, 2500),
)
FENCES = st.one_of(
    st.just(()),
    st.lists(st.one_of(BOXES, FIELDS, CIRCLES), min_size=1, max_size=4).map(tuple),
)
WORLDS = st.builds(
    World,
    mission=MISSIONS,
    discs=st.lists(DISCS, max_size=12).map(tuple),
    walls=st.lists(WALLS, max_size=2).map(tuple),
    pop_ups=st.lists(POP_UPS, max_size=8).map(tuple),
    wind=st.sampled_from([(0.0, 0.0), (0.0, 0.0), (5.0, 0.0), (0.0, -8.0)]),
    sight=st.sampled_from([10_000.0, 4000.0]),
    fence=FENCES,
)


@flown(WORLDS_FLOWN[CHOSEN][0])
@given(WORLDS)
def test_nothing_that_is_seen_in_time_is_entered(world: World) -> None:
    flight = fly(world)
    assert not flight.entries, "\n".join(flight.decisions[-12:])
    assert not flight.breaches, "\n".join(flight.decisions[-12:])


@flown(WORLDS_FLOWN[CHOSEN][1])
@given(WORLDS)
def test_nor_on_six_degrees_of_freedom(world: World) -> None:
    flight = fly(world, "6dof")
    assert not flight.entries, "\n".join(flight.decisions[-12:])
    assert not flight.breaches, "\n".join(flight.decisions[-12:])


# Found by the property above, shrunk by hand or by hypothesis.
FOUND = {
    "an edge of the fence whose middle lies in a circle to stay out of": World(
        mission=((12_000.0, 0.0),),
        walls=(
            Walls(1500.0, 0.0, 0.0, width=50.0, length=5350.0, radius=600.0, closed=False, open_side=1),
            Walls(3700.0, -350.0, -90.0, width=340.0, length=2650.0, radius=500.0, closed=True, open_side=1),
        ),
        wind=(5.0, 0.0),
        fence=(FenceArea(False, centre=(4600.0, 2300.0), radius=2400.0), field(250.0, 3650.0)),
    ),
    "the end of a narrow box, round which several waypoints were passed at once": World(
        mission=((1950.0, -1250.0),), fence=(box(1600.0, -6000.0, 50.0, 6100.0),)
    ),
}


@pytest.mark.parametrize("name", FOUND)
def test_what_was_entered_once_is_not_entered_again(name: str) -> None:
    flight = fly(FOUND[name])
    assert not flight.entries
    assert not flight.breaches


def test_the_judge_sees_an_entry() -> None:
    """Without room to see it in time: the property can fail."""
    late = World(pop_ups=(PopUp(200.0, 0.0, -1500.0, 1500.0),))
    assert fly(late).entries


@pytest.mark.parametrize("width", [100.0, 200.0])
def test_a_dead_end_on_six_degrees_of_freedom(width: float) -> None:
    """A dead end as narrow as an orbit, closed by a pop-up while the vehicle is in it."""
    shut = World(
        walls=(Walls(2000.0, 30.0, 0.0, width=width + 100.0, length=5000.0, radius=600.0, closed=True),),
        pop_ups=(PopUp(280.0, 180.0, 0.0, 600.0), PopUp(300.0, 90.0, 300.0, 400.0)),
    )
    flight = fly(shut, "6dof")
    assert not flight.entries
