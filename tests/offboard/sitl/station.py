"""A ground station of a few lines: packs what it is told, reads what comes, in process."""

from __future__ import annotations

import math

from offboard.framing import Framer
from offboard.sitl.aircraft import Aircraft
from offboard.sitl.autopilot import FLAVOURS, Autopilot, Settings
from offboard.sitl.dialect import Codec, mavlink
from tests.offboard.fake_plant import HOME, PERFORMANCE, FakePlant

POINTS = ((0.0, 0.0, 200.0), (2000.0, 0.0, 200.0), (2000.0, 2000.0, 200.0))
"""North, east, altitude [m] of a small mission."""


def autopilot(kind="px4", *, launcher=None, plant=None, **settings):
    aircraft = Aircraft(plant or FakePlant(), HOME, PERFORMANCE, launcher)
    return Autopilot(aircraft, Settings(flavour=FLAVOURS[kind], **settings))


def item(
    seq, north, east, altitude, *, command=16, current=0, kind=0, parameters=(0.0, 0.0, 0.0, 0.0), frame=6
):
    """MISSION_ITEM_INT of a place on the map."""
    latitude, longitude = HOME.to_geodetic(north, east)
    place = (round(latitude * 1e7), round(longitude * 1e7), altitude)
    return mavlink.MAVLink_mission_item_int_message(
        1, 1, seq, frame, command, current, 1, *parameters, *place, kind
    )


def mission(kind="px4", points=POINTS, flagged=0):
    """Items of a mission with the last one circled about, home in front for ArduPilot."""
    places = [(0.0, 0.0, 0.0), *points] if kind == "ardupilot" else list(points)
    return [
        item(seq, *place, command=17 if seq == len(places) - 1 else 16, current=int(seq == flagged))
        for seq, place in enumerate(places)
    ]


class Station:
    """Talks to one autopilot on one link."""

    def __init__(self, pilot, link=0, system=245, component=190):
        self.pilot = pilot
        self.link = link
        self.codec = Codec(system, component)
        self.framer = Framer(self.codec.decode)
        self.seen = []
        pilot.open(link)

    def send(self, *messages):
        for message in messages:
            self.pilot.feed(self.codec.pack(message), self.link)

    def read(self, *types):
        """What has come since the last time; only these types, if any are given."""
        new = self.framer.feed(self.pilot.flush(self.link))
        self.seen += new
        return [message for message in new if not types or message.get_type() in types]

    def fly(self, seconds, step=0.1):
        """Let time pass; everything that was said meanwhile."""
        found = []
        for _ in range(round(seconds / step)):
            self.pilot.step(step)
            found += self.read()
        return found

    def fly_until(self, done, limit=3600.0, step=0.1):
        """Let time pass until something is so; everything that was said meanwhile."""
        found = []
        for _ in range(round(limit / step)):
            if done():
                return found
            self.pilot.step(step)
            found += self.read()
        raise AssertionError("it never came to that")

    def command(self, number, *parameters):
        """Send a COMMAND_LONG; its result."""
        values = (*parameters, *[0.0] * (7 - len(parameters)))
        self.send(mavlink.MAVLink_command_long_message(1, 1, number, 0, *values))
        acks = [m for m in self.read("COMMAND_ACK") if m.command == number]
        return acks[-1].result if acks else None

    def upload(self, items, kind=0):
        """Upload items as MAVSDK does; the result, and how each was asked for."""
        self.read()
        asked = []
        self.send(mavlink.MAVLink_mission_count_message(1, 1, len(items), kind))
        while True:
            answers = self.read()
            done = [m for m in answers if m.get_type() == "MISSION_ACK"]
            if done:
                return done[-1].type, asked
            wanted = [m for m in answers if m.get_type().startswith("MISSION_REQUEST")]
            if not wanted:
                return None, asked
            asked += wanted
            self.send(items[wanted[-1].seq])

    def download(self, kind=0):
        """The list as the autopilot has it."""
        self.send(mavlink.MAVLink_mission_request_list_message(1, 1, kind))
        (count,) = self.read("MISSION_COUNT")
        found = []
        for seq in range(count.count):
            self.send(mavlink.MAVLink_mission_request_int_message(1, 1, seq, kind))
            found += self.read("MISSION_ITEM_INT")
        self.send(mavlink.MAVLink_mission_ack_message(1, 1, 0, kind))
        return found

    def parameter(self, name, value):
        """Set a float, or an integer as the autopilot wants it."""
        self.send(mavlink.MAVLink_param_set_message(1, 1, name.encode(), value, 9))

    def start(self, kind="px4"):
        """Arm and fly the mission."""
        modes = {"px4": (4, 4), "ardupilot": (10, 0)}
        return self.command(400, 1.0), self.command(176, 1.0, *modes[kind])

    def last(self, name):
        """The latest message of a type."""
        return next(m for m in reversed(self.seen) if m.get_type() == name)


def ready(kind="px4", plant=None, **settings):
    """A station and an autopilot that is flying the small mission."""
    changes = {"MIS_TKO_LAND_REQ": 0.0} if kind == "px4" else {}
    station = Station(autopilot(kind, plant=plant, parameters=changes, **settings))
    station.fly(0.1)
    assert station.upload(mission(kind))[0] == 0
    assert station.start(kind) == (0, 0)
    station.fly(0.1)
    return station


def distance(pilot, north, east):
    state = pilot.aircraft.state
    return math.hypot(state.north - north, state.east - east)
