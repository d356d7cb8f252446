"""Compile the model and pack it, for FMI 3.0 and FMI 2.0: `python -m fmu.build [--all] [-o FILE]`.

Only the standard library is used, so that this runs in an isolated build environment.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib.util
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from fmu.emit import (
    GENERATED,
    HEADERS,
    MODEL,
    SOURCES,
    build_description,
    c_header,
    c_tables,
    model_description,
    terminals,
)
from fmu.emit_fmi2 import model_description_fmi2
from fmu.errors import BuildError

FOLDER = Path(__file__).parent
PACKAGED = FOLDER / f"{MODEL}.fmu"
"""Where the FMI 3.0 FMU lies once it has been built."""
PACKAGED_FMI2 = FOLDER / f"{MODEL}_fmi2.fmu"
"""Where the FMI 2.0 FMU lies once it has been built; the same library, described as FMI 2.0 asks."""
FLAGS = (
    "-std=c99",
    "-O3",
    "-fno-tree-vectorize",
    "-g0",
    "-s",
    "-ffp-contract=off",
    "-fno-math-errno",
    "-shared",
)
"""No contraction to fused multiply-add: the same bits from every compiler. No vectorising: pairs loaded
across what the last stage stored one by one wait for the store."""
_EPOCH = (1980, 1, 1, 0, 0, 0)
_ARCHITECTURES = {"amd64": "x86_64", "x86_64": "x86_64", "arm64": "aarch64", "aarch64": "aarch64"}
_SYSTEMS = {"Linux": ("linux", ".so"), "Darwin": ("darwin", ".dylib"), "Windows": ("windows", ".dll")}
_SUFFIXES = {"linux": ".so", "darwin": ".dylib", "windows": ".dll"}
TARGETS = {
    "x86_64-linux": "x86_64-linux-gnu.2.17",
    "aarch64-linux": "aarch64-linux-gnu.2.17",
    "x86_64-windows": "x86_64-windows-gnu",
    "x86_64-darwin": "x86_64-macos.10.15",
    "aarch64-darwin": "aarch64-macos.11.0",
}
"""Platforms that `--all` builds for: FMI 3.0 platform tuple, and what zig calls it."""
FMI2_PLATFORMS = {
    "x86_64-linux": "linux64",
    "aarch64-linux": "aarch64-linux",
    "x86_64-windows": "win64",
    "x86_64-darwin": "darwin64",
    "aarch64-darwin": "aarch64-darwin",
}
"""Folders of FMI 2.0, which names no ARM: there the tuples of FMI 3.0 are used, as fmpy does on macOS.

fmpy 0.3.32 looks on ARM Linux in linux64 and finds the wrong library: prefer the FMI 3.0 file there.
"""


def find_compiler() -> list[str] | None:
    """Command of the machine's C compiler (cc, gcc or clang); None if there is none."""
    for name in ("cc", "gcc", "clang"):
        if path := shutil.which(name):
            return [path]
    return None


def compiler() -> list[str]:
    """Command that compiles C: the machine's own compiler, else the one in the ziglang package.

    Raises
    ------
    BuildError
        If there is neither.
    """
    if command := find_compiler():
        return command
    if importlib.util.find_spec("ziglang") is not None:
        return [sys.executable, "-m", "ziglang", "cc"]
    raise BuildError("no C compiler: install gcc or clang, or `pip install ziglang`")


def platform_tuple() -> tuple[str, str]:
    """FMI 3.0 platform tuple of this machine ("x86_64-linux") and the suffix of its libraries.

    Raises
    ------
    BuildError
        If the standard has no tuple for it.
    """
    architecture = _ARCHITECTURES.get(platform.machine().lower())
    system = _SYSTEMS.get(platform.system())
    if architecture is None or system is None:
        raise BuildError(f"no FMI platform tuple for {platform.machine()} {platform.system()}")
    return f"{architecture}-{system[0]}", system[1]


def sources() -> dict[str, str]:
    """Text of every file of the FMUs that is not a binary, by the name it has here.

    The instantiation token is a digest of all of them, so library and descriptions always fit.
    """
    files = {name: (FOLDER / "src" / name).read_text(encoding="utf-8") for name in (*SOURCES, *HEADERS)}
    files[GENERATED] = c_tables()
    files["buildDescription.xml"] = build_description()
    files["terminalsAndIcons.xml"] = terminals()
    templates = (c_header(""), model_description(""), model_description_fmi2(""))
    digest = hashlib.sha256()
    for name, text in [*sorted(files.items()), *(("", text) for text in templates)]:
        digest.update(name.encode() + b"\0" + text.encode() + b"\0")
    token = digest.hexdigest()[:32]
    files["variables.h"] = c_header(token)
    files["modelDescription.xml"] = model_description(token)
    files["modelDescription2.xml"] = model_description_fmi2(token)
    return files


def compile_library(folder: Path, command: Sequence[str], suffix: str) -> Path:
    """Compile the sources in a folder to a shared library beside them.

    Raises
    ------
    BuildError
        With the compiler's own words.
    """
    library = folder / f"{MODEL}{suffix}"
    position = () if suffix == ".dll" else ("-fPIC",)
    inputs = [str(folder / name) for name in (*SOURCES, GENERATED)]
    call = [*command, *FLAGS, *position, *inputs, "-o", str(library), "-lm"]
    try:
        done = subprocess.run(call, capture_output=True, text=True, check=False)
    except OSError as error:
        raise BuildError(f"{command[0]}: {error}") from error
    if done.returncode != 0 or not library.is_file():
        raise BuildError(f"{' '.join(command)} failed with {done.returncode}:\n{done.stderr.strip()}")
    return library


def zig(target: str) -> list[str]:
    """Command that compiles for a platform of `TARGETS`.

    Raises
    ------
    BuildError
        If the ziglang package is missing.
    """
    if importlib.util.find_spec("ziglang") is None:
        raise BuildError("building for all platforms needs zig: `pip install ziglang`")
    return [sys.executable, "-m", "ziglang", "cc", "-target", TARGETS[target]]


def compile_libraries(
    files: Mapping[str, str], command: Sequence[str] | None, all_platforms: bool
) -> dict[str, bytes]:
    """Shared library by FMI 3.0 platform tuple: of this machine, or of every one in `TARGETS`."""
    if all_platforms:
        commands = {name: (zig(name), _SUFFIXES[name.partition("-")[2]]) for name in TARGETS}
    else:
        name, suffix = platform_tuple()
        commands = {name: (list(command) if command is not None else compiler(), suffix)}
    libraries = {}
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        for file, text in files.items():
            (folder / file).write_text(text, encoding="utf-8", newline="\n")
        for name, (call, suffix) in commands.items():
            libraries[name] = compile_library(folder, call, suffix).read_bytes()
    return libraries


def build_fmus(
    target: Path = PACKAGED, command: Sequence[str] | None = None, *, all_platforms: bool = False
) -> tuple[Path, Path]:
    """Build both FMUs; each file appears whole or not at all.

    Parameters
    ----------
    target : Path
        FMI 3.0 file to write; the FMI 2.0 file gets its name with `_fmi2` added.
    command : sequence of str, optional
        C compiler; found if not given.
    all_platforms : bool
        Cross-compile with zig for every platform of `TARGETS` instead of this one.

    Raises
    ------
    BuildError
        If they cannot be built.
    """
    files = sources()
    libraries = compile_libraries(files, command, all_platforms)
    second = target.with_name(f"{target.stem}_fmi2{target.suffix}")
    _write_zip(target, _content_fmi3(files, libraries))
    _write_zip(second, _content_fmi2(files, libraries))
    return target, second


def build_fmu(
    target: Path = PACKAGED, command: Sequence[str] | None = None, *, all_platforms: bool = False
) -> Path:
    """Build both FMUs (see `build_fmus`); the path of the FMI 3.0 file."""
    return build_fmus(target, command, all_platforms=all_platforms)[0]


def carries_all(path: Path = PACKAGED) -> bool:
    """Whether a file holds a library for every platform of `TARGETS`, made from the present sources."""
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
            current = archive.read("modelDescription.xml") == sources()["modelDescription.xml"].encode()
    except (OSError, KeyError, zipfile.BadZipFile):
        return False
    return current and all(
        any(name.startswith(f"binaries/{tuple_}/") for name in names) for tuple_ in TARGETS
    )


def _content_fmi3(files: Mapping[str, str], libraries: Mapping[str, bytes]) -> dict[str, bytes]:
    content = {"modelDescription.xml": files["modelDescription.xml"].encode()}
    for name, library in libraries.items():
        content[f"binaries/{name}/{MODEL}{_SUFFIXES[name.partition('-')[2]]}"] = library
    content["terminalsAndIcons/terminalsAndIcons.xml"] = files["terminalsAndIcons.xml"].encode()
    return content | _common(files, ("buildDescription.xml",))


def _content_fmi2(files: Mapping[str, str], libraries: Mapping[str, bytes]) -> dict[str, bytes]:
    content = {"modelDescription.xml": files["modelDescription2.xml"].encode()}
    for name, library in libraries.items():
        content[f"binaries/{FMI2_PLATFORMS[name]}/{MODEL}{_SUFFIXES[name.partition('-')[2]]}"] = library
    return content | _common(files, ())


def _common(files: Mapping[str, str], more: Sequence[str]) -> dict[str, bytes]:
    names = sorted((*SOURCES, *HEADERS, GENERATED, "variables.h", *more))
    content = {f"sources/{name}": files[name].encode() for name in names}
    licence = FOLDER.parent / "LICENSE"
    if licence.is_file():
        content["documentation/licenses/license.txt"] = licence.read_bytes()
    return content


def _write_zip(target: Path, content: Mapping[str, bytes]) -> None:
    """Write a zip beside the target and move it into place; the same content gives the same bytes."""
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    try:
        with os.fdopen(handle, "wb") as stream, zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
            for path, data in content.items():
                entry = zipfile.ZipInfo(path, _EPOCH)
                entry.compress_type = zipfile.ZIP_DEFLATED
                entry.external_attr = 0o644 << 16
                archive.writestr(entry, data)
        Path(name).chmod(0o644)
        Path(name).replace(target)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def main(arguments: Sequence[str] | None = None) -> int:
    """Command line: 0 built, 3 not."""
    parser = argparse.ArgumentParser(prog="python -m fmu.build", description="Build the aircraft's FMUs.")
    parser.add_argument("-o", "--output", type=Path, default=PACKAGED, help="FMI 3.0 file (%(default)s)")
    parser.add_argument("--all", action="store_true", help="for every platform, with zig, not this one only")
    options = parser.parse_args(arguments)
    try:
        paths = build_fmus(options.output, all_platforms=options.all)
    except (BuildError, OSError) as error:
        print(f"fmu.build: {error}", file=sys.stderr)
        return 3
    print(*paths, sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
