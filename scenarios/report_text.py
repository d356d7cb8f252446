"""The report's words: verdict, key figures, legend and decision table as HTML fragments."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from html import escape
from typing import Any

from scenarios.report_data import Mark, Run
from scenarios.report_geometry import Encounter
from scenarios.scenario import VehicleSettings

NONE = "–"
"""Stands where a value has no meaning."""


def verdict(run: Run) -> tuple[str, str, str]:
    """Tone of the page ("safe", "entered", "unfinished"), the headline and the sentence below it."""
    summary = run.summary
    violations = summary.get("violations") or 0
    completed = bool(summary.get("completed"))
    ending = "completed the mission" if completed else "did not complete the mission"
    if violations:
        times = "once" if violations == 1 else f"{violations} times"
        headline = f"A safety sphere was entered {times}"
        tone = "entered"
    elif summary.get("fence_breaches"):
        headline, tone = "The geofence was left", "entered"
    else:
        headline, tone = ("Flown safely", "safe") if completed else ("Mission not completed", "unfinished")
    flown = (
        f"The aircraft flew {length(summary.get('path_length_m'))} in {clock(summary.get('flight_time_s'))}"
    )
    return tone, headline, f"{flown} and {ending}. {_nearest(run)}"


def _nearest(run: Run) -> str:
    summary = run.summary
    count = len(run.hazards)
    if not count:
        return "Nothing was in its way."
    among = "the only obstacle" if count == 1 else f"the nearest of {count} obstacles"
    closest, required = summary.get("min_separation_m"), summary.get("violation_radius_m")
    if closest is None:
        return f"{count} obstacle{'s' * (count > 1)} existed, and it met none."
    text = f"It passed {among} at {metres(closest)}"
    return f"{text}, where {metres(required)} must be kept." if required is not None else f"{text}."


def origin(run: Run) -> str:
    """What was flown, with what."""
    scenario, summary = run.scenario, run.summary
    wind, gusts = scenario.wind.speed, scenario.wind.turbulence
    parts = [
        f"Scenario “{scenario.name}”" + (f": {scenario.description}" if scenario.description else ""),
        f"{_aircraft(scenario.vehicle)} at {scenario.vehicle.airspeed:g} m/s",
        f"wind {wind:.1f} m/s" if wind else "no wind",
        *([f"{gusts} turbulence"] if gusts != "none" else []),
        f"preset {_value(summary.get('preset'))}",
        f"seed {_value(summary.get('seed'))}",
        f"Sidestep {_value(summary.get('version'))}",
    ]
    return " · ".join(parts)


def _aircraft(vehicle: VehicleSettings) -> str:
    """What flew, in words."""
    if vehicle.plant is not None:
        return f"an FMU of the user's own ({vehicle.plant.name})"
    return f"{vehicle.aircraft} ({vehicle.fidelity})"


def doubts(run: Run) -> str:
    """A warning if the files of the run do not agree with one another, else nothing."""
    if not run.disagreements:
        return ""
    items = "".join(f"<li>{escape(text)}</li>" for text in run.disagreements)
    return f'<div class="doubts" id="doubts"><p>The files of this run disagree:</p><ul>{items}</ul></div>'


def page_name(vehicle: str, number: int) -> str:
    """File of the page of one own vehicle; `number` counts from 0."""
    return "report.html" if number == 0 else f"report-{vehicle}.html"


def fleet_table(run: Run) -> str:
    """Where there are several own vehicles: what became of each, with a way to its page; else nothing."""
    if len(run.fleet) == 1:
        return ""
    rows = []
    for number, name in enumerate(run.fleet):
        s = run.summary.get("vehicles", {}).get(name, {})
        here = name == run.vehicle
        label = f"<strong>{escape(name)}</strong> (this page)" if here else escape(name)
        link = label if here else f'<a href="{escape(page_name(name, number))}">{label}</a>'
        cells = (
            "completed" if s.get("completed") else "not completed",
            _value(s.get("violations")),
            metres(s.get("min_separation_m")),
            length(s.get("path_length_m")),
            _value(s.get("replans")),
        )
        rows.append(f"<tr><td>{link}</td>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>")
    head = ("Vehicle", "Mission", "Entries", "Closest pass", "Path flown", "Changes of route")
    titles = "".join(f"<th>{title}</th>" for title in head)
    return (
        f'<section id="fleet"><h2>{len(run.fleet)} vehicles</h2><table><thead><tr>{titles}</tr></thead>'
        f"<tbody>{''.join(rows)}</tbody></table></section>"
    )


def key_figures(run: Run) -> str:
    """The cards below the verdict: name, value, what it means."""
    s = run.summary
    decision = s.get("decision_ms") or {}
    completed = s.get("completed")
    rows = (
        (
            "Mission",
            "completed" if completed else "not completed",
            "flown to its end, or to what stands for it",
        ),
        (
            "Entries into a sphere",
            _value(s.get("violations")),
            "must be 0; a sphere is the space round an obstacle",
        ),
        ("Closest pass", metres(s.get("min_separation_m")), _closest_note(s)),
        (
            "Least margin",
            metres(s.get("min_margin_m")),
            "distance left to a sphere at the tightest moment; below 0 is inside",
        ),
        ("Path flown", length(s.get("path_length_m")), "along the track over ground"),
        ("Shortest safe path", length(s.get("optimum_length_m")), _optimum_note(s)),
        (
            "Planned length",
            length(s.get("plan_length_m")),
            "straight from waypoint to waypoint, as finally flown",
        ),
        ("Flight time", clock(s.get("flight_time_s")), "simulated"),
        ("Changes of route", _value(s.get("replans")), "made in flight because of what the radar showed"),
        (
            "Waypoints replaced",
            _value(s.get("waypoints_replaced")),
            "mission points that lie where nothing may fly",
        ),
        (
            "Time per decision",
            milliseconds(decision.get("median")),
            _timing_note(decision),
        ),
        (
            "Computing time",
            seconds(s.get("wall_s")),
            f"{_value(s.get('real_time_factor'), '{:,.0f}')} times faster than real time",
        ),
    )
    return "\n".join(
        f'<div><dt>{name}</dt><dd><div class="value">{escape(value)}</div>'
        f'<div class="note">{escape(note)}</div></dd></div>'
        for name, value, note in rows
    )


def _timing_note(decision: Mapping[str, Any]) -> str:
    if decision.get("median") is None:
        return "no decision was taken"
    return f"median; 99 of 100 within {milliseconds(decision.get('p99'))}"


def _closest_note(summary: Mapping[str, Any]) -> str:
    if summary.get("min_separation_m") is None:
        return "to any obstacle; there was none to pass"
    kept = metres(summary.get("violation_radius_m"))
    return f"to obstacle {_value(summary.get('closest_obstacle'))}, from which {kept} must be kept"


def _optimum_note(summary: Mapping[str, Any]) -> str:
    flown, optimum = summary.get("path_length_m"), summary.get("optimum_length_m")
    if not flown or not optimum:
        return "with everything known beforehand"
    share = 100.0 * (flown / optimum - 1.0)
    if share >= 0.0:
        return f"with everything known beforehand; flown is {share:.2f} % longer"
    return (
        f"with everything known beforehand; flown is {-share:.2f} % shorter, since waypoints count as "
        "reached from some way off and corners are cut"
    )


def encounter_title(group: Encounter) -> tuple[str, str]:
    """Heading and one line of text for a close-up."""
    span = clock_of_day(group.start)
    if group.end - group.start >= 60.0:
        span += f" to {clock_of_day(group.end)}"
    names = [str(i) for i in sorted(p.hazard.id for p in group.passes)]
    who = (
        f"{'obstacle' if len(names) == 1 else 'obstacles'} {_listed(names)}" if names else "a change of route"
    )
    tightest = group.tightest
    if tightest is None:
        return f"{span}: {who}", _taken(group)
    kept = f"passed at {metres(tightest.distance)}, {metres(tightest.hazard.radius)} must be kept"
    return f"{span}: {who}", f"{'ENTERED: ' if tightest.margin < 0.0 else ''}{kept}. {_taken(group)}"


def _taken(group: Encounter) -> str:
    numbers = [str(mark.number) for mark in group.decisions]
    if not numbers:
        return "No decision was taken."
    return f"Decision{'s' * (len(numbers) > 1)} {_listed(numbers)}."


def _listed(names: list[str]) -> str:
    if len(names) > 6:
        return f"{', '.join(names[:5])} and {len(names) - 5} more"
    return " and ".join(filter(None, [", ".join(names[:-1]), names[-1]]))


COLUMNS = (
    ("#", "", "n"),
    ("Time", "h:min:s", "t"),
    ("Where", "north, east [km]", "n"),
    ("Decision", "", "t"),
    ("Why", "", "why"),
    ("New waypoint", "north, east [km]", "n"),
    ("Cost", "0.1 × length + 0.9 × risk", "n"),
    ("Gap", "of the search to the best waypoint", "n"),
    ("Route", "× shortest", "n"),
    ("Took", "[ms]", "n"),
)


def decision_table(run: Run) -> str:
    """All lines of decisions.jsonl as a table."""
    if not run.decisions:
        return "<p>No decision was taken: nothing was in the way, or avoidance was off.</p>"
    head = "".join(f'<th class="{css}">{name}<small>{unit}</small></th>' for name, unit, css in COLUMNS)
    body = "\n".join(_row(mark) for mark in run.decisions)
    text = (
        "Every decision that had a threat or changed the route. <em>Gap</em> is what the waypoint found "
        "costs beyond the best one there is, as a share of what a detour must cost anyway: 0 is the best "
        "possible. <em>Route</em> is the length of the new route over that of the shortest way round."
    )
    return (
        f'<p>{text}</p>\n<div class="scroll"><table id="decision-table"><thead><tr>{head}</tr></thead>'
        f"<tbody>\n{body}\n</tbody></table></div>"
    )


def _row(mark: Mark) -> str:
    row = mark.row
    cells = (
        str(mark.number),
        clock_of_day(mark.time),
        _kilometres([(mark.north, mark.east)]),
        escape(_value(row.get("decision"))),
        escape(_value(row.get("why"))),
        _kilometres(mark.waypoints),
        _value(row.get("cost"), "{:,.1f}"),
        _value(row.get("search_gap"), "{:.4f}"),
        _value(row.get("length_to_optimum"), "{:.5f}"),
        _value(row.get("decision_ms"), "{:.1f}"),
    )
    tds = "".join(f'<td class="{css}">{cell}</td>' for cell, (_, _, css) in zip(cells, COLUMNS, strict=True))
    return f'<tr data-decision="{mark.number}">{tds}</tr>'


def _kilometres(points: Iterable[tuple[float, float]]) -> str:
    return "<br>".join(f"{north / 1e3:,.3f}, {east / 1e3:,.3f}" for north, east in points) or NONE


def _value(value: object, pattern: str = "{}") -> str:
    """A value as text, a dash for null."""
    return NONE if value is None else pattern.format(value)


def metres(value: float | None) -> str:
    """A distance to a tenth of a metre below 100 m, else to whole metres."""
    if value is None:
        return NONE
    return f"{value:,.1f} m" if abs(value) < 100.0 else f"{value:,.0f} m"


def length(value: float | None) -> str:
    """A length in kilometres, to the metre."""
    return NONE if value is None else f"{value / 1e3:,.3f} km"


def seconds(value: float | None) -> str:
    """A duration in seconds."""
    return NONE if value is None else f"{value:,.1f} s"


def milliseconds(value: float | None) -> str:
    """A duration in milliseconds."""
    return NONE if value is None else f"{value:,.1f} ms"


def clock(value: float | None) -> str:
    """A duration in hours and minutes, in seconds below two minutes."""
    if value is None:
        return NONE
    if value < 120.0:
        return f"{value:.0f} s"
    hours, minutes = divmod(round(value / 60.0), 60)
    return f"{hours} h {minutes:02d} min" if hours else f"{minutes} min"


def clock_of_day(value: float) -> str:
    """A time since the start as h:min:s."""
    whole = int(value)
    return f"{whole // 3600}:{whole // 60 % 60:02d}:{whole % 60:02d}"
