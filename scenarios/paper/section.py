"""What a table or figure of the paper becomes: text, tables and plots, for terminal, page and JSON alike."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from scenarios.report_figures import Figure


@dataclass(frozen=True, slots=True)
class Head:
    """Heading of a column."""

    title: str
    note: str = ""
    """What it means, small."""
    ours: bool = False
    """True for our figures, which are tinted beside the paper's."""
    left: bool = False
    """True for words."""


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell with a look of its own."""

    text: str
    look: str = ""
    """"good", "bad", or of Table 5 "dom-better", "dom-equal", "dom-worse", "dom-self"."""


@dataclass(frozen=True, slots=True)
class Grid:
    """A table."""

    heads: tuple[Head, ...]
    lines: tuple[tuple[str | Cell, ...], ...]
    title: str = ""


@dataclass(frozen=True, slots=True)
class Plot:
    """A figure."""

    name: str
    """Of its element on the page."""
    caption: str
    figure: Figure


@dataclass(frozen=True, slots=True)
class Section:
    """One table or figure of the paper."""

    name: str
    """As the command names it."""
    title: str
    intro: str
    grids: tuple[Grid, ...] = ()
    plots: tuple[Plot, ...] = ()
    remarks: tuple[str, ...] = ()
    """Honest remarks, with the numbers of errata."""
    data: Any = field(default_factory=list)
    """What `--json` prints."""
    wide: bool = False
    """True to give each plot the whole width."""


def number(value: float | None, form: str = ",.0f", unit: str = "") -> str:
    """A figure for a cell; a dash where there is none."""
    return "–" if value is None else f"{value:{form}}{unit}"


def text_of(cell: str | Cell) -> str:
    """A cell's text alone."""
    return cell if isinstance(cell, str) else cell.text
