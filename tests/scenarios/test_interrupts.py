"""Ctrl-C and SIGTERM end a flight with its run written; insisting ends it at once."""

from __future__ import annotations

import signal

import pytest

from scenarios.interrupts import stop_on_interrupt


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_first_is_noted_and_the_same_again_stops_hard(number: signal.Signals) -> None:
    before = signal.getsignal(number)
    with stop_on_interrupt() as stop:
        assert not stop
        signal.raise_signal(number)
        assert stop == [number]
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(number)
    assert signal.getsignal(number) is before


def test_one_of_each_is_no_hurry() -> None:
    """Ctrl-C has reached all processes of the terminal, and now another one asks this one to end."""
    with stop_on_interrupt() as stop:
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGTERM)
        assert stop == [signal.SIGINT, signal.SIGTERM]
