"""Each erratum that can be computed, computed from what the paper prints."""

from __future__ import annotations

import math
import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from avoidance.parameters import PAPER
from avoidance.seeds import sphere_seeds
from avoidance.yardsticks import best_waypoint
from scenarios.load import load
from scenarios.paper.errata import errata, errata_markdown
from scenarios.paper.measures import measure
from scenarios.paper.published import published
from scenarios.paper.searches import READINGS, iterations, optimum, problem

SPEED = 15.0
GRAVITY = 9.81
P = published()
MISSION = np.array(P.mission)[:, :2].astype(float)
LENGTH = float(np.hypot(*np.diff(MISSION, axis=0).T).sum())
STRAIGHT = math.dist(MISSION[0], MISSION[-1])
LISTS = {row.planner: row for row in P.table4}


def test_e01_two_waypoints_are_misprinted() -> None:
    printed = np.column_stack((P.printed_x, MISSION[:, 1]))
    assert float(np.hypot(*np.diff(printed, axis=0).T).sum()) == pytest.approx(731_276, abs=1)
    assert pytest.approx(431_633.19, abs=0.01) == LENGTH
    assert abs(LENGTH - P.table3[0].path_length_m) < 5.0
    assert [[p.north, p.east] for p in load("table4").mission] == MISSION.tolist()


def test_e02_flying_times_do_not_follow_from_lengths() -> None:
    rows = {row.obstacles: row for row in P.table3}
    assert pytest.approx(479.592, abs=0.001) == LENGTH / SPEED / 60.0
    assert (rows["0"].flight_min - LENGTH / SPEED / 60.0) * 60.0 == pytest.approx(78.3, abs=0.1)
    speeds = [row.path_length_m / row.flight_min / 60.0 for row in P.table3]
    assert (round(min(speeds), 3), round(max(speeds), 3)) == (14.884, 14.994)
    assert rows["30"].path_length_m > rows["20"].path_length_m
    assert rows["30"].flight_min < rows["20"].flight_min


def test_e03_the_path_length_is_the_polyline() -> None:
    assert abs(P.table3[0].path_length_m - LENGTH) < 5.0
    incoming, outgoing = (MISSION[i + 1] - MISSION[i] for i in (4, 5))
    turn = math.atan2(*outgoing[::-1]) - math.atan2(*incoming[::-1])
    assert abs(math.degrees(math.remainder(turn, 2.0 * math.pi))) == pytest.approx(171.7, abs=0.1)


def test_e04_the_added_length_jumps_twentyfold() -> None:
    added = {r.obstacles: r.path_length_m - P.table3[0].path_length_m for r in P.table3}
    assert (added["10"], added["20"], added["30"]) == (524, 10_433, 11_318)


def test_e05_no_straight_line_explains_the_printed_ratios() -> None:
    """Table 6's times are Table 3's, so its lengths are too; their ratios leave disjoint straight lines."""
    lengths = {int(r.obstacles): r for r in P.table3 if r.obstacles.isdigit()}
    intervals = []
    for row in (row for row in P.table6 if row.planner == "pso"):
        same = lengths[row.obstacles]
        assert same.algorithm_s == pytest.approx(row.time_s, abs=0.01)
        assert same.path_length_m / STRAIGHT > 1.597 > row.plr
        intervals.append((same.path_length_m / (row.plr + 0.005), same.path_length_m / (row.plr - 0.005)))
    assert all(later[1] < earlier[0] for earlier, later in pairwise(intervals))
    assert [round(lengths[n].path_length_m / STRAIGHT, 3) for n in (40, 60, 80, 100)] == [
        1.643,
        1.649,
        1.669,
        1.697,
    ]


def test_e06_the_empty_mission_fails_the_rule_of_thumb() -> None:
    assert pytest.approx(1.597, abs=0.001) == LENGTH / STRAIGHT


@pytest.mark.parametrize(("case", "leg"), [("obstacle 2", 3), ("obstacles 3-5", 4)])
def test_e07_the_printed_fitness_is_the_length_from_the_leg_s_start(case: str, leg: int) -> None:
    whole = math.dist(MISSION[leg], MISSION[leg + 1])
    printed = [row.mean for row in P.table7 if row.case == case]
    assert all(
        90.0 < value - (whole // 10 * 10) < 1120.0 or 700.0 < value - whole < 1120.0 for value in printed
    )
    assert all(abs(value / optimum(problem(case, READINGS[1], PAPER)) - 1.0) < 0.012 for value in printed)
    assert all(value / optimum(problem(case, READINGS[0], PAPER)) > 13.0 for value in printed)


def test_e08_a_median_that_no_ten_runs_can_have() -> None:
    (row,) = (row for row in P.table7 if (row.case, row.planner) == ("obstacles 3-5", "pso"))
    leg = math.dist(MISSION[4], MISSION[5])
    least = (5 * leg + 5 * row.median) / 10.0  # half at the least possible, half at the median
    assert least > row.mean
    assert least == pytest.approx(154_087, abs=1)


@pytest.mark.parametrize(
    ("planner", "length"),
    [("ga", 431_784.17), ("sa", 432_147.03), ("theta-mafoa", 431_723.57), ("pso", 431_726.22)],
)
def test_e09_printed_lengths_follow_from_the_lists(planner: str, length: float) -> None:
    found = measure(LISTS[planner].waypoints)
    assert found.length == pytest.approx(length, abs=0.01)
    assert found.length == pytest.approx(LISTS[planner].length_m, abs=5.0)


def test_e10_pso_is_neither_the_shortest_nor_the_fastest() -> None:
    assert min(P.table4, key=lambda row: row.length_m).planner == "theta-mafoa"
    assert min(P.table4, key=lambda row: row.time_s).planner == "sa"


def test_e11_a_published_list_cuts_a_sphere() -> None:
    gaps = {row.planner: measure(row.waypoints).clearance for row in P.table4}
    assert gaps["theta-mafoa"] == pytest.approx(993.5, abs=0.1)
    assert gaps["pso"] == pytest.approx(1002.7, abs=0.1)
    assert [name for name, row in LISTS.items() if "g3" in measure(row.waypoints).broken] == ["theta-mafoa"]


@pytest.mark.parametrize(
    ("planner", "farthest"), [("ga", 4653.6), ("sa", 4573.7), ("theta-mafoa", 5359.6), ("pso", 5361.2)]
)
def test_e12_waypoints_lie_beyond_the_search_limit(planner: str, farthest: float) -> None:
    found = measure(LISTS[planner].waypoints)
    assert max(w.nearest for w in found.new) == pytest.approx(farthest, abs=0.1)
    assert "g2" in found.broken


def test_e13_annealing_turns_more_than_allowed() -> None:
    turns = sorted(math.degrees(w.turn) for w in measure(LISTS["sa"].waypoints).new)
    assert turns[-2:] == [pytest.approx(33.41, abs=0.01), pytest.approx(35.44, abs=0.01)]
    others = [
        math.degrees(w.turn) for n in ("ga", "theta-mafoa", "pso") for w in measure(LISTS[n].waypoints).new
    ]
    assert max(others) < 9.25


def test_e14_the_third_waypoint_is_moved_for_nothing() -> None:
    assert {n: row.waypoints[2][1] for n, row in LISTS.items()} == {
        "ga": 6480,
        "sa": 6500,
        "theta-mafoa": 6510,
        "pso": 6510,
    }
    nearest = min(math.dist(MISSION[2], place[:2]) for place in P.obstacles)
    assert nearest > 10_000.0


def foot(a: np.ndarray, b: np.ndarray, point: np.ndarray) -> tuple[float, float]:
    """Distance of a point from the infinite line a-b, and where along it (0 at a, 1 at b)."""
    along = b - a
    share = float((point - a) @ along / (along @ along))
    return float(np.hypot(*(point - a - share * along))), share


def test_e15_obstacle_1_is_inside_the_tolerance() -> None:
    distance, share = foot(MISSION[1], MISSION[2], np.array(P.obstacles[0][:2]))
    assert distance == pytest.approx(1590.4, abs=0.1)
    assert 0.0 < share < 1.0


def test_e16_the_turn_has_nothing_to_do_with_the_bank_limit() -> None:
    radius = SPEED**2 / (GRAVITY * math.tan(math.radians(30.0)))
    assert radius == pytest.approx(39.7, abs=0.05)
    assert math.degrees(SPEED / radius) == pytest.approx(21.6, abs=0.05)
    assert radius * math.tan(math.radians(90.0) / 2.0) < 40.0  # a right angle fits into 40 m


def test_e17_the_infinite_line_flags_what_lies_behind() -> None:
    distance, share = foot(MISSION[6], MISSION[7], np.array(P.obstacles[0][:2]))
    assert distance < 0.1
    assert (share - 1.0) * math.dist(MISSION[6], MISSION[7]) == pytest.approx(210_000, rel=0.01)
    distance, share = foot(MISSION[4], MISSION[5], np.array(P.obstacles[1][:2]))
    assert distance == pytest.approx(832.9, abs=0.1)
    assert -share * math.dist(MISSION[4], MISSION[5]) == pytest.approx(65_000, rel=0.01)


def test_e19_the_risk_is_a_wall() -> None:
    intrusion = 1000.0
    assert 0.9 * intrusion**2 > 50 * 0.1 * math.dist(MISSION[3], MISSION[4])


class Law:
    """Eqs. (15), (19) and (20) as printed, on a point that turns by Eq. (14); degrees, 100 Hz."""

    def __init__(
        self, offset: float, *, x_north: bool = True, clip: float = math.inf, limit: float = math.inf
    ):
        self.offset, self.along, self.course = offset, 0.0, 0.0
        self.command, self.bank, self.old = 0.0, 0.0, None
        self.sign = 1.0 if x_north else -1.0
        self.clip, self.limit = clip, limit
        self.largest, self.turned = 0.0, 0.0

    def step(self) -> None:
        # left of the track is DD > 0 with x north: A xpos + B ypos for a leg along x is -y
        error = -self.sign * self.offset
        rate = 0.0 if self.old is None else (error - self.old) / 0.01
        self.old = error
        error = max(-self.clip, min(self.clip, error))
        self.command += (error * 0.001 + rate * 0.05) * 0.1 - self.command * 0.01
        self.command = max(-self.limit, min(self.limit, self.command))
        self.bank += (self.command - self.bank) * 0.01 / 0.3
        self.largest = max(self.largest, abs(self.command))
        turn = GRAVITY * math.tan(math.radians(max(-89.0, min(89.0, self.bank)))) / SPEED * 0.01
        self.course += turn
        self.turned += turn
        self.along += SPEED * math.cos(self.course) * 0.01
        self.offset += SPEED * math.sin(self.course) * 0.01

    def fly(self, seconds: float) -> Law:
        for _ in range(int(seconds * 100)):
            self.step()
        return self


def test_e20_the_sign_fits_x_north_and_reverses_the_leg_with_x_east() -> None:
    right = Law(100.0, limit=30.0).fly(300.0)
    assert abs(right.offset) < 1.0
    assert right.along > 4000.0
    wrong = Law(100.0, x_north=False, limit=30.0).fly(600.0)
    assert math.cos(wrong.course) < -0.9


def test_e22_the_law_works_in_degrees_only() -> None:
    """Linearised: roll command k1 DD + k2 DDrate with a lag of 1 s, a roll lag of 0.3 s, Eq. (14)."""

    def poles(scale: float) -> np.ndarray:
        k1, k2 = 0.001 * 0.1 / 0.01 * scale, 0.05 * 0.1 / 0.01 * scale
        # offset'' = -g bank (small angles, V cancels): s^2 (s + 1)(0.3 s + 1) + g (k2 s + k1) = 0
        return np.roots([0.3, 1.3, 1.0, GRAVITY * k2, GRAVITY * k1])

    assert poles(math.pi / 180.0).real.max() < -0.02
    assert poles(1.0).real.max() > 0.0
    slow = math.sqrt(GRAVITY * 0.01 * math.pi / 180.0)
    assert slow == pytest.approx(0.0414, abs=1e-4)
    assert GRAVITY * 0.5 * math.pi / 180.0 / (2.0 * slow) == pytest.approx(1.03, abs=0.01)


def test_e23_without_limits_the_law_circles() -> None:
    assert Law(10_000.0).fly(10.0).largest > 50.0
    far = Law(3000.0, limit=30.0).fly(900.0)
    assert abs(far.turned) > 4.0 * math.pi
    mended = Law(3000.0, limit=30.0, clip=500.0).fly(900.0)
    assert abs(mended.offset) < 20.0
    assert abs(mended.turned) < math.pi


def test_e24_a_new_leg_kicks_the_command() -> None:
    """DD jumps by 1 km and DD_old is kept: one step adds 0.1 · 0.05 · 1000/0.01 degrees."""
    law = Law(0.0)
    law.step()
    before = law.command
    law.offset = -1000.0
    law.step()
    assert law.command - before == pytest.approx(500.0, abs=1.0)


def test_e25_the_end_of_a_leg_by_its_start_is_wrong_off_track() -> None:
    """5 km before the end, 8.7 km to the side: as far from the start as the end is."""
    leg, here = 10_000.0, (5000.0, 8700.0)
    assert leg - math.hypot(*here) < 1000.0
    assert math.dist(here, (leg, 0.0)) > 9000.0


def test_e26_tangents_give_two_solutions_and_seeds_on_the_sphere_break_g1() -> None:
    north, east = 9000.0, 2000.0  # relative to the aircraft
    square = north**2 + east**2
    angles = {
        sign * math.acos((-1000.0 * north + side * east * math.sqrt(square - 1000.0**2)) / square)
        for sign in (1.0, -1.0)
        for side in (1.0, -1.0)
    }
    touching = []
    for angle in angles:
        point = np.array([north, east]) + 1000.0 * np.array([math.cos(angle), math.sin(angle)])
        if abs(point @ np.array([math.cos(angle), math.sin(angle)])) < 1.0:
            touching.append(point)
    assert (len(angles), len(touching)) == (4, 2)
    assert all(math.dist(point, (north, east)) < 2000.0 for point in touching)  # so both break g1
    question = problem("obstacle 2", READINGS[0], PAPER)
    assert (question.constraints(sphere_seeds(question, 10, np.random.default_rng(0)))["g1"] == 0.0).all()


def test_e27_the_printed_coefficients_are_not_stable() -> None:
    bounds = [24.0 * (1.0 - w**2) / (7.0 - 5.0 * w) for w in (0.09, 0.02)]
    assert [round(bound, 2) for bound in bounds] == [3.63, 3.48]
    assert PAPER.swarm.cognitive + PAPER.swarm.social > max(bounds)


def test_e28_one_personal_best_leaves_only_the_social_term() -> None:
    """With pbest = gbest, Eq. (28) pulls to one point with (r1 + r2) C: no particle remembers its own."""
    runs = list(iterations(problem("obstacle 2", READINGS[1], PAPER), np.random.default_rng(0)))
    assert PAPER.swarm.shared_best
    assert all(later.best <= earlier.best for earlier, later in pairwise(runs))


def test_e29_the_zone_bounds_steps_not_places() -> None:
    runs = list(iterations(problem("obstacle 2", READINGS[1], PAPER), np.random.default_rng(3)))
    steps = [np.abs(later.points - earlier.points).max() for earlier, later in pairwise(runs)]
    assert max(steps) <= 800.0 + 1e-9
    assert PAPER.swarm.largest_step == 0.1 * 2.0 * PAPER.search_limit


def test_e30_the_stop_rule_ends_every_run_at_once() -> None:
    for case in ("obstacle 2", "obstacles 3-5"):
        for seed in range(5):
            found = list(iterations(problem(case, READINGS[0], PAPER), np.random.default_rng(seed)))
            assert len(found) - 1 in (5, 6)


def test_e31_the_range_test_misses_all_but_oncoming_traffic() -> None:
    """Range change in a second against the own motion of 15 m; the intruder 8 km away, 15 m/s."""
    moves = {
        "oncoming": (-15.0, 0.0),
        "same course": (15.0, 0.0),
        "receding": (20.0, 0.0),
        "crossing": (0.0, 15.0),
    }
    flagged = []
    for name, (north, east) in moves.items():
        change = 8000.0 - math.hypot(8000.0 + north - SPEED, east)
        if change > SPEED:
            flagged.append(name)
    assert flagged == ["oncoming"]


def test_e32_twenty_eight_seconds_are_not_five_hundred_metres() -> None:
    assert (28.0 * SPEED, 2.0 * 28.0 * SPEED) == (420.0, 840.0)


def test_e33_an_evaluation_takes_94_milliseconds() -> None:
    (row,) = (row for row in P.table4 if row.planner == "pso")
    assert row.time_s / (10 * 30) == pytest.approx(0.094, abs=0.0005)


def test_e34_annealing_reaches_a_kilometre_and_a_half() -> None:
    assert sum(100.0 * 0.95**k for k in range(1, 31)) == pytest.approx(1492, abs=0.5)


def test_e35_constraints_met_after_the_last_iteration() -> None:
    assert max(row.cs for row in P.table6) == 32.14  # of 30 iterations


def test_e36_scattered_obstacles_can_leave_no_gap() -> None:
    apart, radius = 1500.0, P.safety_radius
    assert 1000.0 < apart < 2.0 * radius


DOC = (Path(__file__).parents[2] / "docs" / "paper.md").read_text(encoding="utf-8")


def test_every_erratum_is_listed_and_the_docs_have_the_table() -> None:
    assert [e.id for e in errata()] == [f"E{n:02d}" for n in range(1, 38)]
    assert errata_markdown() in DOC


def test_what_says_it_is_tested_is_tested() -> None:
    here = Path(__file__).read_text(encoding="utf-8")
    tested = {f"E{number}" for number in re.findall(r"^def test_e(\d\d)_", here, re.M)}
    assert {e.id for e in errata() if e.tested} == tested


def test_the_optimum_of_a_search_is_what_the_grid_says() -> None:
    question = problem("obstacle 2", READINGS[1], PAPER)
    best = best_waypoint(question)
    assert best is not None
    assert optimum(question) == best[1] > math.dist(MISSION[3], MISSION[4])
