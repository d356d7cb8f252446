"""Kalman filters of many tracks: consistent, and quick to follow a turn."""

from __future__ import annotations

import numpy as np

from avoidance import filters

NOISE = np.diag([50.0**2, 150.0**2])[None]


def flown(rng: np.random.Generator, scans: int, turn_at: int = 10_000) -> tuple[filters.Tracks, np.ndarray]:
    """A track of something at 20 m/s that climbs by 2 m/s and may turn by 90 degrees, and its true state."""
    truth = np.array([8000.0, 0.0, -20.0, 0.0, 300.0])
    tracks: filters.Tracks | None = None
    for second in range(scans):
        seen = np.array([[*(truth[:2] + rng.normal(size=2) * (50.0, 150.0)), truth[4]]])
        if tracks is None:
            tracks = filters.begin(np.array([1]), seen, np.array([np.nan]), NOISE, 0.0)
        else:
            row = np.array([0])
            filters.predict(tracks, row, float(second))
            tracks.moving[:] = True
            filters.correct(tracks, row, seen, NOISE, float(second))
        if second == turn_at:
            truth[2:4] = 0.0, 20.0
        if second < scans - 1:
            truth[:2] += truth[2:4]
            truth[4] += 2.0
    assert tracks is not None
    return tracks, truth


def test_errors_are_as_large_as_the_covariance_says() -> None:
    rng = np.random.default_rng(2)
    squares = []
    for _ in range(20):
        tracks, truth = flown(rng, 40)
        error = tracks.state[0] - truth[:4]
        squares.append(error @ np.linalg.solve(tracks.covariance[0], error))
    assert 2.5 < np.mean(squares) < 6.0  # chi-square of 4 degrees


def test_the_climb_rate_is_known_after_a_while() -> None:
    tracks, truth = flown(np.random.default_rng(0), 30)
    assert abs(tracks.vertical[0, 1] - 2.0) < 0.2
    assert abs(tracks.vertical[0, 0] - truth[4]) < 2.0


def test_a_turn_is_noticed_and_followed() -> None:
    tracks, truth = flown(np.random.default_rng(1), 140, turn_at=100)
    assert tracks.steady_since[0] > 100.0
    assert np.hypot(*(tracks.state[0, 2:] - truth[2:4])) < 8.0


def test_columns_are_kept_together() -> None:
    two = filters.begin(
        np.array([1, 2]), np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]), np.full(2, np.nan),
        np.repeat(NOISE, 2, axis=0), 0.0,
    )  # fmt: skip
    two.extend(filters.begin(np.array([3]), np.array([[7.0, 8.0, 9.0]]), np.array([500.0]), NOISE, 1.0))
    two.keep(np.array([True, False, True]))
    assert two.ids.tolist() == [1, 3]
    assert two.state[1].tolist() == [7.0, 8.0, 0.0, 0.0]
    assert two.radius[1] == 500.0


def test_tracks_are_corrected_by_their_own_contacts_whatever_the_order() -> None:
    """Contacts come in any order, and of some tracks only."""
    rng = np.random.default_rng(3)
    places = rng.uniform(-5000.0, 5000.0, (4, 3))
    noise = np.diag([50.0**2, 150.0**2]) + rng.uniform(0.0, 500.0, (4, 1, 1)) * np.eye(2)

    def corrected(rows: list[int]) -> filters.Tracks:
        tracks = filters.begin(np.arange(4), places, np.full(4, np.nan), noise, 0.0)
        chosen = np.array(rows)
        filters.predict(tracks, chosen, 1.0)
        filters.correct(tracks, chosen, (places + 40.0)[chosen], noise[chosen], 1.0)
        return tracks

    together, permuted = corrected([0, 1, 2, 3]), corrected([2, 0, 3, 1])
    for row in range(4):
        alone = corrected([row])
        for tracks in (together, permuted):
            assert np.allclose(tracks.state[row], alone.state[row], rtol=1e-12)
            assert np.allclose(tracks.covariance[row], alone.covariance[row], rtol=1e-12)
            assert np.allclose(tracks.vertical[row], alone.vertical[row], rtol=1e-12)
            assert np.allclose(tracks.mean[row], alone.mean[row], rtol=1e-12)
