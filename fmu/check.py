"""Everything that can be said for or against an FMU of the aircraft, as one list of findings.

`sidestep fmu check` prints it. What needs a tool or data that are not here is skipped, with the reason.
"""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import zipfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import Any

from fmu import flights, nesc
from fmu.build import FMI2_PLATFORMS, FOLDER, platform_tuple
from fmu.cosimulation import CoSimulation, read_description
from fmu.emit import MODEL

PASSED, FAILED, SKIPPED = "passed", "FAILED", "skipped"
FLIGHTS: tuple[Callable[[CoSimulation], Iterator[flights.Seen]], ...] = (
    flights.level_trims,
    flights.turns_and_climbs,
    flights.step_sizes,
    flights.repeats,
    flights.refusals,
    flights.conservation,
    flights.against_the_twin,
)
"""What is flown on each FMU."""
EXCHANGE_TIME = 10.0
"""Flight by Model Exchange [s]."""
_SCHEMAS = {
    "sources/buildDescription.xml": "fmi3BuildDescription.xsd",
    "terminalsAndIcons/terminalsAndIcons.xml": "fmi3TerminalsAndIcons.xsd",
}
"""Further files of an FMI 3.0 FMU and the standard's schema for each."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One line of the table."""

    fmu: str
    """Its FMI version; "both" where two are compared."""
    check: str
    """What was looked at."""
    verdict: str
    """`PASSED`, `FAILED` or `SKIPPED`."""
    detail: str
    """The figure with its limit, or the reason."""


def packaged() -> tuple[Path, ...]:
    """The FMUs that have been built beside this package: FMI 3.0 first."""
    return tuple(sorted(FOLDER.glob(f"{MODEL}*.fmu"), key=lambda path: len(path.name)))


def check(files: Sequence[Path], references: Path = nesc.DATA) -> Iterator[Finding]:
    """Check FMUs of the aircraft, one finding at a time.

    Parameters
    ----------
    files : sequence of Path
        The FMUs; what they do is compared where there is more than one.
    references : Path
        Folder of NASA's reference trajectories.

    Raises
    ------
    PlantError
        If a file is no FMU or does not load on this machine.
    """
    for file in files:
        with CoSimulation(file) as unit:  # what does not load is an error, not a finding
            yield from _files(file)
            for flight in FLIGHTS:
                yield from _flown(file, unit, flight)
        yield _exchange(file)
        yield from _nesc(file, references)
    for first, second in pairwise(files):
        yield _same_bits(first, second)


def _label(file: Path) -> str:
    return f"FMI {str(read_description(file).fmiVersion)[:3]}"


def _files(file: Path) -> Iterator[Finding]:
    """What can be seen without running the model."""
    from fmpy.validation import validate_fmu  # noqa: PLC0415  (slow import)

    yield _judged(file, "schema and rules (fmpy)", validate_fmu(str(file)), "modelDescription.xml")
    yield from _schemas(file)
    yield _fmutool(file)
    with zipfile.ZipFile(file) as archive:
        names = archive.namelist()
    places = sorted({name.split("/")[1] for name in names if name.startswith("binaries/")})
    sources = sum(name.startswith("sources/") and name.endswith(".c") for name in names)
    machine = platform_tuple()[0]
    here = machine in places or FMI2_PLATFORMS[machine] in places
    detail = f"libraries for {', '.join(places) or 'no machine'}; {sources} C files to build others from"
    yield Finding(_label(file), "contents", PASSED if here and sources else FAILED, detail)


def _schemas(file: Path) -> Iterator[Finding]:
    """Validate the further XML files of an FMI 3.0 FMU."""
    import fmpy  # noqa: PLC0415  (slow import)
    from lxml import etree  # noqa: PLC0415  (comes with fmpy)

    folder = Path(fmpy.__file__).parent / "schema" / "fmi3"
    with zipfile.ZipFile(file) as archive:
        present = {name: archive.read(name) for name in _SCHEMAS if name in archive.namelist()}
    for name, data in present.items():
        schema: Any = etree.XMLSchema(etree.parse(str(folder / _SCHEMAS[name])))
        schema.validate(etree.parse(BytesIO(data)))
        mistakes = [f"line {entry.line}: {entry.message}" for entry in schema.error_log]
        yield _judged(file, "schema", mistakes, name)


def _fmutool(file: Path) -> Finding:
    """Ask an independent checker, fmutool of the FMU Manipulation Toolbox."""
    name = "second opinion (fmutool)"
    if importlib.util.find_spec("fmu_manipulation_toolbox") is None:
        return Finding(_label(file), name, SKIPPED, "not installed: pip install fmu-manipulation-toolbox")
    program = "from fmu_manipulation_toolbox.cli.fmutool import fmutool; fmutool()"
    call = [sys.executable, "-c", program, "-input", str(file), "-check"]
    done = subprocess.run(call, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    lines = [line.partition("|")[2].strip() for line in (done.stdout + done.stderr).splitlines()]
    said = [line for line in lines if "compliant" in line or "rror" in line or "WARN" in line]
    clean = (
        done.returncode == 0
        and any("seems to be compliant" in line for line in said)
        and any("No semantic error" in line for line in said)
    )
    return Finding(
        _label(file), name, PASSED if clean else FAILED, "; ".join(said) or f"exit code {done.returncode}"
    )


def _flown(
    file: Path, unit: CoSimulation, flight: Callable[[CoSimulation], Iterator[flights.Seen]]
) -> Iterator[Finding]:
    """What one flight showed; a flight that shows nothing was not possible here."""
    findings = [
        Finding(_label(file), seen.check, PASSED if seen.good else FAILED, seen.detail)
        for seen in flight(unit)
    ]
    yield from findings
    if not findings:
        reason = "the independent model comes with the source tree, not with the package"
        yield Finding(_label(file), "twin", SKIPPED, reason)


def _exchange(file: Path) -> Finding:
    """Whether an importer's own solver, through Model Exchange, flies where Co-Simulation flies."""
    from fmpy import simulate_fmu  # noqa: PLC0415  (slow import)

    name = "Model Exchange"
    if read_description(file).modelExchange is None:
        return Finding(_label(file), name, SKIPPED, "the FMU has no such interface")
    places = ("state.north", "state.east", "state.altitude")
    commands = {"command.mode": 2, "command.orbit.east": 60.0, "command.orbit.radius": 60.0}
    with CoSimulation(file, commands) as unit:
        unit.step(EXCHANGE_TIME)
        there = unit.read(places)
    try:
        flown = simulate_fmu(
            str(file),
            validate=False,
            fmi_type="ModelExchange",
            relative_tolerance=1e-10,
            stop_time=EXCHANGE_TIME,
            output_interval=EXCHANGE_TIME,
            start_values=commands,
            output=places,
        )
    except Exception as error:  # fmpy raises its own and the FMU's
        return Finding(_label(file), name, FAILED, str(error))
    apart = max(abs(float(flown[place][-1]) - value) for place, value in zip(places, there, strict=True))
    detail = f"CVode and Co-Simulation {apart:.0e} m apart after {EXCHANGE_TIME:g} s of turning (1e-3 m)"
    return Finding(_label(file), name, PASSED if apart < 1e-3 else FAILED, detail)


def _nesc(file: Path, folder: Path) -> Iterator[Finding]:
    """NASA's check cases, where their reference trajectories are."""
    if not folder.is_dir():
        reason = f"no reference trajectories at {folder}"
        yield Finding(_label(file), "NASA check cases", SKIPPED, reason)
        return
    for case in nesc.CASES:
        known = nesc.references(case, folder)
        found = nesc.errors(nesc.fly(case, file), known)
        missing = [tool for tool in case.limits if tool not in found]
        good = not missing and all(found[tool] < limit for tool, limit in case.limits.items())
        shown = [
            f"{tool} {found[tool]:.1e} {case.unit} ({limit:g})"
            for tool, limit in case.limits.items()
            if tool in found
        ]
        shown += [f"no {tool} in {folder}" for tool in missing]
        yield Finding(_label(file), f"NASA case {case.number}", PASSED if good else FAILED, "; ".join(shown))


def _same_bits(first: Path, second: Path) -> Finding:
    """Whether two FMUs fly the same flight bit by bit."""
    rows, names = [], []
    for file in (first, second):
        with CoSimulation(file) as unit:
            rows.append(flights.manoeuvre(unit, 0.1))
            names.append(unit.outputs)
    common = [name for name in names[0] if name in names[1]]
    parts = [table[:, [own.index(name) for name in common]] for table, own in zip(rows, names, strict=True)]
    same = parts[0].tobytes() == parts[1].tobytes()
    detail = f"{parts[0].size} values of {len(common)} outputs, compared bit by bit"
    return Finding("both", "the same bits", PASSED if same else FAILED, detail)


def _judged(file: Path, name: str, mistakes: Sequence[str], subject: str) -> Finding:
    """A finding from a list of mistakes."""
    if not mistakes:
        return Finding(_label(file), name, PASSED, subject)
    more = f" (and {len(mistakes) - 1} more)" if len(mistakes) > 1 else ""
    return Finding(_label(file), name, FAILED, f"{subject}: {mistakes[0]}{more}")
