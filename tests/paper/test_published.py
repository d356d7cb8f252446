"""The published figures agree with the transcription, where that lies beside the repository."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from scenarios.paper.published import published

SHARED = Path(__file__).parents[3] / "shared" / "paper"
NAMES = {"PSO": "pso", "GA": "ga", "SA": "sa", "theta-MAFOA": "theta-mafoa", "GCPSO": "gcpso", "MPSO": "mpso"}

beside = pytest.mark.skipif(
    not SHARED.is_dir(), reason="the transcription does not lie beside the repository"
)


def rows(name: str) -> list[dict[str, str]]:
    with (SHARED / name).open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_everything_is_there() -> None:
    paper = published()
    assert [len(t) for t in (paper.mission, paper.obstacles, paper.table3, paper.table4)] == [8, 5, 14, 4]
    assert [len(paper.table6), len(paper.table7)] == [16, 6]
    assert [len(row.waypoints) for row in paper.table4] == [10, 11, 10, 10]


@beside
def test_table_3() -> None:
    for row, told in zip(published().table3, rows("table3.csv"), strict=True):
        assert row.flight_min == float(told["flight_time_min"])
        assert row.path_length_m == float(told["path_length_m"])
        assert row.algorithm_s == (float(told["algo_time_s"]) if told["algo_time_s"] else None)


@beside
def test_table_4() -> None:
    told = rows("table4.csv")
    for row in published().table4:
        mine = [r for r in told if NAMES[r["planner"]] == row.planner]
        assert list(row.waypoints) == [(float(r["x_m"]), float(r["y_m"])) for r in mine]
        assert (row.length_m, row.time_s) == (float(mine[0]["published_length_m"]), float(mine[0]["time_s"]))


@beside
def test_tables_6_and_7() -> None:
    for row, told in zip(published().table6, rows("table6.csv"), strict=True):
        assert (row.obstacles, row.planner) == (int(told["n_obstacles"]), NAMES[told["planner"]])
        assert [row.plr, row.time_s, row.cs, row.successes] == [
            float(told[key]) for key in ("PLR", "TC_s", "CS_iter", "SR_of_10")
        ]
    for fitness, told in zip(published().table7, rows("table7.csv"), strict=True):
        assert fitness.planner == NAMES[told["algorithm"]]
        assert [fitness.mean, fitness.median] == [float(told["mean_fitness"]), float(told["median_fitness"])]
