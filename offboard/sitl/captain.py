"""Who flies: modes, arming, the mission under way. Knows an autopilot's rules, but no protocol."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from enum import IntEnum

from avoidance import Waypoint
from offboard.orbit import Orbit
from offboard.sitl.aircraft import Aircraft, Phase
from offboard.sitl.dialect import mavlink
from offboard.sitl.flavour import Flavour, Role, Say
from offboard.sitl.flight import Course, MissionFlight
from offboard.sitl.items import WireItem, checksum
from offboard.sitl.modes import Mode, Task
from offboard.sitl.parameters import Parameters
from offboard.sitl.plan import Defaults, Kind, Plan
from offboard.sitl.px4 import has_what_is_wanted

DOWN = -20.0
"""Altitude that is asked for to come down to the ground [m]: it is approached ever more slowly."""
ITEM_NAMES = {
    mavlink.MAV_CMD_NAV_WAYPOINT: "WP",
    mavlink.MAV_CMD_NAV_TAKEOFF: "Takeoff",
    mavlink.MAV_CMD_NAV_LAND: "Land",
    mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH: "RTL",
    mavlink.MAV_CMD_NAV_LOITER_UNLIM: "LoitUnlim",
    mavlink.MAV_CMD_NAV_LOITER_TURNS: "LoitTurns",
    mavlink.MAV_CMD_NAV_LOITER_TIME: "LoitTime",
    mavlink.MAV_CMD_NAV_LOITER_TO_ALT: "LoitAlt",
}
"""As ArduPlane calls them."""


class MissionState(IntEnum):
    """MISSION_STATE of MISSION_CURRENT."""

    NO_MISSION = 1
    NOT_STARTED = 2
    ACTIVE = 3
    PAUSED = 4
    COMPLETE = 5


class Captain:
    """Modes, arming and the mission of one aircraft.

    Parameters
    ----------
    aircraft : Aircraft
        What is flown.
    flavour : Flavour
        Whose rules hold.
    parameters : Parameters
        Of the autopilot; read when they are needed.
    say : callable
        Told each event, with what its text needs.
    reached : callable
        Told the seq of each item that has been reached.
    """

    def __init__(
        self,
        aircraft: Aircraft,
        flavour: Flavour,
        parameters: Parameters,
        say: Callable[..., None],
        reached: Callable[[int], None],
    ) -> None:
        self.aircraft = aircraft
        self.flavour = flavour
        self.mode = flavour.mode_for(flavour.start)
        self.armed = False
        self.items: tuple[WireItem, ...] = ()
        """The mission as stored, home included where it is item 0."""
        self.current = 0
        """Seq of the item that is flown to, or would be."""
        self.flight = MissionFlight(self._reached)
        self.takeoff_altitude: float | None = None
        """Given with the last take-off command [m above home]; None takes the parameter."""
        self._parameters = parameters
        self._say = say
        self._tell_reached = reached
        self._orbit: Orbit | None = None
        self._speed: float | None = None
        self._feasible = True
        self._complete = False
        self._climb: Course | None = None

    # What it shows

    @property
    def mission_id(self) -> int:
        """Checksum of the mission; 0 if there is none."""
        return checksum(self.items) if self.items else 0

    @property
    def total(self) -> int:
        """Number of items as MISSION_CURRENT counts them: without home."""
        return max(len(self.items) - (1 if self.flavour.home_item else 0), 0)

    @property
    def mission_state(self) -> MissionState:
        """How the mission stands."""
        if not self.total or not self._feasible:
            return MissionState.NO_MISSION
        if self._complete:
            return MissionState.COMPLETE
        if self.mode.task is Task.MISSION and self.armed:
            return MissionState.ACTIVE
        return MissionState.NOT_STARTED if self.current <= self.first else MissionState.PAUSED

    @property
    def first(self) -> int:
        """Seq of the first item that is flown to."""
        return 1 if self.flavour.home_item else 0

    @property
    def mission_over(self) -> bool:
        """True once the last item has been reached, or is circled about for ever."""
        return self._complete or self.aircraft.phase is Phase.LANDED or self.flight.stays

    # What it is told

    def arm(self) -> str | None:
        """Arm; the reason if it cannot be done."""
        if self.aircraft.phase is Phase.LANDED:
            return "the flight is over"
        if not self.armed:
            self.armed = True
            self._say(Say.ARMED)
            self._enter(self.mode)
        return None

    def disarm(self, force: bool) -> bool:
        """Disarm; in flight only by force, and then the aircraft glides down straight ahead."""
        if self.armed and self.aircraft.moving and not force:
            self._say(Say.IN_FLIGHT)
            return False
        if self.armed:
            self.armed = False
            self.aircraft.aim = None
            self._say(Say.DISARMED)
        return True

    def set_mode(self, mode: Mode) -> bool:
        """Change the mode; False if it is refused."""
        if mode.task is Task.MISSION and (not self._feasible or not self._plan().legs):
            self._say(Say.NO_MISSION)
            return False
        if mode is not self.mode:
            self._enter(mode)
        return True

    def go_to(self, place: Waypoint, radius: float | None, direction: int) -> None:
        """Fly to a place and circle about it."""
        wanted = self._parameters[self.flavour.roles[Role.LOITER]] if radius is None else radius
        orbit = Orbit.about(place, self.aircraft.orbit_radius(wanted), direction)
        self._enter(self.flavour.mode_for(Task.GUIDED), orbit)

    def set_speed(self, airspeed: float | None) -> None:
        """Fly at this airspeed until the mission wants another; None goes back to the usual one."""
        self._speed = airspeed
        self.aircraft.airspeed = airspeed or self._cruise()
        self.aircraft.aim = None

    def set_current(self, seq: int) -> bool:
        """Fly to item `seq` next; False if there is no such item."""
        if not 0 <= seq < len(self.items):
            self._say(Say.OFF_LIST)
            return False
        self._complete = False
        self.flight.plan = self._plan()
        self._begin(seq)
        if self.mode.task is Task.MISSION:
            self._announce(self.current)
        return True

    def take_mission(self, items: Sequence[WireItem], flagged: int | None) -> None:
        """A whole new mission, flown from its flagged item on, as PX4 does it."""
        same = bool(items) and tuple(items) == self.items
        self.items = tuple(items)
        self._feasible = has_what_is_wanted(items, self._parameters)
        if same and self._feasible and not self._complete:
            return
        self._complete = False
        self.flight.plan = self._plan()
        self._begin((flagged or 0) if items else 0)
        if self.mode.task is Task.MISSION and not (self._feasible and self.flight.plan.legs):
            self._say(Say.INFEASIBLE)
            self._enter(self.flavour.mode_for(Task.HOLD))

    def overwrite(self, items: Sequence[WireItem]) -> None:
        """Items written over the old ones, as ArduPilot does it: the target under way is kept."""
        self.items = tuple(items)
        under_way = self.flight.leg if self.mode.task is Task.MISSION else None
        plan = self._plan()
        if under_way is None:
            self.flight.plan = plan
            self.current = min(self.current, max(len(self.items) - 1, 0))
        else:
            self.flight.replace(plan.with_leg(under_way), under_way.seq)

    def power_on(self) -> None:
        """Begin again in the first mode; in flight the aircraft stays armed."""
        self.armed = self.armed and self.aircraft.moving
        self._speed = None
        self._enter(self.flavour.mode_for(self.flavour.start))

    # What it does

    def step(self) -> None:
        """Decide what the aircraft does from now on; to be called after each step of it."""
        aircraft = self.aircraft
        if aircraft.phase is Phase.LANDED:
            self._after_landing()
            return
        if not aircraft.moving:
            self._launch_if_wanted()
        if aircraft.moving:
            aim = self._aim()
            if aim is not None:
                aircraft.fly(aim)

    def _launch_if_wanted(self) -> None:
        """Let the aircraft go: armed, and on the ground only to climb away."""
        if self.armed and (
            not self.aircraft.starts_on_ground or self.mode.task in (Task.MISSION, Task.TAKEOFF)
        ):
            self.aircraft.launch()
            if self.aircraft.starts_on_ground:
                self._say(Say.TAKEOFF)
            self._begin_task(self._orbit)

    def _aim(self) -> Orbit | Course | None:
        """What the aircraft is to fly now."""
        state = self.aircraft.state
        if not self.armed:
            return self.aircraft.ahead(DOWN) if self.aircraft.aim is None else None
        match self.mode.task:
            case Task.MISSION:
                return self._mission_aim()
            case Task.TAKEOFF if self._climb is not None:
                if state.altitude < self._climb[4] - 2.0:
                    return self._climb
                self._climb = None
                self._say(Say.CLIMBED, altitude=state.altitude)
                if self.flavour.atomic:
                    self._enter(self.flavour.mode_for(Task.HOLD))
                else:
                    self._orbit = self.aircraft.circle()
            case Task.PILOT if self.aircraft.aim is None:
                return self.aircraft.ahead()
        return self._orbit

    def _mission_aim(self) -> Orbit | Course | None:
        """The mission's leg, after changing it if it has ended; what follows the mission at its end."""
        before = self.flight.leg
        self.flight.step(self.aircraft.state)
        leg = self.flight.leg
        if leg is None:
            self._complete = True
            self._say(Say.FINISHED)
            self._enter(self.flavour.mode_for(self.flavour.after_mission))
            return self._orbit
        if leg is not before:
            self._announce(leg.seq)
            if before is not None and leg.target.airspeed != before.target.airspeed:
                self._speed = None
        aim = self.flight.command(self.aircraft.state)
        if isinstance(aim, Orbit):
            self.aircraft.airspeed = self._speed or leg.target.airspeed
            return aim
        return aim if aim is None or self._speed is None else (*aim[:5], self._speed)

    def _enter(self, mode: Mode, orbit: Orbit | None = None) -> None:
        """Go into a mode, or begin it again."""
        self.mode = mode
        self._begin_task(orbit)
        if mode.task is Task.MISSION:
            self._say(Say.MISSION_MODE)
            if (leg := self.flight.leg) is not None:
                self._announce(leg.seq)

    def _begin_task(self, orbit: Orbit | None = None) -> None:
        """Begin what the mode is for, from here."""
        task = self.mode.task
        self._orbit = self._orbit_of(task) if orbit is None else orbit
        self._climb = None
        self.aircraft.aim = None
        self.aircraft.airspeed = self._speed or self._cruise()
        if task is Task.TAKEOFF:
            height = self.takeoff_altitude or self._parameters[self.flavour.roles[Role.TAKEOFF]]
            self._climb = self.aircraft.ahead(max(height, self.aircraft.state.altitude))
        if task is Task.MISSION:
            self._complete = False
            self.flight.plan = self._plan()
            self._begin(self.current)

    def _orbit_of(self, task: Task) -> Orbit | None:
        """The circle that belongs to a mode, begun here."""
        radius = self.aircraft.orbit_radius(self._parameters[self.flavour.roles[Role.LOITER]])
        here = Orbit.from_here(self.aircraft.state, radius)
        match task:
            case Task.HOLD | Task.GUIDED:
                return here
            case Task.LAND:
                return replace(here, altitude=DOWN)
            case Task.RETURN:
                height = self._parameters[self.flavour.roles[Role.RETURN]]
                return Orbit(0.0, 0.0, max(height, 0.0) or here.altitude, radius)
        return None

    def _begin(self, seq: int) -> None:
        """Fly to item `seq`, or the first one behind it that is flown to, from here."""
        self.current = max(seq, self.first) if self.items else 0
        self.flight.begin(self.current, self.aircraft.state)
        leg = self.flight.leg
        if leg is not None and (self.mode.task is Task.MISSION or not self.flavour.home_item):
            self.current = leg.seq

    def _announce(self, seq: int) -> None:
        """Another item is flown to."""
        self.current = seq
        what = ITEM_NAMES.get(self.items[seq].command, "") if seq < len(self.items) else ""
        self._say(Say.LEG, seq=seq, what=what)

    def _reached(self, seq: int) -> None:
        """An item has been reached."""
        leg, state = self.flight.leg, self.aircraft.state
        if leg is not None and leg.kind is Kind.TAKEOFF:
            self._say(Say.CLIMBED, altitude=state.altitude)
        elif leg is not None:
            end = leg.target.waypoint
            distance = math.hypot(end.north - state.north, end.east - state.east)
            self._say(Say.REACHED, seq=seq, distance=distance)
        self._tell_reached(seq)

    def _after_landing(self) -> None:
        """Note a touch-down once, and disarm."""
        if self.armed:
            self._say(Say.LANDED)
            self.flight.landed()
            self._complete = self._complete or self.flight.finished
            self.disarm(force=True)

    def _plan(self) -> Plan:
        """The stored mission as legs."""
        defaults = Defaults(
            airspeed=self._cruise(),
            acceptance_radius=self._parameters[self.flavour.roles[Role.ACCEPTANCE]],
            orbit_radius=self._parameters[self.flavour.roles[Role.LOITER]],
            limit_radius=self.aircraft.orbit_radius,
        )
        return Plan.of(self.items, self.first, self.aircraft.frame, defaults)

    def _cruise(self) -> float:
        return self._parameters[self.flavour.roles[Role.AIRSPEED]]
