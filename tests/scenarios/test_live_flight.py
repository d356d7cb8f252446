"""A live flight's record: what the pilot was told, which positions were a guess, where it may fly."""

from __future__ import annotations

import contextlib
import json
from dataclasses import replace

import pytest

from avoidance.parameters import DEFAULT
from offboard.raw_mission import RawMission
from scenarios.errors import ScenarioError
from scenarios.fence import FenceArea
from scenarios.hangar import mission_plan
from scenarios.live_areas import live_areas
from scenarios.live_flight import LiveFlight, Source, scenario_of
from scenarios.live_mission import mission_of, source_of
from scenarios.offboard_commands import fly
from scenarios.record import write_run
from scenarios.scenario import Point
from tests.offboard.live.kit import SMALL, flying

FENCED = replace(
    SMALL,
    geofence=(FenceArea(include=False, centre=(2000.0, -3000.0), radius=500.0),),
    rally=(Point(500.0, -500.0, 150.0),),
)


def test_an_outage_is_in_the_record(tmp_path):
    with flying("px4") as flight:
        flight.vehicle.aboard.tell("info", "before the flight")
        flight.fly(2.0)
        scenario = scenario_of(flight.vehicle, SMALL, "small")
        with contextlib.closing(LiveFlight(scenario, flight.vehicle, Source("test"), DEFAULT)) as live:
            for frame in live:
                flight.simulation.silent = 5.0 <= frame.time < 15.0
                flight.vehicle.aboard.session.patience = 0.002 if flight.simulation.silent else 0.5
                if frame.time >= 20.0:
                    break
            flown = live.result()
            judged = live.judged(flown)
    write_run(tmp_path / "run", flown, judged)
    rows = [json.loads(line) for line in (tmp_path / "run" / "events.jsonl").read_text().splitlines()]
    assert any(row["severity"] == "alarm" and "the link is lost" in row["text"] for row in rows)
    (before,) = [row["t_s"] for row in rows if row["text"] == "before the flight"]
    assert -4.0 < before < -1.0
    ((begin, end),) = json.loads((tmp_path / "run" / "run.json").read_text())["reckoned_s"]
    assert begin == pytest.approx(6.0, abs=1.0)
    assert end == pytest.approx(15.5, abs=1.5)
    assert judged.summary["frames_dropped"] is None
    assert judged.summary["link_losses"] == 1


def test_those_who_decide_know_fence_and_rally_points():
    """What is read from the vehicle reaches the avoidance core, not only the record."""
    with flying("px4", FENCED, touch=False) as flight:
        areas = live_areas(flight.vehicle, None)
        scenario = areas.put_into(scenario_of(flight.vehicle, None, "small"))
        with contextlib.closing(LiveFlight(scenario, flight.vehicle, Source("test"), DEFAULT)) as live:
            core = live._agent._agent
    (waits_at,) = core._vigil._rally._points
    assert (waits_at.north, waits_at.east) == pytest.approx((500.0, -500.0), abs=0.1)
    assert waits_at.altitude == pytest.approx(150.0)
    assert len(core._geofence.areas) == 1


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_areas_of_the_mission_are_put_aboard_and_those_aboard_are_used(autopilot):
    with flying(autopilot) as flight:
        vehicle = flight.vehicle
        assert live_areas(vehicle, SMALL) == live_areas(vehicle, None)
        assert live_areas(vehicle, FENCED).geofence == FENCED.geofence
        found = live_areas(vehicle, None)
    assert "the geofence of the mission is on board" in flight.said("info")
    assert "the geofence on board is kept to, 1 areas" in flight.said("info")
    assert found.rally[0].north == pytest.approx(500.0, abs=0.1)
    assert found.geofence[0].centre == pytest.approx((2000.0, -3000.0), abs=0.1)


def test_a_scenario_s_areas_are_in_the_memory_of_the_simulated_autopilot():
    with flying("px4", FENCED, touch=False) as flight:
        found = live_areas(flight.vehicle, None)
    assert found.geofence[0].radius == 500.0
    assert found.rally[0].altitude == 150.0


def test_a_dry_run_of_another_mission_than_the_one_on_board_is_refused(tmp_path):
    wanted = mission_of("single")
    with flying("px4", touch=False) as flight, pytest.raises(ScenarioError, match="another mission on board"):
        fly(flight.vehicle, wanted, source_of(None, wanted), DEFAULT, tmp_path)


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_a_dry_run_of_the_mission_on_board_is_not(autopilot):
    with flying(autopilot, touch=False) as flight:
        raw = RawMission.of_plan(mission_plan(SMALL.mission, flight.vehicle.aboard.frame))
        assert flight.vehicle.has_mission(raw)
        shorter = RawMission.of(raw.items[:-1])
        assert not flight.vehicle.has_mission(shorter)
