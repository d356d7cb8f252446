"""The rims of discs and walls: where they come nearest to a point, and where they cross."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from avoidance.types import Floats
from scenarios.walled import Shapes, crossing_shares


@dataclass(frozen=True, slots=True, eq=False)
class Rims:
    """Circles, and the straight lines beside walls."""

    centres: Floats
    """Of the circles, shape (c, 2) [m]."""
    radii: Floats
    """Of the circles, shape (c,) [m]."""
    starts: Floats
    """Begin of each line, shape (k, 2) [m]."""
    steps: Floats
    """From there to its end, shape (k, 2) [m]."""

    @classmethod
    def of(cls, shapes: Shapes) -> Rims:
        """The rims of shapes; a wall has a circle about either end and a line on either side."""
        along = shapes.ends - shapes.starts
        length = np.hypot(along[:, 0], along[:, 1])
        wall = length > 0.0
        circles = np.concatenate(
            (
                np.column_stack((shapes.starts, shapes.radii)),
                np.column_stack((shapes.ends[wall], shapes.radii[wall])),
            )
        )
        circles = np.unique(circles, axis=0)
        side = (shapes.radii[wall] / length[wall])[:, None] * np.column_stack(
            (-along[wall, 1], along[wall, 0])
        )
        starts = np.concatenate((shapes.starts[wall] + side, shapes.starts[wall] - side))
        return cls(circles[:, :2], circles[:, 2], starts, np.concatenate((along[wall], along[wall])))

    def feet(self, target: Floats, start: Floats) -> Floats:
        """The point of each rim nearest to `target`, shape (c + k, 2); towards `start` from a centre."""
        out = target - self.centres
        out[(out == 0.0).all(axis=1)] = start - target if (start != target).any() else (1.0, 0.0)
        on_circles = self.centres + out * (self.radii / np.hypot(out[:, 0], out[:, 1]))[:, None]
        square = (self.steps**2).sum(axis=1)
        share = np.clip(((target - self.starts) * self.steps).sum(axis=1) / square, 0.0, 1.0)
        return np.concatenate((on_circles, self.starts + share[:, None] * self.steps))

    def crossings(self) -> Floats:
        """Where two rims cross, shape (m, 2) [m]."""
        return np.concatenate((self._of_circles(), self._of_lines(), self._of_both()))

    def _of_circles(self) -> Floats:
        centres, radii = self.centres, self.radii
        off = centres[:, None] - centres[None]
        between = np.hypot(off[..., 0], off[..., 1])
        meets = (between <= radii[:, None] + radii[None]) & (between >= np.abs(radii[:, None] - radii[None]))
        i, j = np.nonzero(np.triu(meets & (between > 0.0), k=1))
        d = between[i, j]
        along = (d**2 + radii[i] ** 2 - radii[j] ** 2) / (2.0 * d)
        across = np.sqrt(np.maximum(radii[i] ** 2 - along**2, 0.0))
        unit = (centres[j] - centres[i]) / d[:, None]
        middle = centres[i] + along[:, None] * unit
        normal = np.column_stack((-unit[:, 1], unit[:, 0])) * across[:, None]
        return np.concatenate((middle + normal, middle - normal))

    def _of_lines(self) -> Floats:
        i, j = np.triu_indices(len(self.starts), k=1)
        share, cut = crossing_shares(self.starts[i], self.steps[i], self.starts[j], self.steps[j])
        found: Floats = self.starts[i[cut]] + share[cut, None] * self.steps[i[cut]]
        return found

    def _of_both(self) -> Floats:
        """Lines, rows, with circles, columns."""
        length = np.hypot(self.steps[:, 0], self.steps[:, 1])
        unit = self.steps / length[:, None]
        offset = self.centres[None] - self.starts[:, None]
        forward = (offset * unit[:, None]).sum(axis=-1)
        across = unit[:, None, 0] * offset[..., 1] - unit[:, None, 1] * offset[..., 0]
        half = np.sqrt(np.maximum(self.radii**2 - across**2, 0.0))
        found = []
        for reach in (forward - half, forward + half):
            cut = (np.abs(across) <= self.radii) & (reach >= 0.0) & (reach <= length[:, None])
            line, circle = np.nonzero(cut)
            found.append(self.starts[line] + reach[line, circle, None] * unit[line])
        return np.concatenate(found)
