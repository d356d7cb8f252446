"""Every equation and algorithm of the paper is cited where it is used, or listed here as unused."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGES = ("avoidance", "fmu", "offboard", "scenarios")
OTHER_SOURCES = {"offboard/geodesic.py", "offboard/frames.py"}  # cite Vincenty's equations, not the paper's

UNUSED: dict[str, str] = {}  # equation or algorithm, and why nothing uses it
NUMBERS = re.compile(r"(Eqs?\.|Algorithms?) ([^A-Za-z\]:;.]*(?:(?:and|to) [(\d][^A-Za-z\]:;.]*)*)")


def cited(text: str) -> set[str]:
    """Equation and algorithm numbers in a text, ranges written out."""
    found: set[str] = set()
    for kind, numbers in NUMBERS.findall(text):
        name = "Eq." if kind.startswith("Eq") else "Algorithm"
        plain = numbers.replace("(", "").replace(")", "").replace("–", "-").replace(" to ", "-")
        for first, last in re.findall(r"(\d+)(?:-(\d+))?", plain):
            found |= {f"{name} {number}" for number in range(int(first), int(last or first) + 1)}
    return found


def all_cited() -> set[str]:
    files = [
        file
        for package in PACKAGES
        for file in (ROOT / package).rglob("*")
        if file.suffix in {".py", ".c", ".h"}
    ]
    return set().union(
        *(cited(f.read_text()) for f in files if str(f.relative_to(ROOT)) not in OTHER_SOURCES)
    )


def test_every_equation_and_algorithm_has_its_place() -> None:
    wanted = {f"Eq. {n}" for n in range(1, 32)} | {f"Algorithm {n}" for n in range(1, 11)}
    assert sorted(wanted - all_cited() - set(UNUSED)) == []


def test_what_is_listed_as_unused_is_not_used() -> None:
    assert sorted(all_cited() & set(UNUSED)) == []


def test_ranges_and_lists_are_read() -> None:
    assert cited("Eqs. (9)-(10) and (22)-(24).") == {"Eq. 9", "Eq. 10", "Eq. 22", "Eq. 23", "Eq. 24"}
    assert cited("Algorithms 5 to 7") == {"Algorithm 5", "Algorithm 6", "Algorithm 7"}
