"""From a URL to a vehicle that flies its mission: connect, look, arm, take off, start."""

from __future__ import annotations

import math
from collections.abc import Callable

from offboard.errors import LinkError
from offboard.frames import MapFrame
from offboard.live.aboard import Aboard, request_rates
from offboard.live.autopilots import Mode, rules_of
from offboard.live.limits import EditTimes, read_limits
from offboard.live.messages import Ask, Message, Session
from offboard.live.telemetry import Telemetry
from offboard.live.vehicle import LiveVehicle
from offboard.live.vehicle_clock import VehicleClock
from offboard.raw_mission import TAKE_OFF, RawItem, RawMission

TOO_FAR = 100e3
"""A mission whose home is further away than this from the vehicle is not the vehicle's [m]."""
RETRY_ARM = 2.0
"""A vehicle that refuses to arm is asked again after this time [s]."""
LOWEST_START = 5.0
"""Lower than this above home a vehicle that is not armed stands on the ground [m]."""


def open_vehicle(
    session: Session,
    frame: MapFrame | None = None,
    *,
    wind_bound: float = 0.0,
    times: EditTimes | None = None,
    timeout: float = 30.0,
    touch: bool = True,
) -> LiveVehicle:
    """Wait for a usable vehicle behind a session, and ask it what it can do.

    Parameters
    ----------
    session : Session
        The link.
    frame : MapFrame, optional
        The map; about the vehicle's home unless given.
    wind_bound : float
        Largest steady wind to allow for [m/s].
    times : EditTimes, optional
        How long an edit may take.
    timeout : float
        How long to wait for heartbeat, position and home [s, wall clock].
    touch : bool
        False commands nothing, ever; also message rates are left as they are.

    Raises
    ------
    LinkError
        If it says too little, is neither PX4 nor ArduPilot, or flies somewhere else than the map lies.
    """
    telemetry = Telemetry()
    _hear(session, telemetry, timeout, lambda: telemetry.autopilot >= 0, "heartbeat")
    rules = rules_of(telemetry.autopilot)
    if touch:
        request_rates(session)
    _hear(session, telemetry, timeout, lambda: telemetry.fix is not None, "position: does it have a fix?")
    limits = read_limits(session, rules)
    _hear(session, telemetry, 5.0, lambda: telemetry.home is not None, None)
    fix = telemetry.fix
    if fix is None:
        raise LinkError("the vehicle has told no position")
    home = telemetry.home or (fix.latitude_deg, fix.longitude_deg, fix.amsl - fix.altitude)
    telemetry.home = home
    if frame is None:
        frame = MapFrame(*home)
    try:
        frame.to_map(fix.latitude_deg, fix.longitude_deg)
    except ValueError as error:
        raise LinkError(f"the vehicle is nowhere near the mission: is it the right one? ({error})") from error
    performance = limits.performance(times or EditTimes(), wind_bound)
    clock = VehicleClock(fix.time, session.wall())
    aboard = Aboard(
        session,
        telemetry,
        rules,
        frame,
        performance,
        times or EditTimes(),
        limits.extra,
        clock,
        simulated=limits.simulated,
    )
    if limits.traffic_reaction:
        name = rules.traffic_reaction
        aboard.tell(
            "warning", f"{name} is on: the autopilot's own reaction to traffic will fight ours, set it to 0"
        )
    return LiveVehicle(aboard, touch=touch)


def check_distance(vehicle: LiveVehicle, north: float, east: float) -> None:
    """Make sure that a mission that begins at a place [m] can be this vehicle's, else a `LinkError`."""
    own = vehicle.aboard.ownship()
    away = math.hypot(own.north - north, own.east - east)
    if away > TOO_FAR:
        raise LinkError(f"the mission begins {away / 1e3:.0f} km from the vehicle: is it the right one?")


def with_take_off(raw: RawMission, vehicle: LiveVehicle) -> RawMission:
    """A mission that can be started from the ground: with a take-off before it, if it has none."""
    airborne = vehicle.aboard.ownship().altitude > LOWEST_START or vehicle.aboard.telemetry.armed
    if raw.takes_off or airborne:
        return raw
    first = raw.items[raw.flown_to[0]]
    begin = RawItem(TAKE_OFF, first.frame, (15.0, 0.0, 0.0, math.nan), first.x, first.y, first.z)
    return RawMission.of((begin, *raw.items))


def arm(vehicle: LiveVehicle, timeout: float = 60.0) -> None:
    """Arm a vehicle, asking again while it refuses: ArduPilot's filters need time to settle.

    Raises
    ------
    LinkError
        If it is not armed in time; gives its own words.
    """
    session = vehicle.aboard.session
    until = session.wall() + timeout
    while not vehicle.aboard.telemetry.armed:
        if session.wall() > until:
            name = f"{vehicle.aboard.rules.name}: "  # other warnings are our own
            told = [event.text for event in vehicle.aboard.events if event.severity == "warning"]
            said = [text for text in told if text.startswith(name)]
            raise LinkError(f"the vehicle does not arm: {said[-1] if said else 'it does not say why'}")
        session.ask(Ask.ARM)
        vehicle.wait_for(lambda: vehicle.aboard.telemetry.armed, RETRY_ARM)


def fly_mission(vehicle: LiveVehicle) -> None:
    """Put an armed vehicle into its mission, if it is not; a take-off is part of it."""
    if vehicle.aboard.mode is not Mode.MISSION:
        vehicle.start_mission()


def _hear(
    session: Session, telemetry: Telemetry, timeout: float, ready: Callable[[], bool], what: str | None
) -> None:
    """Listen until something is known; `what` says what is missing if it never is, None lets it be."""
    until = session.wall() + timeout
    while not ready():
        if session.wall() > until:
            if what is None:
                return
            raise LinkError(f"the vehicle is heard, but sends no {what}")
        for one in session.poll(0.1):
            if isinstance(one, Message):
                telemetry.feed(one)
