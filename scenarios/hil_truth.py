"""What a flight in the loop kept clear of, by the plant's own track.

Sense and avoid runs in a process of its own and on the autopilot's clock; the plant has one of its own. Both
recorded the same flight, so the clocks are compared by laying one track upon the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

import numpy as np

from avoidance.types import Floats
from scenarios.errors import RunDirectoryError
from scenarios.metrics import Separation, separations
from scenarios.recorded import Recorded, read_run
from scenarios.scenario import Scenario
from scenarios.track import MovingTrack, Track

FIT = 100.0
"""Tracks of one flight that lie further apart than this in the mean are not compared [m]."""
_SAMPLES = 400
"""Of the autopilot's track, when clocks are compared."""


@dataclass(frozen=True, slots=True)
class ClockFit:
    """How the plant's clock and the recorded run's go together."""

    offset: float
    """Plant's time less the run's [s]."""
    apart: float
    """Root mean square distance of the two tracks with that offset [m]."""

    @classmethod
    def of(cls, plant: Track, run: Track) -> Self | None:
        """Lay one track upon the other.

        Parameters
        ----------
        plant : Track
            The flight as the plant knows it.
        run : Track
            The same flight, or a part of it, as the autopilot told it.

        Returns
        -------
        ClockFit or None
            None if the run is longer than the plant's track, or does not move: then no time can be told.

        Notes
        -----
        Least squares in one unknown: every second first, then by golden section about the best of them.
        """
        from scipy.optimize import minimize_scalar  # noqa: PLC0415

        chosen = np.unique(np.linspace(0, len(run.times) - 1, _SAMPLES).astype(int))
        times, positions = run.times[chosen], run.positions[chosen, :2]
        first, last = plant.times[0] - times[0], plant.times[-1] - times[-1]
        if last < first or float(np.ptp(positions, axis=0).max()) < FIT:
            return None

        def apart(offset: float) -> float:
            there = [np.interp(times + offset, plant.times, column) for column in plant.positions[:, :2].T]
            return float(np.sqrt(np.mean(np.sum((np.column_stack(there) - positions) ** 2, axis=1))))

        seconds = np.arange(first, last + 1.0)
        best = float(seconds[int(np.argmin([apart(float(offset)) for offset in seconds]))])
        found = minimize_scalar(apart, bounds=(best - 1.0, best + 1.0), method="bounded")
        return cls(float(found.x), float(found.fun))


def truth(scenario: Scenario, rows: Sequence[Sequence[Any]], directory: Path) -> dict[str, Any]:
    """Separation by the plant's own track, for the summary.

    Parameters
    ----------
    scenario : Scenario
        What was flown.
    rows : sequence of rows
        The plant's track (`HilRecorder.rows`); what was before its last restart does not count.
    directory : Path
        The run of the other process, for the traffic that it met.

    Returns
    -------
    dict
        `min_separation_m`, `min_margin_m`, `violations`: None where nothing is known. `judged`: `all`;
        `standing`, what always stood there, if there was traffic or something that appears and the clocks
        could not be compared; `nothing`. `clock_fit_m`: how far apart the two tracks of the flight lie, None
        if they were not compared.
    """
    track = _track(rows)
    if track is None:
        return _summary([], "nothing", None)
    run = _run(directory)
    fit = None if run is None else ClockFit.of(track, run.track)
    if run is None or fit is None or fit.apart > FIT:
        always = [each for each in scenario.obstacles if each.appears_at <= 0.0]
        complete = not scenario.traffic and len(always) == len(scenario.obstacles)
        found = separations(track, always)
        return _summary(found, "all" if complete else "standing", None if fit is None else fit.apart)
    standing = [
        replace(each, appears_at=each.appears_at + fit.offset) if each.appears_at > 0.0 else each
        for each in scenario.obstacles
    ]
    traffic = [_at_times_of(track, run.track.times + fit.offset, each) for each in run.traffic]
    return _summary(separations(track, standing, traffic), "all", fit.apart)


def _summary(found: Sequence[Separation], judged: str, fit: float | None) -> dict[str, Any]:
    return {
        "min_separation_m": round(min(each.distance for each in found), 3) if found else None,
        "min_margin_m": round(min(each.margin for each in found), 3) if found else None,
        "violations": sum(each.entries for each in found) if judged != "nothing" else None,
        "judged": judged,
        "clock_fit_m": None if fit is None else round(fit, 3),
    }


def _track(rows: Sequence[Sequence[Any]]) -> Track | None:
    """The plant's track since its last restart; None if there is none."""
    if len(rows) < 2:
        return None
    numbers = np.array([[float(row[0]), *map(float, row[2:5])] for row in rows])
    backwards = np.flatnonzero(np.diff(numbers[:, 0]) <= 0.0)
    numbers = numbers[backwards[-1] + 1 :] if backwards.size else numbers
    if len(numbers) < 2:
        return None
    blank = np.zeros(len(numbers))
    return Track("plant", numbers[:, 0], numbers[:, 1:4], blank, blank, blank)


def _run(directory: Path) -> Recorded | None:
    """The run of the other process; None if it left none that can be read."""
    try:
        run = read_run(directory)
    except RunDirectoryError:
        return None
    return run if len(run.track.times) > 1 else None


def _at_times_of(track: Track, times: Floats, mover: MovingTrack) -> MovingTrack:
    """Traffic known at other times, at those of a track; NaN outside the time for which it is known."""
    known = np.isfinite(mover.positions[:, 0])
    positions = np.full_like(track.positions, np.nan)
    if known.any():
        when = times[known]
        inside = (track.times >= when[0]) & (track.times <= when[-1])
        for axis in range(3):
            positions[inside, axis] = np.interp(track.times[inside], when, mover.positions[known, axis])
    return MovingTrack(mover.id, mover.radius, positions)
