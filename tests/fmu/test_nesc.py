"""The FMU against the trajectories of NASA's own simulation tools (NASA/TM-2015-218675)."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fmu.nesc import CASES, DATA, errors, fly, references, spread

needs_data = pytest.mark.skipif(
    not DATA.is_dir(),
    reason=f"NASA's reference trajectories are absent: no folder {DATA.name} beside the tree",
)


@pytest.fixture(scope="module")
def flown(fmu_file):
    return {case.number: fly(case, fmu_file) for case in CASES}


@needs_data
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.number)
def test_stays_within_the_limit_of_each_reference(case, flown):
    known = references(case)
    found = errors(flown[case.number], known)
    assert set(case.limits) <= set(known)
    for tool, limit in case.limits.items():
        assert found[tool] < limit, tool


@needs_data
@pytest.mark.parametrize(
    "case", [case for case in CASES if case.number != "01"], ids=lambda case: case.number
)
def test_is_nearer_to_a_tool_of_nasa_than_they_are_to_one_another(case, flown):
    """All but 01, where NASA's tools agree to 0.002 ft and a flat earth with linear gravity to 0.011 ft."""
    known = references(case)
    assert min(errors(flown[case.number], known).values()) < spread(known)


@pytest.mark.parametrize("number", ["01", "06"])
def test_falls_as_the_closed_form_says(number, flown):
    """Without air the fall z'' = g + k z, so z = g/k (cosh(sqrt(k) t) - 1); air only makes it slower."""
    gravity, gradient, start = 9.7803, 3.086e-6, 30_000 * 0.3048
    here = gravity - gradient * start
    root = math.sqrt(gradient)
    times = np.arange(301) * 0.1
    vacuum = here / gradient * (np.cosh(root * times) - 1) / 0.3048
    fallen = 30_000 - flown[number][:, 0]
    if number == "01":
        np.testing.assert_allclose(fallen, vacuum, atol=1e-5)
    else:
        assert np.all(fallen[1:] < vacuum[1:])
        assert 100 < vacuum[-1] - fallen[-1] < 1000


def test_the_brick_keeps_its_energy_and_the_damped_one_loses_it(flown):
    moments = np.array([0.001894220, 0.006211019, 0.007194665])
    free, damped = ((flown[number] ** 2) @ moments for number in ("02", "03"))
    np.testing.assert_allclose(free, free[0], rtol=1e-9)
    assert np.all(np.diff(damped) < 0)
