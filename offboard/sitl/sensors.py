"""What the aircraft's radar and its ADS-B receiver pass on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from offboard.link import PlantState
from offboard.sitl.autopilot import Autopilot
from offboard.sitl.dialect import mavlink

UNKNOWN_ID = 0xFFFF
"""`obstacle_id` of what has no identity of its own."""
ADSB_FLAGS = (
    mavlink.ADSB_FLAGS_VALID_COORDS
    | mavlink.ADSB_FLAGS_VALID_ALTITUDE
    | mavlink.ADSB_FLAGS_VALID_HEADING
    | mavlink.ADSB_FLAGS_VALID_VELOCITY
    | mavlink.ADSB_FLAGS_VALID_CALLSIGN
    | mavlink.ADSB_FLAGS_VERTICAL_VELOCITY_VALID
    | mavlink.ADSB_FLAGS_SIMULATED
)


@dataclass(frozen=True, slots=True)
class Return:
    """One radar return of something that stands still."""

    id: int
    north: float
    """North of home [m]."""
    east: float
    """East of home [m]."""
    altitude: float
    """Above home [m]."""


@dataclass(frozen=True, slots=True)
class Report:
    """One aircraft as it reports itself."""

    id: int
    """Its address."""
    north: float
    """North of home [m]."""
    east: float
    """East of home [m]."""
    altitude: float
    """Above home [m]."""
    velocity_north: float
    """Over ground [m/s]."""
    velocity_east: float
    """Over ground [m/s]."""
    climb_rate: float
    """Upward [m/s]."""


def show_radar(autopilot: Autopilot, returns: Sequence[Return], reach: float) -> None:
    """Send a sweep as OBSTACLE_DISTANCE_3D, one message per return.

    Parameters
    ----------
    autopilot : Autopilot
        Whose aircraft carries the radar.
    returns : sequence of Return
        What it sees.
    reach : float
        Range of the radar [m].

    Notes
    -----
    The places are in body axes. ATTITUDE and GLOBAL_POSITION_INT of the same `time_boot_ms` go before
    them: a receiver that turned them back with an attitude a fifth of a second old would be off by a
    kilometre at the edge of the range while the aircraft rolls.
    """
    if not returns:
        return
    state, boot = autopilot.aircraft.state, autopilot.telemetry.boot_ms
    for message_id in (mavlink.MAVLINK_MSG_ID_ATTITUDE, mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT):
        autopilot.broadcast(autopilot.telemetry.message(message_id))
    for each in returns:
        place = body_frd(state, each.north, each.east, each.altitude)
        identity = each.id if 0 <= each.id < UNKNOWN_ID else UNKNOWN_ID
        autopilot.broadcast(
            mavlink.MAVLink_obstacle_distance_3d_message(
                boot,
                mavlink.MAV_DISTANCE_SENSOR_RADAR,
                mavlink.MAV_FRAME_BODY_FRD,
                identity,
                *place,
                0.0,
                reach,
            )
        )


def show_traffic(autopilot: Autopilot, reports: Sequence[Report]) -> None:
    """Send what other aircraft report as ADSB_VEHICLE, one message each."""
    sea = autopilot.aircraft.frame.altitude_m
    for each in reports:
        course = math.atan2(each.velocity_east, each.velocity_north)
        speed = math.hypot(each.velocity_north, each.velocity_east)
        autopilot.broadcast(
            mavlink.MAVLink_adsb_vehicle_message(
                each.id & 0xFFFFFF,
                *autopilot.telemetry.geodetic(each.north, each.east),
                mavlink.ADSB_ALTITUDE_TYPE_GEOMETRIC,
                round(1e3 * (each.altitude + sea)),
                round(math.degrees(course) * 100.0) % 36000,
                min(round(100.0 * speed), 0xFFFF),
                max(-32768, min(round(100.0 * each.climb_rate), 32767)),
                f"UAV{each.id}".encode()[:8],
                mavlink.ADSB_EMITTER_TYPE_UAV,
                0,
                ADSB_FLAGS,
                0,
            )
        )


def body_frd(state: PlantState, north: float, east: float, altitude: float) -> tuple[float, float, float]:
    """A place on the map in body axes of an aircraft: forward, right, down [m].

    Notes
    -----
    Yaw, pitch, roll: Stevens & Lewis 2003, Eq. 1.3-20.
    """
    n, e, d = north - state.north, east - state.east, state.altitude - altitude
    cy, sy = math.cos(state.heading), math.sin(state.heading)
    cp, sp = math.cos(state.pitch), math.sin(state.pitch)
    cr, sr = math.cos(state.bank), math.sin(state.bank)
    ahead, aside = cy * n + sy * e, cy * e - sy * n
    below = sp * ahead + cp * d
    return cp * ahead - sp * d, cr * aside + sr * below, cr * below - sr * aside
