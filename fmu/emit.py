"""The table of variables as `modelDescription.xml` (FMI 3.0), as terminals, and as C."""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree import ElementTree as ET

from fmu.parameters import load_aircraft
from fmu.rows import Variable
from fmu.units import UNITS
from fmu.variables import INDICATORS, REFERENCE, STATES, TABLE
from fmu.views import TERMINALS, VIEWS, View, members

MODEL = "sidestep_aircraft"
"""Model identifier: the name of the library in the FMU."""
SOURCES = (
    "advance.c", "airframe.c", "atmosphere.c", "autopilot.c", "battery.c", "component.c", "exchange.c",
    "fmi2.c", "fmi2_exchange.c", "fmi3.c", "fmi3_exchange.c", "fmi3_unused.c", "ground.c", "guidance.c",
    "kinematic.c", "outputs.c", "powertrain.c", "saving.c", "sensitivity.c", "start.c", "sun.c",
    "trim.c", "turbulence.c", "values.c",
)  # fmt: skip
"""Translation units of the model, beside the generated `variables.c`. One library serves both versions."""
HEADERS = ("angles.h", "component.h", "fmi2.h", "fmi3.h", "model.h")
"""Headers beside the generated `variables.h`."""
GENERATED = "variables.c"
"""Translation unit that is made from the table."""
STEP = 0.01
"""Step that suits the model: the period of the guidance [s]. Euler at 0.1 s diverges."""
DESCRIPTION = "Fixed-wing UAV with guidance: six degrees of freedom, or kinematic"
CATEGORIES = {
    "logStatusError": "Refused calls and failures",
    "logEvents": "Launch, contact with the ground, battery",
}
"""Log categories."""
_HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'


def starts() -> dict[str, float]:
    """Start value of every parameter and input; the aircraft is the packaged default."""
    values = load_aircraft()
    values.update({row.name: row.start for row in TABLE if row.start is not None})
    return values


def model_description(token: str) -> str:
    """`modelDescription.xml` of the FMI 3.0 FMU.

    Parameters
    ----------
    token : str
        Instantiation token, the same as in the library.
    """
    root = description_root("3.0", instantiationToken=token)
    can = dict.fromkeys(
        ("canGetAndSetFMUState", "canSerializeFMUState", "providesDirectionalDerivatives"), "true"
    )
    ET.SubElement(root, "ModelExchange", {"modelIdentifier": MODEL, **can})
    steps = ("canHandleVariableCommunicationStepSize", "hasEventMode", "mightReturnEarlyFromDoStep")
    ET.SubElement(root, "CoSimulation", {"modelIdentifier": MODEL, **can, **dict.fromkeys(steps, "true")})
    add_preliminaries(root)
    table, values = ET.SubElement(root, "ModelVariables"), starts()
    for reference, row in enumerate(TABLE):
        _variable(table, reference, row, values)
    for reference, view in enumerate(VIEWS, start=len(TABLE)):
        _array(table, reference, view, values)
    _structure(ET.SubElement(root, "ModelStructure"))
    return xml_text(root)


def description_root(version: str, **more: str) -> ET.Element:
    """The root of a `modelDescription.xml`: who made what; further attributes as given."""
    facts = {
        "fmiVersion": version,
        "modelName": "SidestepAircraft",
        "description": DESCRIPTION,
        "generationTool": "Sidestep fmu.build",
        "license": "BSD-3-Clause",
        "variableNamingConvention": "structured",
    }
    return ET.Element("fmiModelDescription", facts | more)


def add_preliminaries(root: ET.Element) -> None:
    """What both versions have before the variables: units, log categories, the default experiment."""
    add_units(ET.SubElement(root, "UnitDefinitions"))
    categories = ET.SubElement(root, "LogCategories")
    for name, text in CATEGORIES.items():
        ET.SubElement(categories, "Category", name=name, description=text)
    ET.SubElement(root, "DefaultExperiment", startTime="0", stopTime="60", stepSize=f"{STEP:g}")


def build_description() -> str:
    """`sources/buildDescription.xml`: how an importer compiles the FMU for another platform."""
    root = ET.Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = ET.SubElement(root, "BuildConfiguration", modelIdentifier=MODEL)
    files = ET.SubElement(
        configuration,
        "SourceFileSet",
        language="C99",
        compilerOptions="-ffp-contract=off -fno-math-errno -fno-tree-vectorize",
    )
    for name in (*SOURCES, GENERATED):
        ET.SubElement(files, "SourceFile", name=name)
    return xml_text(root)


def terminals() -> str:
    """`terminalsAndIcons/terminalsAndIcons.xml`: what belongs together (FMI 3.0 only)."""
    root = ET.Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    parent = ET.SubElement(root, "Terminals")
    for name, (text, _) in TERMINALS.items():
        terminal = ET.SubElement(parent, "Terminal", name=name, matchingRule="bus", description=text)
        for row in members(name):
            facts = {"variableName": row.name, "memberName": row.name, "variableKind": "signal"}
            ET.SubElement(terminal, "TerminalMemberVariable", facts)
    return xml_text(root)


def c_header(token: str) -> str:
    """`variables.h`: the struct that holds all values, and how the tables in `variables.c` look."""
    fields = "".join(f"    double {row.field};  /* {row.unit}: {row.description} */\n" for row in TABLE)
    return f"""/* Generated from fmu/variables.py; do not edit. */
#ifndef SIDESTEP_VARIABLES_H
#define SIDESTEP_VARIABLES_H

#include <stddef.h>
#include <stdint.h>

#define MODEL_TOKEN "{token}"
#define N_VARIABLES {len(TABLE)}
#define N_VIEWS {len(VIEWS)}

typedef struct {{
{fields}}} Variables;

typedef enum {{ INDEPENDENT, PARAMETER, INPUT, OUTPUT }} Causality;
typedef enum {{ FLOAT64, INT32, BOOLEAN }} Kind;
typedef struct {{
    size_t offset;
    Causality causality;
    Kind kind;
    double start, minimum, maximum, nominal;
    const char *name;
}} VariableFact;

/* An array over scalars that follow one another; its value reference is N_VARIABLES plus its row. */
typedef struct {{
    uint32_t first, size;
    const char *name;
}} ViewFact;

#if defined(__GNUC__)
#pragma GCC visibility push(hidden)
#endif
extern const VariableFact FACTS[N_VARIABLES];
extern const ViewFact VIEWS[N_VIEWS];
extern const uint32_t STATE_REFERENCES[{len(STATES)}];
#if defined(__GNUC__)
#pragma GCC visibility pop
#endif

#endif
"""


def c_tables() -> str:
    """`variables.c`: one row of facts about each variable, the arrays, the continuous states."""
    values = starts()
    rows = "".join(_c_row(row, values) for row in TABLE)
    views = "".join(f'    {{{REFERENCE[v.first]}, {v.size}, "{v.name}"}},\n' for v in VIEWS)
    states = ", ".join(str(REFERENCE[name]) for name, _ in STATES)
    return f"""/* Generated from fmu/variables.py; do not edit. */
#include "variables.h"

const VariableFact FACTS[N_VARIABLES] = {{
{rows}}};

const ViewFact VIEWS[N_VIEWS] = {{
{views}}};

const uint32_t STATE_REFERENCES[{len(STATES)}] = {{{states}}};
"""


def _c_row(row: Variable, values: Mapping[str, float]) -> str:
    low, high = (repr(float(bound)) for bound in row.bounds)
    start = repr(float(values.get(row.name, 0.0)))
    facts = f"{row.causality.upper()}, {row.kind.upper()}, {start}, {low}, {high}, {row.nominal!r}"
    return f'    {{offsetof(Variables, {row.field}), {facts}, "{row.name}"}},\n'


def xml_text(root: ET.Element) -> str:
    """An element as a file."""
    ET.indent(root)
    return _HEAD + ET.tostring(root, encoding="unicode") + "\n"


def add_units(parent: ET.Element) -> None:
    """Unit definitions, which both versions of FMI spell alike."""
    for unit in UNITS.values():
        element = ET.SubElement(parent, "Unit", name=unit.name)
        ET.SubElement(element, "BaseUnit", {name: str(power) for name, power in unit.base})
        if unit.display:
            display = ET.SubElement(element, "DisplayUnit", name=unit.display, factor=repr(unit.factor))
            if unit.offset:
                display.set("offset", repr(unit.offset))


def real_facts(row: Variable) -> dict[str, str]:
    """Unit, bounds and nominal value, as attributes; numbers alone where the type is no real."""
    facts: dict[str, str] = {}
    if row.kind == "Boolean":
        return facts
    if row.kind == "Float64":
        facts["unit"] = row.unit
        if display := UNITS[row.unit].display:
            facts["displayUnit"] = display
        facts["nominal"] = repr(row.nominal)
    facts["min"], facts["max"] = (as_text(row, bound) for bound in row.bounds)
    return facts


def as_text(row: Variable, value: float) -> str:
    """A value of a variable as XML spells it."""
    if row.kind == "Float64":
        return repr(float(value))
    if row.kind == "Int32":
        return str(int(value))
    return "true" if value else "false"


def _variable(parent: ET.Element, reference: int, row: Variable, values: Mapping[str, float]) -> None:
    facts = {
        "name": row.name,
        "valueReference": str(reference),
        "causality": row.causality,
        "variability": row.variability,
        "description": row.description,
        **real_facts(row),
    }
    if row.causality in ("parameter", "input"):
        facts["start"] = as_text(row, values[row.name])
    for state, derivative in STATES:
        if row.name == derivative:
            facts["derivative"] = str(REFERENCE[state])
    ET.SubElement(parent, row.kind, facts)


def _array(parent: ET.Element, reference: int, view: View, values: Mapping[str, float]) -> None:
    row = view.rows[0]
    facts = {
        "name": view.name,
        "valueReference": str(reference),
        "causality": row.causality,
        "variability": row.variability,
        "description": view.description,
    }
    if all(each.unit == row.unit for each in view.rows):
        facts["unit"] = row.unit
        if display := UNITS[row.unit].display:
            facts["displayUnit"] = display
        facts["nominal"] = repr(row.nominal)
    facts["min"] = repr(float(min(each.bounds[0] for each in view.rows)))
    facts["max"] = repr(float(max(each.bounds[1] for each in view.rows)))
    if row.causality == "input":
        facts["start"] = " ".join(repr(float(values[each.name])) for each in view.rows)
    element = ET.SubElement(parent, "Float64", facts)
    ET.SubElement(element, "Dimension", start=str(view.size))


def _structure(parent: ET.Element) -> None:
    outputs = [str(reference) for reference, row in enumerate(TABLE) if row.causality == "output"]
    arrays = [
        str(reference)
        for reference, view in enumerate(VIEWS, start=len(TABLE))
        if view.rows[0].causality == "output"
    ]
    for reference in outputs + arrays:
        ET.SubElement(parent, "Output", valueReference=reference)
    for _, derivative in STATES:
        ET.SubElement(parent, "ContinuousStateDerivative", valueReference=str(REFERENCE[derivative]))
    for reference in outputs + arrays:
        ET.SubElement(parent, "InitialUnknown", valueReference=reference)
    for name in INDICATORS:
        ET.SubElement(parent, "EventIndicator", valueReference=str(REFERENCE[name]))
