"""Mission edits over a link: how long they take, and what becomes of them. Prints Markdown tables.

    python -m benchmarks.bench_offboard            all of it, about half an hour
    python -m benchmarks.bench_offboard edits      only the edits; likewise flights, pair

The simulated autopilot is `sidestep sitl` in a process of its own; MAVSDK talks to it over UDP.
"""

from __future__ import annotations

import contextlib
import json
import math
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np

from avoidance import Detour, Waypoint
from offboard.link import EditStatus
from offboard.live.connecting import connect
from offboard.live.starting import arm, fly_mission, open_vehicle
from offboard.live.vehicle import LiveVehicle

EDITS = 200
FEW = 60


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@contextlib.contextmanager
def sitl(*arguments: str, scenario: str = "clear") -> Iterator[int]:
    """A simulated autopilot in a process of its own; the port that it sends to."""
    port = free_port()
    command = [sys.executable, "-m", "scenarios.cli", "sitl", scenario, "--port", str(port), *arguments]
    with tempfile.TemporaryFile("w+") as said:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=said)
        try:
            yield port
        except BaseException:
            said.seek(0)
            print(f"{' '.join(command)} said, exit code {process.poll()}:\n{said.read()}", file=sys.stderr)
            raise
        finally:
            process.terminate()
            process.wait(10)


@contextlib.contextmanager
def flying(port: int) -> Iterator[LiveVehicle]:
    """A vehicle on the mission that it has."""
    with contextlib.closing(connect(f"udpin://127.0.0.1:{port}", 30.0)) as session:
        vehicle = open_vehicle(session)
        vehicle.adopt_mission()
        arm(vehicle)
        fly_mission(vehicle)
        vehicle.wait_until(vehicle.time + 5.0)
        yield vehicle


def edit(vehicle: LiveVehicle, number: int) -> tuple[float, float, EditStatus]:
    """One detour: until the vehicle is on the new item, until it is confirmed [ms], and its end."""
    own, route = vehicle.state().ownship, vehicle.route()
    ahead = tuple(w for w in route.waypoints if w.item is not None)
    side = 400.0 if number % 2 else -400.0
    north = own.north + 4000.0 * math.cos(own.course) - side * math.sin(own.course)
    east = own.east + 4000.0 * math.sin(own.course) + side * math.cos(own.course)
    new = Waypoint(north, east, ahead[0].altitude)
    before = len(vehicle.editor.records)
    fallbacks = vehicle.editor.fallbacks
    vehicle.begin(Detour(why="benchmark", route=(new, *ahead), waypoint=new))
    begun = time.monotonic()
    on_item = math.nan
    while len(vehicle.editor.records) == before and time.monotonic() < begun + 30.0:
        vehicle.pump(0.05)
        shown = vehicle.aboard.telemetry.target
        if math.isnan(on_item) and shown is not None and shown.arrived >= begun:
            place = vehicle.aboard.frame.to_map(shown.latitude_deg, shown.longitude_deg)
            if math.dist(place, (north, east)) < 5.0:
                on_item = 1e3 * (shown.arrived - begun)
    while vehicle.editor.fallen_back and time.monotonic() < begun + 60.0:
        vehicle.pump(0.05)
    record = vehicle.editor.records[before]
    status = record.status if vehicle.editor.fallbacks == fallbacks else EditStatus.TIMED_OUT
    return on_item, record.milliseconds, status


def edits() -> None:
    """The table of edits."""
    print(
        "| link | autopilot | edits | confirmed | told as failed | on the new item | confirmed after | p99 |"
    )
    print("|---|---|---|---|---|---|---|---|")
    cases = [
        ("real time", "px4", FEW, 1.0, ()),
        ("real time", "ardupilot", FEW, 1.0, ()),
        ("10 × real time", "px4", EDITS, 10.0, ()),
        ("10 × real time", "ardupilot", EDITS, 10.0, ()),
        ("10 × real time, 10 % loss", "px4", EDITS, 10.0, ("--loss", "0.1")),
        ("10 × real time, 10 % loss", "ardupilot", EDITS, 10.0, ("--loss", "0.1")),
    ]
    for name, autopilot, count, speed, more in cases:
        arguments = ("--autopilot", autopilot, "--speed", str(speed), *more)
        with sitl(*arguments) as port, flying(port) as vehicle:
            found = []
            for number in range(count):
                found.append(edit(vehicle, number))
                vehicle.wait_until(vehicle.time + 1.0)
        confirmed = [f for f in found if f[2] is EditStatus.CONFIRMED]
        failed = sum(f[2] in (EditStatus.REFUSED, EditStatus.TIMED_OUT) for f in found)
        on_item, after = np.nanmedian([f[0] for f in confirmed]), np.median([f[1] for f in confirmed])
        p99 = np.percentile([f[1] for f in confirmed], 99)
        print(
            f"| {name} | {autopilot} | {count} | {len(confirmed)} | {failed} | {on_item:.0f} ms "
            f"| {after:.0f} ms = {after * speed / 1e3:.2f} s simulated | {p99:.0f} ms |",
            flush=True,
        )


def flights() -> None:
    """The table of flights."""
    print(
        "| scenario | autopilot | speed | violations | least margin | edits | waypoints, largest distance |"
    )
    print("|---|---|---|---|---|---|---|")
    for scenario in ("single", str(Path(__file__).parent / "reference" / "offboard-100km.toml")):
        for autopilot in ("px4", "ardupilot"):
            with (
                tempfile.TemporaryDirectory() as folder,
                sitl("--autopilot", autopilot, "--speed", "25", scenario=scenario) as port,
            ):
                live, twin = Path(folder) / "live", Path(folder) / "twin"
                cli = [sys.executable, "-m", "scenarios.cli"]
                url = f"udpin://127.0.0.1:{port}"
                run = partial(
                    subprocess.run, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
                )
                run([*cli, "fly", scenario, "-o", str(twin)])
                run([*cli, "offboard", "--connect", url, "--mission", scenario, "-o", str(live)])
                summary = json.loads((live / "summary.json").read_text())
                mine, other = injected(live), injected(twin)
                apart = [math.dist(a, b) for a, b in zip(mine, other, strict=False)]
                print(
                    f"| {Path(scenario).stem} | {autopilot} | {summary['real_time_factor']} "
                    f"| {summary['violations']} | {summary['min_margin_m']} m "
                    f"| {summary['edits_confirmed']} of {summary['edits']} "
                    f"| {len(mine)} and {len(other)}, {max(apart, default=math.nan):.1f} m |",
                    flush=True,
                )


def pair() -> None:
    """Two vehicles towards each other, each watched over by a process of its own."""
    scenario = str(Path(__file__).parent / "reference" / "offboard-pair.toml")
    with (
        tempfile.TemporaryDirectory() as folder,
        sitl("--vehicles", "2", "--speed", "20", scenario=scenario) as port,
    ):
        watchers = [
            subprocess.Popen(
                [
                    *(sys.executable, "-m", "scenarios.cli", "offboard", "--obstacles", "mavlink"),
                    *(
                        "--connect",
                        f"udpin://127.0.0.1:{port + number}",
                        "-o",
                        str(Path(folder) / str(number)),
                    ),
                ],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            for number in range(2)
        ]
        codes = [watcher.wait(300) for watcher in watchers]
        summaries = [json.loads((Path(folder) / str(n) / "summary.json").read_text()) for n in range(2)]
    apart = ", ".join(f"{summary['min_separation_m']:.0f} m" for summary in summaries)
    print(f"Two vehicles over ADSB_VEHICLE at 20 times real time: exit codes {codes}, separation {apart}.")


def injected(directory: Path) -> list[tuple[float, float]]:
    """The waypoints that avoidance put in during a run, in their order."""
    rows = [json.loads(line) for line in (directory / "decisions.jsonl").read_text().splitlines()]
    return [(w["north_m"], w["east_m"]) for row in rows for w in row["waypoints"]]


PARTS = {"edits": edits, "flights": flights, "pair": pair}

if __name__ == "__main__":
    for name in sys.argv[1:] or PARTS:
        PARTS[name]()
        print(flush=True)
