"""Positions of a scenario file → points on the map."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from offboard.frames import MapFrame
from scenarios.errors import Problem
from scenarios.scenario import Point
from scenarios.schema import MAP_LIMIT, HomeTable, PlaceTable, PositionTable


class Places:
    """Puts positions on the map about home, and notes those that lie beyond it in `problems`."""

    def __init__(self, home: HomeTable) -> None:
        self._frame = MapFrame(home.latitude_deg, home.longitude_deg, home.altitude_m)
        self.problems: list[Problem] = []

    def points(
        self, tables: Sequence[PositionTable], altitude: float, key: Callable[[int], str]
    ) -> list[Point]:
        """Map points, NaN for a position beyond the map.

        Parameters
        ----------
        tables : sequence of PositionTable
            Validated.
        altitude : float
            For those that give none [m].
        key : callable
            How messages name the position with that index.
        """
        points = []
        for index, table in enumerate(tables):
            north, east = self.place(table, key(index))
            height = altitude if table.altitude_m is None else table.altitude_m
            points.append(Point(north, east, height, getattr(table, "speed_m_s", None)))
        return points

    def place(self, table: PlaceTable, key: str) -> tuple[float, float]:
        """North and east of home [m]; NaN beyond the map. `key` is how messages name the position."""
        if table.latitude_deg is not None and table.longitude_deg is not None:
            return self._on_map(table.latitude_deg, table.longitude_deg, key)
        if table.north_m is None or table.east_m is None:
            raise ValueError("a position table without a position was not validated")
        return table.north_m, table.east_m

    def _on_map(self, latitude_deg: float, longitude_deg: float, key: str) -> tuple[float, float]:
        try:
            north, east = self._frame.to_map(latitude_deg, longitude_deg)
        except ValueError:  # farther than any map reaches
            north = east = math.inf
        if max(abs(north), abs(east)) <= MAP_LIMIT:
            return north, east
        message = (
            f"latitude_deg = {latitude_deg:.12g}, longitude_deg = {longitude_deg:.12g} is beyond the map, "
            f"which reaches {MAP_LIMIT / 1000.0:,.0f} km from home to the north, south, east and west"
        )
        self.problems.append(Problem(key, None, message))
        return math.nan, math.nan
