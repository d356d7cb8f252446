"""Many flights over processes, each result a file written whole: a killed campaign continues."""

from __future__ import annotations

import hashlib
import json
import os
import sys
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path

from scenarios.compare_flight import Job, Record, fly_job
from scenarios.errors import RunDirectoryError
from scenarios.toml_text import to_toml

ROOMS = ("avoidance", "fmu", "offboard", "scenarios")
"""Packages whose code decides how a flight ends."""


class Store:
    """Records of flights in a directory, each with a digest of everything that it depends on.

    Parameters
    ----------
    directory : Path
        Where they lie; made when the first one is written.
    """

    def __init__(self, directory: Path) -> None:
        self._directory = directory

    def path(self, job: Job) -> Path:
        """File of a job."""
        return self._directory / f"{job.name}.json"

    def read(self, job: Job) -> Record | None:
        """The record of a job, or None if it has not been flown with this world, preset and code."""
        try:
            stored = json.loads(self.path(job).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        if not isinstance(stored, dict) or stored.get("digest") != digest(job):
            return None
        record: Record = stored["record"]
        return record

    def write(self, job: Job, record: Record) -> None:
        """Keep a record; the file is whole or not there.

        Raises
        ------
        RunDirectoryError
            If it cannot be written.
        """
        path = self.path(job)
        half = path.with_suffix(f".{os.getpid()}.part")
        text = json.dumps({"digest": digest(job), "record": record}, allow_nan=False)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            half.write_text(text, encoding="utf-8")
            half.replace(path)
        except OSError as error:
            raise RunDirectoryError(self._directory, f"cannot be written ({error})") from error


def digest(job: Job) -> str:
    """What a flight depends on, boiled down: world, parameters, and the code that flies it."""
    text = f"{to_toml(job.scenario)}\n{job.parameters!r}\n{job.avoidance} {job.gaps}\n{_code()}"
    return hashlib.sha256(text.encode()).hexdigest()[:24]


@cache
def _code() -> str:
    """Digest of the code of all rooms, subpackages of `scenarios` apart (they show what was flown)."""
    root = Path(__file__).parent.parent
    whole = hashlib.sha256()
    for room in ROOMS:
        deep = room != "scenarios"
        files = (root / room).rglob("*") if deep else (root / room).glob("*.py")
        for file in sorted(f for f in files if f.suffix in {".py", ".fmu", ".toml"} and f.is_file()):
            whole.update(str(file.relative_to(root)).encode())
            whole.update(file.read_bytes())
    return whole.hexdigest()


def fly_all(
    jobs: Iterable[Job], *, processes: int | None = None, store: Store | None = None, title: str = "flights"
) -> dict[str, Record]:
    """Fly all jobs that the store does not hold yet; a progress bar tells the time left.

    Parameters
    ----------
    jobs : iterable of Job
        Two of the same name are the same flight and flown once.
    processes : int, optional
        How many; one for each core if not given. Results do not depend on it, wall times apart.
    store : Store, optional
        Where records are kept as they come.
    title : str
        Name of the progress bar.

    Returns
    -------
    dict
        Records by name, in the order of the jobs.
    """
    wanted = {job.name: job for job in jobs}
    found: dict[str, Record] = {}
    if store is not None:
        found = {name: record for name, job in wanted.items() if (record := store.read(job)) is not None}
    missing = [job for name, job in wanted.items() if name not in found]
    for name, record in _progress(_flown(missing, processes), title, len(found), len(wanted)):
        found[name] = record
        if store is not None:
            store.write(wanted[name], record)
    return {name: found[name] for name in wanted}


def _flown(jobs: Sequence[Job], processes: int | None) -> Iterator[tuple[str, Record]]:
    if not jobs:
        return
    from joblib import Parallel, delayed  # noqa: PLC0415

    workers = Parallel(n_jobs=-1 if processes is None else processes, return_as="generator_unordered")
    yield from workers(delayed(_named)(job) for job in jobs)


def _named(job: Job) -> tuple[str, Record]:
    return job.name, fly_job(job)


def _progress(
    records: Iterable[tuple[str, Record]], title: str, done: int, total: int
) -> Iterator[tuple[str, Record]]:
    """Pass records on with a progress bar on stderr; silent where stderr is not a terminal."""
    from rich.console import Console  # noqa: PLC0415
    from rich.progress import (  # noqa: PLC0415
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(bar_width=30),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(elapsed_when_finished=False),
        console=Console(stderr=True),
        transient=True,
        disable=not sys.stderr.isatty(),
    )
    with bar:
        task = bar.add_task(title, total=total, completed=done)
        for pair in records:
            bar.update(task, advance=1)
            yield pair
