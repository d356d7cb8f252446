"""Time the aircraft FMU against its yardsticks: `python benchmarks/bench_fmu.py` prints Markdown tables.

All subjects take turns in one run, so that a busy machine slows them alike; ratios are of medians. A
yardstick that is not installed is left out, with its name (`make bench` installs them all).
"""

from __future__ import annotations

import ctypes
import importlib.util
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from fmu import FmuLibrary, FmuPlant
from fmu.build import FLAGS, compiler
from fmu.cosimulation import CoSimulation

REFERENCE = Path(__file__).parent / "reference"
ROUNDS = 25
SPELL = 0.02
"""Time of one subject in one round [s]."""
CROWD = 200
JSBSIM = ("minisgs", "c182", "c172r", "t6texan2", "sgs233")
"""Aircraft of jsbsim's wheel among which the lightest fixed-wing one is looked for: the five quickest of them
all that have wings (a glider without engine or systems is the quickest)."""
Subject = tuple[Callable[[], object], float]
"""A call, and how much flight it makes [s]."""

BARE, GUIDED = "C, direct surfaces", "C, with guidance"
PLANT = "FmuPlant, steps of {} s"
KINEMATIC = "FmuPlant, kinematic, steps of 1 s"
RK4 = "bare 12-state RK4 in C"
READ = "FmuPlant, steps of 0.1 s, state read after each"
DIRECT = "FmuPlant, direct surfaces, steps of 0.1 s, state read after each"
PYTHON = "pythonfmu, steps of 0.1 s, state read after each"


def subjects(stack: ExitStack) -> dict[str, Subject]:
    """Everything that is timed, by name."""
    library = stack.enter_context(FmuLibrary.open())

    def plant(**options: object) -> FmuPlant:
        return stack.enter_context(FmuPlant(library, **options))  # type: ignore[arg-type]

    far = {"altitude": 200.0, "airspeed": 15.0}
    guided, direct, kinematic = plant(), plant(), plant(fidelity="kinematic")
    guided.fly_leg(0, 0, 9e6, 0, **far)
    kinematic.fly_leg(0, 0, 9e6, 0, **far)
    direct.fly_direct(0.0, direct.get("state.elevator"), 0.0, direct.get("state.throttle"))
    found: dict[str, Subject] = {
        RK4: (airframe12(stack), 10.0),
        BARE: (lambda: direct.step(10.0), 10.0),
        GUIDED: (lambda: guided.step(10.0), 10.0),
        PLANT.format("0.1"): (lambda: guided.step(0.1), 0.1),
        PLANT.format("1"): (lambda: guided.step(1.0), 1.0),
        KINEMATIC: (lambda: kinematic.step(1.0), 1.0),
        READ: (lambda: (guided.step(0.1), guided.state), 0.1),
        DIRECT: (lambda: (direct.step(0.1), direct.state), 0.1),
    }
    with quiet():
        return found | python_aircraft(stack) | jsbsim()


@contextmanager
def quiet() -> Iterator[None]:
    """Nothing of what a library in C++ tells goes to the table."""
    sys.stdout.flush()
    kept = os.dup(1)
    with open(os.devnull, "w") as nowhere:
        os.dup2(nowhere.fileno(), 1)
        try:
            yield
        finally:
            os.dup2(kept, 1)
            os.close(kept)


def airframe12(stack: ExitStack) -> Callable[[], object]:
    """Ten seconds of the bare airframe, compiled with the model's own flags."""
    folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
    target = folder / "airframe12.so"
    flags = [flag for flag in FLAGS if flag != "-fvisibility=hidden"]
    command = [*compiler(), *flags, "-fPIC", str(REFERENCE / "airframe12.c"), "-o", str(target), "-lm"]
    subprocess.run(command, check=True)
    function = ctypes.CDLL(str(target)).airframe12
    function.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_double, ctypes.c_int]
    state = (ctypes.c_double * 12)(0, 0, -200, 14.976, 0, 0.8443, 0, 0.056315, 0, 0, 0, 0)
    control = (ctypes.c_double * 4)(0, 0.01652, 0, 0.3572)
    return lambda: function(state, control, 0.01, 1000)


def python_aircraft(stack: ExitStack) -> dict[str, Subject]:
    """The same airframe in Python, in an FMU, through the same importer."""
    if importlib.util.find_spec("pythonfmu") is None:
        return {}
    from pythonfmu.builder import FmuBuilder  # noqa: PLC0415

    folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
    FmuBuilder.build_FMU(REFERENCE / "python_aircraft.py", dest=folder)
    unit = stack.enter_context(CoSimulation(folder / "PythonAircraft.fmu"))
    outputs = unit.outputs
    return {PYTHON: (lambda: (unit.step(0.1), unit.read(outputs)), 0.1)}


def jsbsim() -> dict[str, Subject]:
    """jsbsim's lightest fixed-wing aircraft: the one whose run() of 10 ms takes least."""
    if importlib.util.find_spec("jsbsim") is None:
        return {}
    from jsbsim import FGFDMExec  # noqa: PLC0415

    found: dict[str, Subject] = {}
    for name in JSBSIM:
        machine = FGFDMExec(None)
        machine.set_debug_level(0)
        machine.set_dt(0.01)
        if not machine.load_model(name):
            continue
        machine.disable_output()
        for key, value in {"h-sl-ft": 3000, "vc-kts": 90, "lat-gc-deg": 10, "long-gc-deg": 10}.items():
            machine[f"ic/{key}"] = value
        if machine.run_ic():
            found[f"jsbsim {name}, run()"] = (machine.run, 0.01)
    if not found:
        return {}
    quick = {name: min(spell(found[name]) for _ in range(10)) for name in found}
    best = min(quick, key=lambda name: quick[name])
    return {best: found[best]}


def spell(subject: Subject) -> float:
    """Processor time per 10 ms of flight, over a short spell [µs]; what others do does not count."""
    call, flight = subject
    count, begin = 0, time.perf_counter()
    used = time.thread_time()
    while time.perf_counter() - begin < SPELL or not count:
        call()
        count += 1
    return (time.thread_time() - used) / count * 1e6 * 0.01 / flight


def crowd() -> float:
    """Processor time to make that many instances [ms]; the library is loaded already."""
    with FmuLibrary.open() as library, ExitStack() as stack:
        stack.enter_context(FmuPlant(library))
        begin = time.thread_time()
        plants = [FmuPlant(library, east=10.0 * i) for i in range(CROWD)]
        taken = (time.thread_time() - begin) * 1e3
        for plant in plants:
            plant.close()
    return taken


def requirements(names: list[str]) -> list[tuple[str, str, str, float]]:
    """What must hold: words, the slower, the faster, and the least ratio of the two."""
    rows = [("kinematic against 6-DOF, steps of 1 s", PLANT.format("1"), KINEMATIC, 5.0)]
    if PYTHON in names:
        rows.append(("FmuPlant against the same model in pythonfmu, 0.1 s", PYTHON, DIRECT, 20.0))
    for name in names:
        if name.startswith("jsbsim"):
            rows.append((f"C with guidance against {name}", name, GUIDED, 7.0))
            rows.append((f"FmuPlant at 0.1 s against {name}", name, PLANT.format("0.1"), 4.0))
            rows.append((f"FmuPlant at 1 s against {name}", name, PLANT.format("1"), 6.0))
    return rows


def main() -> int:
    """Print what was measured, and whether each requirement is kept; with --strict, 1 if one is not."""
    with ExitStack() as stack:
        timed = subjects(stack)
        rounds: dict[str, list[float]] = {name: [] for name in timed}
        for _ in range(ROUNDS):
            for name, subject in timed.items():
                rounds[name].append(spell(subject))
    median = {name: statistics.median(times) for name, times in rounds.items()}
    print(f"Python {platform.python_version()}, {platform.machine()}, {ROUNDS} rounds, {compiler()[0]}\n")
    print("| flown | processor time per 10 ms of flight [µs], median | quartiles |")
    print("|---|---|---|")
    for name, times in sorted(rounds.items(), key=lambda item: median[item[0]]):
        low, _, high = statistics.quantiles(times, n=4)
        print(f"| {name} | {median[name]:.3f} | {low:.3f} to {high:.3f} |")
    print("\n| ratio, in this run | measured | required | kept |")
    print("|---|---|---|---|")
    kept = []
    for words, slower, faster, least in requirements(list(timed)):
        ratio = median[slower] / median[faster]
        kept.append(ratio >= least)
        print(f"| {words} | {ratio:.1f} × | ≥ {least:g} × | {_yes(kept[-1])} |")
    cost = median[GUIDED] / median[RK4]
    kept.append(cost <= 1.7)
    print(f"| cost of the C step with guidance, over {RK4} | {cost:.2f} × | ≤ 1.7 × | {_yes(kept[-1])} |")
    instances = statistics.median(crowd() for _ in range(5))
    kept.append(instances < 100.0)
    print(f"| {CROWD} instances, made and trimmed | {instances:.0f} ms | < 100 ms | {_yes(kept[-1])} |")
    for package in ("jsbsim", "pythonfmu"):
        if importlib.util.find_spec(package) is None:
            print(f"\n{package} is not installed: its rows are left out.")
    return 1 if "--strict" in sys.argv[1:] and not all(kept) else 0


def _yes(kept: bool) -> str:
    return "yes" if kept else "**no**"


if __name__ == "__main__":
    sys.exit(main())
