"""An encounter of two aircraft as a system file (SSP 1.0): `python -m fmu.ssp -o encounter.ssp`.

Two instances of the FMI 2.0 FMU (SSP 1.0 knows no later one), `own` and `intruder`, head-on. `own` flies
north along a leg; the leg of `intruder` ends where `own` is, so that it comes to meet it wherever it goes:
two connections from outputs to inputs. All start values are a parameter set named `initialValues`.
"""

from __future__ import annotations

import argparse
import math
import os
import sys
import tempfile
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.etree import ElementTree as ET

from fmu.build import PACKAGED_FMI2
from fmu.errors import FmuError, PlantError
from fmu.variables import TABLE

DISTANCE = 4000.0
"""From nose to nose at the start [m]."""
DURATION, STEP = 120.0, 0.1
"""Suggested end and step of the experiment [s]."""
OWN: Mapping[str, float] = {"command.leg.to_north": 10_000.0}
"""Start values of the own aircraft."""
INTRUDER: Mapping[str, float] = {
    "initial.north": DISTANCE,
    "initial.heading": math.pi,
    "command.leg.from_north": DISTANCE,
    "command.leg.to_north": 0.0,
}
"""Start values of the intruder."""
WIRES = (
    ("own", "state.north", "intruder", "command.leg.to_north"),
    ("own", "state.east", "intruder", "command.leg.to_east"),
)
"""Connections: from whom, which output, to whom, which input."""
OUTPUTS = ("state.north", "state.east", "state.altitude", "state.airspeed", "state.heading")
"""Outputs that the components show."""
PARAMETER_SET = "initialValues"
_NAMES = {
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssc": "http://ssp-standard.org/SSP1/SystemStructureCommon",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
}
_TYPES = {"Float64": "Real", "Int32": "Integer", "Boolean": "Boolean"}
_KINDS = {row.name: _TYPES[row.kind] for row in TABLE}


def write_encounter(target: Path, fmu: Path = PACKAGED_FMI2) -> Path:
    """Write the encounter; the file appears whole or not at all.

    Parameters
    ----------
    target : Path
        File to write.
    fmu : Path
        FMI 2.0 FMU of the aircraft.

    Raises
    ------
    PlantError
        If there is no such FMU.
    """
    if not fmu.is_file():
        raise PlantError("load", 0.0, "missing", f"no FMU at {fmu}; build it with `sidestep fmu build`")
    resource = f"resources/{fmu.name}"
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    try:
        with os.fdopen(handle, "wb") as stream, zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("SystemStructure.ssd", system_structure(resource))
            archive.write(fmu, resource)
        Path(name).chmod(0o644)
        Path(name).replace(target)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
    return target


def system_structure(source: str) -> str:
    """`SystemStructure.ssd`: components, their start values, the wires between them."""
    for prefix, address in _NAMES.items():
        ET.register_namespace(prefix, address)
    root = ET.Element(_tag("ssd", "SystemStructureDescription"), version="1.0", name="encounter")
    system = ET.SubElement(root, _tag("ssd", "System"), name="encounter")
    elements = ET.SubElement(system, _tag("ssd", "Elements"))
    for name, values in (("own", OWN), ("intruder", INTRUDER)):
        _component(elements, name, source, values)
    connections = ET.SubElement(system, _tag("ssd", "Connections"))
    for start, output, end, input_ in WIRES:
        ET.SubElement(
            connections,
            _tag("ssd", "Connection"),
            startElement=start,
            startConnector=output,
            endElement=end,
            endConnector=input_,
        )
    ET.SubElement(root, _tag("ssd", "DefaultExperiment"), startTime="0.0", stopTime=str(DURATION))
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _component(parent: ET.Element, name: str, source: str, values: Mapping[str, float]) -> None:
    component = ET.SubElement(
        parent, _tag("ssd", "Component"), name=name, type="application/x-fmu-sharedlibrary", source=source
    )
    connectors = ET.SubElement(component, _tag("ssd", "Connectors"))
    inputs = [variable for _, _, end, variable in WIRES if end == name]
    for variable, kind in [*((each, "output") for each in OUTPUTS), *((each, "input") for each in inputs)]:
        connector = ET.SubElement(connectors, _tag("ssd", "Connector"), name=variable, kind=kind)
        ET.SubElement(connector, _tag("ssc", _KINDS[variable]))
    bindings = ET.SubElement(component, _tag("ssd", "ParameterBindings"))
    binding = ET.SubElement(
        ET.SubElement(bindings, _tag("ssd", "ParameterBinding")), _tag("ssd", "ParameterValues")
    )
    table = ET.SubElement(binding, _tag("ssv", "ParameterSet"), version="1.0", name=PARAMETER_SET)
    parameters = ET.SubElement(table, _tag("ssv", "Parameters"))
    for variable, value in values.items():
        entry = ET.SubElement(parameters, _tag("ssv", "Parameter"), name=variable)
        ET.SubElement(entry, _tag("ssv", _KINDS[variable]), value=repr(value))


def _tag(prefix: str, name: str) -> str:
    return f"{{{_NAMES[prefix]}}}{name}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Command line: 0 written, 3 not."""
    parser = argparse.ArgumentParser(prog="python -m fmu.ssp", description="Write an encounter as SSP.")
    parser.add_argument("-o", "--output", type=Path, default=Path("encounter.ssp"), help="file (%(default)s)")
    options = parser.parse_args(arguments)
    try:
        print(write_encounter(options.output))
    except (FmuError, OSError) as error:
        print(f"fmu.ssp: {error}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main())
