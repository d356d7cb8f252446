"""What can go wrong with a plant in the loop, beside the plant itself."""

from __future__ import annotations

from collections.abc import Sequence

from offboard.errors import LinkError, OffboardError


class OptionError(OffboardError):
    """Something the user has given cannot be used; lists every mistake in it."""

    def __init__(self, source: object, mistakes: Sequence[str]) -> None:
        super().__init__(f"{source}: " + "; ".join(mistakes))
        self.source = source
        self.mistakes = tuple(mistakes)


class LinkLost(LinkError):  # noqa: N818  (an outcome that callers wait for by this name)
    """The autopilot has closed the connection, or says nothing any more."""
