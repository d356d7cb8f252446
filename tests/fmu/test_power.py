"""Sun, solar array and battery."""

from __future__ import annotations

import json
import math
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

SHARED = Path(__file__).resolve().parents[3] / "shared" / "paper" / "solar_power.json"
NIGHT = {"environment.start_time": datetime(2025, 6, 21, 23, 0, tzinfo=UTC).timestamp()}


def unix(*moment):
    return datetime(*moment, tzinfo=UTC).timestamp()


@pytest.mark.parametrize(
    ("place", "moment", "elevation", "azimuth"),
    [
        # Equinox: overhead on the equator at local noon (12:07 UTC by the equation of time), due east at six.
        ((0.0, 0.0), (2025, 3, 20, 12, 7), 89.9, None),
        ((0.0, 0.0), (2025, 3, 20, 6, 7), 0.0, 90.0),
        # Solstices at noon: 90 deg - |latitude - 23.44 deg|.
        ((47.37, 0.0), (2025, 6, 21, 12, 2), 90 - 47.37 + 23.44, 180.0),
        ((47.37, 0.0), (2025, 12, 21, 11, 58), 90 - 47.37 - 23.44, 180.0),
        ((-33.9, 151.2), (2025, 12, 21, 1, 53), 90 - 33.9 + 23.44, 0.0),
    ],
)
def test_the_sun_stands_where_it_should(place, moment, elevation, azimuth, make_plant):
    latitude, longitude = map(math.radians, place)
    values = {"environment.latitude": latitude, "environment.longitude": longitude}
    plant = make_plant(parameters=values | {"environment.start_time": unix(*moment)})
    assert math.degrees(plant.get("sun.elevation")) == pytest.approx(elevation, abs=0.25)
    if azimuth is not None:
        off = math.degrees(plant.get("sun.azimuth")) - azimuth
        assert (off + 180) % 360 - 180 == pytest.approx(0.0, abs=0.6)


def test_level_flight_takes_the_published_power(make_plant):
    """68.2 W at 15 m/s (SPEC's figure at sea level), and 6 W for the avionics."""
    plant = make_plant(altitude=0.0)
    plant.step(5.0)
    assert plant.get("battery.power_out") == pytest.approx(68.2 + 6.0, abs=0.3)


def test_the_array_gives_the_published_power_per_light(make_plant):
    """P = A eta eta_mppt eta_cbr (1 - k (T - 25 degC)) (direct eps cos + 0.82707 diffuse)."""
    noon = {"environment.start_time": unix(2025, 3, 20, 12, 7), "environment.latitude": 0.0}
    plant = make_plant(altitude=0.0, parameters=noon | {"environment.longitude": 0.0})
    pitch, light = plant.state.pitch, plant.get("sun.irradiance")
    direct, diffuse = light / 1.1, light / 11
    warm = 1 - 0.003 * (plant.get("sensor.temperature") - 298.15)
    beam = direct * math.cos(pitch) * np.interp(math.cos(pitch), [0.9659258262890683, 1], [0.997, 1])
    expected = 0.6375 * 0.237 * 0.95 * 0.97 * warm * (beam + 0.82707 * diffuse)
    assert plant.get("battery.power_in") == pytest.approx(expected, rel=2e-3)
    assert expected == pytest.approx(139.2 * (beam + 0.82707 * diffuse) / 1000 * warm, rel=1e-3)


def test_figures_are_the_published_ones(make_plant):
    if not SHARED.is_file():
        pytest.skip(f"published figures not found at {SHARED}")
    published = json.loads(SHARED.read_text())
    plant = make_plant()
    assert plant.get("aircraft.solar.area") == published["x8_scaled"]["A_solar"]
    assert plant.get("aircraft.solar.efficiency") == published["solar"]["eta_sc"]
    chain = published["solar"]["eta_cbr"] * published["solar"]["eta_mppt"]
    assert plant.get("aircraft.solar.chain_efficiency") == pytest.approx(chain)
    assert plant.get("aircraft.power.chain_efficiency") == pytest.approx(published["eta_chain"], abs=1e-5)
    assert plant.get("aircraft.battery.charge_efficiency") == published["bat"]["eta_chrg"]
    assert plant.get("aircraft.battery.discharge_efficiency") == published["bat"]["eta_dchrg"]


@pytest.mark.parametrize("fidelity", ["6dof", "kinematic"])
def test_the_battery_gives_what_is_taken(fidelity, make_plant):
    plant = make_plant(fidelity=fidelity, parameters=NIGHT)
    before = plant.get("battery.energy")
    assert plant.get("battery.state_of_charge") == 1.0
    plant.step(600.0)
    used = before - plant.get("battery.energy")
    assert plant.get("battery.power_in") == 0.0
    assert used == pytest.approx(600 * plant.get("battery.power_out") / 0.97, rel=2e-3)


def test_both_fidelities_use_about_the_same_energy(make_plant):
    used = []
    for fidelity in ("6dof", "kinematic"):
        plant = make_plant(fidelity=fidelity, parameters=NIGHT)
        plant.fly_orbit(0, 100, 100, 1, 260, 16)
        plant.step(300.0)
        used.append(9e5 - plant.get("battery.energy"))
    assert used[1] == pytest.approx(used[0], rel=0.04)


def test_an_empty_battery_stops_the_motor_after_warning_of_the_reserve(make_plant):
    plant = make_plant(parameters=NIGHT | {"initial.charge": 0.21}, altitude=900.0)
    plant.step(300.0)
    assert plant.get("battery.on_reserve")
    assert not plant.get("battery.empty")
    while not plant.get("battery.empty"):
        plant.step(60.0)
        assert plant.time < 7200
    plant.step(20.0)
    assert plant.get("battery.energy") == 0.0
    assert plant.get("state.throttle") < 1e-3
    assert plant.state.climb_rate < -0.3


def test_a_full_battery_takes_no_more_and_a_clear_noon_fills_one(make_plant):
    noon = {"environment.start_time": unix(2025, 6, 21, 11, 30), "initial.charge": 0.5}
    plant = make_plant(fidelity="kinematic", parameters=noon)
    plant.step(3600.0)
    assert plant.get("battery.state_of_charge") > 0.55
    full = make_plant(parameters=noon | {"initial.charge": 1.0})
    full.step(60.0)
    assert full.get("battery.state_of_charge") == pytest.approx(1.0, abs=1e-4)
    assert full.get("battery.energy") <= 9e5
