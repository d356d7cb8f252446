"""`sidestep offboard`: sense and avoid for a vehicle on a MAVLink link."""

from __future__ import annotations

import contextlib
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from scenarios.command_errors import FAILED, INTERRUPTED, OK, UNSAFE, expected_errors
from scenarios.interrupts import stop_on_interrupt

if TYPE_CHECKING:
    from avoidance.parameters import Parameters
    from offboard.live.vehicle import LiveVehicle
    from scenarios.live_areas import LiveAreas
    from scenarios.live_flight import LiveFlight
    from scenarios.live_mission import LiveMission, SourceChoice


def offboard(
    *,
    connect: Annotated[
        str,
        typer.Option(
            metavar="URL", help="udpin://0.0.0.0:14540, tcpout://127.0.0.1:5760, serial:///dev/ttyUSB0:57600."
        ),
    ] = "udpin://0.0.0.0:14540",
    mission: Annotated[
        str | None,
        typer.Option(
            metavar="FILE|SCENARIO",
            help="A .plan or WPL file, or a scenario; the one on the vehicle if not given.",
        ),
    ] = None,
    obstacles: Annotated[
        str | None,
        typer.Option(
            metavar="SOURCE",
            help="mavlink: what the vehicle sends; scenario:FILE: a simulated radar; udp:PORT: JSON lines. "
            "Else mavlink, or the mission's own where that is a scenario with obstacles.",
        ),
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Decide and show; touch nothing.")] = False,
    arm: Annotated[bool, typer.Option("--arm", help="Arm and start without asking.")] = False,
    preset: Annotated[str | None, typer.Option(help="Avoidance: default or paper.")] = None,
    wind_bound: Annotated[
        float | None,
        typer.Option(min=0.0, help="Largest steady wind to allow for [m/s]; the scenario's, or 3."),
    ] = None,
    timeout: Annotated[float, typer.Option(min=0.1, help="Wait so long for a vehicle [s].")] = 60.0,
    signing_key: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Sign all frames and drop what is not signed (MAVLink 2 signing)."),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Where the run is written (else sidestep-runs)."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print summary.json and nothing else.")] = False,
) -> None:
    """Fly a real or simulated vehicle's mission with sense and avoid: PX4 or ArduPilot, over MAVLink.

    A human wins: after a mode change that is not ours nothing is commanded until the mission mode is back.
    Ctrl-C ends the watch and writes the run; the vehicle flies on along its mission.

    Exit codes: 0 flown safely; 1 a safety sphere was entered or the mission not completed; 2 bad input;
    3 no vehicle, or the link lost for good; 130 interrupted.
    """
    from offboard.signing import load_key  # noqa: PLC0415
    from scenarios import run  # noqa: PLC0415
    from scenarios.live_mission import mission_of, source_of  # noqa: PLC0415
    from scenarios.target import check_target, free_directory  # noqa: PLC0415

    with expected_errors():
        key = None if signing_key is None else load_key(signing_key)
        wanted = mission_of(mission)
        parameters = run.preset(preset or wanted.preset)
        source = source_of(obstacles, wanted)
        directory = output or free_directory(wanted.named(source), 0)
        check_target(directory)
        code = _connect_and_fly(
            connect,
            wanted,
            source,
            parameters,
            directory,
            wind_bound=wanted.wind_bound if wind_bound is None else wind_bound,
            timeout=timeout,
            key=key,
            touch=not dry_run,
            arm=arm,
            as_json=as_json,
        )
    raise typer.Exit(code)


def _connect_and_fly(
    url: str,
    wanted: LiveMission,
    source: SourceChoice,
    parameters: Parameters,
    directory: Path,
    *,
    wind_bound: float,
    timeout: float,
    key: bytes | None,
    touch: bool,
    arm: bool,
    as_json: bool,
) -> int:
    """Connect, prepare, fly, judge, write, show; the exit code."""
    from offboard.live.connecting import connect  # noqa: PLC0415
    from offboard.live.starting import open_vehicle  # noqa: PLC0415
    from scenarios.live_show import say  # noqa: PLC0415

    say(f"Waiting for a vehicle on {url} (up to {timeout:g} s) ...")
    session = connect(url, timeout, key)
    with contextlib.closing(session):
        vehicle = open_vehicle(session, wanted.frame, wind_bound=wind_bound, touch=touch)
        return fly(vehicle, wanted, source, parameters, directory, arm=arm, as_json=as_json)


def fly(
    vehicle: LiveVehicle,
    wanted: LiveMission,
    source: SourceChoice,
    parameters: Parameters,
    directory: Path,
    *,
    arm: bool = False,
    as_json: bool = False,
) -> int:
    """Prepare a vehicle that is there, fly, judge, write, show; the exit code.

    Nothing is commanded before it is certain that obstacles can be known.
    """
    from scenarios.live_flight import LiveFlight, scenario_of  # noqa: PLC0415
    from scenarios.live_show import LiveStatus, say  # noqa: PLC0415

    vehicle.aboard.listener = lambda event: say(event.text, event.severity)
    made = source.make(vehicle, parameters)
    areas = _prepare(vehicle, wanted, source, arm=arm)
    scenario = areas.put_into(scenario_of(vehicle, source.scenario or wanted.scenario, wanted.name))
    flight = LiveFlight(scenario, vehicle, made, parameters, wanted.seed)
    with contextlib.closing(flight), stop_on_interrupt() as stop:
        with LiveStatus(vehicle, flight, source.text) as status:
            for frame in flight:
                status.update(frame)
                if stop:
                    break
        vehicle.aboard.listener = None
        return _write(flight, directory, as_json=as_json)


def _prepare(vehicle: LiveVehicle, wanted: LiveMission, source: SourceChoice, *, arm: bool) -> LiveAreas:
    """Put the mission on the vehicle, arm it and start it, as far as that is asked for; where it may be."""
    from offboard.live import starting  # noqa: PLC0415
    from offboard.live.autopilots import Mode  # noqa: PLC0415
    from scenarios.live_areas import live_areas  # noqa: PLC0415
    from scenarios.live_show import say  # noqa: PLC0415

    aboard = vehicle.aboard
    kind = "simulated" if aboard.simulated else "not known to be simulated"
    can = vehicle.performance
    say(
        f"{aboard.rules.name}, {kind}: {can.airspeed:g} m/s, bank limit {can.max_bank * 57.29578:.0f} deg, "
        f"acceptance radius {can.acceptance_radius:g} m; mode {aboard.mode_name}, "
        f"{'armed' if aboard.telemetry.armed else 'disarmed'}"
    )
    if source.kind == "scenario" and not aboard.simulated:
        aboard.tell("warning", "obstacles are those of a scenario: real ones are not seen (--obstacles)")
    if not vehicle.touch:
        vehicle.adopt_mission()
        _check_same(vehicle, wanted)
        return live_areas(vehicle, wanted.scenario)
    flying = aboard.telemetry.armed and aboard.mode is Mode.MISSION
    question = "REPLACE the mission that it flies" if flying and wanted.raw is not None else ""
    if not flying:
        question = "Start the mission" if aboard.telemetry.armed else "ARM the vehicle and start its mission"
    if wanted.raw is not None:
        starting.check_distance(vehicle, *wanted.begin)
    if question and not (arm or aboard.simulated):
        _ask(f"{question}?")
    if wanted.raw is None:
        vehicle.adopt_mission()
    else:
        vehicle.upload_raw(starting.with_take_off(wanted.raw, vehicle))
    areas = live_areas(vehicle, wanted.scenario)
    starting.arm(vehicle)
    starting.fly_mission(vehicle)
    return areas


def _check_same(vehicle: LiveVehicle, wanted: LiveMission) -> None:
    """A dry run of a mission needs that mission on board, for it uploads nothing."""
    from scenarios.errors import ScenarioError  # noqa: PLC0415

    if wanted.raw is not None and not vehicle.has_mission(wanted.raw):
        raise ScenarioError(
            "--dry-run",
            f"the vehicle has another mission on board than {wanted.name!r}, and nothing is uploaded in a "
            "dry run; put it on board first, or leave --mission out",
        )


def _ask(question: str) -> None:
    """Go on only if a human says yes."""
    from scenarios.errors import ScenarioError  # noqa: PLC0415

    if not sys.stdin.isatty():
        raise ScenarioError(
            "--arm", "needed: the vehicle may be real, and nobody is there to ask; nothing was sent"
        )
    if not typer.confirm(question, err=True):
        raise ScenarioError("--arm", "nothing was sent, nothing was started")


def _write(flight: LiveFlight, directory: Path, *, as_json: bool) -> int:
    """Judge, write, show; the exit code."""
    from scenarios.live_show import ending_words, say  # noqa: PLC0415
    from scenarios.record import summary_text, write_run  # noqa: PLC0415
    from scenarios.report import write_report  # noqa: PLC0415
    from scenarios.show import results  # noqa: PLC0415

    flown = flight.result()
    judged = flight.judged(flown)
    write_run(directory, flown, judged, write_report)
    if as_json:
        sys.stdout.write(summary_text(judged.summary))
    else:
        if (words := ending_words(flight.ending)) is not None:
            say(words, "alarm")
        results(flown, judged, directory)
    if flight.ending == "interrupted":
        return INTERRUPTED
    if flight.ending == "link lost":
        return FAILED
    return OK if judged.summary["completed"] and not judged.summary["violations"] else UNSAFE
