"""The exact planner: the shortest path for a point among discs.

The shortest path consists of segments that touch discs and of arcs on discs. Its graph has the free common
tangents of the discs as edges, joined by the free arcs between them; start and goal are discs of radius 0.
Discs come in lazily: solve with none, add those that the path cuts or nearly cuts, repeat. A path that is
shortest among some of the discs and clear of all of them is shortest among all: the result stays exact.
"""

from __future__ import annotations

import heapq
import math

import numpy as np

from avoidance.arcs import STRIDE, TAU, Barred, admit, checked_discs, covered_arcs, uncovered
from avoidance.barriers import Barriers
from avoidance.geofence import Walls
from avoidance.geometry import Point
from avoidance.path import TOUCH, Path, clear
from avoidance.tangents import Tangents, common_tangents, unobstructed
from avoidance.types import Bools, Floats, Ints

__all__ = ["Path", "clear", "shortest_path"]

START, GOAL = 0, 1
SAME_ANGLE = 1e-10
"""Angles closer than this are one point of a circle [rad]."""
NEAR = 2.0
"""With the discs that the path cuts come those nearer to it than this many radii: fewer rounds."""


def shortest_path(
    start: Point,
    goal: Point,
    centres: Floats,
    radii: Floats,
    walls: Walls | None = None,
    longest: float = math.inf,
) -> Path | None:
    """Find the shortest path that enters no disc.

    Parameters
    ----------
    start, goal : Point
        Where it begins and ends (north, east) [m]; either may lie on a circle.
    centres : Floats
        Centres of the discs (north, east) [m], shape (n, 2).
    radii : Floats
        Their radii [m], shape (n,), zero or more; discs may overlap, contain or equal one another.
    walls : Walls, optional
        Segments that the path keeps `walls.room` from, less where start or goal is nearer. The discs must
        hold one of that radius about each end round which the path may bend.
    longest : float, optional
        A path longer than this is of no use [m]: with some of the discs it would be no longer.

    Returns
    -------
    Path or None
        The shortest path; None if discs and walls leave no way, or none so short.

    Raises
    ------
    ValueError
        If start or goal lies inside a disc by more than 1e-6 of its radius (within that, the disc is
        shrunk to the point), if a number is not finite, a radius negative, or a shape wrong.

    Notes
    -----
    Tangent graph, A* with the straight distance as bound. Exact up to 1e-9 of the radii: discs may be
    touched, and there is a way between two discs that touch.
    """
    world, sizes = checked_discs(centres, radii)
    ends = np.array([(float(start[0]), float(start[1])), (float(goal[0]), float(goal[1]))])
    named = {"start": (ends[0, 0], ends[0, 1]), "goal": (ends[1, 0], ends[1, 1])}
    sizes = admit(named, world, sizes)
    origin = ends.mean(axis=0)
    barriers = Barriers.of(walls, ends, origin)
    graph = _Graph(ends - origin, world - origin, sizes, barriers)
    path = graph.straight()
    waiting = sizes > 0.0
    posts = waiting & barriers.at_ends(graph.world)
    barred = not barriers.clear(path.points[:1], path.points[1:])[0]
    while True:
        clearance = path.clearance(graph.world)
        if not barred and not (waiting & (clearance < sizes * (1.0 - TOUCH))).any():
            return Path(path.length, path.points + origin, path.discs, path.sweeps, world, sizes)
        near = (waiting & (clearance < sizes * NEAR)) | posts
        waiting &= ~near
        posts, barred = np.zeros_like(posts), False
        graph.add(np.flatnonzero(near))
        found = graph.search()
        if found is None or found.length > longest:
            return None
        path = found


class _Graph:
    """The tangent graph of the discs added so far; discs are numbered from 2, after start and goal."""

    def __init__(self, ends: Floats, world: Floats, sizes: Floats, barriers: Barriers) -> None:
        self.world, self.sizes = world, sizes
        self.barriers = barriers
        self.members = np.array([-1, -1], dtype=np.int64)  # number in the world of each disc of the graph
        self.centres, self.radii = ends, np.zeros(2)
        self.arcs = uncovered(2)
        self.barred: Barred = (np.empty(0, dtype=np.int64), np.empty(0), np.empty(0))
        self.tangents = Tangents.none()

    def add(self, discs: Ints) -> None:
        """Put discs of the world into the graph."""
        discs = discs[~self._contained(discs)]
        old, new = len(self.radii), len(self.radii) + len(discs)
        self.members = np.concatenate([self.members, discs])
        self.centres = np.concatenate([self.centres, self.world[discs]])
        self.radii = np.concatenate([self.radii, self.sizes[discs]])
        inner = self.radii * (1.0 - TOUCH)
        if len(self.barriers):
            discs_so_far, begins, ends = self.barred
            numbers, begin, end = self.barriers.arcs(self.centres[old:], self.radii[old:])
            begins, ends = np.append(begins, begin), np.append(ends, end)
            self.barred = np.append(discs_so_far, numbers + old), begins, ends
        self.arcs = covered_arcs(
            self.centres, self.radii, self.radii * (1.0 - 2.0 * TOUCH), barred=self.barred
        )
        fresh, every = np.arange(old, new), np.arange(2, new)
        first, second = np.nonzero(np.arange(new)[:, None] < fresh)
        tangents = self._uncovered(common_tangents(first, fresh[second], self.centres, self.radii))
        tangents = tangents.take(unobstructed(tangents, every, self.centres[2:], inner[2:]))
        if len(self.barriers):
            tangents = tangents.take(self.barriers.clear(tangents.point, tangents.end))
        if len(self.tangents):
            kept = self._uncovered(self.tangents)
            kept = kept.take(unobstructed(kept, fresh, self.centres[old:], inner[old:]))
            tangents = kept.joined(tangents)
        self.tangents = tangents

    def _contained(self, discs: Ints) -> Bools:
        """Which of some discs of the world lie inside another of them or inside a disc of the graph."""
        others = np.concatenate([self.members[2:], discs])
        centres, radii = self.world[others], self.sizes[others]
        away = np.hypot(
            self.world[discs, 0, None] - centres[:, 0], self.world[discs, 1, None] - centres[:, 1]
        )
        inside = away + self.sizes[discs, None] <= radii * (1.0 + TOUCH / 10.0)
        mutual = away + radii <= self.sizes[discs, None] * (1.0 + TOUCH / 10.0)
        inside &= ~mutual | (discs[:, None] > others) | (np.arange(len(others)) < len(self.members) - 2)
        inside &= discs[:, None] != others
        return np.asarray(inside.any(axis=1))

    def _uncovered(self, tangents: Tangents) -> Tangents:
        """Tangents with both ends on free arcs."""
        if not len(self.arcs.disc):
            return tangents
        covered = self.arcs.covers(tangents.i, tangents.angle_i)
        covered |= self.arcs.covers(tangents.j, tangents.angle_j)
        return tangents.take(~covered)

    def straight(self) -> Path:
        """The segment from start to goal."""
        length = math.dist(self.centres[START], self.centres[GOAL])
        ends = np.array([self.centres[START], self.centres[GOAL]])
        return Path(length, ends, np.array([-1]), np.zeros(1), self.world, self.sizes)

    def search(self) -> Path | None:
        """The shortest path among the discs of the graph; None if there is no way."""
        seeds = self.tangents.take(self.tangents.i == START)
        between = self.tangents.take(self.tangents.i > GOAL)
        final = self.tangents.take(self.tangents.i == GOAL).reversed()
        if not len(seeds) or not len(final):
            return None
        every = between.joined(between.reversed(), final, seeds)
        last = len(every) - len(seeds)
        group, offset = self._placed(every)
        order = np.argsort(group[0, :last] * STRIDE + offset[0, :last], kind="stable")
        order = np.concatenate([order, np.arange(last, len(every))])
        every, group, offset = every.take(order), group[:, order], offset[:, order]
        radius = self.radii[every.ends[:, [0, 2]].T]
        circular = group[0, :last] >= 2 * len(self.arcs.disc)
        slides = _Slides(group[0, :last], offset[0, :last], radius[0, :last], circular)
        after, slide = slides.after_departures()
        landing, run = slides.after_arrivals(group[1], offset[1], radius[1])
        landing[every.j == GOAL] = last
        onward, cost = landing.tolist(), (every.length + run).tolist()
        rest = np.hypot(*(every.point[:last] - self.centres[GOAL]).T)
        trail = _cheapest(
            (onward[last:], cost[last:]),
            (after.tolist(), slide.tolist()),
            (onward[:last], cost[:last]),
            [*rest.tolist(), 0.0],
        )
        if trail is None:
            return None
        return self._path(every.take(np.array([last + trail[0], *trail[1:]])))

    def _placed(self, tangents: Tangents) -> tuple[Ints, Floats]:
        """Where the tangents leave (row 0) and arrive (row 1), shape (2, t).

        The group is one free arc in one sense of rotation; the offset is the angle from its beginning.
        """
        disc, sense = tangents.ends[:, [0, 2]].T, tangents.ends[:, [1, 3]].T
        angle = tangents.lines[:, 5:7].T
        if not len(self.arcs.disc):
            return 2 * disc + (sense > 0), np.mod(sense * angle, TAU)
        gap = self.arcs.gap(disc.ravel(), angle.ravel()).reshape(disc.shape)
        nowhere = np.zeros(len(self.radii))
        opening = np.concatenate([self.arcs.end, nowhere])[gap]
        closing = np.concatenate([self.arcs.begin[self.arcs.following], nowhere])[gap]
        return 2 * gap + (sense > 0), np.mod(sense * (angle - np.where(sense > 0, opening, closing)), TAU)

    def _path(self, flown: Tangents) -> Path:
        """Path that flies some tangents in turn, with the arcs between."""
        points, discs, sweeps, lengths = [self.centres[START]], [], [], []
        ends = flown.end
        for k in range(len(flown)):
            disc, sense = int(flown.i[k]), int(flown.sense_i[k])
            if k > 0:
                sweep = (sense * (flown.angle_i[k] - flown.angle_j[k - 1])) % TAU
                if SAME_ANGLE < sweep < TAU - 2.0 * SAME_ANGLE:
                    points.append(flown.point[k])
                    discs.append(int(self.members[disc]))
                    sweeps.append(sense * float(sweep))
                    lengths.append(float(self.radii[disc] * sweep))
            if flown.length[k] > 0.0:
                points.append(ends[k])
                discs.append(-1)
                sweeps.append(0.0)
                lengths.append(float(flown.length[k]))
        points[-1] = self.centres[GOAL]
        numbers = np.array(discs, dtype=np.int64)
        length = math.fsum(lengths)
        return Path(length, np.array(points), numbers, np.array(sweeps), self.world, self.sizes)


class _Slides:
    """Motion along free arcs, over departures sorted by group and angle."""

    def __init__(self, group: Ints, offset: Floats, radius: Floats, circular: Bools) -> None:
        self.group, self.offset, self.radius, self.circular = group, offset, radius, circular
        self.first = np.searchsorted(group, group, side="left")

    def after_departures(self) -> tuple[Ints, Floats]:
        """Next departure on the same arc after each (-1: none) and the way to it [m]."""
        index = np.arange(len(self.group))
        following = np.append(index[1:], 0)
        same = self.group[following] == self.group
        same[-1:] = False
        target = np.where(same, following, np.where(self.circular, self.first, -1))
        ahead = np.mod(self.offset[target] - self.offset, TAU)
        return target, np.asarray(self.radius * ahead)

    def after_arrivals(self, group: Ints, offset: Floats, radius: Floats) -> tuple[Ints, Floats]:
        """First departure from each arrival on (-1: none) and the way to it [m]."""
        keys = self.group * STRIDE + self.offset
        target = np.searchsorted(keys, group * STRIDE + offset - SAME_ANGLE)
        inside = np.minimum(target, len(keys) - 1)
        same = (target < len(keys)) & (self.group[inside] == group)
        first = np.minimum(np.searchsorted(self.group, group, side="left"), len(keys) - 1)
        around = (self.group[first] == group) & self.circular[first]
        target = np.where(same, inside, np.where(around, first, -1))
        ahead = self.offset[target] - offset
        ahead = np.where(same, np.maximum(ahead, 0.0), ahead + TAU)
        return target, np.asarray(radius * ahead)


Links = tuple[list[int], list[float]]


def _cheapest(seeds: Links, slides: Links, flights: Links, rest: list[float]) -> list[int] | None:
    """Find the cheapest chain of flights from start to goal by A*.

    Parameters
    ----------
    seeds, slides, flights : Links
        For each seed the departure it leads to (-1: none) and its cost [m]; for each departure the same of
        sliding on to the next one and of flying its tangent. The goal is the departure after the last.
    rest : list[float]
        Lower bound of the way from each departure to the goal, 0 for the goal itself [m].

    Returns
    -------
    list[int] or None
        The seed, then the departures whose tangents are flown; None if the goal cannot be reached.
    """
    goal = len(rest) - 1
    cost = [math.inf] * len(rest)
    came = [0] * len(rest)  # 2 × departure + flown, or -1 - seed
    heap: list[tuple[float, int]] = []
    for k, (target, way) in enumerate(zip(*seeds, strict=True)):
        if target >= 0 and way < cost[target]:
            cost[target], came[target] = way, -1 - k
            heapq.heappush(heap, (way + rest[target], target))
    done = bytearray(len(rest))
    while heap:
        _, here = heapq.heappop(heap)
        if here == goal:
            break
        if done[here]:
            continue
        done[here] = 1
        for flown, (targets, ways) in enumerate((slides, flights)):
            target, way = targets[here], cost[here] + ways[here]
            if target >= 0 and way < cost[target]:
                cost[target], came[target] = way, 2 * here + flown
                heapq.heappush(heap, (way + rest[target], target))
    else:
        return None
    trail: list[int] = []
    step = came[goal]
    while step >= 0:
        if step % 2:
            trail.append(step // 2)
        step = came[step // 2]
    return [-1 - step, *reversed(trail)]
