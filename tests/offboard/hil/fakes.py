"""A plant that is a few lines: it stands, leaps into the air, and glides to where its pitch axis says."""

from __future__ import annotations

from pathlib import Path

import pytest

from offboard.hil.plant import NEUTRAL, Axes, Phase, Truth

WIRE = Path(__file__).parents[4] / "shared" / "wire"
AT_REST = Truth(
    0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
    0.0, 0.0, -9.81, 101325.0, 0.0, 288.15, 0.0,
)  # fmt: skip


def recording(name):
    """Path of a recorded exchange; the test is skipped where the recordings are not."""
    path = WIRE / name
    if not path.is_file():
        pytest.skip(f"no recordings of real autopilots at {WIRE}")
    return path


class FakePlant:
    """North grows by a metre per second of full throttle once launched."""

    def __init__(self):
        self.restart()

    def restart(self):
        self._truth = AT_REST
        self.phase = Phase.STANDING
        self.contact_speed = 0.0
        self.flown: list[Axes] = []
        self.axes = NEUTRAL

    def truth(self):
        return self._truth

    def fly(self, axes):
        self.axes = axes
        self.flown.append(axes)

    def launch(self):
        self.phase = Phase.LAUNCHING

    def step(self, duration):
        t = self._truth
        moving = self.phase is not Phase.STANDING
        speed = self.axes.throttle if moving else 0.0
        north = t.north + speed * duration
        self._truth = t._replace(time=t.time + duration, north=north, velocity_north=speed, airspeed=speed)
