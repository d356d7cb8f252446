"""Aircraft files (TOML) to model parameters, checked against the table."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path

from fmu.errors import AircraftError
from fmu.rows import Variable
from fmu.variables import TABLE

FOLDER = Path(__file__).parent / "aircraft"
DEFAULT = "skywalker_x8"

_ROWS: dict[str, Variable] = {row.name: row for row in TABLE if row.name.startswith("aircraft.")}


def aircraft_names() -> tuple[str, ...]:
    """Names of the parameter sets that come with the package."""
    return tuple(sorted(path.stem for path in FOLDER.glob("*.toml")))


def aircraft_path(aircraft: str) -> Path:
    """File of an aircraft given by name or by the path of a TOML file.

    Raises
    ------
    ValueError
        If there is no such name or file.
    """
    path = Path(aircraft) if aircraft.endswith(".toml") else FOLDER / f"{aircraft}.toml"
    if not path.is_file():
        known = ", ".join(aircraft_names())
        raise ValueError(f"aircraft={aircraft!r}: neither a TOML file nor one of {known}")
    return path


def load_aircraft(aircraft: str = DEFAULT) -> dict[str, float]:
    """Read a parameter set.

    Parameters
    ----------
    aircraft : str
        Name of a packaged set, or path of a TOML file.

    Returns
    -------
    dict
        Value by variable name, every `aircraft.*` row of the table, SI and radians.

    Raises
    ------
    ValueError
        If there is no such set.
    AircraftError
        With every mistake of the file: unknown or missing keys, values outside their range, a tensor of
        inertia that no rigid body can have.
    """
    path = aircraft_path(aircraft)
    try:
        with path.open("rb") as stream:
            document = tomllib.load(stream)
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise AircraftError(path, [str(error)]) from error
    values = {key: value for key, value in _flatten(document) if key not in ("name", "sources")}
    mistakes = [f"{key} is unknown" for key in values if key not in _ROWS]
    mistakes += [f"{key} is missing" for key in _ROWS if key not in values]
    for key, value in values.items():
        if key in _ROWS:
            mistakes += check_value(_ROWS[key], value)
    if not mistakes:
        mistakes = [*check_inertia(values), *_check_limits(values)]
    if mistakes:
        raise AircraftError(path, mistakes)
    return {key: float(values[key]) for key in _ROWS}


def check_value(row: Variable, value: object) -> list[str]:
    """What is wrong with a value for a variable; empty if nothing is."""
    if isinstance(value, bool) and row.kind == "Boolean":
        value = int(value)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        return [f"{row.name} = {value!r} is not a finite number"]
    if not row.minimum <= value <= row.maximum:
        return [f"{row.name} = {value:g} is outside [{row.minimum:g}, {row.maximum:g}]"]
    if row.kind != "Float64" and value != int(value):
        return [f"{row.name} = {value:g} is not a whole number"]
    return []


def check_inertia(values: Mapping[str, float]) -> list[str]:
    """Whether a rigid body can have this tensor: no principal moment exceeds the sum of the other two.

    Notes
    -----
    Symmetric about the x-z plane, so the pitch axis is principal and the other two follow from a
    quadratic.
    """
    xx, yy, zz, xz = (values[f"aircraft.inertia.{axis}"] for axis in ("xx", "yy", "zz", "xz"))
    mean, half = (xx + zz) / 2, math.hypot((xx - zz) / 2, xz)
    small, middle, large = sorted((yy, mean - half, mean + half))
    if small > 0 and large <= small + middle:
        return []
    return [
        f"aircraft.inertia: principal moments {small:.4g}, {middle:.4g}, {large:.4g} kg m2 "
        "belong to no rigid body (each must be positive and at most the sum of the other two)"
    ]


def _check_limits(values: Mapping[str, float]) -> list[str]:
    low, cruise, high = (values[f"aircraft.limits.{k}_airspeed"] for k in ("min", "cruise", "max"))
    if low <= cruise <= high:
        return []
    return [f"aircraft.limits: airspeeds min {low:g}, cruise {cruise:g}, max {high:g} are not in order"]


def _flatten(table: Mapping[str, object], prefix: str = "") -> Iterator[tuple[str, float]]:
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _flatten(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value  # type: ignore[misc]  # checked by `check_value` before use
