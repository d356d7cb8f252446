"""The table of variables as `modelDescription.xml` of FMI 2.0, for the same library.

Arrays, terminals, early return and `buildDescription.xml` are FMI 3.0's only.
"""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree import ElementTree as ET

from fmu.emit import (
    GENERATED,
    MODEL,
    SOURCES,
    add_preliminaries,
    as_text,
    description_root,
    real_facts,
    starts,
    xml_text,
)
from fmu.rows import Variable
from fmu.variables import INDICATORS, REFERENCE, STATES, TABLE

_KINDS = {"Float64": "Real", "Int32": "Integer", "Boolean": "Boolean"}


def model_description_fmi2(token: str) -> str:
    """`modelDescription.xml` of the FMI 2.0 FMU.

    Parameters
    ----------
    token : str
        The guid, the same as in the library.
    """
    root = description_root("2.0", guid=token, numberOfEventIndicators=str(len(INDICATORS)))
    can = ("canGetAndSetFMUstate", "canSerializeFMUstate", "providesDirectionalDerivative")
    for interface, more in (
        ("ModelExchange", ("completedIntegratorStepNotNeeded",)),
        ("CoSimulation", ("canHandleVariableCommunicationStepSize",)),
    ):
        facts = {"modelIdentifier": MODEL, **dict.fromkeys((*can, *more), "true")}
        files = ET.SubElement(ET.SubElement(root, interface, facts), "SourceFiles")
        for name in (*SOURCES, GENERATED):
            ET.SubElement(files, "File", name=name)
    add_preliminaries(root)
    table, values = ET.SubElement(root, "ModelVariables"), starts()
    for reference, row in enumerate(TABLE):
        _variable(table, reference, row, values)
    _structure(ET.SubElement(root, "ModelStructure"))
    return xml_text(root)


def _variable(parent: ET.Element, reference: int, row: Variable, values: Mapping[str, float]) -> None:
    element = ET.SubElement(
        parent,
        "ScalarVariable",
        name=row.name,
        valueReference=str(reference),
        causality=row.causality,
        variability=row.variability,
        description=row.description,
    )
    facts = real_facts(row)
    if row.causality in ("parameter", "input"):
        facts["start"] = as_text(row, values[row.name])
    for state, derivative in STATES:
        if row.name == derivative:
            facts["derivative"] = str(REFERENCE[state] + 1)
    ET.SubElement(element, _KINDS[row.kind], facts)


def _structure(parent: ET.Element) -> None:
    outputs = [index for index, row in enumerate(TABLE, start=1) if row.causality == "output"]
    sections = {
        "Outputs": outputs,
        "Derivatives": [REFERENCE[derivative] + 1 for _, derivative in STATES],
        "InitialUnknowns": outputs,
    }
    for name, indices in sections.items():
        section = ET.SubElement(parent, name)
        for index in indices:
            ET.SubElement(section, "Unknown", index=str(index))
