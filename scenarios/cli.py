"""The command line. Heavy imports stay inside the commands, so that help answers at once."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from scenarios import (
    __version__,
    compare_commands,
    fmu_commands,
    hil_commands,
    offboard_commands,
    paper_commands,
    plan_commands,
    sitl_commands,
)
from scenarios.command_errors import INTERRUPTED, OK, UNSAFE, expected_errors
from scenarios.interrupts import stop_on_interrupt

if TYPE_CHECKING:
    from avoidance.parameters import Parameters
    from scenarios.scenario import Scenario

app = typer.Typer(
    name="sidestep",
    help="Sense and avoid for fixed-wing UAVs: fly missions among obstacles on a 6-DOF aircraft model.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # plain help: rich would double the time it takes
    add_completion=False,
)
app.add_typer(fmu_commands.app)
app.add_typer(hil_commands.app)
app.add_typer(plan_commands.app)
app.command()(compare_commands.compare)
app.command()(offboard_commands.offboard)
app.command()(paper_commands.paper)
app.command()(sitl_commands.sitl)


def main() -> None:
    """Entry point of the `sidestep` command."""
    app()


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"sidestep {__version__}")
        raise typer.Exit(OK)


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Sense and avoid for fixed-wing UAVs: fly missions among obstacles on a 6-DOF aircraft model."""


@app.command("list")
def list_scenarios() -> None:
    """List the scenarios that come with Sidestep."""
    from scenarios.load import catalogue_names, load  # noqa: PLC0415
    from scenarios.show import scenario_table  # noqa: PLC0415

    with expected_errors():
        scenario_table([load(name) for name in catalogue_names()])


@app.command()
def fly(
    scenario: Annotated[
        str, typer.Argument(help="Name from `sidestep list`, or the path of a .toml file.")
    ] = "table4",
    *,
    seed: Annotated[
        int | None, typer.Option(min=0, help="All randomness comes from it; the scenario's own if not given.")
    ] = None,
    preset: Annotated[
        str | None,
        typer.Option(
            help="Avoidance as good as we can (default) or as printed (paper); else the scenario's."
        ),
    ] = None,
    planner: Annotated[
        str | None, typer.Option(help="Who finds ways round, such as pso, ga, exact; else the scenario's.")
    ] = None,
    wind: Annotated[
        str | None,
        typer.Option(metavar="N,E", help="Steady wind towards north and east [m/s], such as 3,-4."),
    ] = None,
    turbulence: Annotated[
        str | None, typer.Option(help="none, light, moderate or severe; the scenario's own if not given.")
    ] = None,
    obstacles: Annotated[
        int | None,
        typer.Option(metavar="N", min=0, max=100_000, help="How many obstacles 'random' draws."),
    ] = None,
    fidelity: Annotated[
        str | None, typer.Option(help="6dof or kinematic; the scenario's own if not given.")
    ] = None,
    plant: Annotated[
        Path | None,
        typer.Option(metavar="TOML", help="Fly an FMU of your own: its mapping (docs/aircraft.md)."),
    ] = None,
    no_avoidance: Annotated[bool, typer.Option("--no-avoidance", help="Fly on whatever is ahead.")] = False,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Where the run is written (else sidestep-runs)."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print summary.json and nothing else.")] = False,
) -> None:
    """Fly a scenario and write down everything about it.

    Exit codes: 0 flown safely; 1 a safety sphere was entered or the mission not completed; 2 bad input;
    3 the aircraft model or a link failed; 130 interrupted (what was flown is written).
    """
    from dataclasses import replace  # noqa: PLC0415

    from scenarios import run  # noqa: PLC0415
    from scenarios.fly_options import changed  # noqa: PLC0415
    from scenarios.load import load  # noqa: PLC0415
    from scenarios.planners import planned_by  # noqa: PLC0415
    from scenarios.target import check_target, free_directory  # noqa: PLC0415

    with expected_errors():
        if preset is not None:
            run.preset(preset)
        chosen = load(scenario)
        seed = chosen.seed if seed is None else seed
        parameters = planned_by(run.preset(preset or chosen.preset), planner or chosen.planner)
        chosen = changed(chosen, wind=wind, turbulence=turbulence, fidelity=fidelity, plant=plant)
        chosen = replace(chosen, seed=seed, preset=parameters.name, planner=parameters.optimiser)
        chosen = run.prepare(chosen, seed, obstacles=obstacles)
        directory = output or free_directory(chosen, seed)
        check_target(directory)
        code = _fly_and_write(
            chosen, parameters, directory, seed=seed, avoidance=not no_avoidance, as_json=as_json
        )
    raise typer.Exit(code)


@app.command()
def report(directory: Annotated[Path, typer.Argument(metavar="DIR", help="A run directory.")]) -> None:
    """Write report.html of a run again, from its files alone."""
    from scenarios.report import write_report  # noqa: PLC0415

    with expected_errors():
        typer.echo(str(write_report(directory)))


@app.command()
def replay(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="A run directory.")],
    speed: Annotated[float, typer.Option(min=0.0, help="Times real time; 0 shows everything at once.")] = 0.0,
) -> None:
    """Tell a recorded flight again, event by event, and check its figures against its files.

    Exit codes: 0 the figures agree; 1 they do not; 2 the directory cannot be read.
    """
    from scenarios.recorded import differences, read_fleet  # noqa: PLC0415
    from scenarios.replay import timeline  # noqa: PLC0415
    from scenarios.show import play, verdict_of_replay  # noqa: PLC0415

    with expected_errors():
        runs = read_fleet(directory)
        for run in runs:
            play(timeline(run), speed)
        found = [text for run in runs for text in differences(run)]
        verdict_of_replay(runs, found)
    raise typer.Exit(UNSAFE if found else OK)


@app.command()
def stress(
    *,
    kind: Annotated[
        str, typer.Option(help="static or mixed (random fields), moving, turning or noise (traffic).")
    ] = "static",
    obstacles: Annotated[
        str | None,
        typer.Option(metavar="N,N,…", help="Obstacles per field, or intruders per encounter; one row each."),
    ] = None,
    runs: Annotated[int, typer.Option(min=1, max=100_000, help="Worlds per row.")] = 25,
    seed: Annotated[int, typer.Option(min=0, help="Run i of a seed is the same world for ever.")] = 0,
    vehicle: Annotated[str, typer.Option(help="kinematic or 6dof.")] = "kinematic",
    preset: Annotated[str, typer.Option(help="Avoidance: default or paper.")] = "default",
    planner: Annotated[
        str | None, typer.Option(help="Who finds ways round, such as pso, ga, exact; pso if not given.")
    ] = None,
    jobs: Annotated[int | None, typer.Option(min=1, help="Processes; as many as cores if not given.")] = None,
    dask: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Scheduler of a Dask cluster that does the work.")
    ] = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Failing worlds are written there.")
    ] = Path("sidestep-stress"),
    as_json: Annotated[bool, typer.Option("--json", help="Print the rows as JSON and nothing else.")] = False,
) -> None:
    """Fly through many random worlds and count what happens.

    Exit codes: 0 every feasible world was flown safely; 1 some were not, and lie in DIR as scenarios that
    `sidestep fly` flies again; 2 bad input; 3 the aircraft model failed; 130 interrupted.
    """
    from scenarios.stress import rows, run, write_case  # noqa: PLC0415
    from scenarios.stress_options import campaign_of  # noqa: PLC0415
    from scenarios.stress_show import failures, progress, table  # noqa: PLC0415

    with expected_errors():
        campaign = campaign_of(kind, obstacles, runs, seed, vehicle, preset, planner, jobs, dask)
        outcomes, files = [], []
        for outcome in progress(run(campaign, jobs=jobs, dask=dask), campaign):
            outcomes.append(outcome)
            if outcome.failing:
                files.append((outcome, write_case(outcome, campaign, output)))
        found = rows(outcomes)
        if as_json:
            sys.stdout.write(json.dumps([row.as_json() for row in found], indent=2) + "\n")
        else:
            table(found, campaign)
            failures(files)
    raise typer.Exit(UNSAFE if files else OK)


def _fly_and_write(
    scenario: Scenario,
    parameters: Parameters,
    directory: Path,
    *,
    seed: int,
    avoidance: bool,
    as_json: bool,
) -> int:
    """Fly, judge, write, show; the exit code."""
    from scenarios.hangar import Hangar  # noqa: PLC0415
    from scenarios.record import summary_text, write_run  # noqa: PLC0415
    from scenarios.report import write_report  # noqa: PLC0415
    from scenarios.run import Flight  # noqa: PLC0415
    from scenarios.score import score  # noqa: PLC0415
    from scenarios.show import Progress, results  # noqa: PLC0415

    with stop_on_interrupt() as stop, Hangar(scenario, parameters) as hangar:
        flight = Flight(scenario, hangar, seed=seed, parameters=parameters, avoidance=avoidance)
        with Progress(scenario) as progress:
            for frame in flight:
                progress.update(frame, flight)
                if stop:
                    break
        flown = flight.result()
        judged = score(flown, hangar.energy())
    write_run(directory, flown, judged, write_report)
    if as_json:
        sys.stdout.write(summary_text(judged.summary))
    else:
        results(flown, judged, directory)
    if flown.ending == "interrupted":
        return INTERRUPTED
    return OK if judged.safe else UNSAFE


if __name__ == "__main__":
    main()
