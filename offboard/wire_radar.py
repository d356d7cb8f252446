"""A `Radar` fed by what a vehicle sends: ADSB_VEHICLE, OBSTACLE_DISTANCE_3D, OBSTACLE_DISTANCE.

COLLISION carries no position: it is an alarm, not a return.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from avoidance import RadarScan
from offboard.frames import MapFrame
from offboard.link import VehicleState
from offboard.live.facts import Attitude, Fix
from offboard.live.messages import Message
from offboard.live.telemetry import Telemetry
from offboard.own_echo import OwnEcho
from offboard.sightings import Sighting, Sightings

RADAR_KEEPS = 2.5
"""A radar return is used for so long: sweeps come once a second [s]."""
TRAFFIC_KEEPS = 8.0
"""A report of traffic is used for so long; meanwhile it is moved on at its velocity [s]."""
NO_ID = 0xFFFF
"""`obstacle_id` of what has none."""
FIRST_UNNAMED = 2_000_000_000
"""Returns without an identity are numbered from here."""
FIRST_SECTOR = 2_100_000_000
"""Sectors of OBSTACLE_DISTANCE are numbered from here."""
BODY_FRD, LOCAL_FRD = (12, 8), (20, 21)
"""MAV_FRAME numbers: along the body's axes; level, along the nose."""
DEGREE = 1e7
VALID_COORDS, VALID_ALTITUDE, VALID_HEADING, VALID_VELOCITY = 1, 2, 4, 8
"""Bits of ADSB_VEHICLE.flags."""
VERTICAL_VELOCITY_VALID = 128
"""Bit of ADSB_VEHICLE.flags."""
FARTHEST = 500e3
"""What is reported further away than this is no obstacle of ours [m]."""


class WireRadar:
    """Makes scans of messages.

    Parameters
    ----------
    frame : MapFrame
        The map.
    clock : callable
        A time of the vehicle's clock [s] as seconds since the start.
    safety_radius : float
        RS of the core [m]: OBSTACLE_DISTANCE, which ends at 655 m, is used only if RS is smaller than its
        range.
    alarm : callable
        Called with a text where there is no position to make a return of.
    own_address : int
        ICAO address of the vehicle's own transponder, 0 if unknown: its echo is no traffic.
    note : callable, optional
        Called with a text when an echo of the vehicle itself has been found among the traffic.
    """

    def __init__(
        self,
        frame: MapFrame,
        clock: Callable[[float], float],
        safety_radius: float,
        alarm: Callable[[str], None],
        *,
        own_address: int = 0,
        note: Callable[[str], None] | None = None,
    ) -> None:
        self._frame = frame
        self._clock = clock
        self._safety_radius = safety_radius
        self._alarm = alarm
        self._returns = Sightings(RADAR_KEEPS)
        self._traffic = Sightings(TRAFFIC_KEEPS)
        self._unnamed = FIRST_UNNAMED
        self._told: set[str] = set()
        self._echo = OwnEcho(own_address)
        self._note = note
        self.heard = 0
        """Messages that became returns."""

    def scan(self, state: VehicleState, now: float) -> RadarScan:  # noqa: ARG002
        """Everything that has been reported lately, where it is at the time of the vehicle's state."""
        time = state.ownship.time
        a, b = self._returns.scan(time), self._traffic.scan(time)
        if not len(b.ids):
            return a
        if not len(a.ids):
            return b
        return _joined(a, b)

    def take(self, message: Message, telemetry: Telemetry) -> None:
        """Take over a message, with what the vehicle has told of itself up to then."""
        fix = telemetry.fix
        if fix is None:
            return
        match message.name:
            case "ADSB_VEHICLE":
                self._adsb(message, fix)
            case "OBSTACLE_DISTANCE_3D":
                self._obstacle(message, telemetry, fix)
            case "OBSTACLE_DISTANCE":
                self._sectors(message, telemetry, fix)
            case "COLLISION" if message.whole("threat_level") > 0:
                seconds = message.number("time_to_minimum_delta")
                self._alarm(f"the autopilot expects a collision in {seconds:.0f} s; it does not say where")

    def _adsb(self, message: Message, fix: Fix) -> None:
        flags = message.whole("flags")
        latitude_deg, longitude_deg = message.number("lat") / DEGREE, message.number("lon") / DEGREE
        place = abs(latitude_deg) <= 90.0 and abs(longitude_deg) <= 180.0
        if not (flags & VALID_COORDS and place):
            return
        aside_deg = math.remainder(longitude_deg - fix.longitude_deg, 360.0)
        if math.hypot(latitude_deg - fix.latitude_deg, aside_deg) > 10.0:
            return
        known = bool(flags & VALID_ALTITUDE)
        altitude = message.number("altitude") / 1e3 - (fix.amsl - fix.altitude) if known else fix.altitude
        speed = message.number("hor_velocity") / 100.0 if flags & VALID_VELOCITY else 0.0
        course = math.radians(message.number("heading") / 100.0) if flags & VALID_HEADING else 0.0
        climb = message.number("ver_velocity") / 100.0 if flags & VERTICAL_VELOCITY_VALID else 0.0
        age = max(message.number("tslc"), 0.0)
        north, east = self._frame.to_map(latitude_deg, longitude_deg)
        report = Sighting(
            message.whole("ICAO_address"),
            north,
            east,
            altitude,
            self._clock(fix.time) - age,
            speed * math.cos(course) if flags & VALID_HEADING else 0.0,
            speed * math.sin(course) if flags & VALID_HEADING else 0.0,
            climb,
        )
        if self._is_own(report, fix):
            return
        self.heard += 1
        self._traffic.put(report)

    def _is_own(self, report: Sighting, fix: Fix) -> bool:
        """True for an echo of the vehicle itself; told once."""
        north, east = self._frame.to_map(fix.latitude_deg, fix.longitude_deg)
        time = self._clock(fix.time)
        own = Sighting(0, north, east, fix.altitude, time, fix.velocity_north, fix.velocity_east)
        if not self._echo.holds(report, own):
            return False
        text = f"ADSB_VEHICLE {report.id:06X} is this vehicle itself: it is not taken for traffic"
        if self._note is not None and self._echo.sure(report.id) and text not in self._told:
            self._told.add(text)
            self._note(text)
        return True

    def _obstacle(self, message: Message, telemetry: Telemetry, fix: Fix) -> None:
        offset = tuple(message.number(key) for key in ("x", "y", "z"))
        attitude, fix, time = _then(message, telemetry, fix)
        frame = message.whole("frame", -1)
        if frame not in BODY_FRD + LOCAL_FRD:
            self._once(f"OBSTACLE_DISTANCE_3D in frame {frame} is not understood; BODY_FRD (12) is")
            return
        if attitude is None or not all(abs(value) < FARTHEST for value in offset):
            return
        level = Attitude(attitude.time, 0.0, 0.0, attitude.yaw) if frame in LOCAL_FRD else attitude
        identity = message.whole("obstacle_id", NO_ID)
        if identity == NO_ID:
            self._unnamed += 1
            identity = self._unnamed
        self._put(identity, to_ned(level, *offset), fix, time)

    def _sectors(self, message: Message, telemetry: Telemetry, fix: Fix) -> None:
        reach = message.number("max_distance") / 100.0
        if not reach > self._safety_radius:
            self._once(
                f"OBSTACLE_DISTANCE reaches {reach:.0f} m, less than the safety radius of "
                f"{self._safety_radius:.0f} m: it is not used"
            )
            return
        distances = message.fields.get("distances")
        attitude, fix, time = _then(message, telemetry, fix)
        if not isinstance(distances, list) or attitude is None:
            return
        step = message.number("increment_f")
        if not step > 0.0:
            step = message.number("increment")
        if not step > 0.0:
            return
        offset = message.number("angle_offset")
        nose = attitude.yaw if message.whole("frame") in BODY_FRD + LOCAL_FRD else 0.0
        for number, centimetres in enumerate(distances):
            if not isinstance(centimetres, int | float) or not 0 < centimetres <= 100.0 * reach:
                continue
            angle = nose + math.radians((0.0 if math.isnan(offset) else offset) + number * step)
            away = centimetres / 100.0
            ned = (away * math.cos(angle), away * math.sin(angle), 0.0)
            self._put(FIRST_SECTOR + number, ned, fix, time)

    def _put(self, identity: int, ned: tuple[float, float, float], fix: Fix, time: float) -> None:
        north, east = self._frame.to_map(fix.latitude_deg, fix.longitude_deg)
        self.heard += 1
        self._returns.put(
            Sighting(identity, north + ned[0], east + ned[1], fix.altitude - ned[2], self._clock(time))
        )

    def _once(self, text: str) -> None:
        if text not in self._told:
            self._told.add(text)
            self._alarm(text)


def to_ned(attitude: Attitude, forward: float, right: float, down: float) -> tuple[float, float, float]:
    """A vector in body axes as north, east, down [m].

    Notes
    -----
    Yaw, pitch, roll, in this order: Stevens & Lewis 2003, Eq. 1.3-20, transposed.
    """
    cr, sr = math.cos(attitude.roll), math.sin(attitude.roll)
    cp, sp = math.cos(attitude.pitch), math.sin(attitude.pitch)
    cy, sy = math.cos(attitude.yaw), math.sin(attitude.yaw)
    aside, below = cr * right - sr * down, sr * right + cr * down
    ahead = cp * forward + sp * below
    return cy * ahead - sy * aside, sy * ahead + cy * aside, cp * below - sp * forward


def _then(message: Message, telemetry: Telemetry, fix: Fix) -> tuple[Attitude | None, Fix, float]:
    """Attitude, position and time of a measurement: the latest if it gives no time."""
    time = message.number("time_boot_ms") / 1e3
    if not time > 0.0 or abs(time - fix.time) > RADAR_KEEPS:
        return telemetry.attitude_at(fix.time), fix, fix.time
    return telemetry.attitude_at(time), telemetry.at(time) or fix, time


def _joined(a: RadarScan, b: RadarScan) -> RadarScan:
    return RadarScan(
        a.time,
        np.concatenate((a.ids, b.ids)),
        np.concatenate((a.positions, b.positions)),
        np.concatenate((a.radii, b.radii)),
    )
