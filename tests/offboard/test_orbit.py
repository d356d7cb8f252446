from __future__ import annotations

import math

import pytest

from avoidance import Waypoint
from offboard.orbit import Orbit
from tests.offboard.fake_plant import FakePlant


@pytest.mark.parametrize("heading", [0.0, 1.0, -2.5])
def test_the_orbit_from_here_passes_through_here_and_lies_to_the_right(heading: float) -> None:
    state = FakePlant(north=3000.0, east=-200.0, heading=heading).state

    orbit = Orbit.from_here(state, 60.0)

    to_centre = (orbit.north - state.north, orbit.east - state.east)
    assert math.hypot(*to_centre) == pytest.approx(60.0)
    assert math.remainder(math.atan2(to_centre[1], to_centre[0]) - heading, math.tau) == pytest.approx(
        0.5 * math.pi
    )
    assert orbit.direction == 1


def test_a_plant_told_to_fly_it_stays_on_it() -> None:
    plant = FakePlant(heading=0.7)
    orbit = Orbit.from_here(plant.state, 60.0)

    orbit.command(plant, 15.0)
    for _ in range(60):
        plant.step(1.0)

    distances = [math.dist(place, (orbit.north, orbit.east)) for place in plant.track]
    assert max(distances) < 65.0
    assert min(distances) > 55.0


@pytest.mark.parametrize(("radius", "direction"), [(0.0, 1), (math.nan, 1), (-5.0, -1), (60.0, 0)])
def test_impossible_orbits_are_refused(radius: float, direction: int) -> None:
    with pytest.raises(ValueError, match="must be"):
        Orbit.about(Waypoint(0.0, 0.0, 200.0), radius, direction)
