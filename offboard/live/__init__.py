"""A vehicle over MAVSDK: the only package that imports `mavsdk`.

`session` talks to MAVSDK and hands everything over through a queue; all else here is synchronous and,
but for `session`, knows neither threads nor MAVSDK.
"""
