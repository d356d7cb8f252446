"""The mission interface, and whoever flies it: missions with MAVSDK's names, vehicles, the loop."""
