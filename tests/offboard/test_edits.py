from __future__ import annotations

import dataclasses

import pytest

from avoidance import Detour, Hold, Keep, Resume, Waypoint
from offboard.edits import Edit, EditAction, Observed, route_of
from offboard.link import EditStatus


def test_the_route_of_a_decision() -> None:
    way = (Waypoint(1.0, 2.0, 3.0),)
    centre = Waypoint(0.0, 0.0, 200.0)

    assert route_of(Keep(why="free", route=way)) is None
    assert route_of(Hold(why="no way", centre=centre, radius=80.0, direction=1)) is None
    assert route_of(Resume(why="free again", route=way)) == way
    assert route_of(Detour(why="blocked", waypoint=way[0], route=way)) == way
    with pytest.raises(ValueError, match="a detour needs the whole remaining route"):
        route_of(Detour(why="blocked", waypoint=way[0]))


WANTED = Observed(total=9, current=3, target=Waypoint(1000.0, 0.0, 200.0))


def test_an_edit_is_confirmed_by_what_the_vehicle_flies() -> None:
    edit = Edit(WANTED)
    elsewhere = dataclasses.replace(WANTED, target=Waypoint(9000.0, 0.0, 200.0))

    assert edit.poll(0.0, WANTED) is EditAction.SEND  # what was seen before it was sent proves nothing
    assert edit.poll(0.1, elsewhere) is EditAction.WAIT
    assert edit.poll(0.2, dataclasses.replace(WANTED, total=8)) is EditAction.WAIT
    assert edit.status is EditStatus.PENDING
    assert edit.poll(0.3, WANTED) is EditAction.NONE
    assert edit.status is EditStatus.CONFIRMED


def test_an_edit_without_an_answer_is_sent_again_and_at_last_given_up() -> None:
    edit = Edit(WANTED, timeout=1.0, attempts=2)

    actions = [edit.poll(0.5 * tick, None) for tick in range(6)]

    wanted = ["send", "wait", "send", "wait", "fall back", "none"]
    assert [action.value for action in actions] == wanted
    assert edit.status is EditStatus.TIMED_OUT


def test_a_refused_edit_is_retried_at_once_and_then_given_up() -> None:
    edit = Edit(WANTED, timeout=5.0, attempts=2)
    refusal = dataclasses.replace(WANTED, refused=True)

    actions = [edit.poll(0.1 * tick, refusal if tick else None) for tick in range(3)]

    assert actions == [EditAction.SEND, EditAction.SEND, EditAction.FALL_BACK]
    assert edit.status is EditStatus.REFUSED
