"""The curves that bound the feasible waypoints, and where they meet (Eq. 27, generalised).

Tangents from the start and from the target to the circles that the legs must keep clear of, the circles that
the waypoint itself must keep clear of, and those about what is avoided that it must not leave. Points and
directions are complex numbers, north + i east: a turn is a product, and the dot and the cross product of a
and b are the real and the imaginary part of conj(a) b.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from avoidance.flown import as_complex, as_pairs
from avoidance.problem import WaypointProblem
from avoidance.types import Bools, Complexes, Floats, Ints

OUTSIDE = 0.02
"""Seeds lie this far outside the curves they stand on [m]."""
CORNER_PADS = np.array([OUTSIDE, 6.0, 20.0, 60.0])
"""Tangents that meet near their circle are drawn this far outside, so that the turn stays outside too [m]."""
CIRCLE_POINTS = 12
"""Points on each circle that the waypoint must keep clear of."""
RING = np.exp(2.0j * np.pi / CIRCLE_POINTS * np.arange(CIRCLE_POINTS))
"""Their directions from its centre."""
MOST_CIRCLES = 40
"""Circles whose intersections with one another fit into a decision."""
PARALLEL = 1e-12
"""Sine of the angle at which two rays count as parallel."""


@dataclass(frozen=True, slots=True, eq=False)
class Curves:
    """Circles, and rays that touch them."""

    start: complex
    """Where the legs begin [m]."""
    target: complex
    """Where they end [m]."""
    centres: Complexes
    """Of circles, shape (c,) [m]: first those to keep out of, then those to keep within (g2)."""
    radii: Floats
    """Their radii, shape (c,) [m]."""
    rims: int
    """How many are to be kept out of."""
    from_start: Complexes
    """Directions of tangents from the start that reach their circle, by pad, shape (p, a)."""
    from_target: Complexes
    """The same from the target, shape (p, b)."""

    @classmethod
    def of(cls, problem: WaypointProblem, near: Ints) -> Curves:
        """Those of the obstacles with the indices `near`, shape (d,)."""
        centres, keep = as_complex(problem.centres[near]), problem.keep[near]
        if not problem.rays:
            problem.rays.append(_rays(problem, centres, keep))
        radii = (keep if "g1" in problem.relaxed else problem.keep_waypoint[near]) + OUTSIDE
        if "g2" not in problem.relaxed:
            limit = problem.parameters.search_limit - OUTSIDE
            centres = np.concatenate([centres, as_complex(problem.centres[problem.avoided])])
            radii = np.concatenate([radii, np.full(len(problem.avoided), limit)])
        ends = complex(*problem.start), complex(*problem.target)
        return cls(*ends, centres, radii, len(near), *problem.rays[0])

    def corners(self, pads: int = len(CORNER_PADS)) -> Complexes:
        """Where rays from the start meet rays from the target, drawn with some of the pads."""
        first, second = self.from_start[:pads, :, None], self.from_target[:pads, None]
        between = self.target - self.start
        sine = (np.conj(first) * second).imag
        with np.errstate(divide="ignore", invalid="ignore"):  # parallel rays meet nowhere
            along_first = (np.conj(between) * second).imag / sine
            along_second = (np.conj(between) * first).imag / sine
        good = (along_first > 0.0) & (along_second > 0.0) & (np.abs(sine) >= PARALLEL)
        return np.asarray((self.start + along_first * first)[good])

    def pierced(self) -> tuple[Complexes, Complexes]:
        """Where rays enter circles, and where they leave them."""
        rays = np.concatenate([self.from_start[0], self.from_target[0]])[:, None]
        origins = np.full(rays.shape, self.target)
        origins[: self.from_start.shape[1]] = self.start
        seen = np.conj(rays) * (self.centres - origins)
        square = self.radii * self.radii - seen.imag**2
        half = np.sqrt(np.maximum(square, 0.0))
        near, far = seen.real - half, seen.real + half
        ahead = (square >= 0.0) & (far > 0.0)
        entered = ahead & (near > 0.0)
        return (origins + near * rays)[entered], (origins + far * rays)[ahead]

    def crossings(self) -> tuple[Complexes, Complexes]:
        """Intersections of all pairs of circles; of many, of those alone that are to be kept out of."""
        count = len(self.centres) if len(self.centres) <= MOST_CIRCLES else self.rims
        centres, radii = self.centres[:count], self.radii[:count]
        offset = centres - centres[:, None]
        distance = np.abs(offset)
        first, second = np.nonzero(distance < radii + radii[:, None])
        first, second = first[first < second], second[first < second]
        offset, distance = offset[first, second], np.maximum(distance[first, second], 1e-9)
        along = (distance**2 + radii[first] ** 2 - radii[second] ** 2) / (2.0 * distance)
        square = radii[first] ** 2 - along**2
        good = square >= 0.0
        unit = offset[good] / distance[good]
        foot = centres[first[good]] + along[good] * unit
        half = 1.0j * np.sqrt(square[good]) * unit
        return foot + half, foot - half

    def meetings(self, pads: int = len(CORNER_PADS)) -> Floats:
        """Where any of them meet, shape (m, 2) [m]."""
        return as_pairs(np.concatenate([self.corners(pads), *self.pierced(), *self.crossings()]))

    def beside(self) -> Floats:
        """Points along each circle, and where it comes nearest to the straight leg, shape (m, 2) [m]."""
        between = self.target - self.start
        across = 1.0j * between / max(abs(between), 1e-9)
        directions = np.append(RING, [across, -across])
        found = self.centres[: self.rims, None] + self.radii[: self.rims, None] * directions
        return np.asarray(found.view(np.float64).reshape(-1, 2))


def _rays(problem: WaypointProblem, centres: Complexes, keep: Floats) -> tuple[Complexes, Complexes]:
    """Directions of tangents from the start and from the target that reach their circle, by pad."""
    points = np.array([complex(*problem.start), complex(*problem.target)])
    offset = centres - points[:, None]
    directions = _tangents(offset, keep + CORNER_PADS[:, None, None])
    reaching = _reaching(problem, points, offset, keep + OUTSIDE, directions[0])
    return directions[:, 0, reaching[0]], directions[:, 1, reaching[1]]


def _tangents(offset: Complexes, radii: Floats) -> Complexes:
    """Directions of the left, then of the right tangents from points to circles.

    Of centres as seen from each point, shape (k, d), and radii of shape (p, 1, d): shape (p, k, 2d). Towards
    the centre, turned by 90 degrees, from inside.
    """
    distance = np.maximum(np.abs(offset), 1e-9)
    sine = np.minimum(radii / distance, 1.0)
    opening = np.sqrt(1.0 - sine * sine) + 1.0j * sine
    bearing = offset / distance
    return np.concatenate([bearing * np.conj(opening), bearing * opening], axis=-1)


def _reaching(
    problem: WaypointProblem, points: Complexes, offset: Complexes, radii: Floats, directions: Complexes
) -> Bools:
    """Which of the tangents from k points nothing blocks before they touch their circle, shape (k, 2d)."""
    square = np.tile(np.abs(offset) ** 2 - radii * radii, 2)
    touch = points[:, None] + np.sqrt(np.maximum(square, 0.0)) * directions
    begin = np.broadcast_to(points[:, None], touch.shape)
    less = np.full((touch.size, 1), -OUTSIDE)
    short = problem.line_shortfall(begin.reshape(-1, 1), touch.reshape(-1, 1), less)
    return np.asarray((short <= 0.0).reshape(touch.shape) & (square > 0.0))
