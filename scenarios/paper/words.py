"""The prose of the page and the terminal (`words.toml`), filled in with figures."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any


@dataclass(frozen=True, slots=True)
class Words:
    """What is said about one table or figure."""

    title: str
    intro: str
    remarks: tuple[str, ...]


def words(name: str, **values: object) -> Words:
    """The words for a table or figure, `{…}` filled in with the values.

    Raises
    ------
    KeyError
        If a value is missing.
    """
    entry = _all()[name]
    return Words(
        entry["title"],
        entry["intro"].format(**values),
        tuple(remark.format(**values) for remark in entry.get("remarks", ())),
    )


@cache
def _all() -> dict[str, Any]:
    return tomllib.loads((files("scenarios.paper") / "words.toml").read_text(encoding="utf-8"))
