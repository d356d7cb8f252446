"""Positions of a scenario file → points on the map."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from offboard.frames import MapFrame
from scenarios.errors import Problem
from scenarios.scenario import Point
from scenarios.schema import MAP_LIMIT, HomeTable, PositionTable


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
            if table.latitude_deg is not None and table.longitude_deg is not None:
                north, east = self._on_map(table.latitude_deg, table.longitude_deg, index, key)
            elif table.north_m is not None and table.east_m is not None:
                north, east = table.north_m, table.east_m
            else:
                raise ValueError("a position table without a position was not validated")
            height = altitude if table.altitude_m is None else table.altitude_m
            points.append(Point(north, east, height, getattr(table, "speed_m_s", None)))
        return points

    def _on_map(
        self, latitude_deg: float, longitude_deg: float, index: int, key: Callable[[int], str]
    ) -> tuple[float, float]:
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
        self.problems.append(Problem(key(index), None, message))
        return math.nan, math.nan
