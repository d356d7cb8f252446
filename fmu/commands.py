"""What every plant is told, whoever made its FMU: modes, steps, directions."""

from __future__ import annotations

DIRECT, LEG, ORBIT = 0, 1, 2
"""Values of `command.mode`."""
LONGEST_STEP = 3600.0
"""Longest communication step the model accepts [s]."""


def check_direction(direction: int) -> None:
    """Refuse an orbit that is neither clockwise (+1) nor anticlockwise (-1).

    Raises
    ------
    ValueError
        If it is neither.
    """
    if direction not in (-1, 1):
        raise ValueError(f"direction={direction!r}: must be +1 (clockwise) or -1")


def check_duration(duration: float) -> None:
    """Refuse a step [s] that is no positive number, or too long.

    Raises
    ------
    ValueError
        If it is not within (0, `LONGEST_STEP`].
    """
    if not 0.0 < duration <= LONGEST_STEP:
        raise ValueError(f"duration={duration!r}: must be within (0, {LONGEST_STEP:g}] s")
