"""How long it is believed that there is no way round."""

from __future__ import annotations

from avoidance import Ownship, Route, Waypoint
from avoidance.holding import FIRST_WAIT, LONGEST_WAIT, NoWay

ROUTE = Route(Waypoint(0.0, 0.0, 200.0), (Waypoint(9000.0, 0.0, 200.0, item=0),))


def at(time: float) -> Ownship:
    return Ownship(time, 15.0 * time, 0.0, 200.0, 15.0, 0.0, airspeed=15.0)


def test_a_search_in_vain_is_made_again_after_twice_as_long() -> None:
    no_way, waits, time = NoWay(), [], 0.0
    for _ in range(5):
        no_way = no_way.again(at(time), ROUTE, version=1)
        waits.append(no_way.until - time)
        assert no_way.lasts(at(no_way.until - 0.1), ROUTE, version=1)
        assert not no_way.lasts(at(no_way.until), ROUTE, version=1)
        time = no_way.until
    assert waits == [FIRST_WAIT, 2.0 * FIRST_WAIT, 4.0 * FIRST_WAIT, LONGEST_WAIT, LONGEST_WAIT]


def test_it_is_not_believed_of_another_route_nor_when_something_new_is_known() -> None:
    no_way = NoWay().again(at(0.0), ROUTE, version=1).again(at(3.0), ROUTE, version=1)
    other = Route(ROUTE.origin, ROUTE.waypoints)
    assert not no_way.lasts(at(4.0), ROUTE, version=2)
    assert not no_way.lasts(at(4.0), other, version=1)
    assert no_way.again(at(4.0), ROUTE, version=2).until == 4.0 + FIRST_WAIT
