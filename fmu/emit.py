"""The table of variables as `modelDescription.xml` (FMI 3.0) and as a C header."""

from __future__ import annotations

import math
from collections.abc import Mapping
from xml.etree import ElementTree as ET

from fmu.parameters import load_aircraft
from fmu.variables import TABLE, UNITS, Variable

MODEL = "sidestep_aircraft"
"""Model identifier: the name of the library in the FMU."""
SOURCES = (
    "airframe.c",
    "atmosphere.c",
    "autopilot.c",
    "guidance.c",
    "instance.c",
    "kinematic.c",
    "powertrain.c",
    "trim.c",
    "fmi3.c",
    "fmi3_unused.c",
)
"""Translation units of the model."""
HEADERS = ("fmi3.h", "model.h")
"""Headers beside the generated `variables.h`."""
STEP = 0.01
"""Step that suits the model: the period of the guidance [s]."""


def starts() -> dict[str, float]:
    """Start value of every parameter and input; the aircraft is the packaged default."""
    values = load_aircraft()
    values.update({row.name: row.start for row in TABLE if row.start is not None})
    return values


def model_description(token: str) -> str:
    """`modelDescription.xml` of the FMI 3.0 Co-Simulation FMU.

    Parameters
    ----------
    token : str
        Instantiation token, the same as in the library.
    """
    root = ET.Element(
        "fmiModelDescription",
        fmiVersion="3.0",
        modelName="SidestepAircraft",
        instantiationToken=token,
        description="Fixed-wing UAV with guidance: six degrees of freedom, or kinematic",
        generationTool="Sidestep fmu.build",
        license="BSD-3-Clause",
        variableNamingConvention="structured",
    )
    ET.SubElement(root, "CoSimulation", modelIdentifier=MODEL, canHandleVariableCommunicationStepSize="true")
    _units(ET.SubElement(root, "UnitDefinitions"))
    categories = ET.SubElement(root, "LogCategories")
    ET.SubElement(categories, "Category", name="logStatusError", description="Refused calls and failures")
    ET.SubElement(root, "DefaultExperiment", startTime="0", stopTime="60", stepSize=f"{STEP:g}")
    table, values = ET.SubElement(root, "ModelVariables"), starts()
    for reference, row in enumerate(TABLE):
        _variable(table, reference, row, values)
    structure = ET.SubElement(root, "ModelStructure")
    for element in ("Output", "InitialUnknown"):
        for reference, row in enumerate(TABLE):
            if row.causality == "output":
                ET.SubElement(structure, element, valueReference=str(reference))
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def build_description() -> str:
    """`sources/buildDescription.xml`: how an importer compiles the FMU for another platform."""
    root = ET.Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = ET.SubElement(root, "BuildConfiguration", modelIdentifier=MODEL)
    files = ET.SubElement(configuration, "SourceFileSet", language="C99")
    for name in SOURCES:
        ET.SubElement(files, "SourceFile", name=name)
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def c_header(token: str) -> str:
    """`variables.h`: the struct that holds all values, and one row of facts about each."""
    values = starts()
    members = "".join(f"    double {row.field};  /* {row.unit}: {row.description} */\n" for row in TABLE)
    rows = "".join(_c_row(row, values) for row in TABLE)
    return f"""/* Generated from fmu/variables.py; do not edit. */
#ifndef SIDESTEP_VARIABLES_H
#define SIDESTEP_VARIABLES_H

#include <stddef.h>

#define MODEL_TOKEN "{token}"
#define N_VARIABLES {len(TABLE)}

typedef struct {{
{members}}} Variables;

#ifdef VARIABLE_FACTS
typedef enum {{ INDEPENDENT, PARAMETER, INPUT, OUTPUT }} Causality;
typedef enum {{ FLOAT64, INT32, BOOLEAN }} Kind;
typedef struct {{
    size_t offset;
    Causality causality;
    Kind kind;
    double start, minimum, maximum;
    const char *name;
}} VariableFact;

static const VariableFact FACTS[N_VARIABLES] = {{
{rows}}};
#endif

#endif
"""


def _c_row(row: Variable, values: Mapping[str, float]) -> str:
    low = "-1e300" if row.minimum == -math.inf else repr(float(row.minimum))
    high = "1e300" if row.maximum == math.inf else repr(float(row.maximum))
    start = repr(float(values.get(row.name, 0.0)))
    facts = f"{row.causality.upper()}, {row.kind.upper()}, {start}, {low}, {high}"
    return f'    {{offsetof(Variables, {row.field}), {facts}, "{row.name}"}},\n'


def _units(parent: ET.Element) -> None:
    for unit in UNITS.values():
        element = ET.SubElement(parent, "Unit", name=unit.name)
        ET.SubElement(element, "BaseUnit", {name: str(power) for name, power in unit.base})
        if unit.display:
            ET.SubElement(element, "DisplayUnit", name=unit.display, factor=repr(unit.factor))


def _variable(parent: ET.Element, reference: int, row: Variable, values: Mapping[str, float]) -> None:
    facts = {
        "name": row.name,
        "valueReference": str(reference),
        "causality": row.causality,
        "variability": row.variability,
        "description": row.description,
    }
    if row.kind == "Float64":
        facts["unit"] = row.unit
        if display := UNITS[row.unit].display:
            facts["displayUnit"] = display
    if row.kind != "Boolean":
        if math.isfinite(row.minimum):
            facts["min"] = _text(row, row.minimum)
        if math.isfinite(row.maximum):
            facts["max"] = _text(row, row.maximum)
    if row.causality in ("parameter", "input"):
        facts["start"] = _text(row, values[row.name])
    ET.SubElement(parent, row.kind, facts)


def _text(row: Variable, value: float) -> str:
    if row.kind == "Float64":
        return repr(float(value))
    if row.kind == "Int32":
        return str(int(value))
    return "true" if value else "false"
