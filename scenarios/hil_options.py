"""The options of `sidestep hil`, checked and converted: degrees to radians, text to numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from datetime import UTC, datetime

from offboard.frames import MapFrame
from offboard.hil.errors import OptionError
from offboard.hil.sensors import SensorModel
from offboard.hil.simulation import LaunchRule
from scenarios.hil_setup import HilOptions


def options_of(
    autopilot: str,
    aircraft: str,
    airframe: str | None,
    launch: str,
    launch_throttle: float,
    launch_delay: float,
    home: str,
    start: str,
    wind: str,
    faults: str,
    values: Sequence[str],
    seed: int,
    sensors: SensorModel | None = None,
) -> HilOptions:
    """What the user has asked for.

    Raises
    ------
    OptionError
        Naming the option, its value and what it must be.
    """
    frame, heading = _home(home)
    north, east = _numbers("--wind", wind, (2,), "N,E, such as 3,-4")
    return HilOptions(
        autopilot=autopilot,
        aircraft=aircraft,
        airframe=airframe,
        launch=launch,
        rule=LaunchRule(launch_throttle, launch_delay),
        wind=(north, east),
        faults=faults,
        home=frame,
        heading=heading,
        start=_time(start),
        sensors=sensors or SensorModel(),
        seed=seed,
        values=dict(_value(each) for each in values),
    )


def _home(text: str) -> tuple[MapFrame, float]:
    numbers = _numbers("--home", text, (3, 4), "LAT,LON,ALT or LAT,LON,ALT,HDG")
    try:
        frame = MapFrame(*numbers[:3])
    except ValueError as error:
        raise OptionError("--home", [str(error)]) from error
    return frame, math.radians(numbers[3]) if len(numbers) > 3 else 0.0


def _numbers(option: str, text: str, counts: Sequence[int], form: str) -> list[float]:
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError as error:
        raise OptionError(option, [f"{text!r} must be {form}"]) from error
    if len(numbers) not in counts or not all(map(math.isfinite, numbers)):
        raise OptionError(option, [f"{text!r} must be {form}"])
    return numbers


def _time(text: str) -> datetime:
    try:
        time = datetime.fromisoformat(text)
    except ValueError as error:
        raise OptionError("--start", [f"{text!r} must be a time such as 2025-06-21T08:00Z"]) from error
    return time.replace(tzinfo=UTC) if time.tzinfo is None else time.astimezone(UTC)


def _value(text: str) -> tuple[str, float]:
    name, equals, number = text.partition("=")
    try:
        if not equals:
            raise ValueError(text)
        return name.strip(), float(number)
    except ValueError as error:
        raise OptionError("--set", [f"{text!r} must be NAME=VALUE, such as launch.speed=16"]) from error
