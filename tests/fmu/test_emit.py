"""Table, description and header agree."""

from __future__ import annotations

import re
from xml.etree import ElementTree as ET

from fmu.emit import build_description, c_header, model_description, starts
from fmu.variables import TABLE, UNITS


def test_every_row_is_described():
    root = ET.fromstring(model_description("token"))
    elements = list(root.find("ModelVariables"))
    assert [e.attrib["name"] for e in elements] == [row.name for row in TABLE]
    assert [int(e.attrib["valueReference"]) for e in elements] == list(range(len(TABLE)))
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
    assert re.findall(r'"([^"]+)"\},$', header, re.M) == [row.name for row in TABLE]
    assert '#define MODEL_TOKEN "token"' in header


def test_the_default_aircraft_is_the_x8():
    assert starts()["aircraft.mass"] == 3.364


def test_the_build_description_names_every_source():
    names = [e.attrib["name"] for e in ET.fromstring(build_description()).iter("SourceFile")]
    assert "airframe.c" in names
    assert len(names) == len(set(names))


def test_units_of_the_table_are_defined():
    assert {row.unit for row in TABLE} <= set(UNITS)
