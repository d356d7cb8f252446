"""A vehicle for tests that moves straight at constant speed."""

from __future__ import annotations

import math

from avoidance import Ownship
from offboard.link import VehicleState


class StraightFlyer:
    """Flies north at a given speed from a given point; finished after `length` metres."""

    def __init__(self, north=0.0, east=0.0, altitude=200.0, speed=15.0, length=math.inf, heading=0.0):
        self.north, self.east, self.altitude = north, east, altitude
        self.speed, self.heading = speed, heading
        self.time = self.flown = 0.0
        self.length = length
        self.steps = []

    @property
    def finished(self):
        return self.flown >= self.length

    def state(self):
        return VehicleState(
            Ownship(
                time=self.time,
                north=self.north,
                east=self.east,
                altitude=self.altitude,
                velocity_north=self.speed,
                velocity_east=0.0,
                airspeed=self.speed,
                heading=self.heading,
            )
        )

    def advance(self, duration):
        self.steps.append(duration)
        self.time += duration
        self.flown += self.speed * duration
        self.north += self.speed * duration
