"""The errata: what is wrong in the paper, and what Sidestep does about it (`errata.toml`)."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files


@dataclass(frozen=True, slots=True)
class Erratum:
    """One finding."""

    id: str
    """E01, E02 …"""
    where: str
    """Section, equation, table or figure."""
    finding: str
    """What is wrong, with the evidence."""
    ours: str
    """What we do."""
    tested: bool
    """True if tests/paper computes it."""


@cache
def errata() -> tuple[Erratum, ...]:
    """All of them, in the order of their numbers."""
    raw = tomllib.loads((files("scenarios.paper") / "errata.toml").read_text(encoding="utf-8"))
    return tuple(
        Erratum(name, entry["where"], entry["finding"], entry["ours"], "test" in entry)
        for name, entry in raw.items()
    )


def errata_markdown() -> str:
    """The table of docs/paper.md."""
    lines = ["| | where | finding | what we do |", "|---|---|---|---|"]
    lines += [f"| {e.id} | {e.where} | {e.finding} | {e.ours} |" for e in errata()]
    return "\n".join(lines) + "\n"
