"""ArduPlane, as recorded from ArduPlane 4.7 and as its documentation says."""

from __future__ import annotations

from offboard.sitl.dialect import mavlink
from offboard.sitl.flavour import Flavour, Role, Say
from offboard.sitl.modes import Mode, Task
from offboard.sitl.parameters import INT8, INT16, INT32, REAL32, Value

_CUSTOM = mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
_STICKS = mavlink.MAV_MODE_FLAG_MANUAL_INPUT_ENABLED
_STABLE = mavlink.MAV_MODE_FLAG_STABILIZE_ENABLED
_BY_HAND = _CUSTOM | _STICKS | _STABLE
_BY_ITSELF = _CUSTOM | _STICKS | _STABLE | mavlink.MAV_MODE_FLAG_GUIDED_ENABLED

MISSION_TOTAL = "MIS_TOTAL"
"""Number of items, home included; told whenever it changes."""

_TABLE: dict[str, Value] = {
    "ADSB_ICAO_ID": (INT32, 0),
    "AIRSPEED_CRUISE": (REAL32, 15.0),
    "AIRSPEED_MAX": (REAL32, 25.0),
    "AIRSPEED_MIN": (REAL32, 12.0),
    "ARMING_CHECK": (INT32, 1),
    "AVD_ENABLE": (INT8, 0),
    "AVD_F_ACTION": (INT8, 0),
    "BATT_CAPACITY": (INT32, 3300),
    "BATT_MONITOR": (INT8, 4),
    "COMPASS_USE": (INT8, 1),
    "FENCE_ENABLE": (INT8, 0),
    "FENCE_TOTAL": (INT8, 0),
    "FLTMODE1": (INT8, 10),
    "FLTMODE2": (INT8, 11),
    "FLTMODE3": (INT8, 12),
    "FLTMODE4": (INT8, 5),
    "FLTMODE5": (INT8, 5),
    "FLTMODE6": (INT8, 0),
    "FLTMODE_CH": (INT8, 8),
    "FRAME_CLASS": (INT8, 0),
    MISSION_TOTAL: (INT16, 0),
    "MIS_OPTIONS": (INT16, 0),
    "MIS_RESTART": (INT8, 0),
    "NAVL1_PERIOD": (REAL32, 17.0),
    "PTCH_LIM_MAX_DEG": (REAL32, 20.0),
    "PTCH_LIM_MIN_DEG": (REAL32, -25.0),
    "RALLY_TOTAL": (INT8, 0),
    "ROLL_LIMIT_DEG": (REAL32, 30.0),
    "RTL_ALTITUDE": (REAL32, 100.0),
    "RTL_RADIUS": (INT16, 0),
    "SIM_SPEEDUP": (REAL32, 1.0),
    "SYSID_MYGCS": (INT16, 255),
    "SYSID_THISMAV": (INT16, 1),
    "TECS_CLMB_MAX": (REAL32, 5.0),
    "TECS_SINK_MAX": (REAL32, 5.0),
    "TKOFF_ALT": (REAL32, 50.0),
    "WP_LOITER_RAD": (INT16, 60),
    "WP_RADIUS": (INT16, 90),
}

_MODES = (
    ("AUTO", 10, Task.MISSION),
    ("LOITER", 12, Task.HOLD),
    ("GUIDED", 15, Task.GUIDED),
    ("TAKEOFF", 13, Task.TAKEOFF),
    ("RTL", 11, Task.RETURN),
    ("CIRCLE", 1, Task.HOLD),
    ("AVOID_ADSB", 14, Task.GUIDED),
)
_PILOTED = (
    ("MANUAL", 0),
    ("STABILIZE", 2),
    ("TRAINING", 3),
    ("ACRO", 4),
    ("FBWA", 5),
    ("FBWB", 6),
    ("CRUISE", 7),
    ("AUTOTUNE", 8),
)

ARDUPILOT = Flavour(
    name="ardupilot",
    autopilot=mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA,
    version=0x04070000,
    capabilities=mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_FLOAT
    | mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_FLOAT
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_COMMAND_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST
    | mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_FENCE
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_RALLY,
    modes=(
        *(Mode(name, number, task, _BY_ITSELF) for name, number, task in _MODES),
        *(Mode(name, number, Task.PILOT, _BY_HAND) for name, number in _PILOTED),
    ),
    start=Task.PILOT,
    home_item=True,
    atomic=False,
    reached_repeats=1,
    after_mission=Task.RETURN,
    bytewise=False,
    parameters=_TABLE,
    roles={
        Role.AIRSPEED: "AIRSPEED_CRUISE",
        Role.ACCEPTANCE: "WP_RADIUS",
        Role.LOITER: "WP_LOITER_RAD",
        Role.BANK: "ROLL_LIMIT_DEG",
        Role.TAKEOFF: "TKOFF_ALT",
        Role.RETURN: "RTL_ALTITUDE",
    },
    texts={
        Say.ARMED: (6, "Throttle armed"),
        Say.DISARMED: (6, "Throttle disarmed"),
        Say.NOT_ARMED: (2, "Arm: {why}"),
        Say.IN_FLIGHT: (2, "Disarm: flying"),
        Say.NO_MISSION: (4, "Mode change to AUTO failed: no mission"),
        Say.RECEIVED: (6, "Flight plan received"),
        Say.LEG: (6, "Mission: {seq} {what}"),
        Say.REACHED: (6, "Reached waypoint #{seq} dist {distance:.0f}m"),
        Say.CLIMBED: (6, "Takeoff complete at {altitude:.2f}m"),
        Say.FINISHED: (5, "Mission complete, changing mode to RTL"),
        Say.TAKEOFF: (6, "Triggered AUTO. GPS speed = 0.0"),
        Say.LANDED: (6, "Flare complete"),
        Say.GAVE_UP: (4, "Mission upload timeout"),
    },
    fixed_rates=frozenset(),
    most_items=724,
    target_frame=mavlink.MAV_FRAME_GLOBAL,
    target_mask=65016,
    download_frames=True,
)
