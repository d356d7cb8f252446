"""Attitude of a body (forward, right, down) in north-east-down axes: quaternions and Euler angles."""

from __future__ import annotations

import math

from offboard.hil.plant import Truth


def euler(w: float, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Bank, pitch and heading [rad] of an attitude quaternion, body to north-east-down."""
    bank = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    pitch = math.asin(min(max(2.0 * (w * y - x * z), -1.0), 1.0))
    heading = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return bank, pitch, heading


def quaternion(bank: float, pitch: float, heading: float) -> tuple[float, float, float, float]:
    """Attitude quaternion w, x, y, z of bank, pitch and heading [rad]."""
    cr, sr = math.cos(bank / 2), math.sin(bank / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(heading / 2), math.sin(heading / 2)
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


def to_body(truth: Truth, vector: tuple[float, float, float]) -> tuple[float, float, float]:
    """A vector in map axes (north, east, down) as the body (forward, right, down) sees it."""
    w, x, y, z = truth.qw, truth.qx, truth.qy, truth.qz
    n, e, d = vector
    return (
        (1 - 2 * (y * y + z * z)) * n + 2 * (x * y + w * z) * e + 2 * (x * z - w * y) * d,
        2 * (x * y - w * z) * n + (1 - 2 * (x * x + z * z)) * e + 2 * (y * z + w * x) * d,
        2 * (x * z + w * y) * n + 2 * (y * z - w * x) * e + (1 - 2 * (x * x + y * y)) * d,
    )
