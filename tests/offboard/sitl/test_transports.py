"""UDP and TCP with several peers, and links that are bad on purpose."""

from __future__ import annotations

import socket

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from offboard.errors import LinkError
from offboard.sitl.dialect import Codec, mavlink
from offboard.sitl.faulty import Faults, FaultyChannel, FaultyTransport
from offboard.sitl.transports import Exchange, TcpServer, Udp
from tests.offboard.sitl.station import Station, autopilot, mission

LIMIT = 5.0
"""Nothing takes as long over loopback [s]; a socket that waits longer fails the test."""


class Peer:
    """A socket that packs and reads MAVLink."""

    def __init__(self, kind, port):
        self.socket = socket.socket(socket.AF_INET, kind)
        self.socket.settimeout(LIMIT)
        self.socket.connect(("127.0.0.1", port))
        self.codec = Codec(255, 190)

    def send(self, message):
        self.socket.send(self.codec.pack(message))

    def hear(self, exchange, name):
        """The next message of a type, the autopilot being served meanwhile."""
        from offboard.framing import Framer  # noqa: PLC0415

        framer = Framer(self.codec.decode)
        for _ in range(200):
            exchange.receive()
            exchange.autopilot.step(0.1)
            exchange.send()
            for message in framer.feed(self.socket.recv(65536)):
                if message.get_type() == name:
                    return message
        raise AssertionError(f"no {name}")


@pytest.fixture
def udp():
    transport = Udp()
    yield transport
    transport.close()


@pytest.fixture
def tcp():
    transport = TcpServer()
    yield transport
    transport.close()


def heartbeat():
    return mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 0, 3)


@pytest.mark.parametrize("kind", [socket.SOCK_DGRAM, socket.SOCK_STREAM], ids=["udp", "tcp"])
def test_peers_that_come_by_themselves_are_answered(kind, udp, tcp):
    transport = udp if kind == socket.SOCK_DGRAM else tcp
    exchange = Exchange(autopilot(), [transport])
    one, two = Peer(kind, transport.port), Peer(kind, transport.port)
    for peer in (one, two):
        peer.send(heartbeat())
    for peer in (one, two):
        assert peer.hear(exchange, "HEARTBEAT").autopilot == 12
    assert exchange.heard == 2
    for peer in (one, two):
        peer.socket.close()


def test_targets_are_sent_to_without_having_asked():
    listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    listener.bind(("127.0.0.1", 0))
    listener.settimeout(LIMIT)
    transport = Udp(0, [listener.getsockname()])
    exchange = Exchange(autopilot(), [transport])
    exchange.send()
    exchange.autopilot.step(0.1)
    exchange.send()
    data, sender = listener.recvfrom(2048)
    assert data[0] == 0xFD
    assert sender[1] == transport.port
    assert exchange.heard == 0
    exchange.close()
    listener.close()


def test_a_client_that_goes_is_forgotten(tcp):
    exchange = Exchange(autopilot(), [tcp])
    peer = Peer(socket.SOCK_STREAM, tcp.port)
    peer.send(heartbeat())
    peer.hear(exchange, "HEARTBEAT")
    peer.socket.close()
    for _ in range(20):
        exchange.receive()
    assert list(tcp.peers()) == []
    assert exchange.heard == 0


def test_no_more_peers_are_listened_to_than_can_be_served(udp, monkeypatch):
    monkeypatch.setattr("offboard.sitl.transports.MOST_PEERS", 2)
    peers = [Peer(socket.SOCK_DGRAM, udp.port) for _ in range(3)]
    for peer in peers:
        peer.send(heartbeat())
    assert len(udp.receive()) == 2
    assert len(udp.peers()) == 2
    for peer in peers:
        peer.socket.close()


@pytest.mark.parametrize("kind", [Udp, TcpServer])
def test_a_port_that_is_taken_is_named(kind):
    first = kind()
    with pytest.raises(LinkError, match=str(first.port)):
        kind(first.port)
    first.close()


# Bad links


def through(faults, count, seed=0, until=100.0):
    channel = FaultyChannel(faults, np.random.default_rng(seed))
    for number in range(count):
        channel.put(number, float(number))
    return channel, channel.take(until)


def test_a_good_link_changes_nothing():
    assert through(Faults(), 50)[1] == list(range(50))


def test_losses_and_copies_come_at_their_rates():
    channel, arrived = through(Faults(loss=0.2), 5000, until=1e9)
    assert channel.lost == 5000 - len(arrived)
    assert channel.lost / 5000 == pytest.approx(0.2, abs=0.02)
    _, arrived = through(Faults(duplication=0.1), 5000, until=1e9)
    assert len(arrived) / 5000 == pytest.approx(1.1, abs=0.02)


def test_late_frames_overtake_one_another_and_none_is_early():
    channel = FaultyChannel(Faults(delay=(0.5, 3.0)), np.random.default_rng(1))
    for number in range(50):
        channel.put(number, 0.1 * number)
    assert channel.take(0.49) == []
    arrived = channel.take(1e9)
    assert sorted(arrived) == list(range(50))
    assert arrived != sorted(arrived)


def test_nothing_comes_through_an_outage():
    assert through(Faults(outages=((10.0, 20.0),)), 30)[1] == [*range(10), *range(20, 30)]


def test_chance_comes_from_the_seed():
    faults = Faults(loss=0.3, duplication=0.1, delay=(0.0, 5.0))
    assert through(faults, 100, seed=4)[1] == through(faults, 100, seed=4)[1]
    assert through(faults, 100, seed=4)[1] != through(faults, 100, seed=5)[1]


@pytest.mark.parametrize("wrong", [{"loss": 1.5}, {"duplication": -0.1}, {"delay": (3.0, 1.0)}])
def test_faults_that_are_none_are_refused(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        Faults(**wrong)


class Wire:
    """A transport in memory that keeps what is sent."""

    def __init__(self):
        self.inbox, self.sent = [], []

    def receive(self):
        found, self.inbox = self.inbox, []
        return found

    def send(self, peer, frames):
        self.sent += [(peer, frame) for frame in frames]

    def peers(self):
        return (("a", 1),)

    def sockets(self):
        return []

    def close(self):
        pass


def test_a_transport_behind_a_bad_link_is_late_both_ways():
    time, wire, peer = [0.0], Wire(), ("a", 1)
    bad = FaultyTransport(wire, Faults(delay=(1.0, 1.0)), 0, lambda: time[0])
    wire.inbox.append((peer, b"in"))
    bad.send(peer, [b"out"])
    assert bad.receive() == []
    assert wire.sent == []
    time[0] = 1.0
    assert bad.receive() == [(peer, b"in")]
    assert wire.sent == [(peer, b"out")]


@settings(max_examples=25)
@given(st.integers(0, 2**32 - 1))
def test_a_mission_comes_through_a_link_that_loses_a_fifth(seed):
    """The vehicle asks again, the station as well: a whole mission or none, never a mixed one."""
    up, down = (
        FaultyChannel(Faults(loss=0.2, duplication=0.1, delay=(0.0, 0.3)), rng)
        for rng in np.random.default_rng(seed).spawn(2)
    )
    pilot = autopilot("px4")
    ground, items = Station(pilot), mission()
    count, acks = mavlink.MAVLink_mission_count_message(1, 1, len(items), 0), []
    for tick in range(400):
        now = 0.1 * tick
        if tick % 15 == 0 and not acks:
            up.put(ground.codec.pack(count), now)
        for frame in up.take(now):
            pilot.feed(frame)
        pilot.step(0.1)
        for frame in pilot.frames():
            down.put(frame, now)
        for message in ground.framer.feed(b"".join(down.take(now))):
            if message.get_type().startswith("MISSION_REQUEST"):
                up.put(ground.codec.pack(items[message.seq]), now)
            elif message.get_type() == "MISSION_ACK":
                acks.append(message.type)
        assert len(pilot.captain.items) in (0, len(items))
        if acks:
            break
    assert acks[0] == 0
    assert len(pilot.captain.items) == len(items)
