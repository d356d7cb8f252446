"""The table is consistent in itself."""

from __future__ import annotations

from fmu.variables import REFERENCE, TABLE


def test_names_and_fields_are_unique():
    assert len(REFERENCE) == len(TABLE)
    assert len({row.field for row in TABLE}) == len(TABLE)


def test_starts_lie_within_their_bounds():
    for row in TABLE:
        assert row.minimum <= row.maximum
        if row.start is not None:
            assert row.minimum <= row.start <= row.maximum, row.name


def test_only_the_aircraft_file_may_leave_a_start_open():
    open_starts = [row.name for row in TABLE if row.start is None and row.causality in ("parameter", "input")]
    assert open_starts
    assert all(name.startswith("aircraft.") for name in open_starts)


def test_members_read_as_blocks_lie_together():
    """The C code copies these blocks whole."""
    for block in (
        ["state.quaternion.w", "state.quaternion.x", "state.quaternion.y", "state.quaternion.z"],
        ["state.u", "state.v", "state.w"],
        ["state.aileron", "state.elevator", "state.rudder", "state.throttle"],
        [f"rate.{k}" for k in ("u", "v", "w", *(f"quaternion.{c}" for c in "wxyz"), "p", "q", "r")],
    ):
        first = REFERENCE[block[0]]
        assert [row.name for row in TABLE[first : first + len(block)]] == block
