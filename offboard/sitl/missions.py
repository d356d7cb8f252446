"""MAVLink's mission protocol, the vehicle's side: missions, geofences and rally points, up and down."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol

from offboard.sitl.dialect import Message, mavlink
from offboard.sitl.downloads import MISSION, Downloads, Partner
from offboard.sitl.flavour import Flavour
from offboard.sitl.items import WireItem

TYPES = (MISSION, mavlink.MAV_MISSION_TYPE_FENCE, mavlink.MAV_MISSION_TYPE_RALLY)
MOST_ATTEMPTS = 25
"""How often an item is asked for before an upload is given up."""
MOST_ACKNOWLEDGEMENTS = 3
"""How often the end of an upload is acknowledged over a link that loses messages."""
ACCEPTED = mavlink.MAV_MISSION_ACCEPTED


class Owner(Protocol):
    """Whoever flies the missions."""

    def home(self) -> WireItem:
        """Home as an item."""

    def current_item(self) -> int:
        """Seq of the item that is flown to."""

    def too_far(self, item: WireItem) -> int | None:
        """The MAV_MISSION_RESULT for an item that lies out of reach; None if it does not."""

    def uploaded(self, items: Sequence[WireItem], flagged: int | None) -> None:
        """A mission has come in as a whole."""

    def overwritten(self, items: Sequence[WireItem], complete: bool) -> None:
        """One item of the mission has been written over, or the last one of an upload."""

    def gave_up(self) -> None:
        """An upload has come to nothing."""


@dataclass(slots=True)
class Upload:
    """An upload under way."""

    partner: Partner
    kind: int
    end: int
    """Seq behind the last item."""
    next: int
    """Seq of the item asked for."""
    items: list[WireItem] = field(default_factory=list)
    flagged: int | None = None
    attempts: int = 1
    asked_at: float = 0.0


class MissionProtocol:
    """Answers mission messages; asks again for what got lost.

    Parameters
    ----------
    flavour : Flavour
        Whose rules hold.
    owner : Owner
        Told what comes in.
    send : callable
        Sends a message on a link.
    retry : float
        Time until an item is asked for again [s].
    """

    def __init__(
        self, flavour: Flavour, owner: Owner, send: Callable[[int, Message], None], retry: float
    ) -> None:
        self.lists: dict[int, tuple[WireItem, ...]] = dict.fromkeys(TYPES, ())
        self._flavour = flavour
        self._owner = owner
        self._send = send
        self._retry = retry
        self._upload: Upload | None = None
        self._finished: tuple[Partner, int, int] | None = None
        self._repeat: Upload | None = None
        self._lossy: set[Partner] = set()
        self._ints: set[int] = set()
        downloads = self._downloads = Downloads(self.lists, flavour, owner.current_item, send)
        self._handlers: dict[str, Callable[[Partner, Message, float], None]] = {
            "MISSION_COUNT": self._count,
            "MISSION_ITEM": self._item,
            "MISSION_ITEM_INT": self._item,
            "MISSION_WRITE_PARTIAL_LIST": self._write_partial,
            "MISSION_REQUEST_LIST": downloads.count,
            "MISSION_REQUEST_PARTIAL_LIST": downloads.part,
            "MISSION_REQUEST": downloads.item,
            "MISSION_REQUEST_INT": self._request_int,
            "MISSION_ACK": self._ack,
            "MISSION_CLEAR_ALL": self._clear,
        }

    def handle(self, partner: Partner, message: Message, now: float) -> bool:
        """Do what a message asks; False if it is none of this protocol."""
        handler = self._handlers.get(message.get_type())
        if handler is None:
            return False
        self.heard(partner)
        kind = getattr(message, "mission_type", MISSION)
        if kind == mavlink.MAV_MISSION_TYPE_ALL and message.get_type() == "MISSION_CLEAR_ALL":
            handler(partner, message, now)
        elif kind not in TYPES:
            self._answer(partner, mavlink.MAV_MISSION_UNSUPPORTED, kind)
        else:
            handler(partner, message, now)
        return True

    def heard(self, partner: Partner) -> None:
        """Someone goes on to something else, and so has heard that the upload is complete."""
        if self._repeat is not None and partner == self._repeat.partner:
            self._repeat = None

    def step(self, now: float) -> None:
        """Ask again for an item that does not come; give up after a while."""
        self._acknowledge_again(now)
        upload = self._upload
        if upload is None or now < upload.asked_at + self._retry - 1e-9:
            return
        if upload.attempts >= MOST_ATTEMPTS:
            self._upload = None
            self._answer(upload.partner, mavlink.MAV_MISSION_OPERATION_CANCELLED, upload.kind)
            self._owner.gave_up()
            return
        upload.attempts += 1
        self._lossy.add(upload.partner)
        self._ask(upload, now)

    def _acknowledge_again(self, now: float) -> None:
        """Say once more that an upload is complete, to a partner whose link has lost something before.

        MAVSDK does not ask: it waits for an acknowledgement until it gives the upload up.
        """
        repeat = self._repeat
        if repeat is None or now < repeat.asked_at + self._retry - 1e-9:
            return
        self._answer(repeat.partner, ACCEPTED, repeat.kind)
        repeat.asked_at = now
        repeat.attempts += 1
        if repeat.attempts > MOST_ACKNOWLEDGEMENTS:
            self._repeat = None

    def store(self, kind: int, items: Sequence[WireItem]) -> None:
        """Keep a list as it is."""
        self.lists[kind] = tuple(items)

    # Up

    def _count(self, partner: Partner, message: Message, now: float) -> None:
        kind, count = message.mission_type, message.count
        busy = self._upload
        if busy is not None and busy.partner != partner:
            self._answer(partner, mavlink.MAV_MISSION_ERROR, kind)
        elif count > self._flavour.most_items:
            self._answer(partner, mavlink.MAV_MISSION_NO_SPACE, kind)
        elif busy is not None and busy.kind == kind and busy.end == count and busy.next == 0:
            self._ask(busy, now)
        elif count == 0:
            self._upload = None
            self._replace(kind, (), None)
            self._answer(partner, ACCEPTED, kind)
        else:
            self._finished = None
            self._upload = Upload(partner, kind, count, 0)
            if self._in_place(kind):
                self.lists[kind] = self.lists[kind][:count]
                self._owner.overwritten(self.lists[kind], complete=False)
            self._ask(self._upload, now)

    def _write_partial(self, partner: Partner, message: Message, now: float) -> None:
        kind, start, end = message.mission_type, message.start_index, message.end_index
        if not self._in_place(kind):
            self._answer(partner, mavlink.MAV_MISSION_UNSUPPORTED, kind)
        elif self._upload is not None or not 0 <= start <= end <= len(self.lists[kind]):
            self._answer(partner, mavlink.MAV_MISSION_ERROR, kind)
        else:
            self._finished = None
            self._upload = Upload(partner, kind, end + 1, start)
            self._ask(self._upload, now)

    def _item(self, partner: Partner, message: Message, now: float) -> None:
        if message.get_type() == "MISSION_ITEM_INT":
            self._ints.add(partner[0])
        upload, kind, seq = self._upload, message.mission_type, message.seq
        if upload is None or upload.partner != partner or upload.kind != kind:
            if self._finished == (partner, kind, seq):
                self._answer(partner, ACCEPTED, kind)  # our acknowledgement got lost
            return
        if seq >= upload.end:
            self._refuse(upload, mavlink.MAV_MISSION_INVALID_SEQUENCE)
            return
        if seq != upload.next:
            return  # a copy, or one that has overtaken another; what is wanted is asked for again
        item = WireItem.of(message)
        problem = item.problem(kind, nan_allowed=self._flavour.atomic) or self._owner.too_far(item)
        if problem is not None:
            self._refuse(upload, problem)
            return
        self._take(upload, item, bool(message.current), now)

    def _take(self, upload: Upload, item: WireItem, flagged: bool, now: float) -> None:
        """One more item; the last one ends the upload."""
        if flagged:
            upload.flagged = upload.next
        if self._flavour.atomic and item.command == mavlink.MAV_CMD_NAV_TAKEOFF:
            item = replace(item, param1=0.0)  # PX4 does not keep the pitch
        upload.items.append(item)
        if self._in_place(upload.kind):
            if upload.next == 0:
                item = self._owner.home()
            items = list(self.lists[upload.kind])
            items[upload.next : upload.next + 1] = [item]
            self.lists[upload.kind] = tuple(items)
        upload.next += 1
        if upload.next < upload.end:
            if self._in_place(upload.kind):
                self._owner.overwritten(self.lists[upload.kind], complete=False)
            upload.attempts = 1
            self._ask(upload, now)
            return
        self._upload = None
        self._finished = (upload.partner, upload.kind, upload.end - 1)
        if upload.partner in self._lossy:
            self._repeat = upload
            upload.attempts, upload.asked_at = 1, now
        self._replace(upload.kind, upload.items, upload.flagged, upload.partner)

    def _replace(
        self,
        kind: int,
        items: Sequence[WireItem],
        flagged: int | None,
        partner: Partner | None = None,
    ) -> None:
        """A list is complete: acknowledge it, then act on it."""
        if not self._in_place(kind):
            self.lists[kind] = tuple(items)
        elif not items:
            self.lists[kind] = ()
        if partner is not None:
            self._answer(partner, ACCEPTED, kind)
        if kind != MISSION:
            return
        if self._flavour.atomic:
            self._owner.uploaded(items, flagged)
        else:
            self._owner.overwritten(self.lists[kind], complete=True)

    def _in_place(self, kind: int) -> bool:
        return kind == MISSION and not self._flavour.atomic

    def _ask(self, upload: Upload, now: float) -> None:
        """Ask for the next item: PX4 for integers once it knows that the other side has them."""
        upload.asked_at = now
        link, system, component = upload.partner
        ints = self._flavour.atomic and link in self._ints
        ask = mavlink.MAVLink_mission_request_int_message if ints else mavlink.MAVLink_mission_request_message
        self._send(link, ask(system, component, upload.next, upload.kind))

    def _refuse(self, upload: Upload, result: int) -> None:
        self._upload = None
        self._answer(upload.partner, result, upload.kind)

    def _ack(self, partner: Partner, message: Message, now: float) -> None:
        upload = self._upload
        if upload is None or upload.partner != partner or upload.kind != message.mission_type:
            return
        if message.type == mavlink.MAV_MISSION_UNSUPPORTED and partner[0] not in self._ints:
            self._ints.add(partner[0])
            self._ask(upload, now)
        elif message.type != ACCEPTED:
            self._upload = None

    def _request_int(self, partner: Partner, message: Message, now: float) -> None:
        self._ints.add(partner[0])
        self._downloads.item(partner, message, now)

    def _clear(self, partner: Partner, message: Message, now: float) -> None:  # noqa: ARG002
        wanted = TYPES if message.mission_type == mavlink.MAV_MISSION_TYPE_ALL else (message.mission_type,)
        if self._upload is not None:
            self._answer(partner, mavlink.MAV_MISSION_ERROR, message.mission_type)
            return
        for kind in wanted:
            self._replace(kind, (), None)
        self._answer(partner, ACCEPTED, message.mission_type)

    def _answer(self, partner: Partner, result: int, kind: int) -> None:
        self._downloads.answer(partner, result, kind)
