"""Settings of the whole test suite."""

from __future__ import annotations

from hypothesis import settings

settings.register_profile("sidestep", deadline=None)  # a slow machine is not a failure
settings.load_profile("sidestep")
