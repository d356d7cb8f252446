"""`sidestep sitl`: a simulated MAVLink autopilot to connect to."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from scenarios.command_errors import INTERRUPTED, OK, expected_errors

if TYPE_CHECKING:
    from offboard.sitl.faulty import Faults
    from offboard.sitl.transports import Exchange
    from scenarios.sitl_run import Ports
    from scenarios.sitl_world import SitlWorld

MOST_VEHICLES = 20
HIGHEST_PORT = 65535
GROUND_SCENARIO = "clear"
"""Gives home where no scenario is named."""


def sitl(
    scenario: Annotated[
        str | None,
        typer.Argument(
            help="Name from `sidestep list`, or a .toml file; without one, at home on the ground."
        ),
    ] = None,
    *,
    port: Annotated[
        int, typer.Option(min=1, max=65535, help="UDP port that the first vehicle sends to.")
    ] = 14540,
    host: Annotated[str, typer.Option(help="Host that is sent to.")] = "127.0.0.1",
    speed: Annotated[float, typer.Option(min=0.01, max=1000.0, help="Times real time.")] = 1.0,
    autopilot: Annotated[str, typer.Option(help="Whose behaviour: px4 or ardupilot.")] = "px4",
    vehicles: Annotated[
        int, typer.Option(min=1, max=MOST_VEHICLES, help="How many, each with its own ports and system ID.")
    ] = 1,
    seed: Annotated[
        int | None, typer.Option(min=0, help="Of the world; the scenario's own if not given.")
    ] = None,
    parameters: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="Autopilot parameter; may be repeated."),
    ] = None,
    signing_key: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Sign all frames and drop what is not signed (MAVLink 2 signing)."),
    ] = None,
    loss: Annotated[
        float, typer.Option(min=0.0, max=1.0, help="Share of frames that the UDP link loses, either way.")
    ] = 0.0,
    duplicate: Annotated[
        float, typer.Option(min=0.0, max=1.0, help="Share of frames that come twice.")
    ] = 0.0,
    delay: Annotated[
        str | None,
        typer.Option(metavar="MIN,MAX", help="Each frame is late by so much [s], and overtakes others."),
    ] = None,
    outage: Annotated[
        str | None,
        typer.Option(metavar="FROM,TO", help="Nothing comes through between these times [s of wall clock]."),
    ] = None,
    once: Annotated[
        bool, typer.Option("--once", help="End when every vehicle has flown its mission to its end.")
    ] = False,
) -> None:
    """Put a MAVLink autopilot in front of the aircraft model, for ground stations and programs to connect to.

    With a scenario each vehicle waits in the air where its mission begins, until it is armed; its radar's
    returns go out as OBSTACLE_DISTANCE_3D, traffic as ADSB_VEHICLE. Runs until Ctrl-C.

    Exit codes: 0 mission ended (--once); 2 bad input; 3 the aircraft model or a link failed; 130 interrupted.
    """
    from avoidance.parameters import PRESETS  # noqa: PLC0415
    from offboard.signing import load_key  # noqa: PLC0415
    from offboard.sitl.autopilot import FLAVOURS  # noqa: PLC0415
    from scenarios import run  # noqa: PLC0415
    from scenarios.errors import ScenarioError  # noqa: PLC0415
    from scenarios.load import load  # noqa: PLC0415
    from scenarios.sitl_run import connect  # noqa: PLC0415
    from scenarios.sitl_world import SitlWorld, fleet_of  # noqa: PLC0415

    with expected_errors("nothing was flown"), contextlib.ExitStack() as stack:
        if autopilot not in FLAVOURS:
            known = ", ".join(FLAVOURS)
            raise ScenarioError("--autopilot", f"{autopilot!r} is unknown; known: {known}")
        faults = _faults(loss, duplicate, delay, outage)
        address = _address(host, port, vehicles)
        on_ground = scenario is None
        chosen = load(scenario or GROUND_SCENARIO)
        chosen = run.prepare(chosen, chosen.seed if seed is None else seed)
        members = fleet_of(chosen, vehicles, on_ground=on_ground)
        try:
            world = SitlWorld(
                chosen,
                PRESETS[chosen.preset],
                FLAVOURS[autopilot],
                members,
                on_ground=on_ground,
                retry=0.2 * max(speed, 1.0),
                settings=_settings(parameters or []),
                signing_key=None if signing_key is None else load_key(signing_key),
            )
        except ValueError as error:
            raise ScenarioError("--set", str(error)) from error
        stack.enter_context(world)
        exchanges, ports = [], []
        for number, each in enumerate(world.autopilots.values()):
            exchange, its_ports = connect(each, number, port, address, faults)
            stack.callback(exchange.close)
            exchanges.append(exchange)
            ports.append(its_ports)
        code = _run(world, exchanges, ports, speed, once)
    raise typer.Exit(code)


def _run(
    world: SitlWorld, exchanges: Sequence[Exchange], ports: Sequence[Ports], speed: float, once: bool
) -> int:
    """Serve with a line of status; the exit code."""
    from scenarios.sitl_run import serve  # noqa: PLC0415
    from scenarios.sitl_show import StatusLine, greeting  # noqa: PLC0415

    greeting(world, ports, speed)
    with StatusLine(world, exchanges) as status:
        try:
            serve(world, exchanges, speed, status.update, lambda: once and world.over)
        except KeyboardInterrupt:
            return INTERRUPTED
    return OK


def _address(host: str, port: int, vehicles: int) -> str:
    """The numbers of a host's address, looked up once; every vehicle's port must be one."""
    import socket  # noqa: PLC0415

    from scenarios.errors import ScenarioError  # noqa: PLC0415

    if port + vehicles - 1 > HIGHEST_PORT:
        message = (
            f"{port}: {vehicles} vehicles need ports up to {port + vehicles - 1}, the last is {HIGHEST_PORT}"
        )
        raise ScenarioError("--port", message)
    try:
        return socket.gethostbyname(host)
    except (OSError, UnicodeError) as error:
        raise ScenarioError("--host", f"{host!r} is no host that is known (IPv4): {error}") from error


def _settings(texts: Sequence[str]) -> dict[str, float]:
    """Parameters as given on the command line."""
    from scenarios.errors import ScenarioError  # noqa: PLC0415

    found = {}
    for text in texts:
        name, _, value = text.partition("=")
        try:
            found[name.strip()] = float(value)
        except ValueError as error:
            message = f"{text!r} must be a name and a number, such as NAV_LOITER_RAD=100"
            raise ScenarioError("--set", message) from error
    return found


def _faults(loss: float, duplicate: float, delay: str | None, outage: str | None) -> Faults | None:
    """How bad the link is; None if it is good."""
    from offboard.sitl.faulty import Faults  # noqa: PLC0415

    if not (loss or duplicate or delay or outage):
        return None
    outages = (_span("--outage", outage),) if outage else ()
    return Faults(loss, duplicate, _span("--delay", delay) if delay else (0.0, 0.0), outages)


def _span(option: str, text: str) -> tuple[float, float]:
    """Two numbers with a comma, the lesser first."""
    from scenarios.errors import ScenarioError  # noqa: PLC0415

    try:
        low, high = (float(part) for part in text.split(","))
    except ValueError as error:
        raise ScenarioError(option, f"{text!r} must be two numbers with a comma, such as 0.5,3") from error
    if not 0.0 <= low <= high < float("inf"):
        raise ScenarioError(option, f"{text!r} must be two numbers from 0 on, the lesser first")
    return low, high
