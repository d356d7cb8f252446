"""The example for a companion computer flies, against a simulated autopilot that a human starts."""

from __future__ import annotations

import importlib.util
import socket
import threading
from dataclasses import replace
from pathlib import Path

import pytest

from avoidance.parameters import DEFAULT
from offboard.sitl.autopilot import FLAVOURS
from offboard.sitl.transports import Exchange, Udp
from scenarios.fence import FenceArea
from scenarios.scenario import Point
from scenarios.sitl_run import serve
from scenarios.sitl_world import SitlWorld
from tests.offboard.live.kit import SMALL, Simulation

EXAMPLE = Path(__file__).parents[2] / "examples" / "companion.py"


LEFT_SHUT = replace(
    SMALL,
    geofence=(FenceArea(include=False, centre=(2400.0, -1400.0), radius=600.0),),
    rally=(Point(500.0, -500.0, 150.0),),
)
"""The shorter way, to the left, leads through a place that the geofence forbids."""


@pytest.mark.parametrize(("scenario", "side"), [(SMALL, "left"), (LEFT_SHUT, "right")])
def test_the_example_goes_round_what_the_vehicle_reports(scenario, side, capsys):
    spec = importlib.util.spec_from_file_location("companion", EXAMPLE)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    with SitlWorld(scenario, DEFAULT, FLAVOURS["px4"], scenario.fleet, retry=12.0) as world:
        simulation = Simulation(world)
        exchange = Exchange(simulation.autopilot, [Udp(0, [("127.0.0.1", port)])])
        simulation.send_start()
        over = threading.Event()
        arguments = (world, [exchange], 60.0, lambda *_: None, over.is_set)
        thread = threading.Thread(target=serve, args=arguments, daemon=True)
        thread.start()
        try:
            example.main(f"udpin://127.0.0.1:{port}")
        finally:
            over.set()
            thread.join(5.0)
            exchange.close()
    told = capsys.readouterr().out
    assert "obstacle 1 cuts the route" in told
    assert f"pass to the {side}" in told
    assert ("the geofence on board is kept to, 1 areas" in told) == bool(scenario.geofence)
    assert ("the rally points on board are used, 1 of them" in told) == bool(scenario.rally)
    assert "the last waypoint has been reached" in told


def test_the_example_is_short_enough_to_paste():
    code = [line for line in EXAMPLE.read_text().split('"""', 2)[2].splitlines() if line.strip()]
    assert len(code) <= 33
