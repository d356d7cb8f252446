"""Dryden turbulence: intensity and scale of MIL-F-8785C, repeatable by seed, independent of the step."""

from __future__ import annotations

import math

import numpy as np
import pytest

WIND = 6.0
HEIGHT_FT = 60.0 / 0.3048
SPREAD = 0.177 + 0.000823 * HEIGHT_FT
SIGMA_W = 0.1 * WIND
SIGMA_U = SIGMA_W / SPREAD**0.4
LENGTH_U = HEIGHT_FT / SPREAD**1.2 * 0.3048
LENGTH_W = HEIGHT_FT * 0.3048


def gusts(make_plant, seed, seconds=6000):
    """Gusts along, across and down, at 2 Hz, of an aircraft that flies north; kinematic: ten times faster."""
    plant = make_plant(
        fidelity="kinematic",
        altitude=60.0,
        parameters={"turbulence.wind_speed": WIND, "turbulence.seed": seed},
    )
    plant.fly_leg(0, 0, 1e6, 0, 60, 15)
    rows = []
    for _ in range(2 * seconds):
        plant.step(0.5)
        rows.append([plant.get(f"air.gust_{axis}") for axis in ("north", "east", "down")])
    return np.array(rows[200:])


@pytest.fixture(scope="module")
def record(library):
    from fmu import FmuPlant  # noqa: PLC0415

    plants = []

    def make(**options):
        plants.append(FmuPlant(library, **options))
        return plants[-1]

    yield np.concatenate([gusts(make, seed) for seed in range(4)])
    for plant in plants:
        plant.close()


@pytest.mark.parametrize(("axis", "sigma"), [(0, SIGMA_U), (1, SIGMA_U), (2, SIGMA_W)])
def test_intensity_is_that_of_the_standard(axis, sigma, record):
    assert record[:, axis].std() == pytest.approx(sigma, rel=0.12)
    assert abs(record[:, axis].mean()) < 0.15 * sigma


@pytest.mark.parametrize(("axis", "length"), [(0, LENGTH_U), (1, LENGTH_U), (2, LENGTH_W)])
def test_scale_is_that_of_the_standard(axis, length, record):
    """Autocorrelation at 1 s: exp(-r) along, exp(-r)(1 - r/2) across, r = V t / L."""
    lag, ratio = 2, 15.0 / length
    expected = math.exp(-ratio) * (1 if axis == 0 else 1 - ratio / 2)
    values = record[:, axis]
    found = np.mean(values[:-lag] * values[lag:]) / np.mean(values**2)
    assert found == pytest.approx(expected, abs=0.04)


def test_a_seed_repeats_and_another_differs(make_plant):
    first, again, other = (gusts(make_plant, seed, seconds=150) for seed in (5, 5, 6))
    assert first.tobytes() == again.tobytes()
    assert not np.allclose(first, other)


def test_the_step_does_not_matter(make_plant):
    ends = []
    for step in (0.05, 1.0):
        plant = make_plant(parameters={"turbulence.wind_speed": WIND})
        for _ in range(round(20 / step)):
            plant.step(step)
        ends.append([*plant.state])
    np.testing.assert_allclose(ends[0], ends[1], rtol=0, atol=1e-9)


def test_it_is_off_by_default_and_felt_when_on(make_plant):
    calm, rough = make_plant(), make_plant(parameters={"turbulence.wind_speed": WIND})
    for plant in (calm, rough):
        plant.step(20.0)
    assert calm.get("air.gust_down") == 0.0
    assert calm.state.airspeed == pytest.approx(15.0, abs=1e-6)
    assert abs(rough.state.airspeed - 15.0) > 0.01
    assert abs(rough.state.altitude - 200) < 5
