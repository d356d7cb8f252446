"""MAVLink's mission protocol, the vehicle's side, downwards: lists as they are, and acknowledgements."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from offboard.sitl.dialect import Extended, Message, mavlink
from offboard.sitl.flavour import Flavour
from offboard.sitl.items import WireItem, checksum

MISSION = mavlink.MAV_MISSION_TYPE_MISSION

Partner = tuple[int, int, int]
"""Link, system and component of whoever talks."""


class Downloads:
    """Tells what lies in the lists.

    Parameters
    ----------
    lists : mapping
        Items by MAV_MISSION_TYPE; looked at when they are asked for.
    flavour : Flavour
        Whose rules hold.
    current : callable
        Seq of the item that is flown to.
    send : callable
        Sends a message on a link.
    """

    def __init__(
        self,
        lists: Mapping[int, tuple[WireItem, ...]],
        flavour: Flavour,
        current: Callable[[], int],
        send: Callable[[int, Message], None],
    ) -> None:
        self._lists = lists
        self._flavour = flavour
        self._current = current
        self._send = send

    def count(self, partner: Partner, message: Message, now: float) -> None:  # noqa: ARG002
        """How many items a list has."""
        link, system, component = partner
        kind = message.mission_type
        items = self._lists[kind]
        answer = mavlink.MAVLink_mission_count_message(system, component, len(items), kind)
        self._send(link, Extended(answer, checksum(items)) if self._flavour.atomic else answer)

    def part(self, partner: Partner, message: Message, now: float) -> None:  # noqa: ARG002
        """A part of the list: its items, one after the other."""
        kind, items = message.mission_type, self._lists[message.mission_type]
        start = message.start_index
        end = len(items) - 1 if message.end_index == -1 else message.end_index
        if not 0 <= start <= end < len(items):
            self.answer(partner, mavlink.MAV_MISSION_INVALID_SEQUENCE, kind)
            return
        for seq in range(start, end + 1):
            self._send(partner[0], self._item_message(partner, seq, kind, ints=True))

    def item(self, partner: Partner, message: Message, now: float) -> None:  # noqa: ARG002
        """One item."""
        kind, seq = message.mission_type, message.seq
        if not 0 <= seq < len(self._lists[kind]):
            self.answer(partner, mavlink.MAV_MISSION_INVALID_SEQUENCE, kind)
            return
        ints = message.get_type() == "MISSION_REQUEST_INT"
        self._send(partner[0], self._item_message(partner, seq, kind, ints))

    def _item_message(self, partner: Partner, seq: int, kind: int, ints: bool) -> Message:
        item, plain = self._lists[kind][seq], self._flavour.download_frames
        current = int(not plain and kind == MISSION and seq == self._current())
        frame = PLAIN.get(item.frame, item.frame) if plain else item.frame
        make, x, y = mavlink.MAVLink_mission_item_message, item.latitude_deg, item.longitude_deg
        if ints:
            make, x, y = mavlink.MAVLink_mission_item_int_message, item.x, item.y
        to, parameters = partner[1:], (item.param1, item.param2, item.param3, item.param4)
        rest = (item.command, current, item.autocontinue, *parameters, x, y, item.z, kind)
        return make(*to, seq, frame, *rest)

    def answer(self, partner: Partner, result: int, kind: int) -> None:
        """MISSION_ACK."""
        link, system, component = partner
        answer = mavlink.MAVLink_mission_ack_message(system, component, result, kind)
        known = self._lists.get(kind, ())
        self._send(link, Extended(answer, checksum(known)) if self._flavour.atomic else answer)


PLAIN = {
    mavlink.MAV_FRAME_GLOBAL_INT: mavlink.MAV_FRAME_GLOBAL,
    mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT: mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT,
}
"""The frame in which ArduPilot gives an item back."""
