"""Time that a host withholds is read from the system, and told with a run in real time."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from scenarios.hil_priority import stolen_time
from scenarios.hil_self_test import _withheld


@pytest.mark.skipif(not hasattr(os, "sysconf"), reason="no sysconf on this system, so no time is told")
def test_stolen_time_is_the_eighth_number_in_clock_ticks(tmp_path: Path) -> None:
    stat = tmp_path / "stat"
    ticks = os.sysconf("SC_CLK_TCK")
    stat.write_text(f"cpu  10 20 30 40 50 60 70 {3 * ticks} 0 0\ncpu0 1 2 3 4 5 6 7 8 9 10\n")
    assert stolen_time(stat) == 3.0


@pytest.mark.parametrize("text", ["", "cpu 1 2 3\n", "cpu a b c d e f g h i j\n"])
def test_a_system_that_does_not_tell_says_nothing(tmp_path: Path, text: str) -> None:
    stat = tmp_path / "stat"
    stat.write_text(text)
    assert stolen_time(stat) is None
    assert stolen_time(tmp_path / "missing") is None


def test_withheld_time_is_said_only_if_there_was_some() -> None:
    assert "2.5 s" in _withheld(2.5)
    assert _withheld(0.0) == _withheld(0.01) == _withheld(None) == ""
