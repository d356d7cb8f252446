"""The guarantee of docs/guarantee.md: with everything seen in time, nothing that stands still is entered.

`GUARANTEE=thorough` flies thousands of worlds instead of a sample (CONTRIBUTING.md).
"""

from __future__ import annotations

import os

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from scenarios.fence import FenceArea
from tests.avoidance.guarded import Disc, PopUp, Walls, World, fly

THOROUGH = os.environ.get("GUARANTEE") == "thorough"
PROFILE = settings(
    max_examples=int(os.environ.get("GUARANTEE_WORLDS", "3000" if THOROUGH else "120")),
    derandomize=not THOROUGH,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
    print_blob=True,
)


def by_fifty(low: int, high: int) -> st.SearchStrategy[float]:
    """Multiples of 50 m, nearest to nought first."""
    return st.integers(low // 50, high // 50).map(lambda k: 50.0 * k)


RADII = by_fifty(200, 1500)
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


@PROFILE
@given(WORLDS)
def test_nothing_that_is_seen_in_time_is_entered(world: World) -> None:
    flight = fly(world)
    assert not flight.entries, "\n".join(flight.decisions[-12:])
    assert not flight.breaches, "\n".join(flight.decisions[-12:])
