"""Ourselves among the traffic."""

from __future__ import annotations

import pytest

from offboard.own_echo import OwnEcho
from offboard.sightings import Sighting


def own(time):
    """The vehicle: 15 m/s to the north."""
    return Sighting(0, 15.0 * time, 0.0, 200.0, time, 15.0, 0.0)


def report(time, *, north=0.0, east=0.0, altitude=200.0, velocity=(15.0, 0.0), identity=0xABCDEF, age=0.0):
    """Somebody, relative to where the vehicle was when it was measured."""
    then = time - age
    return Sighting(identity, 15.0 * then + north, east, altitude, then, *velocity)


def verdicts(echo, reports):
    return [echo.holds(each, own(float(time))) for time, each in enumerate(reports)]


def test_a_newcomer_that_is_where_we_are_is_us():
    echo = OwnEcho()
    assert (
        verdicts(echo, [report(float(t), north=12.0, altitude=230.0, age=0.8) for t in range(5)])
        == [True] * 5
    )
    assert echo.sure(0xABCDEF)


def test_it_is_held_back_before_it_is_sure():
    echo = OwnEcho()
    verdicts(echo, [report(0.0), report(1.0)])
    assert not echo.sure(0xABCDEF)


def test_a_sender_without_an_address_is_no_surer_than_any_other():
    """Its number is that of an own address that is not known."""
    echo = OwnEcho()
    assert verdicts(echo, [report(0.0, identity=0)]) == [True]
    assert not echo.sure(0)


@pytest.mark.parametrize(
    "other",
    [{"east": 150.0}, {"altitude": 300.0}, {"velocity": (-15.0, 0.0)}, {"velocity": (15.0, 8.0)}],
    ids=["beside", "above", "head-on", "crossing"],
)
def test_somebody_else_is_not(other):
    assert verdicts(OwnEcho(), [report(float(t), **other) for t in range(6)]) == [False] * 6


def test_who_comes_near_is_not_taken_for_us_before_many_reports():
    echo = OwnEcho()
    closing = [report(float(t), east=max(400.0 - 100.0 * t, 20.0)) for t in range(12)]
    assert not any(verdicts(echo, closing))


def test_who_has_come_from_afar_and_flies_beside_us_stays_traffic():
    """A slow overtaker with nearly our velocity: however often it is reported next to us."""
    slowly = [report(float(t), north=min(-600.0 + 15.0 * t, 0.0), velocity=(18.0, 0.0)) for t in range(80)]
    assert not any(verdicts(OwnEcho(), slowly))


def test_an_echo_that_is_late_in_a_turn_is_us_again_afterwards():
    echo = OwnEcho()
    turn = [report(float(t), velocity=(12.0, 9.0)) for t in range(3)]
    after = [report(float(t)) for t in range(3, 20)]
    assert verdicts(echo, [*turn, *after])[-1]


def test_an_echo_that_leaves_us_is_an_intruder_at_once():
    echo = OwnEcho()
    verdicts(echo, [report(float(t)) for t in range(5)])
    assert not echo.holds(report(5.0, east=200.0), own(5.0))


def test_our_own_address_counts_near_us_only_and_not_the_one_that_everybody_has():
    assert OwnEcho(0xABCDEF).holds(report(0.0, east=700.0), own(0.0))
    assert not OwnEcho(0xABCDEF).holds(report(0.0, east=3000.0), own(0.0))
    assert not OwnEcho(1194684).holds(report(0.0, east=700.0, identity=1194684), own(0.0))
