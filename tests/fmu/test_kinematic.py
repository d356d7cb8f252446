"""The kinematic fidelity flies the 6-DOF aircraft's tracks."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from scipy.spatial import cKDTree

# Turns of 30, 90, 120 and 172 degrees, right and left, with a climb.
WAYPOINTS = (
    (0, 0, 200),
    (2000, 0, 200),
    (3500, 900, 200),
    (2600, 2400, 230),
    (4200, 3000, 230),
    (2300, 2000, 200),
)


def track(plant):
    """Positions at 10 Hz along all legs, with the leg changed 100 m before its end."""
    points = []
    for start, end in itertools.pairwise(WAYPOINTS):
        plant.fly_leg(start[0], start[1], end[0], end[1], end[2], 15.0)
        while math.hypot(plant.state.north - end[0], plant.state.east - end[1]) > 100.0:
            plant.step(0.1)
            points.append((plant.state.north, plant.state.east, plant.state.altitude))
            assert plant.time < 2000
    return np.array(points)


@pytest.mark.parametrize("guidance", ["l1", "paper"])
@pytest.mark.parametrize("aircraft", ["skywalker_x8", "techpod"])
@pytest.mark.parametrize("wind", [(0, 0, 0), (4, -3, 0)])
def test_tracks_of_both_fidelities_stay_together(guidance, aircraft, wind, make_plant):
    options = {"guidance": guidance, "aircraft": aircraft, "wind": wind}
    full = track(make_plant(**options))
    fast = track(make_plant(fidelity="kinematic", **options))
    apart = max(cKDTree(full).query(fast)[0].max(), cKDTree(fast).query(full)[0].max())
    assert apart < 20.0


def test_turns_as_fast_as_the_aircraft(make_plant):
    """Steady turn at 30 degrees: 20.25 deg/s, the published trim of the X8."""
    plant = make_plant(fidelity="kinematic", altitude=0.0)
    plant.fly_orbit(0, 40, 20, 1, 0, 15)
    rates = []
    for _ in range(300):
        plant.step(0.1)
        rates.append(math.degrees(math.hypot(plant.state.q, plant.state.r)))
    assert max(rates) == pytest.approx(20.2536, abs=0.05)


def test_reports_a_consistent_attitude(make_plant):
    plant = make_plant(fidelity="kinematic", wind=(3, -2, 0))
    plant.fly_orbit(0, 100, 100, 1, 220, 16)
    for _ in range(30):
        plant.step(1.0)
    body = [plant.get(f"state.{axis}") for axis in "uvw"]
    speed = math.hypot(plant.get("state.ground_speed"), plant.state.climb_rate)
    assert math.hypot(*body) == pytest.approx(speed, rel=1e-9)
    assert plant.get("sensor.load_factor") == pytest.approx(1 / math.cos(plant.state.bank), rel=1e-9)
