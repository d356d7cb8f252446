"""The page: every table and figure asked for, in one HTML file that needs no network."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape

from scenarios import __version__
from scenarios.compare_page import document, plot_html
from scenarios.paper.errata import errata
from scenarios.paper.section import Cell, Grid, Head, Section
from scenarios.paper.words import words
from scenarios.paper.worlds import Options

CODE = re.compile(r"`([^`]+)`")
ERRATUM = re.compile(r"\bE(\d\d)\b")


def page(sections: Sequence[Section], options: Options) -> str:
    """The whole page as text."""
    opening = words("page", preset=options.preset, runs=options.runs, fidelity=options.fidelity)
    links = "".join(f'<a href="#{s.name}">{escape(s.title.split(":")[0])}</a>' for s in sections)
    body = [
        f"<h1>{escape(opening.title)}</h1>",
        f"<p>{_prose(opening.intro)}</p>",
        f'<nav>{links}<a href="#errata">Errata</a></nav>',
        *(_section(section) for section in sections),
        _errata(),
        f'<p class="soft">Made by Sidestep {escape(__version__)}.</p>',
    ]
    plots = {plot.name: plot.figure for section in sections for plot in section.plots}
    return document(opening.title, "\n".join(body), plots)


def _section(section: Section) -> str:
    parts = [f'<h2 id="{section.name}">{escape(section.title)}</h2>', f"<p>{_prose(section.intro)}</p>"]
    parts += [_grid(grid) for grid in section.grids]
    if section.plots:
        wide = " wide" if section.wide else " three" if len(section.plots) == 3 else ""
        inner = "".join(plot_html(plot.name, plot.caption) for plot in section.plots)
        parts.append(f'<div class="plots{wide}">{inner}</div>')
    if section.remarks:
        items = "".join(f"<li>{_prose(remark)}</li>" for remark in section.remarks)
        parts.append(f'<ul class="remarks">{items}</ul>')
    return "\n".join(parts)


def _grid(grid: Grid) -> str:
    title = f"<h3>{escape(grid.title)}</h3>" if grid.title else ""
    top = "".join(_head(head) for head in grid.heads)
    body = "".join(
        f"<tr>{''.join(_cell(cell, head) for cell, head in zip(line, grid.heads, strict=True))}</tr>"
        for line in grid.lines
    )
    return (
        f'{title}<div class="scroll"><table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table></div>'
    )


def _head(head: Head) -> str:
    note = f"<small>{escape(head.note)}</small>" if head.note else ""
    look = ' class="l"' if head.left else ""
    return f"<th{look}>{escape(head.title)}{note}</th>"


def _cell(cell: str | Cell, head: Head) -> str:
    text, look = (cell, "") if isinstance(cell, str) else (cell.text, cell.look)
    names = [name for name, on in (("ours", head.ours), ("l", head.left), (look, bool(look))) if on]
    if head.left and len(text) > 40:
        names.append("w")
    look = f' class="{" ".join(names)}"' if names else ""
    return f"<td{look}>{escape(text)}</td>"


def _errata() -> str:
    rows = "".join(
        f'<tr id="{e.id}"><td class="l">{e.id}</td><td class="l">{escape(e.where)}</td>'
        f'<td class="w">{_prose(e.finding)}</td><td class="w">{_prose(e.ours)}</td></tr>'
        for e in errata()
    )
    return (
        '<h2 id="errata">Errata</h2><p>What is wrong in the paper, contradicts itself or cannot be, and what '
        "Sidestep does about it. Those that can be computed are tests of this project.</p>"
        '<div class="scroll"><table><thead><tr><th class="l"></th><th class="l">where</th>'
        '<th class="l">finding</th><th class="l">what we do</th></tr></thead>'
        f"<tbody>{rows}</tbody></table></div>"
    )


def _prose(text: str) -> str:
    """Text with `code` set as such, and errata linked."""
    marked = CODE.sub(r"<code>\1</code>", escape(text, quote=False))
    return ERRATUM.sub(r'<a href="#E\1">E\1</a>', marked)
