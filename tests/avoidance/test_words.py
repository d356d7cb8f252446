"""Reasons in a pilot's words."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from avoidance import Threat, Waypoint
from avoidance.ladder import Plan
from avoidance.search import search_waypoint
from avoidance.types import Rung
from avoidance.words import detour_words, obstacles, replace_words, threat_words
from tests.avoidance.worlds import problem


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


def test_a_way_that_was_preferred_to_another_says_by_how_much_it_is_shorter() -> None:
    threat = Threat((3,), 0, 9100.0, 607.0, 420.0, 1025.0)
    search = replace(search_waypoint(problem([(9000.0, 0.0)]), np.random.default_rng(0)), iterations=1)
    plan = Plan(Rung.ROUTE, ((9000.0, 1050.0), (9300.0, 1050.0)), search)
    assert detour_words(threat, plan).endswith("no single waypoint serves")
    assert detour_words(threat, replace(plan, saved=61.2)).endswith("61 m shorter than by a single waypoint")
    close = replace(plan, rung=Rung.CLOSE, saved=23.0)
    assert "23 m shorter than outside the tolerance" in detour_words(threat, close)
    assert detour_words(threat, replace(plan, expecting=True)).endswith("where nobody has looked yet")
