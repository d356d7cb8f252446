"""The same aircraft written a second time, from the textbooks, in matrices: the oracle of the C model.

Sources: Stevens & Lewis, Aircraft Control and Simulation, 2nd ed. (equations of motion in matrix form, 1.5;
steady-state flight, 3.4); Etkin & Reid, Dynamics of Flight (wind axes). Attitude is a direction cosine
matrix of Euler angles, moments are solved with the full inertia tensor.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import root

GRAVITY = 9.81


def dcm(bank, pitch, heading):
    """Earth to body, as the product of three elementary rotations."""
    c, s = math.cos, math.sin
    roll = np.array([[1, 0, 0], [0, c(bank), s(bank)], [0, -s(bank), c(bank)]])
    nod = np.array([[c(pitch), 0, -s(pitch)], [0, 1, 0], [s(pitch), 0, c(pitch)]])
    yaw = np.array([[c(heading), s(heading), 0], [-s(heading), c(heading), 0], [0, 0, 1]])
    return roll @ nod @ yaw


@dataclass
class Twin:
    """Forces, moments and accelerations of one parameter set at one air density."""

    values: dict
    density: float
    gravity: float = GRAVITY

    def __getitem__(self, key):
        return self.values["aircraft." + key]

    def coefficients(self, alpha, beta, rates, surfaces, airspeed):
        """CD, CY, CL and Cl, Cm, Cn as dot products of derivatives with what they multiply."""
        p, q, r = (
            np.asarray(rates) * [self["wing.span"], self["wing.chord"], self["wing.span"]] / (2 * airspeed)
        )
        da, de, dr = surfaces
        held = np.clip(alpha, self["aero.alpha_min"], self["aero.alpha_max"])
        plate = max(0.0, 2 * (math.sin(alpha) ** 2 - math.sin(held) ** 2))
        terms = {
            "CL": dict(zip(("0", "_alpha", "_alpha2", "_alpha3"), held ** np.arange(4), strict=True))
            | {"_q": q, "_elevator": de},
            "CD": {
                "0": 1,
                "_alpha": held,
                "_alpha2": held**2,
                "_elevator2": de**2,
                "_beta": beta,
                "_beta2": beta**2,
            },
            "Cm": {"0": 1, "_alpha": alpha, "_q": q, "_elevator": de},
        }
        lateral = {"_beta": beta, "_p": p, "_r": r, "_aileron": da, "_rudder": dr}
        terms |= {"CY": lateral, "Cl": lateral, "Cn": lateral}
        out = {head: sum(self[f"aero.{head}{k}"] * x for k, x in row.items()) for head, row in terms.items()}
        out["CD"] += plate
        return out

    def thrust(self, throttle, airspeed):
        """Thrust [N] of either engine model."""
        if self["propulsion.model"] == 1:
            return self["propulsion.max_thrust"] * throttle
        exit_speed = airspeed + throttle * (self["propulsion.motor_speed"] - airspeed)
        area = self["propulsion.disc_area"] * self["propulsion.coefficient"]
        return self.density / 2 * area * exit_speed * (exit_speed - airspeed)

    def accelerations(self, velocity_air, rates, attitude, surfaces, throttle, wind_ned=(0, 0, 0)):
        """Body accelerations of the ground velocity, angular accelerations, specific force."""
        airspeed = float(np.linalg.norm(velocity_air))
        alpha = math.atan2(velocity_air[2], velocity_air[0])
        beta = math.asin(velocity_air[1] / airspeed)
        k = self.coefficients(alpha, beta, rates, surfaces, airspeed)
        dynamic = self.density / 2 * airspeed**2 * self["wing.area"]
        stability = np.array(
            [[math.cos(alpha), 0, -math.sin(alpha)], [0, 1, 0], [math.sin(alpha), 0, math.cos(alpha)]]
        )
        force = dynamic * stability @ np.array([-k["CD"], k["CY"], -k["CL"]])
        force[0] += self.thrust(throttle, airspeed)
        lengths = np.array([self["wing.span"], self["wing.chord"], self["wing.span"]])
        moment = dynamic * lengths * np.array([k["Cl"], k["Cm"], k["Cn"]])
        xx, yy, zz, xz = (self[f"inertia.{axis}"] for axis in ("xx", "yy", "zz", "xz"))
        tensor = np.array([[xx, 0, -xz], [0, yy, 0], [-xz, 0, zz]])
        to_body = dcm(*attitude)
        specific = force / self["mass"]
        ground = np.asarray(velocity_air) + to_body @ np.asarray(wind_ned, float)
        linear = specific + to_body @ [0, 0, self.gravity] - np.cross(rates, ground)
        angular = np.linalg.solve(tensor, moment - np.cross(rates, tensor @ rates))
        return linear, angular, specific

    def trim(self, airspeed, bank=0.0, climb=0.0, rudder=False):
        """Steady flight with a given bank and climb: what scipy finds when nothing accelerates.

        Unknowns: alpha, beta, pitch, turn rate, aileron, elevator, rudder (or beta = 0), throttle.
        """

        def split(x):
            alpha, beta, pitch, turn, da, de, dr, throttle = x
            air = airspeed * np.array(
                [math.cos(alpha) * math.cos(beta), math.sin(beta), math.sin(alpha) * math.cos(beta)]
            )
            rates = dcm(bank, pitch, 0) @ [0, 0, turn]
            return air, rates, (bank, pitch, 0.0), (da, de, dr), throttle

        def residual(x):
            air, rates, attitude, surfaces, throttle = split(x)
            linear, angular, _ = self.accelerations(air, rates, attitude, surfaces, throttle)
            rise = -(dcm(*attitude).T @ air)[2]
            return [*linear, *angular, rise - climb, x[1] if rudder else x[6]]

        guess = [0.05, 0, 0.05 + climb / airspeed, self.gravity * math.tan(bank) / airspeed, 0, 0, 0, 0.5]
        found = root(residual, guess, tol=1e-13)
        names = ("alpha", "beta", "pitch", "turn", "aileron", "elevator", "rudder", "throttle")
        return dict(zip(names, found.x, strict=True)) | {"residual": float(np.abs(residual(found.x)).max())}
