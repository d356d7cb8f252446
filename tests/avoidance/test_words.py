"""Reasons in a pilot's words."""

from __future__ import annotations

from avoidance import Threat, Waypoint
from avoidance.words import obstacles, replace_words, threat_words


def test_obstacles_are_listed() -> None:
    assert obstacles((3,)) == "obstacle 3"
    assert obstacles((3, 4, 5)) == "obstacles 3, 4 and 5"
    assert obstacles((1, 2, 3, 4, 5, 6)) == "obstacles 1, 2, 3, 4 and 2 more"


def test_a_threat_says_who_where_and_how_near() -> None:
    words = threat_words(Threat((3, 4), 0, 9100.0, 607.0, 420.0, 1050.0))
    assert words == "obstacles 3 and 4 cut the route 9.1 km ahead: 420 m where 1050 m is to be kept"


def test_waypoints_are_counted_from_one() -> None:
    here, there = Waypoint(0.0, 0.0, 200.0, item=4), Waypoint(300.0, 400.0, 200.0, item=4, moved=True)
    assert replace_words(here, there, (7,)).startswith("waypoint 5 cannot be flown to: obstacle 7 too near")
    assert "500 m away" in replace_words(here, there, (7,))
    assert "skipped" in replace_words(here, None, ())
