"""An autopilot's output channels and what they move: a TOML file per airframe.

The file::

    name = "px4-10041"
    autopilot = "px4"                 # or "ardupilot"
    description = "one line"
    source = "where the order comes from"

    [[output]]
    channel = 1                       # counted from 1, as autopilots do
    drives = {roll = 1.0}             # roll, pitch, yaw, throttle per full output

The airframe's command on an axis is the sum over its channels, kept within ±1 (throttle 0 to 1). Signs are a
pilot's: right wing down, nose up, nose right are positive.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from offboard.hil.errors import OptionError
from offboard.hil.plant import Axes

FOLDER = Path(__file__).parent / "airframes"
AXES = Axes._fields
AUTOPILOTS = ("px4", "ardupilot")
CHANNELS = 32
"""Most channels an autopilot sends."""
NEUTRAL_PWM, IDLE_PWM, FULL_PWM = 1500.0, 1000.0, 2000.0
"""Pulse widths of a centred surface, an engine at rest, and full output [µs]."""
_KEYS = ("name", "autopilot", "description", "source", "output")


@dataclass(frozen=True, slots=True)
class Output:
    """One output channel."""

    channel: int
    """Counted from 0."""
    drives: Axes
    """What full output adds to each axis."""

    @property
    def is_engine(self) -> bool:
        """True if it moves nothing but the throttle."""
        return self.drives.throttle != 0.0


@dataclass(frozen=True, slots=True)
class Airframe:
    """Which output moves what.

    Examples
    --------
    >>> load_airframe("px4-x8").axes([0.5, -0.5, 0.7])
    Axes(roll=-0.5, pitch=0.0, yaw=0.0, throttle=0.7)
    """

    name: str
    """As given to `--airframe`."""
    autopilot: str
    """"px4" or "ardupilot"."""
    description: str
    """One line for the user."""
    source: str
    """Where the order of channels comes from."""
    outputs: tuple[Output, ...]
    """Channels that move something."""

    def axes(self, values: Sequence[float]) -> Axes:
        """What normalised outputs (surfaces -1 to 1, engine 0 to 1) ask for.

        A channel that is missing or not a number counts as neutral.
        """
        roll = pitch = yaw = throttle = 0.0
        for output in self.outputs:
            value = values[output.channel] if output.channel < len(values) else 0.0
            if math.isnan(value):  # this output is disarmed
                continue
            drives = output.drives
            roll += drives.roll * value
            pitch += drives.pitch * value
            yaw += drives.yaw * value
            throttle += drives.throttle * value
        return Axes(
            min(max(roll, -1.0), 1.0),
            min(max(pitch, -1.0), 1.0),
            min(max(yaw, -1.0), 1.0),
            min(max(throttle, 0.0), 1.0),
        )

    def axes_of_pwm(self, pwm: Sequence[int]) -> Axes:
        """What pulse widths [µs] ask for; 0 means no output, and counts as neutral."""
        values = [0.0] * CHANNELS
        for output in self.outputs:
            width = pwm[output.channel] if output.channel < len(pwm) else 0
            if width == 0:
                continue
            if output.is_engine:
                values[output.channel] = (width - IDLE_PWM) / (FULL_PWM - IDLE_PWM)
            else:
                values[output.channel] = (width - NEUTRAL_PWM) / (FULL_PWM - NEUTRAL_PWM)
        return self.axes(values)

    def values_for(self, axes: Axes, count: int = 16) -> list[float]:
        """Outputs by which an autopilot of this airframe asks for `axes`; every surface takes its part."""
        values = [0.0] * count
        for output in self.outputs:
            wanted = sum(
                math.copysign(axis, axis * share)
                for axis, share in zip(axes, output.drives, strict=True)
                if share
            )
            low = 0.0 if output.is_engine else -1.0
            values[output.channel] = min(max(wanted, low), 1.0)
        return values

    def pwm_for(self, axes: Axes, count: int = 16) -> list[int]:
        """Pulse widths [µs] by which an autopilot of this airframe asks for `axes`."""
        widths = [0] * count
        values = self.values_for(axes, count)
        for output in self.outputs:
            value = values[output.channel]
            width = IDLE_PWM + value * 1000.0 if output.is_engine else NEUTRAL_PWM + value * 500.0
            widths[output.channel] = round(width)
        return widths


def airframe_names(autopilot: str | None = None) -> tuple[str, ...]:
    """Names of the airframes that come with the package, all or those of one autopilot."""
    return tuple(name for name in sorted(_packaged()) if autopilot is None or name.startswith(autopilot))


def load_airframe(name: str) -> Airframe:
    """An airframe by name, or by the path of a TOML file.

    Raises
    ------
    OptionError
        If there is none, or with every mistake in the file.
    """
    path = Path(name) if name.endswith(".toml") else _packaged().get(name)
    if path is None:
        raise OptionError(
            "airframe", [f"{name!r} is unknown; known: {', '.join(airframe_names())}, or FILE.toml"]
        )
    try:
        with path.open("rb") as stream:
            document = tomllib.load(stream)
    except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise OptionError(path, [str(error)]) from error
    mistakes: list[str] = []
    airframe = _checked(document, name, mistakes)
    if mistakes:
        raise OptionError(path, mistakes)
    return airframe


def _packaged() -> dict[str, Path]:
    """Files by name; a file that serves two airframes is named for both, with `+` between."""
    return {name: path for path in FOLDER.glob("*.toml") for name in path.stem.split("+")}


def _checked(document: Mapping[str, Any], name: str, mistakes: list[str]) -> Airframe:
    mistakes += [f"{key} is unknown; known: {', '.join(_KEYS)}" for key in document if key not in _KEYS]
    autopilot = document.get("autopilot")
    if autopilot not in AUTOPILOTS:
        mistakes.append(f"autopilot = {autopilot!r} must be one of {', '.join(AUTOPILOTS)}")
    tables = document.get("output")
    if not isinstance(tables, list) or not tables:
        mistakes.append("output is missing: at least one [[output]] with channel and drives")
        tables = []
    outputs = [_output(index, table, mistakes) for index, table in enumerate(tables)]
    channels = [output.channel for output in outputs]
    mistakes += [f"channel = {c + 1} is given twice" for c in sorted(set(channels)) if channels.count(c) > 1]
    description, source = (str(document.get(key, "")) for key in ("description", "source"))
    return Airframe(name, str(autopilot), description, source, tuple(outputs))


def _output(index: int, table: object, mistakes: list[str]) -> Output:
    where = f"output {index + 1}"
    if not isinstance(table, dict):
        mistakes.append(f"{where} must be a table")
        return Output(0, Axes(0.0, 0.0, 0.0, 0.0))
    channel = table.get("channel")
    if not isinstance(channel, int) or isinstance(channel, bool) or not 1 <= channel <= CHANNELS:
        mistakes.append(f"{where}: channel = {channel!r} must be a whole number from 1 to {CHANNELS}")
        channel = 1
    drives = table.get("drives")
    if not isinstance(drives, dict) or not drives:
        mistakes.append(f"{where}: drives = {drives!r} must be a table such as {{roll = 1.0}}")
        drives = {}
    shares = dict.fromkeys(AXES, 0.0)
    for axis, share in drives.items():
        if axis not in AXES:
            mistakes.append(f"{where}: drives.{axis} is unknown; known: {', '.join(AXES)}")
        elif not isinstance(share, int | float) or isinstance(share, bool) or not 0.0 < abs(share) <= 2.0:
            mistakes.append(f"{where}: drives.{axis} = {share!r} must be a number within ±2, and not 0")
        else:
            shares[axis] = float(share)
    if shares["throttle"] and any(shares[axis] for axis in ("roll", "pitch", "yaw")):
        mistakes.append(f"{where}: an engine's channel cannot move a surface as well")
    return Output(channel - 1, Axes(**shares))
