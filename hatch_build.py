"""Build hook: the aircraft's FMU is compiled when the package is installed."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class FmuBuildHook(BuildHookInterface[Any]):
    """Compiles and packs the FMU for wheels; an editable install gets it in the source tree.

    The machine's own C compiler is used; only where there is none, ziglang is asked for (it is large).
    """

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        """What the build needs beyond hatchling."""
        return [] if self.target_name != "wheel" or self._build.find_compiler() else ["ziglang>=0.13"]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the FMU and tag the wheel for this platform, since it carries a native library."""
        if self.target_name != "wheel":
            return
        if version == "editable":
            fmu = self._build.build_fmu()
        else:
            self._folder = tempfile.TemporaryDirectory(prefix="sidestep-build-")
            fmu = self._build.build_fmu(Path(self._folder.name) / self._build.PACKAGED.name)
            build_data["force_include"][str(fmu)] = f"fmu/{fmu.name}"
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{_platform_tag()}"
        self.app.display_info(f"built {fmu}")

    def finalize(self, *_arguments: object) -> None:
        """Remove what was built beside the source tree."""
        if (folder := getattr(self, "_folder", None)) is not None:
            folder.cleanup()

    @property
    def _build(self) -> Any:  # noqa: ANN401  (a module)
        """`fmu.build` of the source tree, wherever the build front end runs from."""
        if self.root not in sys.path:
            sys.path.insert(0, self.root)
        import fmu.build  # noqa: PLC0415  (importable only with the root on the path)

        return fmu.build


def _platform_tag() -> str:
    """Most specific platform tag of this interpreter, as wheels spell it."""
    from packaging.tags import platform_tags  # noqa: PLC0415  (comes with hatchling, not with the package)

    tags = list(platform_tags())
    return next((tag for tag in tags if tag.startswith("linux_")), tags[0])
