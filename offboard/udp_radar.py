"""A `Radar` fed over UDP: one JSON object per line, from whatever sees obstacles (docs/offboard.md).

    {"id": 7, "latitude_deg": 14.5, "longitude_deg": 76.6, "relative_altitude_m": 200}
    {"id": 8, "range_m": 8200, "bearing_deg": 12.5, "safety_radius_m": 400}
    {"id": 9, "north_m": 9000, "east_m": 120, "velocity_north_m_s": -15, "velocity_east_m_s": 0}

The place is geodetic, or as seen from the vehicle (true bearing), or on the map about home. Altitude,
velocity, safety radius and `age_s` may be left out.
"""

from __future__ import annotations

import json
import math
import socket
from collections.abc import Callable, Mapping

from avoidance import Ownship, RadarScan
from offboard.errors import LinkError
from offboard.frames import MapFrame
from offboard.link import VehicleState
from offboard.sightings import Sighting, Sightings

KEEPS = 3.0
"""A report is used for so long [s]."""
LARGEST = 65536
"""Bytes of a datagram."""
AT_ONCE = 1000
"""Most datagrams read in one scan: who floods the port does not hold up the decision."""
PLACES = (("latitude_deg", "longitude_deg"), ("range_m", "bearing_deg"), ("north_m", "east_m"))
"""The ways to give a place."""


class UdpRadar:
    """Listens on a UDP port.

    Parameters
    ----------
    port : int
        Port on this machine; 0 takes a free one.
    frame : MapFrame
        The map.
    alarm : callable
        Called once with what is wrong with the first line that is not understood.

    Raises
    ------
    LinkError
        If the port cannot be had.
    """

    def __init__(self, port: int, frame: MapFrame, alarm: Callable[[str], None]) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.bind(("0.0.0.0", port))
        except (OSError, OverflowError) as error:
            self._socket.close()
            raise LinkError(f"UDP port {port} cannot be had: {error}") from error
        self._socket.setblocking(False)
        self.port: int = self._socket.getsockname()[1]
        self.refused = 0
        """Lines that were not understood."""
        self._frame = frame
        self._alarm = alarm
        self._seen = Sightings(KEEPS)

    def scan(self, state: VehicleState, now: float) -> RadarScan:  # noqa: ARG002
        """Everything that has been reported lately."""
        own = state.ownship
        for line in self._lines():
            try:
                self._seen.put(sighting_of(line, own, self._frame))
            except ValueError as error:
                self.refused += 1
                if self.refused == 1:
                    self._alarm(f"UDP port {self.port}: {error}; such lines are left out")
        return self._seen.scan(own.time)

    def close(self) -> None:
        """Close the port."""
        self._socket.close()

    def _lines(self) -> list[bytes]:
        found: list[bytes] = []
        for _ in range(AT_ONCE):
            try:
                data = self._socket.recv(LARGEST)
            except (BlockingIOError, InterruptedError):
                break
            except ConnectionError:  # so Windows tells that a sender has gone
                continue
            found += [line for line in data.splitlines() if line.strip()]
        return found


def sighting_of(line: bytes, own: Ownship, frame: MapFrame) -> Sighting:
    """The report in one line.

    Parameters
    ----------
    line : bytes
        A JSON object.
    own : Ownship
        The vehicle, from which ranges and bearings count.
    frame : MapFrame
        The map.

    Raises
    ------
    ValueError
        If it is not understood; says what is wrong.
    """
    try:
        row = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{line[:60]!r} is not JSON") from error
    if not isinstance(row, dict):
        raise ValueError(f"{line[:60]!r} is no object")
    identity = row.get("id")
    if isinstance(identity, bool) or not isinstance(identity, int) or not 0 <= identity < 2**31:
        raise ValueError(f"id = {identity}, must be a whole number from 0 to 2147483647")
    given = [keys for keys in PLACES if all(key in row for key in keys)]
    if len(given) != 1:
        ways = "; ".join(" and ".join(keys) for keys in PLACES)
        raise ValueError(f"id {identity}: exactly one of these must be given: {ways}")
    first, second = (_number(row, key) for key in given[0])
    if given[0][0] == "latitude_deg":
        north, east = frame.to_map(first, second)
    elif given[0][0] == "range_m":
        if first < 0.0:
            raise ValueError(f"range_m = {first:g}, must be 0 or more")
        bearing = math.radians(second)
        north, east = own.north + first * math.cos(bearing), own.east + first * math.sin(bearing)
    else:
        north, east = first, second
    radius = _number(row, "safety_radius_m") if row.get("safety_radius_m") is not None else None
    if radius is not None and radius <= 0.0:
        raise ValueError(f"safety_radius_m = {radius:g}, must be above 0")
    return Sighting(
        identity,
        north,
        east,
        _number(row, "relative_altitude_m", own.altitude),
        own.time - max(_number(row, "age_s", 0.0), 0.0),
        _number(row, "velocity_north_m_s", 0.0),
        _number(row, "velocity_east_m_s", 0.0),
        _number(row, "climb_rate_m_s", 0.0),
        radius,
    )


def _number(row: Mapping[str, object], key: str, otherwise: float | None = None) -> float:
    value = row.get(key, otherwise)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError(f"{key} = {value}, must be a number")
    return float(value)
