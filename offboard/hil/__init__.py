"""The plant behind a real autopilot: PX4's simulator API and ArduPilot's JSON backend.

The protocol cores (`json_protocol`, `px4_protocol`, `framing`) do no I/O; `pipes` and the bridges do. The
plant is a `plant.HilPlant`, a protocol: nobody here knows the FMU.
"""
