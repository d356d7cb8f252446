"""`sidestep hil …`: the aircraft as the plant behind PX4 or ArduPilot, software or hardware."""

from __future__ import annotations

import contextlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from scenarios.command_errors import BAD_INPUT, OK, UNSAFE, expected_errors

if TYPE_CHECKING:
    from scenarios.hil_run import Course
    from scenarios.hil_setup import HilOptions

app = typer.Typer(
    name="hil",
    help="In the loop: PX4 or ArduPilot, software or hardware, flies our aircraft model.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

Aircraft = Annotated[
    str, typer.Option(help="Parameter set, its TOML file, or the mapping (TOML) of an FMU of yours.")
]
Airframe = Annotated[
    str | None, typer.Option(help="Order of the channels: a name (`sidestep hil airframes`) or a TOML file.")
]
Launch = Annotated[str, typer.Option(help="runway, catapult, or air (level at 100 m).")]
LaunchThrottle = Annotated[
    float, typer.Option(min=0.01, max=1.0, help="Let go once the autopilot asks for this much thrust.")
]
LaunchDelay = Annotated[float, typer.Option(min=0.0, max=60.0, help="… for so long [s].")]
Home = Annotated[
    str,
    typer.Option(metavar="LAT,LON,ALT[,HDG]", help="Where it begins [deg, deg, m, deg]."),
]
Start = Annotated[str, typer.Option(metavar="TIME", help="When it begins, ISO 8601; for sun and compass.")]
Wind = Annotated[str, typer.Option(metavar="N,E", help="Steady wind towards north and east [m/s].")]
Faults = Annotated[
    str, typer.Option(metavar="LIST", help="Failures: NAME@START[-END][:VALUES]; … (docs/hil.md).")
]
Values = Annotated[
    list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Variable of the model; repeatable.")
]
Seed = Annotated[int, typer.Option(min=0, help="Of the sensors' noise.")]
Output = Annotated[
    Path | None, typer.Option("-o", "--output", metavar="DIR", help="Write track, events and summary there.")
]
Until = Annotated[
    float | None, typer.Option(min=0.1, help="Stop after so much simulated time [s]; else at Ctrl-C.")
]
Timeout = Annotated[
    float, typer.Option(min=0.0, help="Give up when the autopilot is silent so long [s]; 0: wait for ever.")
]
Host = Annotated[str, typer.Option(help="Address of this machine to listen on; 0.0.0.0: all.")]
SelfTestOption = Annotated[
    bool, typer.Option("--self-test", help="Fly with a scripted autopilot and print where the time goes.")
]
Seconds = Annotated[float, typer.Option(min=1.0, max=86400.0, help="Simulated time of the self-test [s].")]
AsJson = Annotated[bool, typer.Option("--json", help="Print the summary as JSON and nothing else.")]
WithAvoidance = Annotated[
    str | None,
    typer.Option(metavar="SCENARIO", help="Fly it with sense and avoid: `sidestep offboard` runs beside it."),
]
Connect = Annotated[str, typer.Option(metavar="URL", help="With it: where MAVSDK meets the autopilot.")]
Arm = Annotated[bool, typer.Option("--arm", help="With it: arm and start without asking.")]
DEFAULT_LINKS = "udp://127.0.0.1:14550,udp://127.0.0.1:14540"
DEFAULT_HOME = "47.397742,8.545594,488,0"
DEFAULT_START = "2025-06-21T08:00Z"


@app.command()
def px4(
    *,
    tcp: Annotated[int, typer.Option(min=1, max=65535, help="Listen for PX4 SITL; 4560 + instance.")] = 4560,
    host: Host = "127.0.0.1",
    serial: Annotated[
        str | None, typer.Option(metavar="DEV:BAUD", help="A board over USB or serial, in real time.")
    ] = None,
    mission_link: Annotated[
        str | None,
        typer.Option(
            metavar="URLS",
            help="With --serial: MAVLink is passed on to udp://HOST:PORT[,…]; else to 14550 and 14540 here.",
        ),
    ] = None,
    speed: Annotated[
        float, typer.Option(min=0.0, max=1000.0, help="Times real time; 0: as fast as PX4 answers.")
    ] = 1.0,
    aircraft: Aircraft = "skywalker_x8",
    airframe: Airframe = None,
    launch: Launch = "runway",
    launch_throttle: LaunchThrottle = 0.3,
    launch_delay: LaunchDelay = 0.5,
    home: Home = DEFAULT_HOME,
    start: Start = DEFAULT_START,
    wind: Wind = "0,0",
    faults: Faults = "",
    gps_latency: Annotated[
        float, typer.Option(min=0.0, max=2.0, help="Of HIL_GPS [s]; give PX4's EKF2_GPS_DELAY the same.")
    ] = 0.1,
    gps_rate: Annotated[float, typer.Option(min=1.0, max=25.0, help="Of HIL_GPS [Hz].")] = 10.0,
    values: Values = None,
    seed: Seed = 1,
    output: Output = None,
    until: Until = None,
    timeout: Timeout = 0.0,
    with_avoidance: WithAvoidance = None,
    connect: Connect = "udpin://0.0.0.0:14540",
    arm: Arm = False,
    self_test: SelfTestOption = False,
    seconds: Seconds = 60.0,
    real_time: Annotated[
        bool, typer.Option("--real-time", help="Self-test over a serial line in real time instead.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """The simulator's side of PX4's MAVLink API: lockstep over TCP, real time over serial.

    Exit codes: 0 done; 1 the self-test found something; 2 bad input; 3 the model or the link failed;
    130 interrupted (what was flown is written).
    """
    with _errors():
        from offboard.hil.sensors import SensorModel  # noqa: PLC0415
        from scenarios.hil_options import options_of  # noqa: PLC0415
        from scenarios.hil_run import run_px4_serial, run_px4_tcp  # noqa: PLC0415

        options = options_of(
            "px4", aircraft, airframe, launch, launch_throttle, launch_delay, home, start, wind, faults,
            values or (), seed, SensorModel(gps_rate=gps_rate, gps_latency=gps_latency),
        )  # fmt: skip
        _refuse("--real-time", real_time and not self_test, "only with --self-test; --serial is always so")
        _refuse_what_does_nothing(output, with_avoidance, arm=arm, self_test=self_test)
        sitl_alone = "only with --serial: PX4 SITL has MAVLink ports of its own"
        _refuse("--mission-link", mission_link is not None and serial is None, sitl_alone)
        _refuse("--speed", speed != 1.0 and serial is not None, "not with --serial: a board has real time")
        if self_test:
            _self_test(options, seconds, real_time=real_time, as_json=as_json)
        options, course = _course(options, output, until, timeout, as_json, with_avoidance, connect, arm)
        if serial is not None:
            run_px4_serial(options, serial, mission_link or DEFAULT_LINKS, course)
        else:
            run_px4_tcp(options, (host, tcp), speed, course)


@app.command()
def ardupilot(
    *,
    udp: Annotated[int, typer.Option(min=1, max=65535, help="Listen for ArduPilot's servo packets.")] = 9002,
    host: Host = "127.0.0.1",
    aircraft: Aircraft = "skywalker_x8",
    airframe: Airframe = None,
    launch: Launch = "runway",
    launch_throttle: LaunchThrottle = 0.3,
    launch_delay: LaunchDelay = 0.5,
    home: Home = DEFAULT_HOME,
    start: Start = DEFAULT_START,
    wind: Wind = "0,0",
    faults: Faults = "",
    values: Values = None,
    seed: Seed = 1,
    output: Output = None,
    until: Until = None,
    timeout: Timeout = 0.0,
    with_avoidance: WithAvoidance = None,
    connect: Connect = "udpin://0.0.0.0:14540",
    arm: Arm = False,
    self_test: SelfTestOption = False,
    seconds: Seconds = 60.0,
    as_json: AsJson = False,
) -> None:
    """The plant of ArduPilot's SITL "JSON" backend: lockstep over UDP.

    Exit codes: 0 done; 1 the self-test found something; 2 bad input; 3 the model or the link failed;
    130 interrupted (what was flown is written).
    """
    with _errors():
        from scenarios.hil_options import options_of  # noqa: PLC0415
        from scenarios.hil_run import run_ardupilot  # noqa: PLC0415

        options = options_of(
            "ardupilot", aircraft, airframe, launch, launch_throttle, launch_delay, home, start, wind, faults,
            values or (), seed,
        )  # fmt: skip
        _refuse_what_does_nothing(output, with_avoidance, arm=arm, self_test=self_test)
        if self_test:
            _self_test(options, seconds, real_time=False, as_json=as_json)
        options, course = _course(options, output, until, timeout, as_json, with_avoidance, connect, arm)
        run_ardupilot(options, (host, udp), course)


@app.command()
def airframes() -> None:
    """List the orders of channels that come with Sidestep."""
    from offboard.hil.channels import airframe_names, load_airframe  # noqa: PLC0415

    for name in airframe_names():
        typer.echo(f"{name:<18}{load_airframe(name).description}")


def _refuse(option: str, given: bool, words: str) -> None:
    """An option that would do nothing is a mistake: somebody relies on it."""
    from offboard.hil.errors import OptionError  # noqa: PLC0415

    if given:
        raise OptionError(option, [words])


def _refuse_what_does_nothing(
    output: Path | None, with_avoidance: str | None, *, arm: bool, self_test: bool
) -> None:
    """As `_refuse`, of what both commands have."""
    _refuse("--arm", arm and with_avoidance is None, "only with --with-avoidance")
    _refuse("--with-avoidance", with_avoidance is not None and self_test, "not with --self-test")
    _refuse("--output", output is not None and self_test, "not with --self-test: it writes nothing")


def _course(
    options: HilOptions,
    output: Path | None,
    until: float | None,
    timeout: float,
    as_json: bool,
    scenario: str | None,
    url: str,
    arm: bool,
) -> tuple[HilOptions, Course]:
    """How the run is conducted; a scenario also says where, when and in what wind."""
    from scenarios.hil_run import Course  # noqa: PLC0415

    if scenario is None:
        return options, Course(output, until, timeout, as_json)
    from scenarios.hil_avoidance import Together  # noqa: PLC0415

    together = Together.of(scenario, url, output, arm=arm, as_json=as_json)
    return together.options(options), Course(output, until, timeout, as_json, together)


def _self_test(options: HilOptions, seconds: float, *, real_time: bool, as_json: bool) -> None:
    """Run it, print it, exit."""
    from scenarios.hil_self_test import fly_ardupilot, fly_px4, fly_real_time  # noqa: PLC0415
    from scenarios.hil_setup import Rig  # noqa: PLC0415
    from scenarios.hil_show import self_test_json, self_test_table  # noqa: PLC0415

    flown = fly_real_time if real_time else fly_px4 if options.autopilot == "px4" else fly_ardupilot
    with Rig(options) as rig:
        found = flown(rig, seconds)
    if as_json:
        sys.stdout.write(json.dumps(self_test_json(found), indent=2) + "\n")
    else:
        self_test_table(found)
    raise typer.Exit(OK if found.passed else UNSAFE)


@contextlib.contextmanager
def _errors() -> Iterator[None]:
    """What the user has given wrongly is bad input; the rest as in every command."""
    from fmu.errors import AircraftError  # noqa: PLC0415
    from fmu.mapping import MappingError  # noqa: PLC0415
    from offboard.hil.errors import OptionError  # noqa: PLC0415

    with expected_errors():
        try:
            yield
        except (ValueError, OptionError, AircraftError, MappingError) as error:
            typer.echo(f"sidestep: {error}", err=True)
            raise typer.Exit(BAD_INPUT) from error
