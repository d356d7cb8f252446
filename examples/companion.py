"""Sense and avoid on a companion computer: the autopilot flies its mission, we keep it clear.

    python examples/companion.py serial:///dev/ttyACM0:921600

A human uploads the mission, arms and starts; from then on what ADSB_VEHICLE and OBSTACLE_DISTANCE_3D report
is flown round, within the geofence on board; where no way is free, the vehicle waits, at a rally point if one
can be reached. Any mode change by a human ends our commands until the mission mode is back.
"""

import sys
from contextlib import closing
from functools import partial

from avoidance.agent import Agent
from offboard.live.areas import areas_for_core
from offboard.live.connecting import connect
from offboard.live.limits import OWN_ADDRESS
from offboard.live.starting import open_vehicle
from offboard.live.waiting import WaitingClock
from offboard.pilot import Pilot, fly
from offboard.wire_radar import WireRadar


def main(url: str) -> None:
    """Fly with the vehicle behind a URL until its mission ends."""
    with closing(connect(url, timeout=60.0)) as session:
        vehicle = open_vehicle(session, wind_bound=3.0)
        aboard = vehicle.aboard
        aboard.listener = lambda event: print(f"{event.time:7.1f} s  {event.severity}: {event.text}")
        vehicle.adopt_mission()
        alarm = partial(aboard.tell, "alarm")
        own = int(aboard.parameters.get(OWN_ADDRESS, 0))
        radar = WireRadar(aboard.frame, aboard.clock.ours, 1000.0, alarm, own_address=own)
        vehicle.on_obstacle = radar.take
        fence, rally = areas_for_core(vehicle)
        pilot = Pilot(vehicle, radar, Agent(vehicle.performance, geofence=fence, rally=rally))
        for frame in fly([pilot], WaitingClock(vehicle), period=1.0):
            decision = frame.steps[0].decision
            if decision.route is not None:
                print(f"{frame.time:7.1f} s  {decision.name}: {decision.why}")


if __name__ == "__main__":
    main(sys.argv[1])
