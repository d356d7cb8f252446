"""Closed-form plane and space geometry of points, segments, circles and spheres.

Points are pairs (north, east) [m] unless an argument says otherwise; angles are measured from north
towards east. Differences are taken before products, so that nothing is lost 350 km from the origin.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from avoidance.types import Bools, Floats

FEW = 40
"""So few centres are not worth sorting out."""
Point: TypeAlias = Sequence[float] | Floats
"""A point as any indexable pair (north, east) [m]."""


def segment_point_distance(a: Point, b: Point, points: Floats) -> Floats:
    """Distance of each point from one segment.

    Parameters
    ----------
    a, b : Point
        Ends of the segment (north, east) [m]; they may coincide.
    points : Floats
        Points (north, east) [m], shape (n, 2).

    Returns
    -------
    Floats
        Distances [m], shape (n,).

    Notes
    -----
    Eq. (21), the distance between vehicle and obstacle, minimised over the segment. Differs from the
    paper: the ends of the segment count, not the infinite line (E17).
    """
    along_north, along_east = float(b[0]) - float(a[0]), float(b[1]) - float(a[1])
    length = math.hypot(along_north, along_east)
    north, east = points[..., 0] - float(a[0]), points[..., 1] - float(a[1])
    if length == 0.0:
        return np.asarray(np.hypot(north, east))
    unit_north, unit_east = along_north / length, along_east / length
    along = north * unit_north + east * unit_east
    across = east * unit_north - north * unit_east
    beyond = np.maximum(np.maximum(-along, along - length), 0.0)
    return np.asarray(np.hypot(across, beyond))


def distances(points: Floats, centres: Floats) -> Floats:
    """Distance of every centre from every point.

    Parameters
    ----------
    points : Floats
        Points (north, east) [m], shape (m, 2).
    centres : Floats
        Points (north, east) [m], shape (n, 2).

    Returns
    -------
    Floats
        Distances [m], shape (m, n).

    Notes
    -----
    Eqs. (3) and (21), in the plane.
    """
    north = points[:, 0, None] - centres[:, 0]
    east = points[:, 1, None] - centres[:, 1]
    square = np.square(north, out=north)
    square += np.square(east, out=east)
    return np.asarray(np.sqrt(square, out=square))  # hypot is several times slower


def point_distances(centres: Floats, point: Point) -> Floats:
    """Distance of each centre, shape (n, 2), from one point [m], shape (n,)."""
    return np.asarray(np.hypot(centres[:, 0] - float(point[0]), centres[:, 1] - float(point[1])))


def within_reach(points: Floats, centres: Floats, reach: Floats | float) -> Bools | slice:
    """Which centres can lie within `reach` of any of the points, by the box about them.

    Parameters
    ----------
    points : Floats
        Points (north, east) [m], shape (m, 2), m >= 1.
    centres : Floats
        Points (north, east) [m], shape (n, 2).
    reach : Floats or float
        Distance for all or for each centre [m], shape (n,).

    Returns
    -------
    Bools or slice
        False only where no point is that near, shape (n,); all, where sorting them out would cost more than
        it saves.
    """
    if len(centres) <= FEW:
        return slice(None)
    near = np.ones(len(centres), dtype=np.bool_)
    for axis in (0, 1):
        along, centre = points[:, axis], centres[:, axis]
        near &= (centre + reach >= along.min()) & (centre - reach <= along.max())
    return near


def segments_clearance(starts: Floats, ends: Floats, centres: Floats) -> Floats:
    """Distance of every centre from every segment.

    Parameters
    ----------
    starts, ends : Floats
        Ends of the segments (north, east) [m], shape (m, 2); a segment may be a point.
    centres : Floats
        Points (north, east) [m], shape (n, 2).

    Returns
    -------
    Floats
        Distances [m], shape (m, n).

    Notes
    -----
    Eq. (21) minimised over each segment, ends included (differs from the paper: E17).
    """
    along_north, along_east = ends[:, 0] - starts[:, 0], ends[:, 1] - starts[:, 1]
    length = np.hypot(along_north, along_east)
    point = length == 0.0
    scale = np.where(point, 1.0, length)
    unit_north, unit_east = (along_north / scale)[:, None], (along_east / scale)[:, None]
    north = centres[:, 0] - starts[:, 0, None]
    east = centres[:, 1] - starts[:, 1, None]
    along = north * unit_north + east * unit_east
    square = east * unit_north - north * unit_east
    beyond = np.maximum(-along, along - length[:, None])
    np.maximum(beyond, 0.0, out=beyond)
    if point.any():
        beyond[point] = np.hypot(north[point], east[point])
    np.square(square, out=square)
    square += np.square(beyond, out=beyond)
    return np.asarray(np.sqrt(square, out=square))  # hypot is several times slower


def segment_sphere_interval(
    start: Sequence[float], end: Sequence[float], centre: Sequence[float], radius: float
) -> tuple[float, float] | None:
    """Part of a segment that lies in a sphere.

    Parameters
    ----------
    start, end : Sequence[float]
        Ends of the segment [m], as many coordinates as the centre has (two or three).
    centre : Sequence[float]
        Centre of the sphere [m].
    radius : float
        Its radius [m].

    Returns
    -------
    tuple[float, float] or None
        Entry and exit as fractions of the segment, 0 ≤ t₀ ≤ t₁ ≤ 1; touching counts (t₀ = t₁).
        None if the segment stays outside. A segment of no length inside the sphere gives (0, 1).

    Notes
    -----
    Eqs. (22)-(26), Algorithm 6, with the coefficients b and c taken relative to the centre and the
    discriminant as r² less the squared distance of the line from the centre, which loses no digits far
    from the origin. Differs from the paper: t is limited to [0, 1] (E17); the infinite line flags
    spheres that have been passed.
    """
    a = half_b = offset = 0.0
    for s, e, c in zip(start, end, centre, strict=True):
        a += (e - s) ** 2
        half_b += (e - s) * (s - c)
        offset += (s - c) ** 2
    if a == 0.0:
        return (0.0, 1.0) if offset <= radius * radius else None
    nearest = -half_b / a
    distance_squared = sum(
        (s + (e - s) * nearest - c) ** 2 for s, e, c in zip(start, end, centre, strict=True)
    )
    room = radius * radius - distance_squared
    if room < 0.0:
        return None
    half = math.sqrt(room / a)
    first, last = max(0.0, nearest - half), min(1.0, nearest + half)
    return (first, last) if first <= last else None


def tangent_points(point: Point, centre: Point, radius: float) -> Floats:
    """Points where the two tangents from a point touch a circle.

    Parameters
    ----------
    point : Point
        Where the tangents start (north, east) [m], on or outside the circle.
    centre : Point
        Centre of the circle [m].
    radius : float
        Its radius [m].

    Returns
    -------
    Floats
        Touching points (north, east) [m], shape (2, 2): the one to the right of the line from the point
        to the centre, seen from above, then the one to the left. On the circle both are the point.

    Raises
    ------
    ValueError
        If the point lies inside the circle (by more than 1e-9 of the radius).

    Notes
    -----
    Eq. (27). Differs from the paper: its formula holds only with the vehicle at the origin and gives
    four candidates; here coordinates are relative to the point and both results are tangents (E26).
    """
    north, east = float(centre[0]) - float(point[0]), float(centre[1]) - float(point[1])
    distance = math.hypot(north, east)
    if not distance > radius * (1.0 - 1e-9):
        raise ValueError(f"point must lie outside the circle: distance {distance} m, radius {radius} m")
    sine = min(1.0, radius / distance)
    cosine = math.sqrt((1.0 - sine) * (1.0 + sine))
    ahead, aside = cosine * cosine, cosine * sine  # the tangent is cosine × distance long
    p_north, p_east = float(point[0]), float(point[1])
    return np.array(
        [
            (p_north + ahead * north - aside * east, p_east + ahead * east + aside * north),
            (p_north + ahead * north + aside * east, p_east + ahead * east - aside * north),
        ]
    )


def circle_intersections(centre_1: Point, radius_1: float, centre_2: Point, radius_2: float) -> Floats:
    """Points that two circles have in common.

    Parameters
    ----------
    centre_1, centre_2 : Point
        Centres (north, east) [m].
    radius_1, radius_2 : float
        Radii [m].

    Returns
    -------
    Floats
        Common points (north, east) [m], shape (k, 2): none, one (touching) or two, the one to the right
        of the line from centre 1 to centre 2 first. Circles that coincide give none.
    """
    north, east = float(centre_2[0]) - float(centre_1[0]), float(centre_2[1]) - float(centre_1[1])
    distance = math.hypot(north, east)
    if distance == 0.0 or distance > radius_1 + radius_2 or distance < abs(radius_1 - radius_2):
        return np.empty((0, 2))
    along = ((radius_1 - radius_2) * (radius_1 + radius_2) / distance + distance) / 2.0
    aside = math.sqrt(max(0.0, (radius_1 - along) * (radius_1 + along)))
    unit_north, unit_east = north / distance, east / distance
    foot = (float(centre_1[0]) + along * unit_north, float(centre_1[1]) + along * unit_east)
    right = (foot[0] - aside * unit_east, foot[1] + aside * unit_north)
    left = (foot[0] + aside * unit_east, foot[1] - aside * unit_north)
    return np.array([right] if aside == 0.0 else [right, left])


def line_circle_intersections(a: Point, b: Point, centre: Point, radius: float) -> Floats:
    """Points where the line through two points meets a circle.

    Parameters
    ----------
    a, b : Point
        Two different points of the line (north, east) [m].
    centre : Point
        Centre of the circle [m].
    radius : float
        Its radius [m].

    Returns
    -------
    Floats
        Common points (north, east) [m] in the order of travel from `a` to `b`, shape (k, 2): none, one
        (touching) or two. The line is not limited to the segment.

    Raises
    ------
    ValueError
        If `a` and `b` coincide.
    """
    north, east = float(b[0]) - float(a[0]), float(b[1]) - float(a[1])
    length = math.hypot(north, east)
    if length == 0.0:
        raise ValueError(f"a and b must differ to give a line: both are {tuple(map(float, a))}")
    unit_north, unit_east = north / length, east / length
    to_north, to_east = float(centre[0]) - float(a[0]), float(centre[1]) - float(a[1])
    along = to_north * unit_north + to_east * unit_east
    across = to_east * unit_north - to_north * unit_east
    if abs(across) > radius:
        return np.empty((0, 2))
    half = math.sqrt((radius - across) * (radius + across))
    spots = [along] if half == 0.0 else [along - half, along + half]
    return np.array([(float(a[0]) + t * unit_north, float(a[1]) + t * unit_east) for t in spots])
