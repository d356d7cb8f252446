"""Table, description and header agree."""

from __future__ import annotations

import re
from xml.etree import ElementTree as ET

from fmu.emit import build_description, c_header, c_tables, model_description, starts, terminals
from fmu.emit_fmi2 import model_description_fmi2
from fmu.units import UNITS
from fmu.variables import REFERENCE, STATES, TABLE
from fmu.views import TERMINALS, VIEWS


def test_every_row_is_described():
    root = ET.fromstring(model_description("token"))
    elements = list(root.find("ModelVariables"))
    assert [e.attrib["name"] for e in elements] == [row.name for row in (*TABLE, *VIEWS)]
    assert [int(e.attrib["valueReference"]) for e in elements] == list(range(len(elements)))
    elements = elements[: len(TABLE)]
    assert all({"min", "max"} <= set(e.attrib) for e in elements if e.tag != "Boolean")
    assert all("nominal" in e.attrib for e in elements if e.tag == "Float64")
    assert all(e.attrib["description"] for e in elements)
    assert all("unit" in e.attrib for e in elements if e.tag == "Float64")
    angles = [e for e in elements if e.get("unit") == "rad"]
    assert angles
    assert all(e.attrib["displayUnit"] == "deg" for e in angles)
    for element in elements:
        if element.attrib["causality"] in ("parameter", "input"):
            assert "start" in element.attrib
            if element.tag != "Boolean":
                assert float(element.attrib["min"]) <= float(element.attrib["start"])
                assert float(element.attrib["start"]) <= float(element.attrib["max"])


def test_the_header_has_the_same_rows_in_the_same_order():
    header = c_header("token")
    assert re.findall(r"^    double (\w+);", header, re.M) == [row.field for row in TABLE]
    names = re.findall(r'"([^"]+)"\},$', c_tables(), re.M)
    assert names == [row.name for row in (*TABLE, *VIEWS)]
    assert '#define MODEL_TOKEN "token"' in header


def test_the_default_aircraft_is_the_x8():
    assert starts()["aircraft.mass"] == 3.364


def test_the_build_description_names_every_source():
    names = [e.attrib["name"] for e in ET.fromstring(build_description()).iter("SourceFile")]
    assert "airframe.c" in names
    assert len(names) == len(set(names))


def test_units_of_the_table_are_defined():
    assert {row.unit for row in TABLE} <= set(UNITS)


def test_states_and_their_derivatives_are_paired_in_both_versions():
    pairs = {derivative: state for state, derivative in STATES}
    three = ET.fromstring(model_description("token")).find("ModelVariables")
    found = {e.attrib["name"]: e.attrib["derivative"] for e in three if "derivative" in e.attrib}
    assert found == {name: str(REFERENCE[state]) for name, state in pairs.items()}
    two = ET.fromstring(model_description_fmi2("token")).find("ModelVariables")
    found = {e.attrib["name"]: e[0].attrib["derivative"] for e in two if "derivative" in e[0].attrib}
    assert found == {name: str(REFERENCE[state] + 1) for name, state in pairs.items()}


def test_both_versions_describe_the_same_scalars():
    two = ET.fromstring(model_description_fmi2("token")).find("ModelVariables")
    three = ET.fromstring(model_description("token")).find("ModelVariables")
    for old, new in zip(two, three, strict=False):
        assert old.attrib["name"] == new.attrib["name"]
        assert old[0].attrib.get("start") == new.attrib.get("start")
        assert old[0].attrib.get("unit") == new.attrib.get("unit")
    assert len(two) == len(TABLE)


def test_every_array_lies_over_scalars_of_one_causality():
    for view in VIEWS:
        assert len(view.rows) == view.size
        assert len({(row.causality, row.kind) for row in view.rows}) == 1


def test_terminals_name_variables_that_exist():
    root = ET.fromstring(terminals())
    assert [e.attrib["name"] for e in root.iter("Terminal")] == list(TERMINALS)
    members = [e.attrib["variableName"] for e in root.iter("TerminalMemberVariable")]
    assert members
    assert set(members) <= set(REFERENCE)
