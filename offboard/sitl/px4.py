"""PX4 fixed-wing, as recorded from PX4 1.17 and as its documentation says."""

from __future__ import annotations

from collections.abc import Sequence

from offboard.sitl.dialect import mavlink
from offboard.sitl.flavour import Flavour, Role, Say
from offboard.sitl.items import WireItem
from offboard.sitl.modes import Mode, Task
from offboard.sitl.parameters import INT32, REAL32, Parameters, Value

LANDING_WANTED = "MIS_TKO_LAND_REQ"
"""0 wants nothing of a mission, 1 a take-off, 2 a landing, 3 both, 4 both or neither."""

_AUTO = 4
_AUTO_FLAGS = (
    mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
    | mavlink.MAV_MODE_FLAG_AUTO_ENABLED
    | mavlink.MAV_MODE_FLAG_GUIDED_ENABLED
    | mavlink.MAV_MODE_FLAG_STABILIZE_ENABLED
)
_BY_HAND = mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | mavlink.MAV_MODE_FLAG_MANUAL_INPUT_ENABLED
_STABILISED = _BY_HAND | mavlink.MAV_MODE_FLAG_STABILIZE_ENABLED


def has_what_is_wanted(items: Sequence[WireItem], parameters: Parameters) -> bool:
    """PX4's check of a mission: whether it has the take-off and landing that are wanted of it."""
    if LANDING_WANTED not in parameters:
        return True
    commands = {item.command for item in items}
    takes_off = mavlink.MAV_CMD_NAV_TAKEOFF in commands
    lands = bool(commands & {mavlink.MAV_CMD_NAV_LAND, mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH})
    match int(parameters[LANDING_WANTED]):
        case 1:
            return takes_off
        case 2:
            return lands
        case 3:
            return takes_off and lands
        case 4:
            return takes_off == lands
    return True


def custom_mode(main: int, sub: int = 0) -> int:
    """PX4's number of a mode: main mode in the third byte, sub mode in the fourth."""
    return main << 16 | sub << 24


def _auto(name: str, sub: int, task: Task) -> Mode:
    return Mode(name, custom_mode(_AUTO, sub), task, _AUTO_FLAGS)


_TABLE: dict[str, Value] = {
    "ADSB_ICAO_ID": (INT32, 1194684),
    "BAT1_N_CELLS": (INT32, 4),
    "CBRK_FLIGHTTERM": (INT32, 121212),
    "COM_DISARM_LAND": (REAL32, 2.0),
    "COM_DL_LOSS_T": (INT32, 10),
    "COM_OBL_RC_ACT": (INT32, 0),
    "COM_RC_IN_MODE": (INT32, 4),
    "COM_RC_LOSS_T": (REAL32, 1.0),
    "EKF2_MAG_DECL": (REAL32, 0.0),
    "FW_AIRSPD_MAX": (REAL32, 25.0),
    "FW_AIRSPD_MIN": (REAL32, 12.0),
    "FW_AIRSPD_TRIM": (REAL32, 15.0),
    "FW_LND_ANG": (REAL32, 4.0),
    "FW_R_LIM": (REAL32, 30.0),
    "FW_T_CLMB_MAX": (REAL32, 5.0),
    "FW_T_SINK_MAX": (REAL32, 5.0),
    "GF_ACTION": (INT32, 2),
    "MAV_SYS_ID": (INT32, 1),
    "MAV_TYPE": (INT32, mavlink.MAV_TYPE_FIXED_WING),
    "MIS_DIST_1WP": (REAL32, 10000.0),
    "MIS_TAKEOFF_ALT": (REAL32, 50.0),
    LANDING_WANTED: (INT32, 2),
    "NAV_ACC_RAD": (REAL32, 50.0),
    "NAV_DLL_ACT": (INT32, 0),
    "NAV_FW_ALT_RAD": (REAL32, 10.0),
    "NAV_LOITER_RAD": (REAL32, 80.0),
    "NAV_RCL_ACT": (INT32, 2),
    "NAV_TRAFF_AVOID": (INT32, 1),
    "NPFG_PERIOD": (REAL32, 10.0),
    "RTL_RETURN_ALT": (REAL32, 60.0),
    "RTL_TYPE": (INT32, 0),
    "SENS_BOARD_ROT": (INT32, 0),
    "SYS_AUTOCONFIG": (INT32, 0),
    "SYS_AUTOSTART": (INT32, 10041),
    "SYS_HITL": (INT32, 0),
}

PX4 = Flavour(
    name="px4",
    autopilot=mavlink.MAV_AUTOPILOT_PX4,
    version=0x01110040,
    capabilities=mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_FLOAT
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_COMMAND_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE
    | mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_FENCE
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_RALLY,
    modes=(
        _auto("Hold", 3, Task.HOLD),
        _auto("Mission", 4, Task.MISSION),
        _auto("Takeoff", 2, Task.TAKEOFF),
        _auto("Return", 5, Task.RETURN),
        _auto("Land", 6, Task.LAND),
        _auto("Ready", 1, Task.HOLD),
        Mode("Manual", custom_mode(1), Task.PILOT, _BY_HAND),
        Mode("Altitude", custom_mode(2), Task.PILOT, _STABILISED),
        Mode("Position", custom_mode(3), Task.PILOT, _STABILISED),
        Mode("Acro", custom_mode(5), Task.PILOT, _BY_HAND),
        Mode("Stabilized", custom_mode(7), Task.PILOT, _STABILISED),
    ),
    start=Task.HOLD,
    home_item=False,
    atomic=True,
    reached_repeats=10,
    after_mission=Task.HOLD,
    bytewise=True,
    parameters=_TABLE,
    roles={
        Role.AIRSPEED: "FW_AIRSPD_TRIM",
        Role.ACCEPTANCE: "NAV_ACC_RAD",
        Role.LOITER: "NAV_LOITER_RAD",
        Role.BANK: "FW_R_LIM",
        Role.TAKEOFF: "MIS_TAKEOFF_ALT",
        Role.RETURN: "RTL_RETURN_ALT",
    },
    texts={
        Say.ARMED: (6, "Armed by external command\t"),
        Say.DISARMED: (6, "Disarmed by external command\t"),
        Say.NOT_ARMED: (2, "Arming denied: {why}\t"),
        Say.IN_FLIGHT: (2, "Disarming denied: not landed\t"),
        Say.MISSION_MODE: (6, "Executing Mission\t"),
        Say.NO_MISSION: (2, "Switching to Mission is currently not available\t"),
        Say.INFEASIBLE: (2, "No valid mission available, loitering\t"),
        Say.FINISHED: (6, "Mission finished, loitering\t"),
        Say.OFF_LIST: (2, "WPM: WP CURR CMD: Not in list\t"),
        Say.TAKEOFF: (6, "Takeoff detected\t"),
        Say.LANDED: (6, "Landing detected\t"),
        Say.GAVE_UP: (2, "Operation timeout\t"),
    },
    fixed_rates=frozenset({mavlink.MAVLINK_MSG_ID_MISSION_CURRENT}),
    most_items=2000,
    target_frame=mavlink.MAV_FRAME_GLOBAL_INT,
    target_mask=0,
    download_frames=False,
)
