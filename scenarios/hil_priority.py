"""Being on time on a machine that does other things too."""

from __future__ import annotations

import contextlib
import gc
import os
from collections.abc import Iterator
from pathlib import Path

_PRIORITY = 10
_STEAL = 8
"""Field of the first line of /proc/stat: time in which the host ran something else (proc(5))."""


@contextlib.contextmanager
def real_time() -> Iterator[str]:
    """Within it this process, and none that it starts, goes before all ordinary ones, where that is allowed.

    Python's garbage collector rests meanwhile: it would make a step late now and then. The loop leaves no
    reference cycles behind, so nothing piles up.

    Yields
    ------
    str
        What was reached, in words.
    """
    gc.collect()
    gc.disable()
    before = _raise_priority()
    try:
        yield "ordinary priority" if before is None else "real-time priority"
    finally:
        if before is not None:
            os.sched_setscheduler(0, before, os.sched_param(0))
        gc.enable()


def _raise_priority() -> int | None:
    """Take a real-time priority; the scheduling policy of before, or None if it is not allowed."""
    if not hasattr(os, "sched_setscheduler"):
        return None  # not Linux
    before = os.sched_getscheduler(0)
    try:
        os.sched_setscheduler(0, os.SCHED_RR | os.SCHED_RESET_ON_FORK, os.sched_param(_PRIORITY))
    except OSError:
        return None
    return before & ~os.SCHED_RESET_ON_FORK


def stolen_time(stat: Path = Path("/proc/stat")) -> float | None:
    """Processor time that a virtual machine's host has withheld since the machine started.

    No priority helps against that: a machine that loses time this way is not idle, whatever it shows itself.

    Parameters
    ----------
    stat : Path
        Where Linux tells it.

    Returns
    -------
    float or None
        Sum over all processors [s]; None where the system does not tell.
    """
    try:
        first = stat.read_text().partition("\n")[0].split()
        return int(first[_STEAL]) / os.sysconf("SC_CLK_TCK")
    except (OSError, IndexError, ValueError):
        return None
