"""What `scenarios.hangar` promises of the vehicle, measured: `python benchmarks/vehicle_limits.py`.

Prints a Markdown table: how far the flight strays from a leg that counts as captured, after changes of course
of every size, and how far the flight into a tight orbit and round it leaves the disc about its centre that
holds it as planned (`avoidance.orbits.orbit_reach` adds two tracking errors to that).
"""

from __future__ import annotations

import argparse
import math
from dataclasses import replace

import numpy as np

from avoidance import Hold, Resume, Waypoint
from avoidance.orbits import SIDES, TIGHT, orbit_centres, roll_in
from avoidance.parameters import DEFAULT
from scenarios.hangar import Hangar
from scenarios.load import load
from scenarios.scenario import FIDELITIES, TURBULENCES, Point, Scenario, Wind

STEP = 0.1
"""Spacing of the track [s]."""
LEG = 1500.0
"""Length of a leg [m]."""
BEARINGS = np.radians([0.0, 45.0, 90.0, 180.0, 225.0, 270.0])
"""Where the wind blows to [rad]."""


def zigzag(legs: int) -> tuple[Point, ...]:
    """A mission with changes of course of every size, up to a reversal."""
    rng, course, north, east = np.random.default_rng(0), 0.0, 0.0, 0.0
    points = [Point(north, east, 200.0)]
    for _ in range(legs):
        north, east = north + LEG * math.cos(course), east + LEG * math.sin(course)
        points.append(Point(north, east, 200.0))
        course += float(rng.uniform(-math.pi, math.pi))
    return tuple(points)


def strayed(scenario: Scenario, seconds: float) -> tuple[float, float]:
    """Largest distance from a leg that counts as captured, and what is promised [m]."""
    worst = 0.0
    with Hangar(scenario, DEFAULT) as hangar:
        vehicle = hangar.own_vehicle()
        for _ in range(round(seconds / STEP)):
            vehicle.advance(STEP)
            own, route = vehicle.state().ownship, vehicle.route()
            begin, end = route.origin, route.waypoints[0]
            north, east = end.north - begin.north, end.east - begin.east
            length = math.hypot(north, east)
            off_north, off_east = own.north - begin.north, own.east - begin.east
            along = (off_north * north + off_east * east) / length
            if vehicle.performance.capture_distance <= along <= length:
                worst = max(worst, abs(north * off_east - east * off_north) / length)
    return worst, vehicle.performance.tracking_error


def overshot(scenario: Scenario, orbits: int) -> float:
    """How far flights into tight orbits and round them leave the disc that holds them as planned [m]."""
    rng, worst = np.random.default_rng(1), -math.inf
    slowest = scenario.vehicle.airspeed - math.hypot(scenario.wind.north, scenario.wind.east)
    with Hangar(scenario, DEFAULT) as hangar:
        vehicle = hangar.own_vehicle()
        radius = TIGHT * vehicle.performance.turn_radius
        planned = math.hypot(radius, roll_in(vehicle.performance))
        for number in range(orbits):
            vehicle.advance(float(rng.integers(5, 50)))
            own, route, side = vehicle.state().ownship, vehicle.route(), number % 2
            here, course = np.array([[own.north, own.east]]), np.array([own.course])
            north, east = orbit_centres(here, course, vehicle.performance)[0, side].tolist()
            centre = Waypoint(north, east, own.altitude)
            vehicle.begin(Hold(why="", centre=centre, radius=radius, direction=int(SIDES[side])))
            for _ in range(round(math.tau * radius / slowest / STEP)):
                vehicle.advance(STEP)
                own = vehicle.state().ownship
                worst = max(worst, math.dist((own.north, own.east), (north, east)) - planned)
            vehicle.begin(Resume(why="", route=route.waypoints))
    return worst


def main() -> None:
    """Print one row for each fidelity, wind and turbulence."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=6000.0, help="flown on legs per row (%(default)s)")
    parser.add_argument("--orbits", type=int, default=60, help="flown per row (%(default)s)")
    parser.add_argument("--winds", type=float, nargs="+", default=[0.0, 8.0], help="[m/s] (%(default)s)")
    parser.add_argument("--airspeed", type=float, default=15.0, help="[m/s] (%(default)s)")
    parser.add_argument("--acceptance-radius", type=float, default=20.0, help="[m] (%(default)s)")
    options = parser.parse_args()
    clear = load("clear")
    mission = zigzag(math.ceil(options.seconds * options.airspeed / LEG))
    head = (
        "fidelity",
        "wind [m/s]",
        "turbulence",
        "from a captured leg [m]",
        "promised [m]",
        "beyond the disc [m]",
    )
    print(f"| {' | '.join(head)} |\n{'|---' * len(head)}|")
    for fidelity in FIDELITIES.values():
        vehicle = replace(
            clear.vehicle,
            fidelity=fidelity,
            airspeed=options.airspeed,
            acceptance_radius=options.acceptance_radius,
        )
        for speed in options.winds:
            bearings = BEARINGS if speed > 0.0 else BEARINGS[:1]
            for turbulence in TURBULENCES.values():
                winds = [Wind(speed * math.cos(b), speed * math.sin(b), turbulence) for b in bearings]
                flights = [replace(clear, mission=mission, wind=wind, vehicle=vehicle) for wind in winds]
                astray, promised = max(strayed(flight, options.seconds / len(flights)) for flight in flights)
                beyond = max(overshot(flight, options.orbits // len(flights)) for flight in flights)
                print(
                    f"| {fidelity} | {speed:g} | {turbulence} | {astray:.1f} | {promised:g} | {beyond:.1f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
