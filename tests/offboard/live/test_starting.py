"""From a vehicle on the ground to one that flies: what it says where it will not."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from offboard.errors import LinkError
from offboard.live.aboard import Event
from offboard.live.autopilots import rules_of
from offboard.live.starting import RETRY_ARM, arm


class Refusing:
    """A PX4 that does not arm, and what its pilot has been told."""

    def __init__(self, *warnings):
        self.now = 0.0
        self.aboard = SimpleNamespace(
            session=SimpleNamespace(wall=lambda: self.now, ask=lambda _: 1),
            telemetry=SimpleNamespace(armed=False),
            rules=rules_of(12),
            events=[Event(0.0, "warning", text) for text in warnings],
        )

    def wait_for(self, _ready, timeout):
        self.now += timeout


@pytest.mark.parametrize(
    ("warnings", "reason"),
    [
        ((), "it does not say why"),
        (("obstacles are those of a scenario",), "it does not say why"),
        (("PX4: Preflight Fail: no GPS", "obstacles are those of a scenario"), "PX4: Preflight Fail: no GPS"),
    ],
    ids=["nothing", "our own warning", "its own words"],
)
def test_why_a_vehicle_does_not_arm_is_said_in_its_own_words(warnings, reason):
    with pytest.raises(LinkError, match=f"^the vehicle does not arm: {reason}$"):
        arm(Refusing(*warnings), timeout=2.0 * RETRY_ARM)
