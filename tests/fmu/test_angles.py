"""The series that stand for arc sine and arc tangent of small angles (`fmu/src/angles.h`)."""

from __future__ import annotations

import ctypes
import math
import subprocess
from pathlib import Path

import numpy as np
import pytest

from fmu.build import FLAGS, FOLDER, compiler

SOURCE = """
#include "angles.h"
double tangent(double y, double x) { return angle_of(y, x); }
double sine(double s) { return angle_of_sine(s); }
"""
ULP = 2.0**-52


@pytest.fixture(scope="module")
def angles(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    folder = tmp_path_factory.mktemp("angles")
    (folder / "angles.c").write_text(SOURCE, encoding="utf-8")
    target = folder / "angles.so"
    flags = [flag for flag in FLAGS if flag != "-fvisibility=hidden"]
    include = f"-I{Path(FOLDER) / 'src'}"
    files = [str(folder / "angles.c"), "-o", str(target), "-lm"]
    subprocess.run([*compiler(), *flags, "-fPIC", include, *files], check=True)
    library = ctypes.CDLL(str(target))
    for name, arguments in (("tangent", 2), ("sine", 1)):
        function = getattr(library, name)
        function.argtypes, function.restype = [ctypes.c_double] * arguments, ctypes.c_double
    return library


def test_arc_tangent_within_two_units_in_the_last_place(angles: ctypes.CDLL) -> None:
    for t in np.concatenate([np.linspace(-0.2, 0.2, 2001), np.geomspace(1e-300, 1.0, 300)]):
        assert abs(angles.tangent(3.0 * t, 3.0) - math.atan(t)) <= 2.0 * ULP * abs(math.atan(t))


@pytest.mark.parametrize(
    ("y", "x"), [(0.0, -1.0), (-0.0, -1.0), (1.0, 0.0), (1.0, -5.0), (0.0, 0.0), (-2.0, 1.0)]
)
def test_arc_tangent_of_every_quadrant_is_the_library_s(angles: ctypes.CDLL, y: float, x: float) -> None:
    assert angles.tangent(y, x) == math.atan2(y, x)


def test_arc_sine_within_two_units_in_the_last_place(angles: ctypes.CDLL) -> None:
    for s in np.concatenate([np.linspace(-1.0, 1.0, 4001), np.linspace(-0.13, 0.13, 2001)]):
        assert abs(angles.sine(s) - math.asin(s)) <= 2.0 * ULP * abs(math.asin(s))


@pytest.mark.parametrize(("s", "expected"), [(1.5, math.pi / 2), (-1.0000001, -math.pi / 2)])
def test_arc_sine_beyond_one_is_that_of_one(angles: ctypes.CDLL, s: float, expected: float) -> None:
    assert angles.sine(s) == expected


def test_not_a_number_stays_one(angles: ctypes.CDLL) -> None:
    assert math.isnan(angles.sine(math.nan))
    assert math.isnan(angles.tangent(math.nan, 1.0))
