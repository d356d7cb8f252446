"""Aircraft files: read, checked, all mistakes at once."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from fmu import AircraftError, aircraft_names, load_aircraft
from fmu.parameters import FOLDER

SHARED = Path(__file__).resolve().parents[3] / "shared" / "paper" / "aircraft.json"
NAMES = {
    "m": "mass", "Jx": "inertia.xx", "Jy": "inertia.yy", "Jz": "inertia.zz", "Jxz": "inertia.xz",
    "S": "wing.area", "b": "wing.span", "c": "wing.chord", "CLde": "aero.CL_elevator",
    "CLa": "aero.CL_alpha", "CLa2": "aero.CL_alpha2", "CLa3": "aero.CL_alpha3", "CDa1": "aero.CD_alpha",
    "CDa2": "aero.CD_alpha2", "CDde2": "aero.CD_elevator2", "CDb1": "aero.CD_beta", "CDb2": "aero.CD_beta2",
    "Cma": "aero.Cm_alpha", "Cmde": "aero.Cm_elevator", "CLq": "aero.CL_q", "Cmq": "aero.Cm_q",
}  # fmt: skip
NAMES |= {f"{h}0": f"aero.{h}0" for h in ("CL", "CD", "Cm")}
LATERAL = {"b": "beta", "p": "p", "r": "r", "da": "aileron", "dr": "rudder"}
NAMES |= {f"{h}{k}": f"aero.{h}_{v}" for h in ("CY", "Cl", "Cn") for k, v in LATERAL.items()}


def changed(tmp_path, *replacements):
    text = (FOLDER / "skywalker_x8.toml").read_text()
    for old, new in replacements:
        assert old in text
        text = text.replace(old, new, 1)
    path = tmp_path / "mine.toml"
    path.write_text(text)
    return str(path)


def test_both_sets_load():
    assert aircraft_names() == ("skywalker_x8", "techpod")
    assert load_aircraft("techpod")["aircraft.mass"] == 2.65


@pytest.mark.parametrize("aircraft", ["skywalker_x8", "techpod"])
def test_sets_carry_the_published_numbers(aircraft):
    if not SHARED.is_file():
        pytest.skip(f"published parameter sets not found at {SHARED}")
    published = json.loads(SHARED.read_text())[aircraft]["params"]
    values = load_aircraft(aircraft)
    for key, value in published.items():
        if key != "rho":
            assert values["aircraft." + NAMES[key]] == pytest.approx(value, rel=1e-12), key


def test_all_mistakes_are_named_at_once(tmp_path):
    path = changed(
        tmp_path, ("mass = 3.364", "mass = -3"), ("area = 0.75", "aera = 0.75"), ("CL_q = 3.87", "CL_q = nan")
    )
    with pytest.raises(AircraftError) as caught:
        load_aircraft(path)
    assert len(caught.value.mistakes) == 4
    for words in (
        "aircraft.mass = -3",
        "aircraft.wing.aera is unknown",
        "wing.area is missing",
        "CL_q = nan",
    ):
        assert words in str(caught.value)


def test_a_body_that_cannot_be_is_refused(tmp_path):
    """The X8's published tensor."""
    path = changed(
        tmp_path, ("xx = 0.335", "xx = 1.229"), ("yy = 0.14", "yy = 0.1702"), ("zz = 0.4", "zz = 0.8808"),
        ("xz = -0.029", "xz = 0.9343"),
    )  # fmt: skip
    with pytest.raises(AircraftError, match=r"0\.1045.*0\.1702.*2\.005"):
        load_aircraft(path)


def test_broken_toml_is_refused(tmp_path):
    path = tmp_path / "broken.toml"
    path.write_text("[aircraft")
    with pytest.raises(AircraftError, match=r"broken\.toml"):
        load_aircraft(str(path))


def test_unknown_names_list_the_known():
    with pytest.raises(ValueError, match="skywalker_x8, techpod"):
        load_aircraft("concorde")
