"""Table 4 and Figs. 29 to 32: the planners on two obstacles, and the published lists measured again."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from scenarios.compare_flight import Job, Record
from scenarios.compare_maps import course_map, list_map
from scenarios.outside import OUTSIDE, installed
from scenarios.paper.measures import Measure, measure
from scenarios.paper.published import ListRow, published
from scenarios.paper.searches import full_knowledge_bound
from scenarios.paper.section import Cell, Grid, Head, Plot, Section, number
from scenarios.paper.words import words
from scenarios.paper.worlds import Options, published_job, table4_job, with_more
from scenarios.planners import PLANNERS

OURS = ("pso", "gcpso", "mpso", "ga", "sa", "theta-mafoa", "exact")
"""Always flown; those of other people's making as well where they are installed."""
FIGURES = {"fig29": "ga", "fig30": "sa", "fig31": "theta-mafoa", "fig32": "pso"}
"""Whose path each figure shows."""
CLOSE_UPS = {
    "obstacle 2": (126_500.0, 143_500.0, 8_500.0, 17_000.0),
    "obstacles 3 to 5": (281_500.0, 298_500.0, 13_500.0, 22_000.0),
}


def planners(options: Options) -> tuple[str, ...]:
    """Who flies."""
    outside = tuple(name for name in OUTSIDE if installed(name))
    return with_more((*OURS, *outside), options.planner)


def jobs(options: Options) -> list[Job]:
    """All flights of the table."""
    flights = [table4_job(options, planner) for planner in planners(options)]
    return [*flights, *(published_job(options, row) for row in published().table4)]


def section(options: Options, records: Mapping[str, Record]) -> Section:
    """The table, ours beside the paper's, and the lists on the map."""
    rows = [_ours(name, records[table4_job(options, name).name]) for name in planners(options)]
    rows += [_published(row, records[published_job(options, row).name]) for row in published().table4]
    heads = (
        Head("planner", left=True),
        Head("whose", left=True),
        Head("printed", "paper's length [m]"),
        Head("plan", "length measured [m]", ours=True),
        Head("flown", "on the FMU [m]", ours=True),
        Head("clearance", "plan, nearest obstacle; 1,000 needed [m]", ours=True),
        Head("flown margin", "outside the nearest sphere [m]", ours=True),
        Head("time", "paper's, or our decisions' [s]"),
        Head("constraints broken", "as printed, Eqs. 7–12", left=True, ours=True),
    )
    lines = tuple(_line(row) for row in rows)
    missing = [name for name in OUTSIDE if not installed(name)]
    skipped = f" Not installed here: {', '.join(missing)} (pip install 'sidestep[bench]')." if missing else ""
    text = words(
        "table4",
        fidelity=options.fidelity,
        preset=options.preset,
        skipped=skipped,
        optimum=f"{records[table4_job(options, 'pso').name]['summary']['optimum_length_m']:,.1f}",
        bound=f"{full_knowledge_bound(options.parameters):,.1f}",
    )
    plots = _plots(options, records)
    return Section("table4", text.title, text.intro, (Grid(heads, lines),), plots, text.remarks, rows)


def figure_section(name: str, options: Options, records: Mapping[str, Record]) -> Section:
    """Fig. 29, 30, 31 or 32: one planner's path, the published list beside it."""
    planner = FIGURES[name]
    record = records[table4_job(options, planner).name]
    (row,) = (row for row in published().table4 if row.planner == planner)
    ours, theirs = measure(record["plan"]), measure(row.waypoints)
    plots = [Plot(f"{name}-all", "The whole path", course_map({"ours, flown": record}))]
    for place, window in CLOSE_UPS.items():
        figure = course_map({"ours, flown": record}, window=window)
        printed = list_map({"published list": row.waypoints}, record["obstacles"], window=window)
        figure["data"] += [t for t in printed["data"] if t["meta"]["role"] == "flown"]
        figure["data"][-1]["line"] = {"color": "#a0427f", "dash": "dash", "width": 2.0}
        plots.append(Plot(f"{name}-{place.replace(' ', '-')}", f"At {place}, to scale", figure))
    told = (
        f"Ours: plan {ours.length:,.1f} m, constraints broken: {ours.details}. Published list, measured "
        f"again: {theirs.length:,.1f} m, constraints broken: {theirs.details}."
    )
    text = words(name, text=told)
    data = {"planner": planner, "ours": _measured(ours), "published": _measured(theirs)}
    return Section(name, text.title, text.intro, (), tuple(plots), text.remarks, data, wide=False)


def _ours(planner: str, record: Record) -> dict[str, Any]:
    found = measure(record["plan"])
    return _row(planner, "ours", found, record) | {"time_s": round(record["algorithm_s"], 3)}


def _published(row: ListRow, record: Record) -> dict[str, Any]:
    found = measure(row.waypoints)
    extra = {"time_s": row.time_s, "printed_length_m": row.length_m}
    return _row(row.planner, "published", found, record) | extra


def _row(planner: str, source: str, found: Measure, record: Record) -> dict[str, Any]:
    summary = record["summary"]
    return {
        "planner": planner,
        "source": source,
        "plan_length_m": round(found.length, 2),
        "flown_length_m": summary["path_length_m"],
        "min_clearance_m": round(found.clearance, 2),
        "constraints_broken": list(found.broken),
        "time_s": None,
        "details": found.details,
        "flown_margin_m": summary["min_margin_m"],
        "flown_safely": record["safe"],
        "waypoints": record["plan"],
    }


def _measured(found: Measure) -> dict[str, Any]:
    return {
        "plan_length_m": round(found.length, 2),
        "min_clearance_m": round(found.clearance, 2),
        "constraints_broken": list(found.broken),
    }


def _line(row: Mapping[str, Any]) -> tuple[str | Cell, ...]:
    broken = row["constraints_broken"]
    routes = row["planner"] in ("exact", "ompl-rrtstar", "ompl-bitstar")
    note = " (routes need not keep g1, g2)" if routes and set(broken) <= {"g1", "g2"} and broken else ""
    look = "" if note else "bad" if broken else "good"
    return (
        PLANNERS[row["planner"]].replace(" (our reading)", "")
        if row["source"] == "published"
        else PLANNERS[row["planner"]],
        row["source"],
        number(row.get("printed_length_m")),
        number(row["plan_length_m"], ",.1f"),
        number(row["flown_length_m"], ",.1f"),
        number(row["min_clearance_m"], ",.1f"),
        Cell(number(row["flown_margin_m"], ",.1f"), "" if row["flown_margin_m"] >= 0.0 else "bad"),
        number(row["time_s"], ".2f"),
        Cell(f"{row['details']}{note}", look),
    )


def _plots(options: Options, records: Mapping[str, Record]) -> tuple[Plot, ...]:
    flown = records[table4_job(options, options.own).name]
    lists = {f"published {PLANNERS[row.planner].split(' (')[0]}": row.waypoints for row in published().table4}
    plots = []
    for place, window in CLOSE_UPS.items():
        figure = course_map({f"ours, {options.own.upper()}, flown": flown}, window=window)
        figure["data"] += [
            {**trace, "line": {**trace["line"], "color": colour, "width": 1.8}}
            for trace, colour in zip(
                [t for t in list_map(lists, [])["data"] if t["meta"]["role"] == "flown"],
                ("#d55e00", "#8a6d00", "#a0427f", "#111111"),
                strict=True,
            )
        ]
        plots.append(Plot(f"table4-{place.replace(' ', '-')}", f"At {place}, to scale", figure))
    return tuple(plots)
