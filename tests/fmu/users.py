"""An FMU that pythonfmu makes, with its mapping: what a user brings along."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest


def make_users_fmu(folder: Path) -> Path:
    """Pack the user's aircraft into an FMU; the path of its mapping."""
    builder = pytest.importorskip("pythonfmu.builder", reason="pythonfmu is not installed (extra dev)")
    here = Path(__file__).parent
    builder.FmuBuilder.build_FMU(here / "user_aircraft.py", dest=folder)
    return Path(shutil.copy(here / "user_aircraft.toml", folder / "mapping.toml"))
