"""A page of tables and figures: one HTML file that needs no network."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping, Sequence
from html import escape
from importlib.resources import files
from pathlib import Path

from scenarios.compare import COLUMNS, Row, cells
from scenarios.compare_maps import course_map
from scenarios.errors import RunDirectoryError
from scenarios.planners import PLANNERS
from scenarios.report_figures import Figure
from scenarios.scenario import Scenario


def document(title: str, body: str, plots: Mapping[str, Figure]) -> str:
    """The whole page; `plots` are drawn into the elements of their names."""
    from plotly.offline import get_plotlyjs  # noqa: PLC0415 (reads 5 MB; only a page needs it)

    template = (files("scenarios") / "compare_page.html").read_text(encoding="utf-8")
    data = json.dumps(plots, allow_nan=False, separators=(",", ":"))
    data = data.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
    values = {"title": escape(title), "body": body, "plots": data, "plotly": get_plotlyjs()}
    return re.sub(r"\{\{(\w+)\}\}", lambda match: values[match[1]], template)


def write_page(path: Path, text: str) -> Path:
    """Write a page whole, or not at all.

    Raises
    ------
    RunDirectoryError
        If it cannot be written.
    """
    half = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        half.write_text(text, encoding="utf-8", newline="\n")
        half.replace(path)
    except OSError as error:
        raise RunDirectoryError(path, f"cannot be written ({error})") from error
    finally:
        half.unlink(missing_ok=True)
    return path


def table_html(heads: Sequence[tuple[str, str]], lines: Sequence[Sequence[str]]) -> str:
    """A table; each heading has a small explanation."""
    top = "".join(
        f"<th>{escape(name)}{f'<small>{escape(note)}</small>' if note else ''}</th>" for name, note in heads
    )
    body = "".join(f"<tr>{''.join(f'<td>{escape(text)}</td>' for text in line)}</tr>" for line in lines)
    return f'<div class="scroll"><table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table></div>'


def plot_html(name: str, caption: str) -> str:
    """A place for a figure."""
    label = escape(caption, quote=True)
    return (
        f"<figure><figcaption>{escape(caption)}</figcaption>"
        f'<div class="plot" id="{name}" role="img" aria-label="{label}"></div></figure>'
    )


def comparison_page(scenario: Scenario, rows: Sequence[Row]) -> str:
    """`sidestep compare` as a page: the table, and the first run of every planner on one map."""
    runs = len(rows[0].records)
    title = f"Planners compared: {scenario.name}"
    intro = (
        f"{scenario.description or scenario.name}. Each planner flew the same "
        f"{'world' if runs == 1 else f'{runs} worlds'}; everything but the planner is the same."
    )
    maps = {PLANNERS[row.planner]: row.records[0] for row in rows}
    body = (
        f"<h1>{escape(title)}</h1><p>{escape(intro)}</p>"
        f"{table_html(COLUMNS, [cells(row) for row in rows])}"
        f'<h2>The first world</h2><div class="plots wide">{plot_html("map", "All planners on one map")}</div>'
    )
    return document(title, body, {"map": course_map(maps, height=620)})
