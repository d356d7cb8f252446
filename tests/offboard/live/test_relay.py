"""The relay that signs for MAVSDK: what goes through it, and the simulated autopilot behind it."""

from __future__ import annotations

import contextlib
import queue
import socket
import threading

import pytest

from avoidance.parameters import DEFAULT
from offboard.errors import InputError, LinkError
from offboard.live.connecting import connect
from offboard.live.messages import Ask, Reply
from offboard.live.outside import MOST_PEERS, Udp, opener
from offboard.live.relay import MOST_STRANGERS, Relay
from offboard.raw_mission import RawMission
from offboard.signing import SigningPipe
from offboard.sitl.autopilot import FLAVOURS
from offboard.sitl.dialect import Codec, mavlink
from offboard.sitl.transports import Exchange, TcpServer
from offboard.sitl.transports import Udp as VehicleUdp
from scenarios.hangar import mission_plan
from scenarios.sitl_run import serve
from scenarios.sitl_world import SitlWorld
from tests.offboard.live.kit import SMALL

KEY, OTHER = bytes(range(32)), bytes(32)
NOW = 1_700_000_000.0
WAIT = 20.0
"""What does not come within this time does not come at all [s]."""


def frame(number=1):
    return Codec(1).pack(mavlink.MAVLink_attitude_message(number, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6))


def signer(key=KEY):
    return SigningPipe(key, lambda: NOW)


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def sender():
    """A UDP socket of a vehicle or of somebody else."""
    one = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    one.bind(("127.0.0.1", 0))
    one.settimeout(WAIT)
    return one


@contextlib.contextmanager
def relayed(url):
    """A relay, and the queue of what it lets in."""
    came = queue.SimpleQueue()
    with contextlib.closing(Relay(url, KEY, came.put, lambda: NOW)) as relay:
        yield relay, came


def test_only_signed_frames_come_in_and_only_who_signs_is_answered():
    port = free_port()
    with relayed(f"udpin://127.0.0.1:{port}") as (relay, came), sender() as vehicle, sender() as stranger:
        to = ("127.0.0.1", port)
        stranger.sendto(frame(1), to)
        stranger.sendto(signer(OTHER).sign(frame(2)), to)
        signed = signer().sign(frame(3))
        vehicle.sendto(signed, to)
        assert came.get(timeout=WAIT) == frame(3)
        assert relay.dropped >= 2
        relay.send(frame(4))
        answer = vehicle.recv(1000)
        assert signer().verify(answer) == frame(4)
        stranger.setblocking(False)
        with pytest.raises(BlockingIOError):
            stranger.recv(1000)
        before = relay.dropped
        stranger.sendto(signed, to)  # heard and sent again by somebody else
        vehicle.sendto(signer().sign(frame(5)) + signer().sign(frame(5)), to)
        pipe = SigningPipe(KEY, lambda: NOW + 1.0)
        vehicle.sendto(pipe.sign(frame(6)), to)
        assert came.get(timeout=WAIT) == frame(6)
        assert relay.dropped == before + 3
    assert came.empty()


def test_half_frames_of_many_strangers_do_not_hold_up_the_vehicle():
    port = free_port()
    with relayed(f"udpin://127.0.0.1:{port}") as (relay, came), contextlib.ExitStack() as stack:
        to = ("127.0.0.1", port)
        vehicle = stack.enter_context(sender())
        pipe = signer()
        signed = pipe.sign(frame(1))
        vehicle.sendto(signed[:20], to)
        vehicle.sendto(signed[20:], to)
        assert came.get(timeout=WAIT) == frame(1)
        for _ in range(MOST_STRANGERS + 5):
            stack.enter_context(sender()).sendto(b"\xfd\xff\x01", to)
        vehicle.sendto(pipe.sign(frame(2)), to)
        assert came.get(timeout=WAIT) == frame(2)
        assert relay.accepted == 2


def test_udpout_speaks_first_and_frees_its_port():
    with sender() as vehicle:
        with relayed(f"udpout://127.0.0.1:{vehicle.getsockname()[1]}") as (relay, came):
            relay.send(frame(1))
            data, address = vehicle.recvfrom(1000)
            assert signer().verify(data) == frame(1)
            vehicle.sendto(signer().sign(frame(2)), address)
            assert came.get(timeout=WAIT) == frame(2)
            relay.close()
        with contextlib.closing(Udp(("0.0.0.0", address[1]))) as again:
            assert again.port == address[1]


def test_a_tcp_link_that_breaks_is_opened_anew(monkeypatch):
    monkeypatch.setattr("offboard.live.relay.REOPEN", 0.01)
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(WAIT)
        with relayed(f"tcpout://127.0.0.1:{server.getsockname()[1]}") as (relay, came):
            pipe = signer()
            for number in (1, 2):
                connection, _ = server.accept()
                with connection:
                    connection.settimeout(WAIT)
                    signed = pipe.sign(frame(number))
                    connection.sendall(signed + signed[:15])
                    assert came.get(timeout=WAIT) == frame(number)
                    relay.send(frame(7))
                    assert SigningPipe(KEY, lambda: NOW).verify(connection.recv(1000)) == frame(7)


def test_a_udp_port_answers_those_that_were_trusted_last_and_its_fixed_peer():
    with contextlib.ExitStack() as stack:
        peers = [stack.enter_context(sender()) for _ in range(MOST_PEERS + 2)]
        first = peers[0].getsockname()
        port = stack.enter_context(contextlib.closing(Udp(("127.0.0.1", 0), first)))
        for peer in peers[1:]:
            port.trust(peer.getsockname())
        port.send(b"x")
        got = []
        assert peers[-1].recv(10) == b"x"  # the last that is sent to: what went to the others is there
        for peer in peers[:-1]:
            peer.setblocking(False)
            with contextlib.suppress(BlockingIOError):
                peer.recv(10)
                got.append(peer)
        assert got == [peers[0], *peers[3:-1]]


@pytest.mark.parametrize(
    "url", ["udpin://", "udpin://127.0.0.1:0", "udpout://a:65536", "serial://x", "raw://"]
)
def test_urls_that_cannot_be_relayed_are_refused(url):
    with pytest.raises(InputError, match="cannot be opened with a signing key; it must be udpin://HOST:PORT"):
        opener(url)


@pytest.mark.parametrize("url", ["udpin://192.0.2.1:14540", "serial:///dev/no-such:57600"])
def test_links_that_are_not_there_are_one_error(url):
    with pytest.raises(LinkError, match=f"{url} cannot be opened"):
        Relay(url, KEY, lambda _: None)


@contextlib.contextmanager
def flying_autopilot(key, port):
    """A simulated autopilot that sends to a UDP port, sixty times as fast; yields its TCP port."""
    with SitlWorld(SMALL, DEFAULT, FLAVOURS["px4"], SMALL.fleet, retry=12.0, signing_key=key) as world:
        tcp = TcpServer()
        autopilot = next(iter(world.autopilots.values()))
        exchange = Exchange(autopilot, [VehicleUdp(0, [("127.0.0.1", port)]), tcp])
        over = threading.Event()
        arguments = (world, [exchange], 60.0, lambda *_: None, over.is_set)
        thread = threading.Thread(target=serve, args=arguments, daemon=True)
        thread.start()
        try:
            yield autopilot, tcp.port
        finally:
            over.set()
            thread.join(5.0)
            exchange.close()


@pytest.mark.parametrize("transport", ["udpin", "tcpout"])
def test_a_mission_goes_up_over_a_signed_link(transport):
    port = free_port()
    with flying_autopilot(KEY, port) as (autopilot, tcp):
        url = f"{transport}://127.0.0.1:{port if transport == 'udpin' else tcp}"
        with contextlib.closing(connect(url, WAIT, KEY)) as session:
            raw = RawMission.of_plan(mission_plan(SMALL.mission, autopilot.aircraft.frame))
            token = session.upload(raw.items, 0)
            replies = []
            while not replies and (came := session.poll(WAIT)):
                replies = [one for one in came if isinstance(one, Reply)]
            assert [(one.ask, one.token, one.ok) for one in replies] == [(Ask.UPLOAD, token, True)]
            assert len(autopilot.captain.items) == len(raw.items)


@pytest.mark.parametrize("theirs", [OTHER, None], ids=["another key", "no key"])
def test_a_vehicle_without_our_key_is_not_found_and_the_message_says_why(theirs):
    port = free_port()
    with (
        flying_autopilot(theirs, port),
        pytest.raises(LinkError, match="within 1 s: what comes is not signed"),
    ):
        connect(f"udpin://127.0.0.1:{port}", 1.0, KEY)
