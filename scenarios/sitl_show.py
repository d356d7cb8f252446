"""What `sidestep sitl` shows on the terminal."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Self

from offboard.sitl.aircraft import Phase

if TYPE_CHECKING:
    from offboard.sitl.autopilot import Autopilot
    from offboard.sitl.transports import Exchange
    from scenarios.sitl_run import Ports
    from scenarios.sitl_world import SitlWorld


def greeting(world: SitlWorld, ports: Sequence[Ports], speed: float) -> None:
    """Who is there and how to connect."""
    first = next(iter(world.autopilots.values()))
    where = (
        "on the ground at home" if first.aircraft.starts_on_ground else f"in scenario {world.scenario.name}"
    )
    count = len(ports)
    what = "1 vehicle" if count == 1 else f"{count} vehicles"
    print(f"{what}, {first.flavour.name} behaviour, {where}, {speed:g} times real time")
    for each in ports:
        tcp = f"; TCP server {each.tcp}" if each.tcp else ""
        print(f"  system {each.system_id}: sends to UDP {each.target} and 14550; UDP server {each.udp}{tcp}")
    one = ports[0]
    print(f"  MAVSDK, Sidestep  udpin://127.0.0.1:{one.target}")
    print(f"  MAVProxy          mavproxy.py --master=udp:127.0.0.1:{one.target}")
    print("  QGroundControl    connects by itself")
    print("Ctrl-C ends it.", flush=True)


class StatusLine:
    """One line that is written over and over on a terminal; a context manager. Silent elsewhere.

    Parameters
    ----------
    world : SitlWorld
        What is shown.
    exchanges : sequence of Exchange
        Whose peers are counted.
    """

    def __init__(self, world: SitlWorld, exchanges: Sequence[Exchange]) -> None:
        self._world = world
        self._exchanges = exchanges
        self._width = 0
        self._live = sys.stdout.isatty()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._live and self._width:
            print()

    def update(self, time: float, speed: float) -> None:
        """Show the state at a simulated time [s], at so many times real time."""
        if not self._live:
            return
        heard = sum(exchange.heard for exchange in self._exchanges)
        minutes, seconds = divmod(int(time), 60)
        parts = [f"{minutes // 60}:{minutes % 60:02}:{seconds:02} ×{speed:.1f}"]
        parts += [status_of(each) for each in list(self._world.autopilots.values())[:3]]
        if len(self._world.autopilots) > 3:
            parts.append("…")
        parts.append("nobody connected" if not heard else f"{heard} connected")
        text = " | ".join(parts)
        print("\r" + text.ljust(self._width), end="", flush=True)
        self._width = len(text)


def status_of(autopilot: Autopilot) -> str:
    """One vehicle in a few words."""
    captain, aircraft = autopilot.captain, autopilot.aircraft
    state = aircraft.ownship()
    phase = {Phase.HELD: "not launched", Phase.LANDED: "landed"}.get(aircraft.phase)
    if phase is None:
        phase = f"{state.altitude:.0f} m {state.ground_speed:.1f} m/s"
    armed = "armed" if captain.armed else "disarmed"
    item = f"item {captain.current} of {len(captain.items)}" if captain.total else "no mission"
    return f"{captain.mode.name} {armed}, {item}, {phase}"
