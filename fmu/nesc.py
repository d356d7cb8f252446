"""NASA's check cases for 6-DOF simulations, flown by the aircraft FMU as parameter sets.

The cases and their reference trajectories: NASA Engineering and Safety Center, NASA/TM-2015-218675, check
cases for verification of six-degree-of-freedom flight vehicle simulations, atmospheric cases 1, 2, 3, 6. The
trajectories of several NASA simulation tools (`sim_NN`) are not part of this package; they are read from a
folder where there is one. Reference data are in US units, and so are the results here.

Earth is flat here. The references turn with an ellipsoidal earth; at the equator, where the cases begin,
gravity less the centrifugal acceleration is 9.7803 - 3.086e-6 h m/s2 (h in metres), which is all that these
four need.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fmu.cosimulation import CoSimulation
from fmu.variables import TABLE

Floats = NDArray[np.float64]
FOOT = 0.3048
SLUG = 14.593902937206364
"""Pound-force second squared per foot [kg]: 0.45359237 × 9.80665 / 0.3048."""
SLUG_FT2 = SLUG * FOOT**2
PERIOD, DURATION = 0.1, 30.0
"""Grid of the reference trajectories [s]."""
START_ALTITUDE_FT = 30_000.0
DATA = Path(__file__).parents[2] / "shared" / "nesc"
"""Where the reference trajectories lie in a development tree: beside the repository."""

_RATES = tuple(f"bodyAngularRateWrtEi_deg_s_{axis}" for axis in ("Roll", "Pitch", "Yaw"))
_ALTITUDE = ("altitudeMsl_ft",)


def _body(values: dict[str, float]) -> dict[str, float]:
    """A body without wings, engine or surfaces, at rest 30,000 ft above the equator."""
    nothing: dict[str, float] = {row.name: 0.0 for row in TABLE if row.name.startswith("aircraft.aero.")}
    return (
        nothing
        | {
            "aircraft.aero.alpha_min": -math.pi,  # no stall: these bodies meet the air from all sides
            "aircraft.aero.alpha_max": math.pi,
            "aircraft.inertia.xz": 0.0,
            "aircraft.propulsion.model": 1,
            "aircraft.propulsion.max_thrust": 0.0,
            "environment.gravity": 9.7803,
            "environment.gravity_gradient": 3.086e-6,
            "aircraft.battery.capacity": 0.0,
            "aircraft.solar.area": 0.0,
            "ground.present": 0,
            "initial.trimmed": 0,
            "initial.airspeed": 0.0,
            "initial.altitude": START_ALTITUDE_FT * FOOT,
            "command.mode": 0,
        }
        | values
    )


_SPHERE = {
    "aircraft.mass": SLUG,
    **{f"aircraft.inertia.{axis}": 3.6 * SLUG_FT2 for axis in ("xx", "yy", "zz")},
    "aircraft.wing.area": 0.1963495 * FOOT**2,
}
_BRICK = {
    "aircraft.mass": 0.155404754 * SLUG,
    "aircraft.inertia.xx": 0.001894220 * SLUG_FT2,
    "aircraft.inertia.yy": 0.006211019 * SLUG_FT2,
    "aircraft.inertia.zz": 0.007194665 * SLUG_FT2,
    "aircraft.wing.area": 0.22222 * FOOT**2,
    "aircraft.wing.span": 0.33333 * FOOT,
    "aircraft.wing.chord": 0.66667 * FOOT,
    "initial.p": math.radians(10.0),
    "initial.q": math.radians(20.0),
    "initial.r": math.radians(30.0),
}
_DAMPING = {"aircraft.aero.Cl_p": -1.0, "aircraft.aero.Cm_q": -1.0, "aircraft.aero.Cn_r": -1.0}


@dataclass(frozen=True, slots=True)
class Case:
    """One check case."""

    number: str
    """As in the report."""
    body: str
    """What falls."""
    verifies: str
    """What a right answer shows."""
    values: Mapping[str, float]
    """Parameter set of the FMU."""
    columns: tuple[str, ...]
    """Columns of the reference that are compared."""
    unit: str
    """Their unit."""
    limits: Mapping[str, float]
    """Largest error allowed, by reference tool, in that unit."""


CASES = (
    Case("01", "sphere, no air", "gravity, translation", _body(_SPHERE), _ALTITUDE, "ft", {"sim_04": 0.02}),
    Case(
        "02",
        "brick, no air",
        "rotation of an asymmetric top",
        _body(_BRICK),
        _RATES,
        "°/s",
        {"sim_01": 1e-5, "sim_04": 1e-5},
    ),
    Case(
        "03",
        "brick, damped by the air",
        "damping derivatives, their reference lengths",
        _body(_BRICK | _DAMPING),
        _RATES,
        "°/s",
        {"sim_04": 5e-4},
    ),
    Case(
        "06",
        "sphere in the air",
        "drag, density of the atmosphere",
        _body(_SPHERE | {"aircraft.aero.CD0": 0.1}),
        _ALTITUDE,
        "ft",
        {"sim_04": 0.02},
    ),
)
"""The cases that a flat earth can fly."""


def fly(case: Case, fmu: Path) -> Floats:
    """Fly a case on an FMU of either version.

    Returns
    -------
    ndarray, shape (301, n)
        The case's columns at each 0.1 s, in its unit.
    """
    if case.columns == _ALTITUDE:
        names, factor = ["state.altitude"], 1.0 / FOOT
    else:
        names, factor = ["state.p", "state.q", "state.r"], math.degrees(1.0)
    rows = []
    with CoSimulation(fmu, case.values) as unit:
        rows.append(unit.read(names))
        for _ in range(round(DURATION / PERIOD)):
            unit.step(PERIOD)
            rows.append(unit.read(names))
    return np.array(rows) * factor


def references(case: Case, folder: Path = DATA) -> dict[str, Floats]:
    """Reference trajectories of a case by tool, shape (301, n) each; empty where there are none."""
    found = {}
    for file in sorted(folder.glob(f"Atmos_{case.number}_sim_*.csv")):
        with file.open(newline="") as stream:
            rows = [[float(row[name]) for name in ("time", *case.columns)] for row in csv.DictReader(stream)]
        table = np.array(rows)
        on_grid = np.arange(round(DURATION / PERIOD) + 1) * PERIOD
        if table.shape[0] != on_grid.size or np.abs(table[:, 0] - on_grid).max() > 1e-6:
            raise ValueError(f"{file}: not one row each {PERIOD} s up to {DURATION:g} s")
        found[file.stem.removeprefix(f"Atmos_{case.number}_")] = table[:, 1:]
    return found


def errors(flown: Floats, known: Mapping[str, Floats]) -> dict[str, float]:
    """Largest difference from each tool over the whole flight and all columns."""
    return {tool: float(np.abs(flown - table).max()) for tool, table in known.items()}


def spread(known: Mapping[str, Floats]) -> float:
    """Largest difference between any two of NASA's own tools."""
    return max((float(np.abs(a - b).max()) for a, b in combinations(known.values(), 2)), default=math.nan)
