"""Somebody else's aircraft, as pythonfmu packs it: own names, own units (feet, knots, degrees), own guidance.

A point with a limited rate of turn. It knows nothing of this project; a mapping makes it a plant.
"""

import math

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

FOOT, KNOT = 0.3048, 1852 / 3600
INPUTS = ("goal_mode", "a_x", "a_y", "b_x", "b_y", "c_x", "c_y", "c_r", "c_turn", "alt_ft", "speed_kt")


class UserAircraft(Fmi2Slave):
    author = "a user"
    description = "A point that turns at 15 degrees a second at most"

    def __init__(self, **options):
        super().__init__(**options)
        self.x, self.y, self.height_ft, self.track_deg, self.tas_kt = 0.0, 0.0, 600.0, 0.0, 30.0
        self.vx = self.vy = self.vz_ft_min = 0.0
        self.wind_x = self.wind_y = 0.0
        self.turn_limit = 15.0
        self.x_0, self.y_0, self.height_0_ft = 0.0, 0.0, 600.0
        for name in ("x", "y", "height_ft", "track_deg", "tas_kt", "vx", "vy", "vz_ft_min"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))
        for name in INPUTS:
            setattr(self, name, 0.0)
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        for name in ("wind_x", "wind_y"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        for name in ("turn_limit", "x_0", "y_0", "height_0_ft"):
            fixed = Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed)
            self.register_variable(fixed)

    def exit_initialization_mode(self):
        self.x, self.y, self.height_ft = self.x_0, self.y_0, self.height_0_ft

    def do_step(self, now, duration):
        steps = max(1, math.ceil(duration / 0.05 - 1e-9))
        for _ in range(steps):
            self.move(duration / steps)
        return True

    def wanted(self):
        """Track [rad] that leads back to the line or the circle."""
        if self.goal_mode == 7:
            dx, dy = self.x - self.c_x, self.y - self.c_y
            range_ = math.hypot(dx, dy)
            turn = 1 if self.c_turn > 0 else -1
            return math.atan2(dy, dx) + turn * (math.pi / 2 + math.atan((range_ - self.c_r) / 30))
        along = math.atan2(self.b_y - self.a_y, self.b_x - self.a_x)
        off = (self.y - self.a_y) * math.cos(along) - (self.x - self.a_x) * math.sin(along)
        return along - math.atan(off / 60)

    def move(self, h):
        error = math.remainder(self.wanted() - math.radians(self.track_deg), math.tau)
        limit = math.radians(self.turn_limit) * h
        self.track_deg = (self.track_deg + math.degrees(max(-limit, min(limit, error)))) % 360
        self.tas_kt = self.speed_kt
        climb = max(-2.0, min(2.0, (self.alt_ft - self.height_ft) * FOOT / 2))
        self.vx = self.tas_kt * KNOT * math.cos(math.radians(self.track_deg)) + self.wind_x
        self.vy = self.tas_kt * KNOT * math.sin(math.radians(self.track_deg)) + self.wind_y
        self.vz_ft_min = climb / FOOT * 60
        self.x, self.y = self.x + self.vx * h, self.y + self.vy * h
        self.height_ft += climb * h / FOOT
