"""Geofence and rally points of a live vehicle, over the wire; uploads that overtake one another."""

from __future__ import annotations

import contextlib

import pytest

from avoidance.parameters import DEFAULT
from offboard.geofence import FenceCircle, FencePolygon, FenceType, GeofenceData
from offboard.live.areas import areas_for_core, fence_aboard, put_fence, put_rally, rally_aboard
from offboard.live.lockstep import connect_in_step
from offboard.live.messages import Ask, Reply
from offboard.live.starting import open_vehicle
from offboard.raw_mission import RawMission
from offboard.sitl.autopilot import FLAVOURS
from scenarios.hangar import mission_plan
from scenarios.sitl_world import SitlWorld
from tests.offboard.live.kit import SMALL, STEP, Simulation

FENCE = GeofenceData(
    (
        FencePolygon(((14.38, 76.58), (14.48, 76.58), (14.48, 76.68)), FenceType.INCLUSION),
        FencePolygon(((14.40, 76.60), (14.41, 76.60), (14.41, 76.61), (14.40, 76.61)), FenceType.EXCLUSION),
    ),
    (FenceCircle((14.42, 76.62), 450.0, FenceType.EXCLUSION),),
)
RALLY = ((14.40, 76.59, 80.0), (14.41, 76.60, 120.0))


@contextlib.contextmanager
def waiting(autopilot):
    """A vehicle that waits, in step."""
    with SitlWorld(SMALL, DEFAULT, FLAVOURS[autopilot], SMALL.fleet) as world:
        simulation = Simulation(world)
        with contextlib.closing(connect_in_step(simulation, STEP)) as session:
            yield simulation, open_vehicle(session)


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_what_is_put_aboard_is_what_is_there(autopilot):
    with waiting(autopilot) as (simulation, vehicle):
        before = simulation.mission()
        assert fence_aboard(vehicle) == GeofenceData()
        assert rally_aboard(vehicle) == ()
        assert put_fence(vehicle, FENCE)
        assert put_rally(vehicle, RALLY)
        assert fence_aboard(vehicle) == FENCE
        assert rally_aboard(vehicle) == RALLY
        assert simulation.mission() == before
        assert [e for e in vehicle.aboard.events if e.severity != "info"] == []


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_they_can_be_had_right_after_a_mission_was_put_aboard(autopilot):
    """MAVSDK does one list at a time: looking at our own mission again would be in the way."""
    with waiting(autopilot) as (_, vehicle):
        put_fence(vehicle, FENCE)
        vehicle.upload_raw(RawMission.of_plan(mission_plan(SMALL.mission, vehicle.aboard.frame)))
        for _ in range(3):
            assert fence_aboard(vehicle) == FENCE
            vehicle.wait_until(vehicle.time + 0.4)
        assert [e.text for e in vehicle.aboard.events if e.severity != "info"] == []


def test_areas_that_lie_nowhere_near_are_not_taken_for_ours():
    with waiting("px4") as (_, vehicle):
        opposite = -14.4, 76.6 - 180.0
        put_fence(vehicle, GeofenceData((), (FenceCircle(opposite, 450.0, FenceType.INCLUSION),)))
        put_rally(vehicle, ((*opposite, 80.0),))
        fence, rally = areas_for_core(vehicle)
    assert (fence.areas, rally) == ((), ())
    told = {event.severity: event.text for event in vehicle.aboard.events}
    assert "the geofence on board is not known and not kept to" in told["alarm"]
    assert "the rally points on board are not used" in told["warning"]


def test_what_is_refused_is_told():
    with waiting("px4") as (_, vehicle):
        corners = tuple((14.4 + 1e-5 * number, 76.6) for number in range(3000))
        huge = GeofenceData((FencePolygon(corners, FenceType.EXCLUSION),))
        assert not put_fence(vehicle, huge)
    (warning,) = [e.text for e in vehicle.aboard.events if e.severity == "warning"]
    assert "did not take the geofence" in warning
    assert "we keep to it" in warning


def test_an_upload_that_follows_another_on_its_heels_is_taken():
    """MAVSDK refuses it as BUSY while it works on the first; the first is called off."""
    with waiting("px4") as (simulation, vehicle):
        raw = RawMission.of_plan(mission_plan(SMALL.mission, vehicle.aboard.frame))
        session = vehicle.aboard.session
        simulation.silent = True
        first = session.upload(raw.items, 0)
        simulation.silent = False
        replies: dict[int, Reply] = {}
        for _ in range(40):
            token = session.upload(raw.items[:2], 0)
            while token not in replies:
                replies |= {one.token: one for one in session.poll(0.1) if isinstance(one, Reply)}
            if replies[token].ok:
                break
        assert replies[token].ok, replies[token].why
        assert not replies[first].ok
        assert replies[first].ask is Ask.UPLOAD
        assert len(simulation.mission()) == 2
