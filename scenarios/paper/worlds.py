"""The flights behind the tables and figures: which world, which planner, which preset."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import as_file, files

from avoidance.parameters import Parameters
from scenarios.compare_flight import Job
from scenarios.load import load
from scenarios.paper.published import ListRow, published
from scenarios.planners import planned_by
from scenarios.run import prepare, preset
from scenarios.scenario import Fidelity, Point, Scenario, Traffic

PAPER_PLANNERS = ("pso", "theta-mafoa", "ga", "sa")
"""Those of Tables 4 to 6, in the order of Table 5."""
RUNS = 10
"""Runs of each row, as in the paper."""
SCENES = {
    "fig17": "four",
    "fig18": "four",
    "fig19": "hill",
    "fig20": "fig20",
    "fig21": "fig21",
    "fig22": "fig22",
    "fig23": "unsafe-waypoint",
    "fig27": "head-on",
    "fig28-left": "from-left",
    "fig28-right": "from-right",
}
"""Scenario of each figure: from the catalogue, or of this package."""
INTRUDERS = (
    Traffic(9001, (Point(350_000.0, 20_000.0, 200.0), Point(200_000.0, 15_000.0, 200.0)), starts_at=15_000.0),
    Traffic(9002, (Point(160_000.0, 30_000.0, 200.0), Point(160_000.0, -10_000.0, 200.0)), starts_at=9_690.0),
)
"""Two aircraft for "40 discrete & 2 moving obstacles": head-on along leg 5; from the right across leg 4."""


@dataclass(frozen=True, slots=True)
class Options:
    """What the command was asked for."""

    preset: str = "default"
    """Rules of the avoidance core."""
    planner: str | None = None
    """Flies Table 3 and the figures in PSO's place, and is a row more in Tables 4 to 7."""
    runs: int = RUNS
    """Runs of each row."""
    fidelity: Fidelity = "6dof"
    """Equations of motion of the FMU."""

    @property
    def own(self) -> str:
        """The planner of Table 3 and the figures."""
        return self.planner or "pso"

    @property
    def planners(self) -> tuple[str, ...]:
        """Rows of Tables 5 and 6."""
        return with_more(PAPER_PLANNERS, self.planner)

    @property
    def parameters(self) -> Parameters:
        """The preset."""
        return preset(self.preset)


def with_more(names: Sequence[str], more: str | None) -> tuple[str, ...]:
    """Names, and one more unless it is among them."""
    return tuple(dict.fromkeys((*names, more) if more else names))


def field_job(options: Options, row: str, index: int, planner: str) -> Job:
    """Run `index` of a row of Table 3: "40", "40+hill", "40+moving".

    The world is the one that `sidestep fly random --obstacles N --seed INDEX` flies.
    """
    return _job(options, f"field-{row.replace('+', '')}-{index}", _field(row, index), planner)


@cache
def _field(row: str, index: int) -> Scenario:
    """World `index` of a row."""
    count, _, more = row.partition("+")
    scenario = _loaded("random")
    if more == "hill":
        hill = _loaded("hill").obstacles
        scenario = replace(scenario, obstacles=tuple(replace(o, id=9000 + o.id) for o in hill))
    elif more == "moving":
        scenario = replace(scenario, traffic=INTRUDERS)
    return replace(prepare(scenario, index, obstacles=int(count)), seed=index)


def table4_job(options: Options, planner: str) -> Job:
    """Table 4's world, flown by a planner from what the radar shows at 10 km."""
    return _job(options, "table4", _loaded("table4"), planner)


def published_job(options: Options, row: ListRow) -> Job:
    """A published waypoint list, flown as it is."""
    scenario = _loaded("table4")
    height = {point[:2]: point[2] for point in published().mission}
    mission = tuple(Point(x, y, height.get((x, y), 200.0)) for x, y in row.waypoints)
    world = replace(scenario, mission=mission)
    return _job(options, f"published-{row.planner}", world, "pso", avoidance=False)


def scene_job(options: Options, figure: str, *, avoidance: bool = True) -> Job:
    """The scene of a figure."""
    name = f"{figure}{'' if avoidance else '-without'}"
    return _job(options, name, scene(SCENES[figure]), options.own, avoidance=avoidance)


def scene(name: str) -> Scenario:
    """A scenario of this package, or else of the catalogue."""
    place = files("scenarios.paper") / "scenes" / f"{name}.toml"
    if not place.is_file():
        return load(name)
    with as_file(place) as path:
        return load(path)


@cache
def _loaded(name: str) -> Scenario:
    """A scenario of the catalogue, read once."""
    return load(name)


def _job(options: Options, name: str, scenario: Scenario, planner: str, *, avoidance: bool = True) -> Job:
    parameters = planned_by(options.parameters, planner)
    vehicle = replace(scenario.vehicle, fidelity=options.fidelity)
    world = replace(scenario, vehicle=vehicle, preset=parameters.name, planner=planner)
    label = f"{name}-{planner if avoidance else 'none'}-{parameters.name}-{options.fidelity}"
    return Job(label, world, parameters, avoidance)
