"""Any Co-Simulation FMU, FMI 2.0 or 3.0, by variable name: what the checks and a user's own FMU need.

Our own FMU is flown through `fmu.library`, which is faster and knows it; this knows only the standard.
"""

from __future__ import annotations

import shutil
import tempfile
from collections import deque
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from fmu.errors import PlantError, RefusedError

VERSIONS = ("2.0", "3.0")
"""FMI versions that can be flown."""
_FLOATS = ("Real", "Float64", "Float32")
_WHOLE = ("Integer", "Enumeration", *(f"{sign}Int{bits}" for sign in ("", "U") for bits in (8, 16, 32, 64)))
_NUMBERS = (*_FLOATS, *_WHOLE, "Boolean")
_CALLS = {"Enumeration": {"2.0": "Integer", "3.0": "Int64"}}
"""Types whose values are moved by another type's functions."""


def read_description(path: Path) -> Any:  # noqa: ANN401  (fmpy has no types)
    """fmpy's model description of an FMU, of whatever version, not validated.

    Raises
    ------
    PlantError
        If the file is missing or is no FMU.
    """
    from fmpy.model_description import read_model_description  # noqa: PLC0415  (slow import)

    if not path.is_file():
        raise PlantError("load", 0.0, "missing", f"no FMU at {path}")
    try:
        return read_model_description(str(path), validate=False)
    except Exception as error:  # fmpy raises whatever zip and XML raise
        raise PlantError("load", 0.0, "unusable", f"{path}: {error}") from error


class CoSimulation:
    """One instance of an FMU, initialised at time zero; a context manager.

    Parameters
    ----------
    path : Path
        The FMU.
    start : mapping, optional
        Start values by variable name, in the FMU's own units.
    description : fmpy model description, optional
        If it has been read before.

    Raises
    ------
    PlantError
        If the file is no FMU with Co-Simulation for this machine, or refuses to start.
    ValueError
        If a start value has a name that the FMU does not know.
    """

    def __init__(
        self,
        path: Path,
        start: Mapping[str, float] | None = None,
        description: Any = None,  # noqa: ANN401
    ) -> None:
        description = description or read_description(path)
        version = str(description.fmiVersion)[:3]
        if version not in VERSIONS:
            raise PlantError("load", 0.0, "unusable", f"{path}: FMI {version}; known: {', '.join(VERSIONS)}")
        if description.coSimulation is None:
            raise PlantError("load", 0.0, "unusable", f"{path}: Model Exchange only, no Co-Simulation")
        self._version = version
        self._variables = {
            variable.name: variable
            for variable in description.modelVariables
            if variable.type in _NUMBERS and not getattr(variable, "dimensions", ())
        }
        self._groups: dict[tuple[str, ...], dict[str, tuple[list[int], list[int]]]] = {}
        self._nanoseconds = 0  # whole numbers do not drift
        self._log: deque[str] = deque(maxlen=10)
        self._slave: Any = None
        self._folder = Path(tempfile.mkdtemp(prefix="sidestep-unit-"))
        try:
            self._slave = self._instantiate(path, description)
            self.write(start or {})
            self._initialise()
        except ValueError:
            self.close()
            raise
        except Exception as error:
            message = self._said() or str(error)
            self.close()
            raise PlantError("initialise", 0.0, "unusable", f"{path}: {message}") from error

    def _instantiate(self, path: Path, description: Any) -> Any:  # noqa: ANN401
        from fmpy import extract, instantiate_fmu  # noqa: PLC0415  (slow import)

        extract(str(path), str(self._folder))
        log = self._remember_3 if self._version == "3.0" else self._remember_2
        folder = str(self._folder)
        return instantiate_fmu(folder, description, "CoSimulation", logger=log, debug_logging=True)

    def _initialise(self) -> None:
        if self._version == "2.0":
            self._slave.setupExperiment(startTime=0.0)
            self._slave.enterInitializationMode()
        else:
            self._slave.enterInitializationMode(startTime=0.0)
        self._slave.exitInitializationMode()

    def _remember_2(self, _environment: Any, _name: bytes, status: int, _category: Any, text: bytes) -> None:  # noqa: ANN401
        self._remember_3(None, status, b"", text)

    def _remember_3(self, _environment: object, status: int, _category: bytes, message: bytes) -> None:
        if status > 0:  # an FMU may log every call; only warnings and worse are told
            self._log.append(message.decode("utf-8", "replace"))

    def _said(self) -> str:
        text = "; ".join(self._log)
        self._log.clear()
        return text

    @property
    def time(self) -> float:
        """Since the start [s]."""
        return self._nanoseconds / 1e9

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of the scalar outputs that are numbers."""
        return tuple(name for name, each in self._variables.items() if each.causality == "output")

    def restart(self, start: Mapping[str, float]) -> None:
        """Begin again at time zero with other start values; what is not named is as the FMU comes.

        Raises
        ------
        ValueError
            If a start value has an unknown name or is refused.
        PlantError
            If the FMU does not start.
        """
        self._nanoseconds = 0
        try:
            self._slave.reset()
            self.write(start)
            self._initialise()
        except ValueError:
            raise
        except Exception as error:
            raise PlantError("initialise", 0.0, "Error", self._said() or str(error)) from error

    def read(self, names: Sequence[str]) -> list[float]:
        """Values of variables, in the order of their names."""
        values = [0.0] * len(names)
        try:
            for kind, (places, references) in self._grouped(tuple(names)).items():
                got = getattr(self._slave, "get" + kind)(references)
                for place, value in zip(places, got, strict=True):
                    values[place] = float(value)
        except ValueError:
            raise
        except Exception as error:
            raise PlantError("read", self.time, "Error", self._said() or str(error)) from error
        return values

    def write(self, values: Mapping[str, float]) -> None:
        """Set variables by name; whole numbers and Booleans are converted.

        Raises
        ------
        ValueError
            If a name is unknown; `RefusedError` if the FMU refuses a value.
        """
        names, numbers = tuple(values), list(values.values())
        for kind, (places, references) in self._grouped(names).items():
            convert = float if kind in _FLOATS else bool if kind == "Boolean" else int
            row = [convert(numbers[place]) for place in places]
            try:
                getattr(self._slave, "set" + kind)(references, row)
            except Exception as error:
                given = ", ".join(f"{names[place]} = {numbers[place]:g}" for place in places)
                said = self._said() or f"the FMU refused {given}: {error}"
                raise RefusedError("set inputs", self.time, "Error", said) from error

    def step(self, duration: float) -> None:
        """Advance by a duration [s]."""
        try:
            self._slave.doStep(self.time, duration)
        except Exception as error:
            raise PlantError("step", self.time, "Error", self._said() or str(error)) from error
        self._nanoseconds += round(duration * 1e9)

    def close(self) -> None:
        """Free the instance and the unpacked files; a second call does nothing."""
        if self._slave is not None:
            self._slave.freeInstance()
            self._slave = None
        shutil.rmtree(self._folder, ignore_errors=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _grouped(self, names: tuple[str, ...]) -> dict[str, tuple[list[int], list[int]]]:
        """Places and value references of these names, by the type whose functions move them."""
        if names not in self._groups:
            groups: dict[str, tuple[list[int], list[int]]] = {}
            for place, name in enumerate(names):
                variable = self._variables.get(name)
                if variable is None:
                    raise ValueError(f"{name!r}: the FMU has no such number")
                kind = _CALLS.get(variable.type, {}).get(self._version, variable.type)
                places, references = groups.setdefault(kind, ([], []))
                places.append(place)
                references.append(variable.valueReference)
            self._groups[names] = groups
        return self._groups[names]
