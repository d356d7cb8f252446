"""The plant with its flight's beginning and end: it stands, is launched, flies, and lands."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from offboard.hil.plant import NEUTRAL, Axes, HilPlant, Phase, Truth
from offboard.hil.timing import Timing


@dataclass(frozen=True, slots=True)
class LaunchRule:
    """When a standing aircraft is let go: the autopilot has asked for thrust, and goes on asking."""

    throttle: float = 0.3
    """From this share of full throttle."""
    delay: float = 0.5
    """For this long [s]."""


@dataclass(slots=True)
class Simulation:
    """A plant on its own clock: command, step, look; launched by its rule, put back when asked."""

    plant: HilPlant
    """The aircraft."""
    rule: LaunchRule = field(default_factory=LaunchRule)
    """When it is launched."""
    watch: Callable[[Truth, Phase, Axes], None] | None = None
    """Called after each step: a recorder."""
    timing: Timing = field(default_factory=Timing)
    """Where the time goes."""
    axes: Axes = NEUTRAL
    """The last command."""
    restarts: int = 0
    """How often the autopilot has begun anew."""
    truth: Truth = field(init=False)
    """State after the last step."""
    phase: Phase = field(init=False)
    """Of the flight."""
    _asked: float = field(default=0.0, init=False, repr=False)

    def __post_init__(self) -> None:
        """Read the plant as it is."""
        self.truth = self.plant.truth()
        self.phase = self.plant.phase

    def step(self, axes: Axes, duration: float) -> Truth:
        """Command the plant, advance it by `duration` [s], and see what became of it."""
        self.timing.start()
        self.axes = axes
        self.plant.fly(axes)
        if self.phase is Phase.STANDING:
            self._consider_launch(axes, duration)
        self.plant.step(duration)
        self.truth = self.plant.truth()
        self.phase = self.plant.phase
        self.timing.steps += 1
        self.timing.lap("plant")
        if self.watch is not None:
            self.watch(self.truth, self.phase, axes)
            self.timing.start()
        return self.truth

    def restart(self) -> None:
        """Put everything back to the start: the autopilot has begun anew."""
        self.plant.restart()
        self._asked = 0.0
        self.axes = NEUTRAL
        self.truth = self.plant.truth()
        self.phase = self.plant.phase
        self.restarts += 1

    def _consider_launch(self, axes: Axes, duration: float) -> None:
        if axes.throttle < self.rule.throttle:
            self._asked = 0.0
            return
        self._asked += duration
        if self._asked >= self.rule.delay - 1e-9:
            self.plant.launch()
