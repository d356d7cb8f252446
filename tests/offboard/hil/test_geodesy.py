"""The quick map agrees with the exact one; ArduPilot arrives where we are; true north is north."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from offboard.frames import MapFrame
from offboard.hil.geodesy import Geodesy, true_north
from tests.offboard.hil.fakes import AT_REST

HOME = MapFrame(47.397742, 8.545594, 488.0)
FAR = st.floats(-150e3, 150e3)
METRE = 1.0 / 111_320.0


@given(north=FAR, east=FAR, dn=st.floats(-240, 240), de=st.floats(-240, 240))
def test_between_anchors_the_map_is_right_to_centimetres(north, east, dn, de):
    geodesy = Geodesy(HOME)
    geodesy.at(north, east)
    place = geodesy.at(north + dn, east + de)
    latitude, longitude = HOME.to_geodetic(north + dn, east + de)
    assert place.latitude_deg == pytest.approx(latitude, abs=0.02 * METRE)
    assert place.longitude_deg == pytest.approx(longitude, abs=0.03 * METRE)


@given(north=FAR, east=FAR)
def test_ardupilot_arrives_at_our_latitude_and_longitude(north, east):
    """Its own arithmetic: a sphere, and the mean latitude for the length of a degree of longitude."""
    geodesy = Geodesy(HOME)
    place = geodesy.at(north, east)
    ofs_north, ofs_east = geodesy.ardupilot_offset(place)
    per_degree = 111318.84502145034
    dlat = ofs_north / per_degree
    dlng = ofs_east / per_degree / math.cos(math.radians(HOME.latitude_deg + dlat / 2))
    assert HOME.latitude_deg + dlat == pytest.approx(place.latitude_deg, abs=0.01 * METRE)
    assert HOME.longitude_deg + dlng == pytest.approx(place.longitude_deg, abs=0.01 * METRE)


def test_map_metres_would_lead_ardupilot_astray():
    ofs_north, _ = Geodesy(HOME).ardupilot_offset(Geodesy(HOME).at(100e3, 0.0))
    assert abs(ofs_north - 100e3) > 100


@pytest.mark.parametrize(("north", "east"), [(0.0, 0.0), (50e3, 80e3), (-120e3, -60e3)])
def test_convergence_is_the_direction_of_the_maps_north(north, east):
    place = Geodesy(HOME).at(north, east)
    here, ahead = HOME.to_geodetic(north, east), HOME.to_geodetic(north + 10.0, east)
    seen = math.atan2((ahead[1] - here[1]) * math.cos(math.radians(here[0])), ahead[0] - here[0])
    assert place.convergence == pytest.approx(seen, abs=1e-4)


def test_across_the_date_line():
    geodesy = Geodesy(MapFrame(-17.0, 179.99))
    place = geodesy.at(0.0, 5e3)
    assert place.longitude_deg < -179.9
    assert geodesy.ardupilot_offset(place)[1] == pytest.approx(5e3, rel=2e-3)


def test_turned_to_true_north_the_motion_keeps_its_size():
    truth = AT_REST._replace(velocity_north=3.0, velocity_east=4.0)
    turned = true_north(truth, math.radians(90.0))
    assert (turned.velocity_north, turned.velocity_east) == pytest.approx((-4.0, 3.0))
    assert (turned.qw, turned.qz) == pytest.approx((math.sqrt(0.5), math.sqrt(0.5)))
    assert true_north(truth, 0.0) is truth
