"""Verify the FMU against NASA's check cases: `python benchmarks/verification.py` prints a Markdown table."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from fmu.check import packaged
from fmu.nesc import CASES, DATA, errors, fly, references, spread


def main() -> int:
    """Print one row for each case; 1 if a limit is not kept, 3 if something is missing."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fmu", type=Path, help="FMU to fly; the built ones if not given")
    parser.add_argument("--data", type=Path, default=DATA, help="NASA's trajectories (%(default)s)")
    options = parser.parse_args()
    files = [options.fmu] if options.fmu else packaged()
    if not files or not options.data.is_dir():
        print(f"needs an FMU (sidestep fmu build) and trajectories in {options.data}", file=sys.stderr)
        return 3
    kept = True
    for file in files:
        print(f"{file.name}\n")
        print("| case | body | what it verifies | our largest error | limit | between NASA's own tools |")
        print("|---|---|---|---|---|---|")
        for case in CASES:
            known = references(case, options.data)
            found = errors(fly(case, file), known)
            kept &= all(found[tool] < limit for tool, limit in case.limits.items())
            ours = ", ".join(f"{error:.2g} ({tool})" for tool, error in found.items())
            limits = ", ".join(f"{limit:g} ({tool})" for tool, limit in case.limits.items())
            row = (case.number, case.body, case.verifies, f"{ours} {case.unit}", limits)
            print(f"| {' | '.join(row)} | {spread(known):.2g} {case.unit} |")
        print()
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
