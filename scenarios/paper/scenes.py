"""Figs. 17 to 23 and 26 to 28: flights through scenes that show what the paper's text says."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from scenarios.compare_flight import Job, Record
from scenarios.compare_maps import course_map
from scenarios.paper.section import Plot, Section, number
from scenarios.paper.words import words
from scenarios.paper.worlds import Options, field_job, scene_job

Window = tuple[float, float, float, float]

WINDOWS: dict[str, dict[str, Window]] = {
    "fig17": {
        "Obstacle 1, to scale": (124e3, 144e3, 7e3, 17e3),
        "Obstacles 2 to 4, to scale": (279e3, 299e3, 13e3, 23e3),
    },
    "fig18": {
        "Obstacle 1, to scale": (124e3, 144e3, 7e3, 17e3),
        "Obstacles 2 to 4, to scale": (279e3, 299e3, 13e3, 23e3),
    },
    "fig19": {"The hill, to scale": (136e3, 164e3, 6e3, 20e3)},
    "fig20": {"The obstacle, to scale": (0.0, 22e3, -5e3, 6e3)},
    "fig21": {"Obstacle 2, to scale": (29e3, 51e3, -2e3, 9e3), "Obstacle 4": (45e3, 67e3, 0.0, 11e3)},
    "fig22": {"Obstacles 2 and 3, to scale": (29e3, 51e3, -2e3, 9e3), "Obstacle 4": (45e3, 67e3, 0.0, 11e3)},
    "fig23": {"The waypoint, to scale": (13e3, 27e3, -3e3, 4e3)},
}
"""Close-ups of each figure by caption: x from, x to, y from, y to [m]."""
MOVING = ("fig27", "fig28")


def jobs(name: str, options: Options) -> list[Job]:
    """The flights behind a figure."""
    if name == "fig26":
        return [field_job(options, "40", 0, options.own)]
    if name == "fig17":
        return [scene_job(options, name, avoidance=False)]
    if name in MOVING:
        scenes = [name] if name == "fig27" else ["fig28-left", "fig28-right"]
        return [scene_job(options, scene, avoidance=avoid) for scene in scenes for avoid in (True, False)]
    return [scene_job(options, name)]


def section(name: str, options: Options, records: Mapping[str, Record]) -> Section:
    """A figure with its words."""
    flown = {job.name: records[job.name] for job in jobs(name, options)}
    if name in MOVING:
        return _moving(name, flown)
    (record,) = flown.values()
    summary = record["summary"]
    ratio = summary["path_length_m"] / (summary["optimum_length_m"] or summary["path_length_m"])
    text = words(
        name,
        violations=summary["violations"],
        margin=number(summary["min_margin_m"], ",.1f"),
        changes=summary["replans"],
        ratio=f"{ratio:.4f}",
    )
    label = {"flown": record}
    plots = [Plot(f"{name}-all", "Everything; x and y have their own scales", course_map(label))]
    for number_, (caption, window) in enumerate(WINDOWS.get(name, {}).items()):
        plots.append(Plot(f"{name}-{number_}", caption, course_map(label, window=window)))
    return Section(
        name, text.title, text.intro, (), tuple(plots), text.remarks, _data(record), wide=len(plots) == 1
    )


def _moving(name: str, flown: Mapping[str, Record]) -> Section:
    """Without and with avoidance, side by side, as Fig. 27 (a) and (b) are."""
    seen = list(flown.values())
    least = [number(record["summary"]["min_separation_m"]) for record in seen]
    if name == "fig27":
        text = words(name, separation=least[0], without=least[1])
        captions = ["With avoidance, to scale", "Without"]
    else:
        text = words(name, left=least[0], left_without=least[1], right=least[2], right_without=least[3])
        captions = [
            "From the left, to scale",
            "Without avoidance",
            "From the right, to scale",
            "Without avoidance",
        ]
    plots = []
    for index, (caption, record) in enumerate(zip(captions, seen, strict=True)):
        window = (12e3, 28e3, -4e3, 4e3)
        figure = course_map({"flown": record}, window=window)
        plots.append(Plot(f"{name}-{index}", caption, figure))
    data = [_data(record) for record in seen]
    return Section(name, text.title, text.intro, (), tuple(plots), text.remarks, data)


def _data(record: Record) -> dict[str, Any]:
    """What `--json` prints of a flight."""
    kept = ("violations", "min_separation_m", "min_margin_m", "path_length_m", "plan_length_m", "replans")
    return {key: record["summary"][key] for key in kept} | {
        "planner": record["planner"],
        "preset": record["preset"],
        "plan": np.round(np.array(record["plan"])[:, :2], 1).tolist(),
        "why": [change["why"] for change in record["changes"]],
    }
