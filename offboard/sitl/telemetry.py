"""What an autopilot tells of itself: one message for each thing."""

from __future__ import annotations

import math
from collections.abc import Callable

from offboard.frames import MapFrame
from offboard.orbit import Orbit
from offboard.sitl.captain import Captain
from offboard.sitl.dialect import Extended, Message, mavlink

NOT_GIVEN = math.nan
CELLS = 4
"""Of the battery."""


class Telemetry:
    """Messages about one aircraft at the present instant.

    Parameters
    ----------
    captain : Captain
        Who flies it.
    start : float
        Unix time at which the clock was 0 [s].
    """

    def __init__(self, captain: Captain, start: float) -> None:
        self._captain = captain
        self._aircraft = captain.aircraft
        self._frame: MapFrame = captain.aircraft.frame
        self._start = start
        self._place = (math.nan, math.nan, 0.0, 0.0)
        self._makers: dict[int, Callable[[], Message | None]] = {
            mavlink.MAVLINK_MSG_ID_HEARTBEAT: self._heartbeat,
            mavlink.MAVLINK_MSG_ID_SYS_STATUS: self._sys_status,
            mavlink.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: self._extended_sys_state,
            mavlink.MAVLINK_MSG_ID_BATTERY_STATUS: self._battery_status,
            mavlink.MAVLINK_MSG_ID_HOME_POSITION: self._home_position,
            mavlink.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN: self._origin,
            mavlink.MAVLINK_MSG_ID_GPS_RAW_INT: self._gps_raw,
            mavlink.MAVLINK_MSG_ID_WIND_COV: self._wind,
            mavlink.MAVLINK_MSG_ID_ATTITUDE: self._attitude,
            mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: self._global_position,
            mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED: self._local_position,
            mavlink.MAVLINK_MSG_ID_VFR_HUD: self._vfr_hud,
            mavlink.MAVLINK_MSG_ID_ALTITUDE: self._altitude,
            mavlink.MAVLINK_MSG_ID_MISSION_CURRENT: self._mission_current,
            mavlink.MAVLINK_MSG_ID_POSITION_TARGET_GLOBAL_INT: self._position_target,
            mavlink.MAVLINK_MSG_ID_NAV_CONTROLLER_OUTPUT: self._nav_controller,
            mavlink.MAVLINK_MSG_ID_SYSTEM_TIME: self._system_time,
            mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION: self._version,
        }

    def message(self, message_id: int) -> Message | None:
        """The message as of now; None if it is unknown or there is nothing to tell."""
        maker = self._makers.get(message_id)
        return None if maker is None else maker()

    def knows(self, message_id: int) -> bool:
        """True if it can be asked for."""
        return message_id in self._makers

    @property
    def boot_ms(self) -> int:
        """Time since power-on [ms]."""
        return round(self._aircraft.clock * 1000.0) & 0xFFFFFFFF

    def geodetic(self, north: float, east: float) -> tuple[int, int]:
        """A place on the map in degE7."""
        latitude, longitude = self._frame.to_geodetic(north, east)
        return round(latitude * 1e7), round(longitude * 1e7)

    def _here(self) -> tuple[int, int]:
        """The present place in degE7, worked out once for all messages of a step."""
        state = self._aircraft.state
        if self._place[:2] != (state.north, state.east):
            self._place = (state.north, state.east, *self.geodetic(state.north, state.east))
        return int(self._place[2]), int(self._place[3])

    def _heartbeat(self) -> Message:
        captain = self._captain
        armed = mavlink.MAV_MODE_FLAG_SAFETY_ARMED if captain.armed else 0
        return mavlink.MAVLink_heartbeat_message(
            mavlink.MAV_TYPE_FIXED_WING,
            captain.flavour.autopilot,
            captain.mode.base_mode | armed,
            captain.mode.custom_mode,
            mavlink.MAV_STATE_ACTIVE if captain.armed else mavlink.MAV_STATE_STANDBY,
            3,
        )

    def _sys_status(self) -> Message:
        charge, ardupilot = self._aircraft.charge(), mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA
        unbroken = mavlink.MAV_SYS_STATUS_GEOFENCE if self._captain.flavour.autopilot == ardupilot else 0
        health = (_SENSORS, _SENSORS, _SENSORS | unbroken)  # as both were recorded without a fence
        return mavlink.MAVLink_sys_status_message(
            *health, 150, _millivolts(charge) * CELLS, -1, round(100 * charge), 0, 0, 0, 0, 0, 0
        )

    def _battery_status(self) -> Message:
        charge = self._aircraft.charge()
        cells = [_millivolts(charge)] * CELLS + [0xFFFF] * (10 - CELLS)
        function, kind = mavlink.MAV_BATTERY_FUNCTION_ALL, mavlink.MAV_BATTERY_TYPE_LION
        return mavlink.MAVLink_battery_status_message(
            0, function, kind, 0x7FFF, cells, -1, -1, -1, round(100 * charge)
        )

    def _extended_sys_state(self) -> Message:
        flying = self._aircraft.moving
        landed = mavlink.MAV_LANDED_STATE_IN_AIR if flying else mavlink.MAV_LANDED_STATE_ON_GROUND
        return mavlink.MAVLink_extended_sys_state_message(mavlink.MAV_VTOL_STATE_UNDEFINED, landed)

    def _home(self) -> tuple[int, int, int]:
        """Home in degE7, degE7 and mm above mean sea level."""
        home = self._frame
        return round(home.latitude_deg * 1e7), round(home.longitude_deg * 1e7), round(home.altitude_m * 1e3)

    def _home_position(self) -> Message:
        home = self._frame
        place = (
            round(home.latitude_deg * 1e7),
            round(home.longitude_deg * 1e7),
            round(home.altitude_m * 1e3),
        )
        upright = [1.0, 0.0, 0.0, 0.0]
        return mavlink.MAVLink_home_position_message(
            *place, 0.0, 0.0, 0.0, upright, 0.0, 0.0, 0.0, self.boot_ms * 1000
        )

    def _origin(self) -> Message:
        home = self._frame
        place = (
            round(home.latitude_deg * 1e7),
            round(home.longitude_deg * 1e7),
            round(home.altitude_m * 1e3),
        )
        return mavlink.MAVLink_gps_global_origin_message(*place, self.boot_ms * 1000)

    def _gps_raw(self) -> Message:
        own = self._aircraft.ownship()
        altitude = round(1e3 * (own.altitude + self._frame.altitude_m))
        return mavlink.MAVLink_gps_raw_int_message(
            self.boot_ms * 1000,
            mavlink.GPS_FIX_TYPE_3D_FIX,
            *self._here(),
            altitude,
            70,
            110,
            round(100.0 * own.ground_speed),
            _centidegrees(own.course),
            14,
        )

    def _wind(self) -> Message:
        north, east = self._aircraft.wind
        altitude = self._aircraft.state.altitude + self._frame.altitude_m
        return mavlink.MAVLink_wind_cov_message(
            self.boot_ms * 1000, north, east, 0.0, 0.0, 0.0, altitude, 0.0, 0.0
        )

    def _attitude(self) -> Message:
        state = self._aircraft.state
        rates = [getattr(state, name, 0.0) if self._aircraft.moving else 0.0 for name in ("p", "q", "r")]
        return mavlink.MAVLink_attitude_message(
            self.boot_ms, state.bank, state.pitch, math.remainder(state.heading, math.tau), *rates
        )

    def _global_position(self) -> Message:
        own = self._aircraft.ownship()
        return mavlink.MAVLink_global_position_int_message(
            self.boot_ms,
            *self._here(),
            round(1e3 * (own.altitude + self._frame.altitude_m)),
            round(1e3 * own.altitude),
            round(100.0 * own.velocity_north),
            round(100.0 * own.velocity_east),
            round(-100.0 * own.climb_rate),
            _centidegrees(own.heading),
        )

    def _local_position(self) -> Message:
        own = self._aircraft.ownship()
        velocity = (own.velocity_north, own.velocity_east, -own.climb_rate)
        return mavlink.MAVLink_local_position_ned_message(
            self.boot_ms, own.north, own.east, -own.altitude, *velocity
        )

    def _vfr_hud(self) -> Message:
        own = self._aircraft.ownship()
        heading = _centidegrees(own.heading) // 100
        throttle = 50 if self._aircraft.moving and self._captain.armed else 0
        altitude = own.altitude + self._frame.altitude_m
        return mavlink.MAVLink_vfr_hud_message(
            own.airspeed, own.ground_speed, heading, throttle, altitude, own.climb_rate
        )

    def _altitude(self) -> Message:
        above = self._aircraft.state.altitude
        sea = above + self._frame.altitude_m
        return mavlink.MAVLink_altitude_message(
            self.boot_ms * 1000, sea, sea, above, above, NOT_GIVEN, NOT_GIVEN
        )

    def _mission_current(self) -> Message:
        captain = self._captain
        atomic = captain.flavour.atomic
        flying = captain.mode.task.name == "MISSION"
        total = captain.total or (0xFFFF if atomic else 0)
        mode = 1 if flying else (2 if atomic else 0)
        message = mavlink.MAVLink_mission_current_message(
            captain.current, total, int(captain.mission_state), mode
        )
        return Extended(message, captain.mission_id, 0, 0) if atomic else message

    def _position_target(self) -> Message | None:
        aim, flavour = self._aircraft.aim, self._captain.flavour
        if aim is None or not self._aircraft.moving:
            return None
        north, east, altitude = (aim.north, aim.east, aim.altitude) if isinstance(aim, Orbit) else aim[2:5]
        rest = [NOT_GIVEN if flavour.atomic else 0.0] * 8
        return mavlink.MAVLink_position_target_global_int_message(
            self.boot_ms,
            flavour.target_frame,
            flavour.target_mask,
            *self.geodetic(north, east),
            altitude + self._frame.altitude_m,
            *rest,
        )

    def _nav_controller(self) -> Message | None:
        aim, state = self._aircraft.aim, self._aircraft.state
        if aim is None or not self._aircraft.moving:
            return None
        north, east, altitude = (aim.north, aim.east, aim.altitude) if isinstance(aim, Orbit) else aim[2:5]
        bearing = math.atan2(east - state.east, north - state.north)
        distance = math.hypot(north - state.north, east - state.east)
        speed = self._aircraft.airspeed if isinstance(aim, Orbit) else aim[5]
        return mavlink.MAVLink_nav_controller_output_message(
            math.degrees(state.bank),
            math.degrees(state.pitch),
            round(math.degrees(bearing)),
            round(math.degrees(bearing)),
            min(round(distance), 0xFFFF),
            altitude - state.altitude,
            speed - state.airspeed,
            0.0 if isinstance(aim, Orbit) else _cross_track(aim[:4], state.north, state.east),
        )

    def _system_time(self) -> Message:
        unix = round(1e6 * (self._start + self._aircraft.clock))
        return mavlink.MAVLink_system_time_message(unix, self.boot_ms)

    def _version(self) -> Message:
        flavour = self._captain.flavour
        nothing = [0] * 8
        versions = (flavour.version, 0, 0, 0)
        return mavlink.MAVLink_autopilot_version_message(
            flavour.capabilities, *versions, nothing, nothing, nothing, 0, 0, 0
        )


_SENSORS = (
    mavlink.MAV_SYS_STATUS_SENSOR_3D_GYRO
    | mavlink.MAV_SYS_STATUS_SENSOR_3D_ACCEL
    | mavlink.MAV_SYS_STATUS_SENSOR_3D_MAG
    | mavlink.MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE
    | mavlink.MAV_SYS_STATUS_SENSOR_DIFFERENTIAL_PRESSURE
    | mavlink.MAV_SYS_STATUS_SENSOR_GPS
    | mavlink.MAV_SYS_STATUS_AHRS
    | mavlink.MAV_SYS_STATUS_PREARM_CHECK
)


def _cross_track(line: tuple[float, ...], north: float, east: float) -> float:
    """Distance right of a line from (north, east) to (north, east) [m]."""
    from_north, from_east, to_north, to_east = line
    along = math.atan2(to_east - from_east, to_north - from_north)
    return (east - from_east) * math.cos(along) - (north - from_north) * math.sin(along)


def _centidegrees(angle: float) -> int:
    """0 to 35999."""
    return round(math.degrees(angle) * 100.0) % 36000


def _millivolts(charge: float) -> int:
    """Voltage of a cell, roughly."""
    return round(1000.0 * (3.3 + 0.9 * charge))
