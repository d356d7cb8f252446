"""What any MAVLink system answers: parameters, rates, pings, time."""

from __future__ import annotations

from collections.abc import Callable

from offboard.sitl.aircraft import Aircraft
from offboard.sitl.dialect import Message, mavlink
from offboard.sitl.links import Links
from offboard.sitl.parameters import Parameters
from offboard.sitl.streams import GROUPS

Handler = Callable[[int, Message], None]
"""Does what a message asks that has come in on a link."""


def handlers(links: Links, parameters: Parameters, aircraft: Aircraft) -> dict[str, Handler]:
    """Handlers by the type of the message.

    Parameters
    ----------
    links : Links
        Where answers go.
    parameters : Parameters
        What is read and set.
    aircraft : Aircraft
        Owns the clock.
    """

    def list_parameters(link: int, message: Message) -> None:  # noqa: ARG001
        for each in parameters.all():
            links.send(link, each)

    def read_parameter(link: int, message: Message) -> None:
        answer = parameters.asked(message)
        if answer is not None:
            links.send(link, answer)

    def set_parameter(link: int, message: Message) -> None:  # noqa: ARG001
        name = parameters.taken(message)
        if name is not None:
            links.broadcast(parameters.message(name))

    def data_stream(link: int, message: Message) -> None:
        """The old way to ask for a rate; all messages of a group alike, heartbeat and clock apart."""
        rate = message.req_message_rate if message.start_stop else 0
        for message_id in GROUPS.get(message.req_stream_id, ()):
            links[link].streams.set(message_id, 1.0 / rate if rate else 0.0)

    def ping(link: int, message: Message) -> None:
        header = message.get_header()
        if message.target_system == 0:
            to = (header.srcSystem, header.srcComponent)
            links.send(link, mavlink.MAVLink_ping_message(message.time_usec, message.seq, *to))

    def timesync(link: int, message: Message) -> None:
        if message.tc1 == 0:
            now = round(aircraft.clock * 1e9)
            links.send(link, mavlink.MAVLink_timesync_message(now, message.ts1))

    return {
        "PARAM_REQUEST_LIST": list_parameters,
        "PARAM_REQUEST_READ": read_parameter,
        "PARAM_SET": set_parameter,
        "REQUEST_DATA_STREAM": data_stream,
        "PING": ping,
        "TIMESYNC": timesync,
    }
