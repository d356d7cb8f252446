"""The FMU unpacked, its shared library loaded once, and one instance of it as plain calls on arrays."""

from __future__ import annotations

import ctypes
import math
import shutil
import tempfile
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any
from xml.etree import ElementTree as ET

from fmu.errors import STATUS, PlantError
from fmu.parameters import load_aircraft
from fmu.saving import SavedPlant, deserialise, serialise

PACKAGED = Path(__file__).parent / "sidestep_aircraft.fmu"
WARNING = 1
"""Highest FMI status with which a run goes on."""
_C_TYPES: dict[str, Any] = {"Float64": ctypes.c_double, "Int32": ctypes.c_int32, "Boolean": ctypes.c_bool}


class FmuLibrary:
    """The FMU's shared library, loaded once; makes any number of instances.

    Use `FmuLibrary.open()`; as a context manager it frees the instances and the unpacked files at its end.

    Examples
    --------
    >>> from fmu import FmuLibrary, FmuPlant
    >>> with FmuLibrary.open() as library:
    ...     plant = FmuPlant(library, altitude=200.0)
    ...     plant.step(1.0)
    ...     round(plant.state.north)
    15
    """

    def __init__(self, folder: Path) -> None:
        description = ET.parse(folder / "modelDescription.xml").getroot()
        table = description.find("ModelVariables")
        self.references: dict[str, int] = {}
        self.kinds: dict[str, str] = {}
        self.causalities: dict[str, str] = {}
        for element in table if table is not None else ():
            if element.find("Dimension") is not None:
                continue  # arrays lie over scalars that are in the list
            name = element.attrib["name"]
            self.references[name] = int(element.attrib["valueReference"])
            self.kinds[name] = element.tag
            self.causalities[name] = element.get("causality", "local")
        self._folder = folder
        self._token = description.attrib["instantiationToken"]
        self._aircraft: dict[str, dict[str, float]] = {}
        self._instances: set[FmuInstance] = set()
        self._slave, self._log = self._load(description)
        self.messages: list[str] = []
        self.functions: Any = self._slave.dll

    @classmethod
    def open(cls, path: Path | None = None) -> FmuLibrary:
        """Unpack and load an FMU built by `fmu.build`.

        Parameters
        ----------
        path : Path, optional
            FMU file; the packaged one if not given.

        Raises
        ------
        PlantError
            If the file is missing or is no FMU for this machine.
        """
        path = PACKAGED if path is None else Path(path)
        if not path.is_file():
            raise PlantError("load", 0.0, "missing", f"no FMU at {path}; build it with `python -m fmu.build`")
        folder = Path(tempfile.mkdtemp(prefix="sidestep-fmu-"))
        try:
            with zipfile.ZipFile(path) as archive:
                archive.extractall(folder)
            return cls(folder)
        except Exception as error:  # fmpy raises bare Exception when the library is missing
            message = _no_library(folder) or str(error)
            shutil.rmtree(folder, ignore_errors=True)
            raise PlantError("load", 0.0, "unusable", f"{path}: {message}") from error

    def _load(self, description: ET.Element) -> tuple[Any, Any]:
        from fmpy.fmi3 import FMU3Slave, fmi3LogMessageCallback  # noqa: PLC0415  (slow import)

        def remember(_environment: object, _status: int, _category: bytes, message: bytes) -> None:
            self.messages.append(message.decode("utf-8", "replace"))

        element = description.find("CoSimulation")
        if element is None:
            raise ValueError("no Co-Simulation interface")
        identifier = element.attrib["modelIdentifier"]
        slave = FMU3Slave(
            guid=self._token,
            modelIdentifier=identifier,
            unzipDirectory=str(self._folder),
            instanceName="library",
        )
        return slave, fmi3LogMessageCallback(remember)

    def aircraft(self, name: str) -> dict[str, float]:
        """Parameters of an aircraft by name or TOML path; the file is read once."""
        if name not in self._aircraft:
            self._aircraft[name] = load_aircraft(name)
        return dict(self._aircraft[name])

    def said(self) -> str:
        """What the model has logged since the last call."""
        text = "; ".join(self.messages)
        self.messages.clear()
        return text

    def instantiate(self, name: str) -> FmuInstance:
        """A new instance, not yet initialised."""
        if self._slave is None:
            raise PlantError("instantiate", 0.0, "closed", "the library has been closed")
        from fmpy.fmi3 import fmi3IntermediateUpdateCallback  # noqa: PLC0415  (slow import)

        nothing = fmi3IntermediateUpdateCallback()
        handle = self.functions.fmi3InstantiateCoSimulation(
            name.encode(),
            self._token.encode(),
            None,
            False,
            True,
            False,
            False,
            None,
            0,
            None,
            self._log,
            nothing,
        )
        if not handle:
            raise PlantError("instantiate", 0.0, "no instance", self.said())
        instance = FmuInstance(self, handle)
        self._instances.add(instance)
        return instance

    def forget(self, instance: FmuInstance) -> None:
        """Strike an instance that has been freed off the list."""
        self._instances.discard(instance)

    def close(self) -> None:
        """Free every instance, unload the library, delete the unpacked files."""
        if self._slave is None:
            return
        for instance in list(self._instances):
            instance.close()
        self._slave.freeLibrary()
        self._slave = None
        shutil.rmtree(self._folder, ignore_errors=True)

    def __enter__(self) -> FmuLibrary:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class Channel:
    """A fixed list of Float64 variables of one instance: arrays allocated once, moved in one call.

    Parameters
    ----------
    instance : FmuInstance
        Whose variables.
    names : sequence of str
        Which, in this order.
    """

    def __init__(self, instance: FmuInstance, names: Sequence[str]) -> None:
        library = instance.library
        count = len(names)
        self.values = (ctypes.c_double * count)()
        self._references = (ctypes.c_uint * count)(*(library.references[name] for name in names))
        self._count = count
        self._instance = instance
        self._get = library.functions.fmi3GetFloat64
        self._set = library.functions.fmi3SetFloat64

    def read(self) -> list[float]:
        """The values now."""
        handle, count = self._instance.live("read"), self._count
        if self._get(handle, self._references, count, self.values, count) > WARNING:
            raise self._instance.failure("read")
        return self.values[:]

    def write(self, values: Sequence[float]) -> None:
        """Set the values; ValueError with the variable's name and range if one is refused."""
        handle, count = self._instance.live("write"), self._count
        self.values[:] = list(values)
        if self._set(handle, self._references, count, self.values, count) > WARNING:
            raise ValueError(self._instance.library.said())


class FmuInstance:
    """One instance of the model: life cycle, values by name, steps."""

    def __init__(self, library: FmuLibrary, handle: int) -> None:
        self.library = library
        self.handle: int | None = handle
        self._nanoseconds = 0  # the model's own grid of time: no drift
        self._flags = (ctypes.c_bool(), ctypes.c_bool(), ctypes.c_bool(), ctypes.c_double())
        self._results = tuple(ctypes.byref(flag) for flag in self._flags)
        self._do_step = library.functions.fmi3DoStep

    @property
    def time(self) -> float:
        """Since the start [s]."""
        return self._nanoseconds / 1e9

    def live(self, what: str) -> int:
        """The handle; PlantError if the instance has been freed (a call would crash the process)."""
        if self.handle is None:
            raise PlantError(what, self.time, "closed")
        return self.handle

    def failure(self, what: str, status: int = 3) -> PlantError:
        """The error to raise after a call that failed."""
        return PlantError(what, self.time, STATUS[min(status, 4)], self.library.said())

    def start(self, values: Mapping[str, float]) -> None:
        """Reset, set these values, initialise at time zero.

        Raises
        ------
        ValueError
            If a value is refused.
        PlantError
            If the aircraft cannot start like this.
        """
        functions, handle = self.library.functions, self.live("initialise")
        if functions.fmi3Reset(handle) > WARNING:
            raise self.failure("reset")
        self._nanoseconds = 0
        self.set_many(values)
        no_tolerance_no_stop = (False, 0.0, 0.0, False, 0.0)
        if (
            functions.fmi3EnterInitializationMode(handle, *no_tolerance_no_stop) > WARNING
            or functions.fmi3ExitInitializationMode(handle) > WARNING
        ):
            raise self.failure("initialise")

    def set_many(self, values: Mapping[str, float]) -> None:
        """Set variables by name, one call per type; ValueError names what is unknown or refused."""
        for kind, c_type in _C_TYPES.items():
            names = [name for name in values if self.kind(name) == kind]
            if not names:
                continue
            count = len(names)
            references = (ctypes.c_uint * count)(*(self.library.references[name] for name in names))
            array = (c_type * count)(*(_convert(name, kind, values[name]) for name in names))
            if (
                getattr(self.library.functions, "fmi3Set" + kind)(
                    self.handle, references, count, array, count
                )
                > WARNING
            ):
                raise ValueError(self.library.said())

    def get(self, name: str) -> float:
        """One variable by name."""
        kind = self.kind(name)
        reference, value = ctypes.c_uint(self.library.references[name]), _C_TYPES[kind]()
        call = getattr(self.library.functions, "fmi3Get" + kind)
        if call(self.live(f"get {name}"), ctypes.pointer(reference), 1, ctypes.pointer(value), 1) > WARNING:
            raise self.failure(f"get {name}")
        return float(value.value)

    def kind(self, name: str) -> str:
        """FMI type of a variable; ValueError if there is no such variable."""
        try:
            return self.library.kinds[name]
        except KeyError:
            raise ValueError(f"name={name!r}: the model has no such variable") from None

    def step(self, duration: float) -> None:
        """Advance by a duration [s]."""
        handle = self.live("step")
        status = self._do_step(handle, self._nanoseconds / 1e9, duration, True, *self._results)
        if status > WARNING:
            raise self.failure("step", status)
        self._nanoseconds += int(duration * 1e9 + 0.5)

    def save(self) -> SavedPlant:
        """The model's state and the time."""
        return SavedPlant(serialise(self), self._nanoseconds)

    def restore(self, saved: SavedPlant) -> None:
        """Go on from a saved state; ValueError if it is none of this model's."""
        deserialise(self, saved.model)
        self._nanoseconds = saved.nanoseconds

    def close(self) -> None:
        """Free the instance; a second call does nothing."""
        if self.handle is not None:
            self.library.functions.fmi3FreeInstance(self.handle)
            self.handle = None
            self.library.forget(self)


def _convert(name: str, kind: str, value: float) -> float | int | bool:
    if kind == "Float64":
        return float(value)
    if not math.isfinite(value) or value != int(value):
        raise ValueError(f"{name} = {value!r} is not a whole number")
    return int(value) if kind == "Int32" else bool(value)


def _no_library(folder: Path) -> str:
    """That an unpacked FMU has no library for this machine, and what helps; nothing if it has one."""
    from fmpy import platform_tuple  # noqa: PLC0415  (slow import)

    binaries = folder / "binaries"
    if not (folder / "modelDescription.xml").is_file() or (binaries / platform_tuple).is_dir():
        return ""
    carried = sorted(each.name for each in binaries.iterdir()) if binaries.is_dir() else []
    others = f"only for {', '.join(carried)}" if carried else "nor for any other"
    return (
        f"no library for this machine ({platform_tuple}), {others}; build it here with `python -m fmu.build`"
    )
