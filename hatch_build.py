"""Build hook: the aircraft's FMU is compiled when the package is installed."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class FmuBuildHook(BuildHookInterface[Any]):
    """Compiles and packs the FMUs for wheels; an editable install gets them in the source tree.

    The machine's own C compiler is used; only where there is none, ziglang is asked for (it is large). The
    wheel is tagged for this platform then. Where `python -m fmu.build --all` has left files with the
    libraries of all platforms in the source tree, the wheel takes those and is tagged `py3-none-any`.
    """

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        """What the build needs beyond hatchling."""
        return [] if self.target_name != "wheel" or self._build.find_compiler() else ["ziglang>=0.13"]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the FMUs, or take those of all platforms, and tag the wheel for what they run on."""
        if self.target_name != "wheel":
            return
        build = self._build
        everywhere = version != "editable" and build.carries_all()
        if everywhere:
            files = (build.PACKAGED, build.PACKAGED_FMI2)
        elif version == "editable":
            files = build.build_fmus()
        else:
            self._folder = tempfile.TemporaryDirectory(prefix="sidestep-build-")
            files = build.build_fmus(Path(self._folder.name) / build.PACKAGED.name)
        if version != "editable":
            build_data["force_include"].update({str(file): f"fmu/{file.name}" for file in files})
        build_data["pure_python"] = everywhere
        build_data["tag"] = "py3-none-any" if everywhere else f"py3-none-{_platform_tag()}"
        self.app.display_info(f"built {files[0]} and {files[1].name}")

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
