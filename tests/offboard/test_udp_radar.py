"""Obstacles over UDP: how much is read at once."""

from __future__ import annotations

import contextlib
import socket

from avoidance import Ownship
from offboard.frames import MapFrame
from offboard.link import VehicleState
from offboard.udp_radar import AT_ONCE, UdpRadar

OWN = Ownship(100.0, 0.0, 0.0, 200.0, 15.0, 0.0)


class Flood:
    """A socket that always has one more datagram."""

    def __init__(self):
        self.read = 0

    def recv(self, size):
        self.read += 1
        return b'{"id": 7, "north_m": 9000, "east_m": 0}'


def test_a_flood_does_not_hold_up_the_decision():
    flood = Flood()
    with contextlib.closing(UdpRadar(0, MapFrame(14.39, 76.60, 600.0), print)) as radar:
        real, radar._socket = radar._socket, flood
        scan = radar.scan(VehicleState(OWN), 100.0)
        radar._socket = real
    assert flood.read == AT_ONCE
    assert scan.ids.tolist() == [7]


def test_what_is_sent_is_seen():
    with (
        contextlib.closing(UdpRadar(0, MapFrame(14.39, 76.60, 600.0), print)) as radar,
        contextlib.closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as sender,
    ):
        sender.sendto(b'{"id": 8, "range_m": 8000, "bearing_deg": 90}\nnonsense', ("127.0.0.1", radar.port))
        scan = radar.scan(VehicleState(OWN), 100.0)
    assert scan.ids.tolist() == [8]
    assert abs(scan.positions[0, 1] - 8000.0) < 1e-6
    assert radar.refused == 1
