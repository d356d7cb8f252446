"""What the terminal shows of a table or figure."""

from __future__ import annotations

import textwrap

from rich.console import Console
from rich.table import Table

from scenarios.paper.section import Cell, Grid, Section

WIDEST = 190
"""Columns of a table that goes to a file or a pipe."""
PROSE = 110
"""Columns of prose."""
STYLES = {
    "good": "green",
    "bad": "bold red",
    "dom-better": "black on white",
    "dom-equal": "black on grey70",
    "dom-worse": "white on grey11",
    "dom-self": "dim",
}


def show(section: Section) -> None:
    """Print a section: its tables, then what is to be said about them."""
    console = Console()
    if not console.is_terminal:
        console.width = max(console.width, WIDEST)
    console.print(section.title, style="bold", highlight=False)
    _prose(console, section.intro, "")
    for grid in section.grids:
        console.print()
        console.print(_table(grid), highlight=False)
    if section.remarks:
        console.print()
    for remark in section.remarks:
        _prose(console, remark, "- ")
    console.print()


def _table(grid: Grid) -> Table:
    table = Table(
        box=None, pad_edge=False, title=grid.title or None, title_justify="left", title_style="bold"
    )
    for head in grid.heads:
        title = f"{head.title}\n[dim]{head.note}[/]" if head.note else head.title
        table.add_column(
            title,
            justify="left" if head.left else "right",
            header_style="bold cyan" if head.ours else "bold",
            overflow="fold",
        )
    for line in grid.lines:
        table.add_row(*(_cell(cell) for cell in line))
    return table


def _cell(cell: str | Cell) -> str:
    if isinstance(cell, str):
        return cell.replace("[", r"\[")
    text = cell.text.replace("[", r"\[")
    style = STYLES.get(cell.look)
    return f"[{style}]{text}[/]" if style and text else text


def _prose(console: Console, text: str, lead: str) -> None:
    width = min(PROSE, console.width)
    wrapped = textwrap.fill(
        text.replace("`", ""), width, initial_indent=lead, subsequent_indent=" " * len(lead)
    )
    console.print(wrapped, highlight=False, markup=False, soft_wrap=True)
