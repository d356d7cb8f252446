"""The core by itself: what an import of it brings along."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
ASK = """
import pkgutil, sys
import avoidance
for module in pkgutil.walk_packages(avoidance.__path__, "avoidance."):
    __import__(module.name)
names = {name.partition(".")[0] for name, module in sys.modules.items() if getattr(module, "__file__", None)}
print(*sorted(names - set(sys.stdlib_module_names)))
"""


def test_the_core_needs_numpy_and_nothing_else() -> None:
    """Neither scipy nor anything of the other rooms, in any of its modules."""
    told = subprocess.run(
        [sys.executable, "-I", "-S", "-c", f"import sys; sys.path[:0] = {[str(ROOT), *_numpy()]!r}\n{ASK}"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert told.stdout.split() == ["avoidance", "numpy"]


def _numpy() -> list[str]:
    """Where numpy is installed; site's own start-up files would import what is none of the core's."""
    import numpy as np  # noqa: PLC0415

    return [str(Path(np.__file__).parents[1])]
