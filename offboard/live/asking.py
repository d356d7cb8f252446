"""Requests that are waited for, while everything else goes on."""

from __future__ import annotations

from collections.abc import Callable

from offboard.errors import LinkError
from offboard.live.messages import Ask, Reply, Session

NOT_ANSWERED = Reply(Ask.UPLOAD, -1, False, "no answer")
SLOWEST_POLL = 0.1
"""Time limits are looked at this often while nothing comes in [s, wall clock]."""


class Asking:
    """Waits for answers of a vehicle.

    Parameters
    ----------
    session : Session
        Whose clock counts.
    pump : callable
        Takes over what comes in, waiting so long for it [s]; hands each answer to `on_reply`.
    """

    def __init__(self, session: Session, pump: Callable[[float], None]) -> None:
        self._session = session
        self._pump = pump
        self._waited: dict[int, Reply | None] = {}

    @property
    def waiting(self) -> bool:
        """True while an answer is waited for."""
        return bool(self._waited)

    def on_reply(self, reply: Reply) -> None:
        """Take over an answer; those that nobody waits for are left alone."""
        if reply.token in self._waited:
            self._waited[reply.token] = reply

    def wait_for(self, ready: Callable[[], bool], timeout: float) -> bool:
        """Wait until something is so; False if it is not within `timeout` wall seconds."""
        until = self._session.wall() + timeout
        while not ready():
            if self._session.wall() >= until:
                return False
            self._pump(SLOWEST_POLL)
        return True

    def request(self, token: int, words: str, timeout: float = 10.0) -> Reply:
        """Wait for the outcome of a request to the session; `words` say what the vehicle is to do.

        Raises
        ------
        LinkError
            If it does not do so.
        """
        self._waited[token] = None
        self.wait_for(lambda: self._waited[token] is not None, timeout)
        reply = self._waited.pop(token) or NOT_ANSWERED
        if not reply.ok:
            raise LinkError(f"the vehicle did not {words} ({reply.why})")
        return reply
