"""Geodesics on the WGS-84 ellipsoid, on arrays.

Vincenty, "Direct and inverse solutions of geodesics on the ellipsoid", Survey Review 23 (1975), with his
equation numbers. Good to a fraction of a millimetre; the inverse does not converge within about half a
degree of the antipode. (pymap3d's `vdist` spoils the whole array as soon as two points in it coincide,
which home and a mission's first item do, so it serves the tests as a second opinion only.)
"""

from __future__ import annotations

import math

import numpy as np

from avoidance.types import Floats

SEMI_MAJOR = 6378137.0
"""Equatorial radius a [m]."""
FLATTENING = 1.0 / 298.257223563
"""f = (a - b)/a."""
SEMI_MINOR = SEMI_MAJOR * (1.0 - FLATTENING)
"""Polar radius b [m]."""
CONVERGED = 1e-14
"""Change of an angle at which an iteration ends [rad]: 0.1 µm on the ground."""
MAX_ITERATIONS = 100
"""After this many the points are taken for antipodal."""


def inverse(
    latitude: float, longitude: float, latitudes: Floats, longitudes: Floats
) -> tuple[Floats, Floats]:
    """Distances and azimuths from one point to others.

    Parameters
    ----------
    latitude, longitude : float
        The one point [rad].
    latitudes, longitudes : array, any shape
        The others [rad].

    Returns
    -------
    distance : array of that shape
        Length of the geodesic [m].
    azimuth : array of that shape
        Its direction where it begins [rad]; 0 where the points coincide.

    Raises
    ------
    ValueError
        If a point is (nearly) antipodal.
    """
    sin_1, cos_1 = _reduced(latitude)
    sin_2, cos_2 = _reduced(latitudes)
    difference = (longitudes - longitude + math.pi) % (2.0 * math.pi) - math.pi
    lam = difference
    for _ in range(MAX_ITERATIONS):
        east = cos_2 * np.sin(lam)
        north = cos_1 * sin_2 - sin_1 * cos_2 * np.cos(lam)
        sin_sigma = np.hypot(east, north)  # (14)
        cos_sigma = sin_1 * sin_2 + cos_1 * cos_2 * np.cos(lam)  # (15)
        sigma = np.arctan2(sin_sigma, cos_sigma)  # (16)
        sin_alpha = _ratio(cos_1 * east, sin_sigma)  # (17)
        cos2_alpha = 1.0 - sin_alpha**2
        cos_2m = cos_sigma - 2.0 * _ratio(sin_1 * sin_2, cos2_alpha)  # (18)
        before, lam = lam, difference + _longitude_correction(sin_alpha, sigma, cos_2m)
        if np.all(np.abs(lam - before) <= CONVERGED):
            scale, B = _series(cos2_alpha)
            distance = scale * (sigma - _arc_correction(B, sigma, cos_2m))  # (19)
            return distance, np.arctan2(east, north)  # (20)
    raise ValueError("positions on opposite sides of the earth have no place on one map")


def direct(latitude: float, longitude: float, distance: Floats, azimuth: Floats) -> tuple[Floats, Floats]:
    """The points at given distances and azimuths from one point.

    Parameters
    ----------
    latitude, longitude : float
        The one point [rad].
    distance, azimuth : array, any shape
        Length of each geodesic [m] and its direction where it begins [rad].

    Returns
    -------
    latitude, longitude : array of that shape
        Where they end [rad]; the longitude is not wrapped.
    """
    sin_1, cos_1 = _reduced(latitude)
    sin_azimuth, cos_azimuth = np.sin(azimuth), np.cos(azimuth)
    sigma_1 = np.arctan2(sin_1, cos_1 * cos_azimuth)  # (1)
    sin_alpha = cos_1 * sin_azimuth  # (2)
    cos2_alpha = 1.0 - sin_alpha**2
    scale, B = _series(cos2_alpha)
    sigma = distance / scale
    for _ in range(MAX_ITERATIONS):
        cos_2m = np.cos(2.0 * sigma_1 + sigma)  # (5)
        before, sigma = sigma, distance / scale + _arc_correction(B, sigma, cos_2m)  # (7)
        if np.all(np.abs(sigma - before) <= CONVERGED):
            break
    sin_sigma, cos_sigma = np.sin(sigma), np.cos(sigma)
    across = sin_1 * sin_sigma - cos_1 * cos_sigma * cos_azimuth
    latitudes = np.arctan2(
        sin_1 * cos_sigma + cos_1 * sin_sigma * cos_azimuth,
        (1.0 - FLATTENING) * np.hypot(sin_alpha, across),
    )  # (8)
    lam = np.arctan2(sin_sigma * sin_azimuth, cos_1 * cos_sigma - sin_1 * sin_sigma * cos_azimuth)  # (9)
    cos_2m = np.cos(2.0 * sigma_1 + sigma)
    return latitudes, longitude + lam - _longitude_correction(sin_alpha, sigma, cos_2m)  # (11)


def _reduced(latitude: float | Floats) -> tuple[Floats, Floats]:
    """Sine and cosine of the reduced latitude U, tan U = (1 - f) tan φ."""
    sine, cosine = (1.0 - FLATTENING) * np.sin(latitude), np.cos(latitude)
    norm = np.hypot(sine, cosine)
    return sine / norm, cosine / norm


def _ratio(a: Floats, b: Floats) -> Floats:
    """a/b, and 0 where b is 0."""
    zero = b == 0.0
    return np.where(zero, 0.0, a / np.where(zero, 1.0, b))


def _series(cos2_alpha: Floats) -> tuple[Floats, Floats]:
    """The factors b·A [m] and B of the arc length, Eqs. (3)-(4)."""
    u2 = cos2_alpha * (SEMI_MAJOR**2 / SEMI_MINOR**2 - 1.0)
    A = 1.0 + u2 / 16384.0 * (4096.0 + u2 * (-768.0 + u2 * (320.0 - 175.0 * u2)))
    B = u2 / 1024.0 * (256.0 + u2 * (-128.0 + u2 * (74.0 - 47.0 * u2)))
    return SEMI_MINOR * A, B


def _arc_correction(B: Floats, sigma: Floats, cos_2m: Floats) -> Floats:
    """Δσ, Eq. (6) [rad]."""
    sine, cosine = np.sin(sigma), np.cos(sigma)
    inner = cosine * (2.0 * cos_2m**2 - 1.0) - B / 6.0 * cos_2m * (4.0 * sine**2 - 3.0) * (
        4.0 * cos_2m**2 - 3.0
    )
    return B * sine * (cos_2m + B / 4.0 * inner)


def _longitude_correction(sin_alpha: Floats, sigma: Floats, cos_2m: Floats) -> Floats:
    """λ - L, the sphere's difference of longitude less the ellipsoid's, Eqs. (10)-(11) [rad]."""
    cos2_alpha = 1.0 - sin_alpha**2
    C = FLATTENING / 16.0 * cos2_alpha * (4.0 + FLATTENING * (4.0 - 3.0 * cos2_alpha))
    inner = cos_2m + C * np.cos(sigma) * (2.0 * cos_2m**2 - 1.0)
    return (1.0 - C) * FLATTENING * sin_alpha * (sigma + C * np.sin(sigma) * inner)
