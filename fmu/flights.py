"""Short flights that show whether an FMU of the aircraft behaves: what `sidestep fmu check` is made of.

Each takes one FMU of either version, started and driven by nothing but the standard's own calls, and answers
with what it saw. Limits are beside the flights; figures are in SI units.
"""

from __future__ import annotations

import importlib.util
import math
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fmu.cosimulation import CoSimulation
from fmu.parameters import aircraft_names, load_aircraft

TWIN = Path(__file__).parents[1] / "tests" / "fmu" / "aircraft_twin.py"
"""The independent model of the same equations, in a source tree."""
CRUISE = 15.0
"""Airspeed of the trims [m/s]."""
_RATES = tuple(f"rate.{axis}" for axis in ("u", "v", "w", "p", "q", "r"))
_EVEN = {"environment.gravity": 9.81, "environment.gravity_gradient": 0.0, "ground.present": 0}
"""As the independent model has it: gravity the same everywhere, no ground."""


class Seen(NamedTuple):
    """What a flight showed."""

    check: str
    """What was looked at, in a few words."""
    good: bool
    """Whether it is as it must be."""
    detail: str
    """The figure and its limit."""


def level_trims(unit: CoSimulation) -> Iterator[Seen]:
    """Each aircraft starts in level trim and is still there a minute later."""
    for aircraft in aircraft_names():
        unit.restart(load_aircraft(aircraft))
        still = max(abs(rate) for rate in unit.read(_RATES))
        begin = unit.read(["state.altitude"])[0]
        drift = speed = 0.0
        for _ in range(60):
            unit.step(1.0)
            altitude, airspeed = unit.read(["state.altitude", "state.airspeed"])
            drift, speed = max(drift, abs(altitude - begin)), max(speed, abs(airspeed - CRUISE))
        good = still < 1e-8 and drift < 1e-3 and speed < 1e-3
        detail = f"accelerations {still:.0e} at the start; in 60 s {drift:.0e} m and {speed:.0e} m/s (1e-3)"
        yield Seen(f"level trim, {aircraft}", good, detail)


def turns_and_climbs(unit: CoSimulation) -> Iterator[Seen]:
    """Each aircraft circles and climbs as it is told to."""
    for aircraft in aircraft_names():
        values = load_aircraft(aircraft)
        circle = {"command.mode": 2, "command.orbit.east": 60.0, "command.orbit.radius": 60.0}
        unit.restart(values | circle)
        off = 0.0
        for second in range(90):
            unit.step(1.0)
            north, east = unit.read(["state.north", "state.east"])
            off = max(off, abs(math.hypot(north, east - 60.0) - 60.0)) if second >= 60 else 0.0
        yield Seen(f"circle, {aircraft}", off < 1.0, f"radius within {off:.2f} m of 60 m (1 m)")
        rise = values["aircraft.limits.climb_rate"]
        unit.restart(values | {"command.altitude": 400.0})
        unit.step(20.0)
        climb, airspeed = unit.read(["state.climb_rate", "state.airspeed"])
        good = abs(climb - rise) < 0.02 and abs(airspeed - CRUISE) < 0.1
        yield Seen(f"climb, {aircraft}", good, f"{climb:.3f} of {rise:g} m/s, at {airspeed:.2f} m/s")


def step_sizes(unit: CoSimulation) -> Iterator[Seen]:
    """The importer's choice of step does not change the flight."""
    ends = [manoeuvre(unit, step)[-1] for step in (1.0, 0.05)]
    places = [unit.outputs.index(f"state.{axis}") for axis in ("north", "east", "altitude")]
    apart = float(np.abs(ends[0] - ends[1])[places].max())
    yield Seen("step size", apart < 5e-4, f"1 s and 0.05 s end {apart:.0e} m apart after 12 s (5e-4 m)")


def repeats(unit: CoSimulation) -> Iterator[Seen]:
    """The same flight again gives the same bits."""
    first, second = (manoeuvre(unit, 0.1).tobytes() for _ in range(2))
    yield Seen("determinism", first == second, f"{len(first) // 8} values, compared bit by bit")


def refusals(unit: CoSimulation) -> Iterator[Seen]:
    """Nonsense is refused with the variable's name, and the flight goes on."""
    unit.restart({})
    bad = {"command.altitude": math.nan, "command.airspeed": math.inf, "wind.north": 1e6}
    named = 0
    for name, value in bad.items():
        try:
            unit.write({name: value})
        except ValueError as error:
            named += name in str(error)
    unit.step(1.0)
    going = all(math.isfinite(value) for value in unit.read(unit.outputs))
    yield Seen("refusals", named == len(bad) and going, f"{named} of {len(bad)} bad inputs refused by name")


def conservation(unit: CoSimulation) -> Iterator[Seen]:
    """Without air a tumbling body keeps its energy and the length of its angular momentum."""
    values = load_aircraft() | {name: 0.0 for name in load_aircraft() if name.startswith("aircraft.aero.")}
    values |= {"aircraft.aero.alpha_min": -math.pi, "aircraft.aero.alpha_max": math.pi}
    values |= {"aircraft.propulsion.model": 1, "aircraft.propulsion.max_thrust": 0.0, "command.mode": 0}
    values |= {"initial.trimmed": 0, "initial.p": 2.0, "initial.q": 1.0, "initial.r": -1.5}
    unit.restart(values | {"initial.altitude": 3000.0} | _EVEN)
    before = _invariants(unit, values)
    unit.step(10.0)
    lost = float(np.abs(_invariants(unit, values) / before - 1.0).max())
    detail = f"energy and angular momentum to {lost:.0e} after 10 s of tumbling (1e-8)"
    yield Seen("conservation", lost < 1e-8, detail)


def _invariants(unit: CoSimulation, values: Mapping[str, float]) -> NDArray[np.float64]:
    """Angular momentum, rotational energy, energy per mass of the centre of gravity."""
    tensor = np.diag([values[f"aircraft.inertia.{axis}"] for axis in ("xx", "yy", "zz")])
    tensor[0, 2] = tensor[2, 0] = -values["aircraft.inertia.xz"]
    rates = np.array(unit.read(["state.p", "state.q", "state.r"]))
    *velocity, altitude = unit.read(["state.u", "state.v", "state.w", "state.altitude"])
    energy = 0.5 * float(np.dot(velocity, velocity)) + 9.81 * altitude
    return np.array([np.linalg.norm(tensor @ rates), rates @ tensor @ rates, energy])


def against_the_twin(unit: CoSimulation) -> Iterator[Seen]:
    """State derivatives at random states against the independent model, both aircraft.

    Nothing is seen where the source tree's tests are absent.
    """
    if (twin := _twin()) is None:
        return
    for aircraft in aircraft_names():
        rng, worst = np.random.default_rng(7), 0.0
        for _ in range(10):
            worst = max(worst, _twin_error(unit, twin, load_aircraft(aircraft), rng))
        yield Seen(
            f"twin, {aircraft}", worst < 1e-9, f"accelerations at 10 random states: {worst:.0e} (1e-9)"
        )


def _twin_error(
    unit: CoSimulation, twin: ModuleType, values: dict[str, float], rng: np.random.Generator
) -> float:
    """Largest relative difference of six accelerations at one random state in random wind."""
    names = ("bank", "pitch", "alpha", "beta", "p", "q", "r", "aileron", "elevator", "rudder", "throttle")
    spans = (3.0, 1.4, 0.5, 0.4, 2.0, 2.0, 2.0, 0.4, 0.4, 0.3, 1.0)
    s = {name: float(rng.uniform(-span, span)) for name, span in zip(names, spans, strict=True)}
    s["throttle"] = abs(s["throttle"])
    wind, heading, airspeed = rng.uniform(-8, 8, 3), float(rng.uniform(-3, 3)), float(rng.uniform(8, 30))
    start = {f"initial.{name}": value for name, value in s.items()} | _EVEN
    start |= {"initial.trimmed": 0, "initial.heading": heading, "initial.airspeed": airspeed}
    start |= {f"wind.{axis}": float(x) for axis, x in zip(("north", "east", "down"), wind, strict=True)}
    unit.restart(values | start)
    a, b = s["alpha"], s["beta"]
    air = airspeed * np.array([math.cos(a) * math.cos(b), math.sin(b), math.sin(a) * math.cos(b)])
    model = twin.Twin(values, unit.read(["air.density"])[0])
    surfaces = (s["aileron"], s["elevator"], s["rudder"])
    attitude, rates = (s["bank"], s["pitch"], heading), np.array([s["p"], s["q"], s["r"]])
    linear, angular, _ = model.accelerations(air, rates, attitude, surfaces, s["throttle"], wind)
    expected = np.concatenate([linear, angular])
    return float((np.abs(np.array(unit.read(_RATES)) - expected) / (1.0 + np.abs(expected))).max())


def _twin() -> ModuleType | None:
    if not TWIN.is_file():
        return None
    spec = importlib.util.spec_from_file_location("sidestep_aircraft_twin", TWIN)
    if spec is None or spec.loader is None:
        return None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # its dataclass looks itself up there
    spec.loader.exec_module(module)
    return module


def manoeuvre(unit: CoSimulation, step: float) -> NDArray[np.float64]:
    """Twelve seconds of turn and climb from the default start: all outputs at each second."""
    unit.restart({})
    unit.write({"command.leg.from_north": -100.0, "command.leg.from_east": 300.0})
    unit.write({"command.leg.to_north": 5000.0, "command.leg.to_east": 4000.0, "command.altitude": 230.0})
    rows = []
    for _ in range(12):
        for _ in range(round(1.0 / step)):
            unit.step(step)
        rows.append(unit.read(unit.outputs))
    return np.array(rows)
