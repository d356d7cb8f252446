"""Geofence and rally points of a live flight: those of the mission, put aboard; else those on board."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from offboard.live.areas import fence_aboard, put_fence, put_rally, rally_aboard
from scenarios.fence import FenceArea, geofence_data
from scenarios.plan_convert import fence_areas
from scenarios.rally import rally_data, rally_points
from scenarios.scenario import Point, Scenario

if TYPE_CHECKING:
    from offboard.live.vehicle import LiveVehicle


@dataclass(frozen=True, slots=True)
class LiveAreas:
    """Where a live vehicle may be, and where it is to wait."""

    geofence: tuple[FenceArea, ...] = ()
    rally: tuple[Point, ...] = ()

    def put_into(self, scenario: Scenario) -> Scenario:
        """The scenario with these in the place of its own."""
        return replace(scenario, geofence=self.geofence, rally=self.rally)


def live_areas(vehicle: LiveVehicle, mission: Scenario | None) -> LiveAreas:
    """What holds for a flight of a vehicle that is there.

    Parameters
    ----------
    vehicle : LiveVehicle
        One that may not be touched is only asked.
    mission : Scenario or None
        Where the mission was taken from, with its geofence and rally points; None for the one on board.
    """
    frame = vehicle.aboard.frame
    fence = () if mission is None else mission.geofence
    rally = () if mission is None else mission.rally
    if not fence:
        fence = fence_areas(fence_aboard(vehicle), frame)
    elif vehicle.touch:
        put_fence(vehicle, geofence_data(fence, frame))
    if not rally:
        rally = rally_points(rally_aboard(vehicle), frame)
    elif vehicle.touch:
        put_rally(vehicle, rally_data(rally, frame))
    return LiveAreas(fence, rally)
