"""The constraints on a new waypoint (Eqs. 7-12): by how much each candidate breaks them, in metres."""

from __future__ import annotations

import math

import numpy as np

from avoidance.flown import as_complex, turn_angle
from avoidance.geometry import distances, segments_clearance, within_reach
from avoidance.types import Complexes, Floats

SHARPEST = 0.99 * math.pi
"""Turns are counted as no sharper than this [rad]."""


def safe_waypoint(points: Floats, centres: Floats, required: Floats) -> Floats:
    """g1: the waypoint keeps `required` from every obstacle.

    Parameters
    ----------
    points : array, shape (n, 2)
        Candidates [m].
    centres : array, shape (d, 2)
        Obstacles [m].
    required : array, shape (d,)
        RS + tolerance of each [m].

    Returns
    -------
    array, shape (n,)
        Largest shortfall [m]; 0 where the constraint is met.

    Notes
    -----
    Eq. (7).
    """
    if not len(centres) or not len(points):
        return np.zeros(len(points))
    near = within_reach(points, centres, required)
    shortfall = required[near] - distances(points, centres[near])
    return np.asarray(shortfall.max(axis=1, initial=0.0))


def search_space(points: Floats, members: Floats, limit: float) -> Floats:
    """g2: the waypoint lies within `limit` of the nearest member of the cluster avoided (Eq. 8).

    Differs from the paper: E12, its own results break the limit measured from the obstacle itself.

    Parameters
    ----------
    points : array, shape (n, 2)
        Candidates [m].
    members : array, shape (c, 2)
        Obstacles of the cluster [m].
    limit : float
        searchspaceLimit [m].

    Returns
    -------
    array, shape (n,)
        Excess [m].
    """
    if not len(members):
        return np.zeros(len(points))
    distance = distances(points, members)
    return np.asarray(np.maximum(distance.min(axis=1) - limit, 0.0))


def feasible_segments(
    starts: Floats, ends: Floats, extra: Floats, centres: Floats, required: Floats
) -> Floats:
    """g3: every segment of the flown curve keeps `required` (+ `extra`) from every obstacle.

    Parameters
    ----------
    starts, ends : array, shape (n, m, 2)
        Segments of each candidate's flown curve, see `avoidance.flown` [m].
    extra : array, shape (n, m)
        Additional room of each segment [m].
    centres : array, shape (d, 2)
        Obstacles [m].
    required : array, shape (d,)
        RS + margin of each [m].

    Returns
    -------
    array, shape (n,)
        Largest shortfall [m].

    Notes
    -----
    Eqs. (9)-(10) and (22)-(26) in the form "distance of a segment from a point", which is the same test
    with 0 <= t <= 1. Differs from the paper: E17 (infinite line) and E18 (both new segments, every
    obstacle).
    """
    if not len(centres):
        return np.zeros(len(starts))
    count, pieces = extra.shape
    ends_all = np.concatenate([starts.reshape(-1, 2), ends.reshape(-1, 2)])
    near = within_reach(ends_all, centres, required + extra.max())
    centres, required = centres[near], required[near]
    if not len(centres):
        return np.zeros(count)
    distance = segments_clearance(starts.reshape(-1, 2), ends.reshape(-1, 2), centres)
    shortfall = (required[None] + extra.reshape(-1, 1) - distance).max(axis=1)
    return np.asarray(np.maximum(shortfall.reshape(count, pieces).max(axis=1), 0.0))


def line_shortfall(
    starts: Complexes, ends: Complexes, extra: Floats, centres: Complexes, required: Floats
) -> Floats:
    """As `feasible_segments`, of ends of shape (n, m) and centres of shape (d,) as complex numbers [m]."""
    begin = starts.reshape(-1)  # obstacles first, lines last: the least over obstacles is a fast one then
    along = ends.reshape(-1) - begin
    length = np.abs(along)
    unit = along / np.maximum(length, 1e-300)
    unit[length == 0.0] = 1.0
    seen = np.conj(unit) * (centres[:, None] - begin)
    beyond = np.minimum(seen.real, length)
    np.maximum(beyond, 0.0, out=beyond)
    np.subtract(seen.real, beyond, out=beyond)
    gap = np.square(seen.imag)
    gap += np.square(beyond, out=beyond)
    np.sqrt(gap, out=gap)
    gap -= required[:, None]
    nearest = gap.min(axis=0).reshape(extra.shape)
    return np.asarray((extra - nearest).max(axis=1, initial=0.0))


def turning_angle(
    points: Floats, start: tuple[float, float], target: tuple[float, float], limit: float
) -> Floats:
    """g4 as printed: the heading change at the waypoint stays within `limit` (Eqs. 11-12).

    Differs from the paper: E16, the denominator of Eq. (11) must be the product of the norms.

    Parameters
    ----------
    points : array, shape (n, 2)
        Candidates [m].
    start, target : (float, float)
        Ends of the detour [m].
    limit : float
        MaxBankAngle [rad].

    Returns
    -------
    array, shape (n,)
        Excess, as an arc of one kilometre radius [m].
    """
    here = as_complex(points)
    turn = turn_angle(here - complex(*start), complex(*target) - here)
    return np.asarray(np.maximum(turn - limit, 0.0) * 1000.0)


def flyable_turn(
    points: Floats,
    start: tuple[float, float],
    target: tuple[float, float],
    course: float | None,
    turn_radius: float,
) -> Floats:
    """g4: the turns on to the first segment and at the waypoint fit into the adjoining segments.

    R tan(dchi/2) must not exceed the shorter of them.

    Parameters
    ----------
    points : array, shape (n, 2)
        Candidates [m].
    start, target : (float, float)
        Ends of the detour [m].
    course : float or None
        Direction of travel at the start [rad].
    turn_radius : float
        R = V²/(g tan phi) [m], Eq. (13).

    Returns
    -------
    array, shape (n,)
        Shortfall [m].

    Notes
    -----
    Replaces Eqs. (11)-(12) in the `default` preset. Differs from the paper: E16, a heading change is
    compared there with a bank angle.
    """
    here = as_complex(points)
    incoming, outgoing = here - complex(*start), complex(*target) - here
    first = np.abs(incoming)
    need = turn_radius * np.tan(0.5 * np.minimum(turn_angle(incoming, outgoing), SHARPEST))
    shortfall = need - np.minimum(first, np.abs(outgoing))
    if course is not None:
        ahead = complex(math.cos(course), math.sin(course))
        begin = turn_radius * np.tan(0.5 * np.minimum(turn_angle(ahead, incoming), SHARPEST))
        np.maximum(shortfall, begin - first, out=shortfall)
    return np.maximum(shortfall, 0.0, out=shortfall)
