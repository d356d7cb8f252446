"""A simulated MAVLink autopilot in front of a plant: bytes in, bytes out; transports apart.

`Autopilot` (autopilot.py) is the whole of it. It behaves as PX4 or as ArduPlane: `px4.py` and
`ardupilot.py` hold what differs. Only this package, `offboard.hil` and the tests know pymavlink.
"""
