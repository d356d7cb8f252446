"""Compile the model and pack it: `python -m fmu.build [-o FILE]`.

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

from fmu.emit import HEADERS, MODEL, SOURCES, build_description, c_header, model_description
from fmu.errors import BuildError

FOLDER = Path(__file__).parent
PACKAGED = FOLDER / f"{MODEL}.fmu"
"""Where the FMU lies once it has been built."""
FLAGS = ("-std=c99", "-O2", "-g0", "-ffp-contract=off", "-fno-math-errno", "-fvisibility=hidden", "-shared")
"""No contraction to fused multiply-add: the same bits from every compiler."""
_EPOCH = (1980, 1, 1, 0, 0, 0)
_ARCHITECTURES = {"amd64": "x86_64", "x86_64": "x86_64", "arm64": "aarch64", "aarch64": "aarch64"}
_SYSTEMS = {"Linux": ("linux", ".so"), "Darwin": ("darwin", ".dylib"), "Windows": ("windows", ".dll")}


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
    """Text of every file that goes to `sources/`, and `modelDescription.xml`, by name.

    The instantiation token is a digest of all of them, so library and description always fit.
    """
    files = {name: (FOLDER / "src" / name).read_text(encoding="utf-8") for name in (*SOURCES, *HEADERS)}
    digest = hashlib.sha256()
    for name, text in [*sorted(files.items()), ("", c_header("")), ("", model_description(""))]:
        digest.update(name.encode() + b"\0" + text.encode() + b"\0")
    token = digest.hexdigest()[:32]
    files["variables.h"] = c_header(token)
    files["buildDescription.xml"] = build_description()
    files["modelDescription.xml"] = model_description(token)
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
    inputs = [str(folder / name) for name in SOURCES]
    call = [*command, *FLAGS, *position, *inputs, "-o", str(library), "-lm"]
    try:
        done = subprocess.run(call, capture_output=True, text=True, check=False)
    except OSError as error:
        raise BuildError(f"{command[0]}: {error}") from error
    if done.returncode != 0 or not library.is_file():
        raise BuildError(f"{' '.join(command)} failed with {done.returncode}:\n{done.stderr.strip()}")
    return library


def build_fmu(target: Path = PACKAGED, command: Sequence[str] | None = None) -> Path:
    """Build the FMU for this machine; the file appears whole or not at all.

    Parameters
    ----------
    target : Path
        File to write.
    command : sequence of str, optional
        C compiler; found if not given.

    Raises
    ------
    BuildError
        If it cannot be built.
    """
    command = list(command) if command is not None else compiler()
    tuple_, suffix = platform_tuple()
    files = sources()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, text in files.items():
            (folder / file).write_text(text, encoding="utf-8", newline="\n")
        library = compile_library(folder, command, suffix).read_bytes()
    content: dict[str, bytes] = {"modelDescription.xml": files.pop("modelDescription.xml").encode()}
    content[f"binaries/{tuple_}/{MODEL}{suffix}"] = library
    content |= {f"sources/{file}": text.encode() for file, text in sorted(files.items())}
    licence = FOLDER.parent / "LICENSE"
    if licence.is_file():
        content["documentation/licenses/license.txt"] = licence.read_bytes()
    _write_zip(target, content)
    return target


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
    parser = argparse.ArgumentParser(prog="python -m fmu.build", description="Build the aircraft's FMU.")
    parser.add_argument("-o", "--output", type=Path, default=PACKAGED, help="file to write (%(default)s)")
    options = parser.parse_args(arguments)
    try:
        path = build_fmu(options.output)
    except (BuildError, OSError) as error:
        print(f"fmu.build: {error}", file=sys.stderr)
        return 3
    print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
