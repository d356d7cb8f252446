"""The Skywalker X8 in plain Python, as pythonfmu packs it: the same twelve equations as `airframe12.c`."""

import math

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

MASS, JX, JY, JZ, JXZ = 3.364, 0.335, 0.14, 0.4, -0.029
AREA, SPAN, CHORD, DENSITY, GRAVITY = 0.75, 2.1, 0.35714285714285715, 1.225, 9.81
DETERMINANT = JX * JZ - JXZ * JXZ
PERIOD = 0.01
NAMES = ("north", "east", "down", "u", "v", "w", "bank", "pitch", "heading", "p", "q", "r")


def derivative(x, aileron, elevator, throttle):
    """Time derivative of the state."""
    _, _, _, u, v, w, bank, pitch, heading, p, q, r = x
    sf, cf, st, ct = math.sin(bank), math.cos(bank), math.sin(pitch), math.cos(pitch)
    ss, cs = math.sin(heading), math.cos(heading)
    airspeed = math.sqrt(u * u + v * v + w * w)
    a, b = math.atan2(w, u), math.asin(v / airspeed)
    sa, ca = math.sin(a), math.cos(a)
    pb, qc, rb = p * SPAN / (2 * airspeed), q * CHORD / (2 * airspeed), r * SPAN / (2 * airspeed)
    lift = 0.08673556671610734 + 4.020328244000679 * a + 3.87 * qc + 0.2780736201734713 * elevator
    drag = (
        0.01970001181915082
        + 0.07909146315766297 * a
        + 1.0554699867680841 * a * a
        + 0.06334739678180232 * elevator * elevator
        + 0.14781193079241584 * b * b
    )
    side = (
        -0.22387215700254048 * b
        - 0.13735505263157893 * pb
        + 0.08386876842105263 * rb
        + 0.043276402502774876 * aileron
    )
    roll = -0.08489628639662417 * b - 0.404198 * pb + 0.0555206 * rb + 0.12018814125782745 * aileron
    nod = 0.018 - 0.2524 * a - 1.3012370370370372 * qc - 0.2292 * elevator
    yaw = 0.0283 * b + 0.004365511578947368 * pb - 0.072 * rb - 0.00339 * aileron
    pressure = 0.5 * DENSITY * airspeed * airspeed * AREA
    jet = airspeed + throttle * (37.42 - airspeed)
    thrust = 0.5 * DENSITY * 0.10178760197630929 * 0.248 * jet * (jet - airspeed)
    fx = (thrust + pressure * (lift * sa - drag * ca)) / MASS
    fy, fz = pressure * side / MASS, pressure * (-lift * ca - drag * sa) / MASS
    l, m, n = pressure * SPAN * roll, pressure * CHORD * nod, pressure * SPAN * yaw  # noqa: E741
    return (
        ct * cs * u + (sf * st * cs - cf * ss) * v + (cf * st * cs + sf * ss) * w,
        ct * ss * u + (sf * st * ss + cf * cs) * v + (cf * st * ss - sf * cs) * w,
        -st * u + sf * ct * v + cf * ct * w,
        r * v - q * w - GRAVITY * st + fx,
        p * w - r * u + GRAVITY * ct * sf + fy,
        q * u - p * v + GRAVITY * ct * cf + fz,
        p + (q * sf + r * cf) * st / ct,
        q * cf - r * sf,
        (q * sf + r * cf) / ct,
        (JXZ * (JX - JY + JZ) * p * q - (JZ * (JZ - JY) + JXZ * JXZ) * q * r + JZ * l + JXZ * n)
        / DETERMINANT,
        ((JZ - JX) * p * r - JXZ * (p * p - r * r) + m) / JY,
        (((JX - JY) * JX + JXZ * JXZ) * p * q - JXZ * (JX - JY + JZ) * q * r + JXZ * l + JX * n)
        / DETERMINANT,
    )


class PythonAircraft(Fmi2Slave):
    author = "Sidestep contributors"
    description = "Skywalker X8, six degrees of freedom, in Python"

    def __init__(self, **options):
        super().__init__(**options)
        alpha, speed = math.radians(3.2266), 15.0
        for name in NAMES:
            setattr(self, name, 0.0)
        self.u, self.w, self.pitch = speed * math.cos(alpha), speed * math.sin(alpha), alpha
        self.aileron, self.elevator, self.throttle = 0.0, math.radians(0.9465), 0.3572
        for name in NAMES:
            self.register_variable(Real(name, causality=Fmi2Causality.output))
        for name in ("aileron", "elevator", "throttle"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))

    def do_step(self, _now, duration):
        x = [getattr(self, name) for name in NAMES]
        control = (self.aileron, self.elevator, self.throttle)
        steps = max(1, round(duration / PERIOD))
        h = duration / steps
        for _ in range(steps):
            k1 = derivative(x, *control)
            k2 = derivative([a + h / 2 * b for a, b in zip(x, k1, strict=True)], *control)
            k3 = derivative([a + h / 2 * b for a, b in zip(x, k2, strict=True)], *control)
            k4 = derivative([a + h * b for a, b in zip(x, k3, strict=True)], *control)
            ks = zip(x, k1, k2, k3, k4, strict=True)
            x = [a + h / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in ks]
        for name, value in zip(NAMES, x, strict=True):
            setattr(self, name, value)
        return True
