"""A vehicle that steps a plant in process."""

from __future__ import annotations

from collections.abc import Sequence

from avoidance import Decision, Hold, Keep, Ownship, Performance, Route, Waypoint
from offboard.edits import Edit, EditAction, Observed, route_of
from offboard.errors import LinkError
from offboard.frames import MapFrame
from offboard.link import EditStatus, Plant, VehicleState
from offboard.mission import MissionItem, MissionPlan, MissionProgress, VehicleAction
from offboard.mission_list import MissionList, same_place
from offboard.orbit import Orbit
from offboard.sequencer import Progress, Target, advance, begin_leg

ORBIT_TURN_RADII = 1.5
"""Radius of an orbit of our own choice, in turn radii at the bank limit."""


class SimulatedVehicle:
    """A `Vehicle` in front of a plant: its mission, its leg sequencing, its holds.

    It is airborne when the simulation begins. Whoever owns time calls `advance`; every other call takes
    no time. The plant is commanded only when the leg or the orbit changes.

    Parameters
    ----------
    plant : Plant
        The aircraft with its guidance, where the flight begins.
    frame : MapFrame
        The map about home.
    performance : Performance
        What the aircraft can do; its `airspeed` is flown where the mission gives none, its
        `acceptance_radius` holds for items that give none.
    """

    def __init__(self, plant: Plant, frame: MapFrame, performance: Performance) -> None:
        self.plant = plant
        self.frame = frame
        self._performance = performance
        self._mission: MissionList | None = None
        self._targets: tuple[Target, ...] = ()
        self._progress = Progress(0, self._here())
        self._paused = True
        self._hold: Orbit | None = None
        self._edit = EditStatus.IDLE
        self._route: Route | None = None
        self._orbit_radius = ORBIT_TURN_RADII * performance.turn_radius

    # What the avoidance core and the loop need

    @property
    def performance(self) -> Performance:
        """Speed, bank limit, acceptance radius and tracking error."""
        return self._performance

    @property
    def finished(self) -> bool:
        """True once the last mission item has been reached."""
        return self._mission is not None and self._progress.current >= len(self._targets)

    @property
    def mission(self) -> MissionList | None:
        """The mission as it is now, with what each item stands for; None before the first upload."""
        return self._mission

    @property
    def holding(self) -> bool:
        """True while the vehicle orbits instead of flying its mission: paused, or told to hold."""
        return self._paused or self._hold is not None

    def state(self) -> VehicleState:
        """Where the plant is, and how far the last edit is (an edit in process needs no time)."""
        state = self.plant.state
        return VehicleState(
            Ownship(
                time=state.time,
                north=state.north,
                east=state.east,
                altitude=state.altitude,
                velocity_north=state.velocity_north,
                velocity_east=state.velocity_east,
                climb_rate=state.climb_rate,
                airspeed=state.airspeed,
                heading=state.heading,
                bank=state.bank,
            ),
            self._edit,
        )

    def route(self) -> Route:
        """What is still to be flown; while the vehicle holds, from where it is.

        The same object is given until something changes.
        """
        if self.holding and not self.finished:
            return Route(self._here(), self._ahead(), held=True)
        if self._route is None:
            self._route = Route(self._progress.origin, self._ahead(), held=False)
        return self._route

    def begin(self, decision: Decision) -> None:
        """Carry out a decision: change the mission, hold, or end a hold.

        While paused only the mission is changed: nothing but `start_mission` ends a pause.

        Raises
        ------
        LinkError
            If no mission has been uploaded.
        ValueError
            If the decision's route cannot be that of this mission.
        """
        if isinstance(decision, Keep) or self.finished:
            return
        route = route_of(decision)
        if route is not None:
            self._take_over(route)
        if self._paused:
            return
        if isinstance(decision, Hold):
            hold = Orbit.about(decision.centre, decision.radius, decision.direction)
            if hold != self._hold:
                self._hold = hold
                self._command()
        elif self._hold is not None:
            self._hold = None
            self._fly_from_here(self._progress.current)

    def advance(self, duration: float) -> None:
        """Step the plant by `duration` seconds, then change legs if one has ended."""
        self.plant.step(duration)
        if not self.holding:
            self._sequence()

    # MAVSDK's mission interface

    def upload_mission(self, mission_plan: MissionPlan) -> None:
        """Replace the whole mission; the vehicle orbits where it is until it is told to start.

        Raises
        ------
        ValueError
            If the plan has no items or one of them cannot be flown; names item, field and value.
        """
        _check(mission_plan)
        self._set_mission(MissionList.of(mission_plan, self.frame, self._performance.airspeed))
        self._progress = Progress(0, self._here())
        self._edit = EditStatus.IDLE
        self.pause_mission()

    def download_mission(self) -> MissionPlan:
        """The mission as it is now, injected items included."""
        return MissionPlan(self._loaded().items())

    def start_mission(self) -> None:
        """Start, or resume after a pause, at the current item, from where the vehicle is.

        An item where the vehicle already is (the first one, as a rule) counts as reached at once.
        """
        self._loaded()
        if not self._paused or self.finished:
            return
        self._paused = False
        self._fly_from_here(self._progress.current)

    def pause_mission(self) -> None:
        """Turn right into an orbit that begins where the vehicle is, until `start_mission`."""
        self._paused = True
        self._hold = None
        self._command()

    def set_current_mission_item(self, index: int) -> None:
        """Fly to item `index` of the mission as it is now, from where the vehicle is.

        A pause lasts, a hold ends.

        Raises
        ------
        ValueError
            If there is no such item.
        """
        total = len(self._loaded().entries)
        if not 0 <= index < total:
            raise ValueError(f"index = {index}, must be between 0 and {total - 1}")
        self._hold = None
        self._fly_from_here(index)

    def mission_progress(self) -> MissionProgress:
        """Current item and total; both the same once the mission is finished."""
        return MissionProgress(self._progress.current, len(self._targets))

    def is_mission_finished(self) -> bool:
        """True once the last item has been reached (MAVSDK's name for `finished`)."""
        return self.finished

    def inject(self, mission_items: Sequence[MissionItem]) -> None:
        """Put items before the current one, in flight, and fly to the first of them at once.

        They become part of the mission as uploaded, so that avoidance goes round for them but does not
        take them away. A pause lasts, a hold ends.

        Raises
        ------
        ValueError
            If there are none, or one of them cannot be flown; names item, field and value.
        """
        mission = self._loaded()
        _check(MissionPlan.of(mission_items))
        current = self._progress.current
        self._set_mission(mission.with_injected(current, mission_items, self.frame))
        self._hold = None
        self._fly_from_here(current)

    # Inside

    def _loaded(self) -> MissionList:
        """The mission, or a `LinkError` if there is none."""
        if self._mission is None:
            raise LinkError("no mission has been uploaded")
        return self._mission

    def _here(self) -> Waypoint:
        """The present position."""
        state = self.plant.state
        return Waypoint(state.north, state.east, state.altitude)

    def _ahead(self) -> tuple[Waypoint, ...]:
        """The waypoints still to be flown to."""
        return () if self._mission is None else self._mission.ahead(self._progress.current)

    def _set_mission(self, mission: MissionList) -> None:
        """Take over a list and what sequencing needs of it."""
        self._mission = mission
        self._targets = mission.targets(self._performance.acceptance_radius)
        self._route = None

    def _take_over(self, route: tuple[Waypoint, ...]) -> None:
        """Edit the mission, in one attempt that is confirmed by what the vehicle then flies."""
        mission = self._loaded()
        current = self._progress.current
        before = mission.ahead(current)
        if route == before:
            return
        edited = mission.with_route(current, route, self.frame)
        edit = Edit(Observed(len(edited.entries), current, route[0] if route else None))
        now = self.plant.state.time
        if edit.poll(now, None) is EditAction.SEND:
            self._set_mission(edited)
            if not route or not same_place(route[0], before[0]):
                self._fly_from_here(current)
        taken = self._targets[current].waypoint if route else None
        edit.poll(now, Observed(len(self._targets), current, taken))
        self._edit = edit.status

    def _fly_from_here(self, current: int) -> None:
        """Begin the leg to item `current` at the present position."""
        here = self._here()
        self._progress = begin_leg(current, here.north, here.east, here.altitude)
        self._route = None
        if not self.holding:
            self._progress = self._advanced()
            self._command()

    def _sequence(self) -> None:
        """Change legs if the present one has ended."""
        progress = self._advanced()
        if progress is not self._progress:
            self._progress = progress
            self._route = None
            self._command()

    def _advanced(self) -> Progress:
        """Progress at the present position."""
        state = self.plant.state
        position = (state.north, state.east, state.altitude)
        return advance(self._progress, self._targets, position, state.time)

    def _command(self) -> None:
        """Tell the plant what to fly: the leg, or the orbit that stands in its way."""
        if self._paused:
            orbit = Orbit.from_here(self.plant.state, self._orbit_radius)
        elif self._hold is not None:
            orbit = self._hold
        elif self.finished:
            end = self._targets[-1].waypoint if self._targets else self._here()
            orbit = Orbit.about(end, self._orbit_radius)
        elif self._progress.loiter_until is not None:
            end = self._targets[self._progress.current].waypoint
            orbit = Orbit.about(end, self._orbit_radius)
        else:
            origin, target = self._progress.origin, self._targets[self._progress.current]
            end = target.waypoint
            self.plant.fly_leg(origin.north, origin.east, end.north, end.east, end.altitude, target.airspeed)
            return
        orbit.command(self.plant, self._performance.airspeed)


def _check(plan: MissionPlan) -> None:
    """Refuse, with a `ValueError`, what an airborne fixed-wing vehicle without a runway cannot fly."""
    plan.check()
    for index, item in enumerate(plan.mission_items):
        if item.vehicle_action is VehicleAction.LAND:
            raise ValueError(f"item {index}: vehicle_action = LAND, but this vehicle does not land")
