"""The plant in the loop and sense and avoid together: `sidestep offboard` beside the bridge, one record.

The bridge keeps this process to itself, for it must be on time; the loop of `sidestep offboard` runs in a
process of its own and reaches the autopilot over MAVLink, as it would in flight.
"""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

from offboard.frames import MapFrame
from scenarios.hil_setup import HilOptions
from scenarios.hil_truth import truth
from scenarios.load import load
from scenarios.run import prepare
from scenarios.scenario import Scenario
from scenarios.target import check_target, free_directory

PREFIX = "plant-"
"""Names of the plant's files in the run directory begin with this."""
_PATIENCE = 30.0
"""The other process may take this long to write its run [s]."""


@dataclass(frozen=True, slots=True)
class Together:
    """A scenario that is flown in the loop."""

    scenario: Scenario
    directory: Path
    """Where the run is written."""
    command: tuple[str, ...]
    """The other process."""

    @classmethod
    def of(cls, name: str, url: str, output: Path | None, *, arm: bool, as_json: bool) -> Self:
        """From what the user has asked for.

        Raises
        ------
        ScenarioError, RunDirectoryError
            If the scenario is none, or nothing can be written there.
        """
        scenario = load(name)
        scenario = prepare(scenario, scenario.seed)
        directory = output or free_directory(scenario, scenario.seed)
        check_target(directory)
        words = [sys.executable, "-m", "scenarios.cli", "offboard", "--connect", url, "--mission", name]
        words += ["--timeout", "300", "-o", str(directory)]
        words += ["--arm"] * arm + ["--json"] * as_json
        return cls(scenario, directory, tuple(words))

    def options(self, options: HilOptions) -> HilOptions:
        """The plant where, when and in what wind the scenario has it, along its first leg."""
        scenario, home = self.scenario, self.scenario.home
        first, then = scenario.mission[:2]
        return replace(
            options,
            home=MapFrame(home.latitude_deg, home.longitude_deg, home.altitude_m),
            heading=math.atan2(then.east - first.east, then.north - first.north),
            start=scenario.start_time_utc,
            wind=(scenario.wind.north, scenario.wind.east),
            aircraft=scenario.vehicle.aircraft,
            values={"initial.north": first.north, "initial.east": first.east, **options.values},
        )

    def begin(self) -> subprocess.Popen[bytes]:
        """Start the other process."""
        return subprocess.Popen(self.command)

    def truth(self, rows: Sequence[Sequence[Any]]) -> dict[str, Any]:
        """Separation by the plant's own track (rows of `HilRecorder`), once the other process has written."""
        return truth(self.scenario, rows, self.directory)


def end(process: subprocess.Popen[bytes]) -> int:
    """Ask the other process to write its run, wait for it; its exit code.

    By SIGTERM, which it takes as Ctrl-C: SIGINT is ignored where a script has started us in the background.
    """
    if process.poll() is None:
        process.terminate()
    try:
        return process.wait(_PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait()
