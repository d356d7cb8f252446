"""Pydantic's errors in a user's words: where, what value, which range."""

from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence
from typing import Any, get_args

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from scenarios.errors import Problem


def key_text(location: Sequence[int | str]) -> str:
    """A place in a file, entries of lists counted from 1: "obstacles #2, safety_radius_m"."""
    text = ""
    for part in location:
        if isinstance(part, int):
            text += f" #{part + 1}"
        elif not text:
            text = part
        else:
            text += f", {part}" if "#" in text else f".{part}"
    return text


def problem(error: Mapping[str, Any], model: type[BaseModel]) -> Problem:
    """One of pydantic's errors as a `Problem`; `model` is the outermost model."""
    location: tuple[int | str, ...] = error["loc"]
    kind: str = error["type"]
    value = error["input"]
    if kind == "extra_forbidden":
        known = _known_keys(model, location[:-1])
        near = difflib.get_close_matches(str(location[-1]), known, n=1)
        hint = f"; did you mean {near[0]}?" if near else "."
        return Problem(key_text(location), value, f"unknown key{hint} Known here: {', '.join(known)}")
    if kind == "missing":
        return Problem(key_text(location), None, "is missing and has no default")
    if kind in ("too_short", "too_long"):
        bound = error["ctx"].get("min_length", error["ctx"].get("max_length"))
        has = error["ctx"]["actual_length"]
        what = "at least" if kind == "too_short" else "at most"
        return Problem(key_text(location), None, f"has {has} entries and needs {what} {bound}")
    if kind == "position":
        return Problem(key_text(location), None, str(error["msg"]))
    return Problem(key_text(location), value, _allowed(kind, error, _field(model, location)))


def _allowed(kind: str, error: Mapping[str, Any], info: FieldInfo | None) -> str:
    bounds = _range(info)
    if kind == "literal_error":
        return f"must be {error['ctx']['expected']}"
    if kind == "string_pattern_mismatch":
        return f"must be letters, digits, '.', '_' or '-', and match {error['ctx']['pattern']}"
    if kind.startswith(("datetime", "timezone")):
        return "must be a date and time with offset, such as 2020-03-21T02:30:00Z"
    types = {"float": "a number", "int": "a whole number", "string": "text in quotes", "list": "a list"}
    types |= {"model": "a table", "bool": "true or false", "finite": "a finite number"}
    word = next((text for prefix, text in types.items() if kind.startswith(prefix)), None)
    if word is not None:
        return f"must be {word}{f' {bounds}' if bounds else ''}"
    return f"must be {bounds}" if bounds else str(error["msg"])


def _range(info: FieldInfo | None) -> str:
    """The bounds of a field in words, from its `Field` arguments."""
    words = {"gt": "greater than", "ge": "at least", "lt": "less than", "le": "at most"}
    found = {name: getattr(item, name) for item in _metadata(info) for name in words if hasattr(item, name)}
    return " and ".join(f"{words[name]} {found[name]:.12g}" for name in words if name in found)


def _metadata(info: FieldInfo | None) -> list[Any]:
    if info is None:
        return []
    found = list(info.metadata)
    for option in get_args(
        info.annotation
    ):  # "Annotated[float, Field(...)] | None" hides them one level down
        for item in getattr(option, "__metadata__", ()):
            found += item.metadata if isinstance(item, FieldInfo) else [item]
    return found


def _field(model: type[BaseModel], location: Sequence[int | str]) -> FieldInfo | None:
    """The field that a location points at, None if it is none."""
    info = None
    current: type[BaseModel] | None = model
    for part in location:
        if isinstance(part, int):
            continue
        if current is None or part not in current.model_fields:
            return info if current is None else None
        info = current.model_fields[part]
        current = _model_in(info.annotation)
    return info


def _model_in(annotation: object) -> type[BaseModel] | None:
    """The model inside an annotation such as `list[Model]` or `Model | None`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    for option in get_args(annotation):
        found = _model_in(option)
        if found is not None:
            return found
    return None


def _known_keys(model: type[BaseModel], location: Sequence[int | str]) -> list[str]:
    info = _field(model, location) if location else None
    inner = model if not location else _model_in(info.annotation if info else None)
    return list(inner.model_fields) if inner else []
