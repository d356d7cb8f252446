"""The 6-DOF airframe against an independent model and against published trims."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fmu import load_aircraft
from tests.fmu.aircraft_twin import Twin, dcm

DEG = 180 / math.pi
GRADIENT = 3.086e-6
"""Default loss of gravity with height [1/s2]; the published trims know none."""
EVEN = {"environment.gravity_gradient": 0.0}
RUDDER = {"skywalker_x8": False, "techpod": True}
DENSITY = {"skywalker_x8": 1.225, "techpod": 1.18}
# Trims at 15 m/s from the project's aircraft data (aircraft.json, "trims_deg"), degrees and throttle.
TRIMS = {
    ("skywalker_x8", 0, 0): {"alpha": 3.2266, "pitch": 3.2266, "elevator": 0.9465, "throttle": 0.3572},
    ("skywalker_x8", 30, 0): {
        "alpha": 3.8179, "beta": 3.2914, "pitch": 4.9501, "elevator": -0.4087, "aileron": 1.3787,
        "throttle": 0.3874, "turn": 20.2536,
    },
    ("skywalker_x8", 0, 3): {"alpha": 3.0757, "pitch": 14.6126, "elevator": 1.1127, "throttle": 0.8153},
    ("techpod", 0, 0): {"alpha": 1.1685, "beta": 0, "pitch": 1.1685, "elevator": -0.1594, "throttle": 0.5279},
    ("techpod", 30, 0): {
        "alpha": 1.5893, "beta": 0, "pitch": 1.3765, "elevator": -1.4803, "aileron": -0.2045,
        "rudder": 2.2532, "throttle": 0.5152, "turn": 21.6258,
    },
    ("techpod", 0, 3): {"alpha": 1.1056, "pitch": 12.6426, "elevator": -0.1289, "throttle": 0.8832},
}  # fmt: skip


def altitude_of(density):
    """Altitude of a density in the standard troposphere [m]: T/T0 = (rho/rho0)^(1/4.2559)."""
    return 288.15 / 0.0065 * (1 - (density / 1.225) ** (1 / 4.25587611))


def degrees(name, value):
    return value if name == "throttle" else value * DEG


@pytest.mark.parametrize(("aircraft", "bank", "climb"), TRIMS)
def test_twin_finds_the_published_trims(aircraft, bank, climb):
    twin = Twin(load_aircraft(aircraft), DENSITY[aircraft])
    found = twin.trim(15.0, bank / DEG, climb, rudder=RUDDER[aircraft])
    assert found["residual"] < 1e-9
    for name, expected in TRIMS[aircraft, bank, climb].items():
        assert degrees(name, found[name]) == pytest.approx(
            expected, abs=1e-3 if name != "throttle" else 1e-4
        ), name


@pytest.mark.parametrize("aircraft", ["skywalker_x8", "techpod"])
def test_starts_in_the_published_level_trim_and_stays(aircraft, make_plant):
    altitude = altitude_of(DENSITY[aircraft])
    plant = make_plant(aircraft=aircraft, altitude=altitude, parameters=EVEN)
    expected = TRIMS[aircraft, 0, 0]
    assert plant.get("state.elevator") * DEG == pytest.approx(expected["elevator"], abs=1e-3)
    assert plant.get("state.throttle") == pytest.approx(expected["throttle"], abs=1e-4)
    for _ in range(60):
        plant.step(1.0)
        state = plant.state
        assert state.airspeed == pytest.approx(15.0, abs=1e-6)
        assert state.altitude == pytest.approx(altitude, abs=1e-5)
        assert state.alpha * DEG == pytest.approx(expected["alpha"], abs=1e-3)


@pytest.mark.parametrize("aircraft", ["skywalker_x8", "techpod"])
def test_climbs_in_the_published_climbing_trim(aircraft, make_plant):
    level = altitude_of(DENSITY[aircraft])
    plant = make_plant(aircraft=aircraft, altitude=level - 60, parameters=EVEN)
    plant.fly_leg(0, 0, 1e5, 0, level + 500, 15.0)
    while plant.state.altitude < level:
        plant.step(0.05)
    expected = TRIMS[aircraft, 0, 3]
    assert plant.state.climb_rate == pytest.approx(3.0, abs=0.01)
    assert plant.state.pitch * DEG == pytest.approx(expected["pitch"], abs=0.05)
    assert plant.state.alpha * DEG == pytest.approx(expected["alpha"], abs=0.02)
    assert plant.get("state.throttle") == pytest.approx(expected["throttle"], abs=0.005)


@pytest.mark.parametrize("aircraft", ["skywalker_x8", "techpod"])
def test_circles_in_the_turning_trim_of_the_twin(aircraft, make_plant):
    plant = make_plant(aircraft=aircraft, altitude=altitude_of(DENSITY[aircraft]), parameters=EVEN)
    plant.fly_orbit(0, 43.0, 43.0, 1, plant.state.altitude, 15.0)
    for _ in range(120):
        plant.step(1.0)
    bank = plant.state.bank
    assert 27 < bank * DEG < 30
    expected = Twin(load_aircraft(aircraft), DENSITY[aircraft]).trim(15.0, bank, rudder=RUDDER[aircraft])
    for name in ("alpha", "beta", "pitch", "aileron", "elevator", "rudder", "throttle"):
        assert plant.get(f"state.{name}") == pytest.approx(expected[name], abs=2e-4), name
    assert 15.0 * math.cos(plant.state.pitch - plant.state.alpha * math.cos(bank)) / expected[
        "turn"
    ] == pytest.approx(math.hypot(plant.state.north, plant.state.east - 43.0), abs=0.3)


def random_start(rng):
    """Parameters of a start anywhere in the flight envelope and beyond stall."""
    names = ("bank", "pitch", "alpha", "beta", "p", "q", "r", "aileron", "elevator", "rudder")
    spans = (3.0, 1.4, 0.5, 0.4, 2.0, 2.0, 2.0, 0.4, 0.4, 0.3)
    values = {f"initial.{n}": rng.uniform(-s, s) for n, s in zip(names, spans, strict=True)}
    return values | {"initial.trimmed": 0, "initial.throttle": rng.uniform(0, 1)}


@pytest.mark.parametrize("aircraft", ["skywalker_x8", "techpod"])
@pytest.mark.parametrize("seed", range(25))
def test_state_derivative_equals_the_twin(aircraft, seed, make_plant):
    rng = np.random.default_rng(seed)
    start, wind = random_start(rng), tuple(rng.uniform(-8, 8, 3))
    heading, airspeed = rng.uniform(-3, 3), rng.uniform(8, 30)
    plant = make_plant(aircraft=aircraft, heading=heading, airspeed=airspeed, wind=wind, parameters=start)
    s = {key.removeprefix("initial."): value for key, value in start.items()}
    a, b = s["alpha"], s["beta"]
    air = airspeed * np.array([math.cos(a) * math.cos(b), math.sin(b), math.sin(a) * math.cos(b)])
    attitude, rates = (s["bank"], s["pitch"], heading), np.array([s["p"], s["q"], s["r"]])
    twin = Twin(load_aircraft(aircraft), plant.get("air.density"), 9.81 - GRADIENT * plant.state.altitude)
    surfaces = (s["aileron"], s["elevator"], s["rudder"])
    linear, angular, specific = twin.accelerations(air, rates, attitude, surfaces, s["throttle"], wind)
    velocity = dcm(*attitude).T @ air + wind

    def outputs(*names):
        return np.array([plant.get(name) for name in names])

    np.testing.assert_allclose(outputs("rate.u", "rate.v", "rate.w"), linear, rtol=1e-9, atol=1e-10)
    np.testing.assert_allclose(outputs("rate.p", "rate.q", "rate.r"), angular, rtol=1e-9, atol=1e-10)
    forces = [f"sensor.specific_force.{axis}" for axis in "xyz"]
    np.testing.assert_allclose(outputs(*forces), specific, rtol=1e-9, atol=1e-10)
    ground = [f"state.velocity_{axis}" for axis in ("north", "east", "down")]
    np.testing.assert_allclose(outputs(*ground), velocity, rtol=1e-9, atol=1e-10)
    w, p, q, r = np.array([plant.get(f"state.quaternion.{k}") for k in "wxyz"]), *rates
    turning = 0.5 * np.array([[0, -p, -q, -r], [p, 0, r, -q], [q, -r, 0, p], [r, q, -p, 0]]) @ w
    np.testing.assert_allclose(outputs(*(f"rate.quaternion.{k}" for k in "wxyz")), turning, atol=1e-10)


def test_stall_is_flagged_and_lift_held(make_plant):
    start = {"initial.trimmed": 0, "initial.alpha": 0.3}
    stalled = make_plant(parameters=start)
    deeper = make_plant(parameters=start | {"initial.alpha": 0.5})
    assert stalled.get("state.stalled") == 1
    assert make_plant().get("state.stalled") == 0
    lift = [
        math.sin(a) * p.get("sensor.specific_force.x") - math.cos(a) * p.get("sensor.specific_force.z")
        for p, a in ((stalled, 0.3), (deeper, 0.5))
    ]
    assert lift[0] == pytest.approx(lift[1], rel=1e-9)


def test_nothing_is_lost_without_air(make_plant):
    """Thrown in a near vacuum the body keeps its energy and the length of its angular momentum."""
    thin = {f"aircraft.aero.{k}": 0.0 for k in ("CL0", "CL_alpha", "CL_q", "CL_elevator", "CD0", "CD_alpha")}
    thin |= {f"aircraft.aero.{k}": 0.0 for k in ("CD_alpha2", "CD_elevator2", "CD_beta2", "Cm0", "Cm_alpha")}
    thin |= {f"aircraft.aero.{h}_{t}": 0.0 for h in ("CY", "Cl", "Cn") for t in ("beta", "p", "r")}
    thin |= {"aircraft.aero.CY_aileron": 0.0, "aircraft.aero.Cn_aileron": 0.0, "aircraft.aero.Cm_q": 0.0}
    thin |= {"aircraft.aero.alpha_max": 1.5, "aircraft.aero.alpha_min": -1.5, "command.mode": 0}
    spin = {"initial.trimmed": 0, "initial.p": 1.0, "initial.q": 0.4, "initial.r": -0.6, "initial.pitch": 0.8}
    plant = make_plant(parameters=thin | spin | EVEN, airspeed=25.0)
    values = load_aircraft()
    xx, yy, zz, xz = (values[f"aircraft.inertia.{k}"] for k in ("xx", "yy", "zz", "xz"))
    tensor = np.array([[xx, 0, -xz], [0, yy, 0], [-xz, 0, zz]])

    def invariants():
        s = plant.state
        rates = np.array([s.p, s.q, s.r])
        speed2 = s.velocity_north**2 + s.velocity_east**2 + s.climb_rate**2
        return np.linalg.norm(tensor @ rates), rates @ tensor @ rates, speed2 / 2 + 9.81 * s.altitude

    before = invariants()
    plant.step(1.0)
    assert abs(plant.state.alpha) < 1.5  # beyond, the drag of a flat plate sets in
    np.testing.assert_allclose(invariants(), before, rtol=1e-8)
